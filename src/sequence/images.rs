//! Frames from image files: a folder, a glob, or a single one.

use std::{
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
    vec,
};

use super::{
    FrameSource, SequenceError, SourceFrame, decode::decode_image, natural::natural_order,
    size_guard::SizeGuard,
};

const EXTENSIONS: [&str; 7] = ["jpg", "jpeg", "png", "bmp", "tif", "tiff", "webp"];

/// Image files, decoded one at a time.
#[derive(Debug)]
pub(super) struct ImageFiles {
    files: vec::IntoIter<PathBuf>,
    next_number: usize,
    size: SizeGuard,
}

impl ImageFiles {
    /// Delivers `files` in their order, the first as frame `first_number`.
    pub(super) fn new(files: Vec<PathBuf>, first_number: usize) -> Self {
        Self { files: files.into_iter(), next_number: first_number, size: SizeGuard::default() }
    }
}

impl FrameSource for ImageFiles {
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, SequenceError> {
        let Some(path) = self.files.next() else {
            return Ok(None);
        };
        let frame = decode_image(&path)?;
        self.size.check(&frame, || path.display().to_string())?;
        let number = self.next_number;
        self.next_number += 1;
        Ok(Some(SourceFrame { frame, number, label: file_name(&path), time: None }))
    }

    fn remaining(&self) -> Option<usize> {
        Some(self.files.len())
    }
}

/// The images of a folder in natural order; hidden files and other kinds are passed over. May be empty.
pub(super) fn images_in(folder: &Path) -> Result<Vec<PathBuf>, SequenceError> {
    let io_error = |source| SequenceError::Io { path: folder.to_owned(), source };
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(io_error)? {
        let path = entry.map_err(io_error)?.path();
        if is_image_file(&path) {
            files.push(path);
        }
    }
    sort_naturally(&mut files);
    Ok(files)
}

/// The images that a glob pattern names, in natural order. May be empty.
pub(super) fn images_matching(pattern: &str) -> Result<Vec<PathBuf>, SequenceError> {
    let options = glob::MatchOptions { require_literal_leading_dot: true, ..glob::MatchOptions::new() };
    let paths = glob::glob_with(pattern, options).map_err(|error| SequenceError::BadPattern {
        pattern: pattern.to_owned(),
        reason: error.to_string(),
    })?;
    let mut files = Vec::new();
    for entry in paths {
        let path = entry
            .map_err(|error| SequenceError::Io { path: error.path().to_owned(), source: error.into() })?;
        if is_image_file(&path) {
            files.push(path);
        }
    }
    sort_naturally(&mut files);
    Ok(files)
}

/// Whether the name is that of an image which can be decoded here.
pub(super) fn has_image_extension(path: &Path) -> bool {
    let extension = path.extension().and_then(OsStr::to_str);
    extension.is_some_and(|given| EXTENSIONS.iter().any(|known| given.eq_ignore_ascii_case(known)))
}

/// A file's name without its folder, for messages.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The folder's own name, also where the path ends in `.` or `..`.
pub(super) fn folder_name(path: &Path) -> String {
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let resolved = || std::path::absolute(path).ok().and_then(|path| path.canonicalize().ok());
    name(path).or_else(|| resolved().and_then(|path| name(&path))).unwrap_or_else(|| file_name(path))
}

fn is_image_file(path: &Path) -> bool {
    has_image_extension(path) && !file_name(path).starts_with('.') && path.is_file()
}

fn sort_naturally(files: &mut [PathBuf]) {
    files.sort_by(|a, b| natural_order(&a.to_string_lossy(), &b.to_string_lossy()));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(files: &[PathBuf]) -> Vec<String> {
        files.iter().map(|path| file_name(path)).collect()
    }

    #[test]
    fn a_folder_lists_its_images_naturally_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["10.jpg", "2.JPG", "1.jpeg", "3.bmp", "4.Png", ".0.jpg", "notes.txt", "0"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        fs::create_dir(folder.path().join("5.jpg")).unwrap();
        let expected = ["1.jpeg", "2.JPG", "3.bmp", "4.Png", "10.jpg"];
        assert_eq!(names(&images_in(folder.path()).unwrap()), expected);
        let pattern = format!("{}/*", folder.path().display());
        assert_eq!(names(&images_matching(&pattern).unwrap()), expected);
        let pattern = format!("{}/[12]*.j*", folder.path().display());
        assert_eq!(names(&images_matching(&pattern).unwrap()), ["1.jpeg", "10.jpg"]);
    }

    #[test]
    fn a_frame_of_another_size_names_both() {
        let folder = tempfile::tempdir().unwrap();
        for (name, width) in [("1.png", 4), ("2.png", 5)] {
            image::GrayImage::new(width, 3).save(folder.path().join(name)).unwrap();
        }
        let mut source = ImageFiles::new(images_in(folder.path()).unwrap(), 1);
        let first = source.next_frame().unwrap().unwrap();
        assert_eq!((first.number, first.label.as_str(), source.remaining()), (1, "1.png", Some(1)));
        let message = source.next_frame().unwrap_err().to_string();
        assert!(message.contains("2.png: this frame is 5x3 but the first is 4x3"), "{message}");
    }

    #[test]
    fn a_bad_pattern_is_an_error() {
        assert!(matches!(images_matching("a/***"), Err(SequenceError::BadPattern { .. })));
    }
}
