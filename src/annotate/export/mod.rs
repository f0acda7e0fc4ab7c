//! Tracks in the formats that other tools read.

use std::{
    fs,
    io::Write as _,
    path::{Path, PathBuf},
};

use super::{VideoInfo, keys::Object, track::Annotated};
use crate::{
    geometry::Rect,
    output::{Destination, OutputError, PartialFile},
};

mod coco;
mod cvat;
mod text;
mod yolo;

pub use cvat::editable_frames;

/// What is written: a video, its objects, and where they are.
#[derive(Debug, Clone, Copy)]
pub struct Tracks<'a> {
    /// The video.
    pub about: &'a VideoInfo,
    /// Its objects.
    pub objects: &'a [Object],
    /// Of each object a box in each frame, or `None` where it is absent.
    pub tracks: &'a [Vec<Option<Annotated>>],
}

/// The formats of annotations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// `x,y,w,h` a frame, NaN where the object is absent; one object. The first pixel is 1.
    Otb,
    /// With a header, a row for each object in each frame.
    Csv,
    /// One JSON object for each object in each frame, with the keys of [`Format::Csv`].
    JsonLines,
    /// MOTChallenge ground truth: `frame,id,x,y,w,h,1,class,1`. The first pixel is 1.
    Mot,
    /// CVAT for video XML 1.1.
    Cvat,
    /// COCO's JSON with `track_id`.
    Coco,
    /// A folder with a text file a frame: `class x y w h`, centre and sides as fractions of the picture.
    Yolo,
}

impl Format {
    /// Every format with the name that the command line has for it.
    pub const NAMES: [(&'static str, Self); 7] = [
        ("otb", Self::Otb),
        ("csv", Self::Csv),
        ("jsonl", Self::JsonLines),
        ("mot", Self::Mot),
        ("cvat", Self::Cvat),
        ("coco", Self::Coco),
        ("yolo", Self::Yolo),
    ];

    /// What the extension of a file says: csv, jsonl, xml (CVAT), json (COCO), otherwise OTB.
    pub fn from_path(path: &Path) -> Self {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        match extension.to_ascii_lowercase().as_str() {
            "csv" => Self::Csv,
            "jsonl" => Self::JsonLines,
            "xml" => Self::Cvat,
            "json" => Self::Coco,
            _ => Self::Otb,
        }
    }
}

impl Tracks<'_> {
    /// The text of a format that is one file; `None` for YOLO's folder.
    pub fn text(&self, format: Format) -> Option<String> {
        match format {
            Format::Otb => Some(text::otb(self)),
            Format::Csv => Some(text::csv(self)),
            Format::JsonLines => Some(text::json_lines(self)),
            Format::Mot => Some(text::mot(self)),
            Format::Cvat => Some(cvat::xml(self)),
            Format::Coco => Some(coco::json(self)),
            Format::Yolo => None,
        }
    }

    /// Writes the tracks to `path`: a file that has its name when it is whole, or for YOLO a folder that is not there yet.
    ///
    /// # Errors
    /// [`OutputError`]; nothing that was there is lost.
    pub fn write(&self, path: &Path, format: Format) -> Result<(), OutputError> {
        match self.text(format) {
            Some(text) => {
                let mut file = PartialFile::create(path)?;
                file.write_all(text.as_bytes()).map_err(|error| file.name_error(error))?;
                file.complete()
            }
            None => self.write_folder(path),
        }
    }

    fn write_folder(&self, path: &Path) -> Result<(), OutputError> {
        let failed = |path: &Path, source| OutputError::Io { path: path.to_owned(), source };
        if path.exists() {
            let there = std::io::Error::new(std::io::ErrorKind::AlreadyExists, "it is there already");
            return Err(failed(path, there));
        }
        let mut partial = path.as_os_str().to_owned();
        partial.push(".partial");
        let partial = PathBuf::from(partial);
        if partial.exists() {
            fs::remove_dir_all(&partial).map_err(|error| failed(&partial, error))?;
        }
        for (name, text) in self.yolo_files() {
            let file = partial.join(name);
            let folder = file.parent().unwrap_or(&partial);
            fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
            fs::write(&file, text).map_err(|error| failed(&file, error))?;
        }
        fs::rename(&partial, path).map_err(|error| failed(path, error))
    }

    /// The files of YOLO's folder: name and text.
    pub fn yolo_files(&self) -> Vec<(String, String)> {
        yolo::files(self)
    }

    /// The classes in the order of their first object.
    fn classes(&self) -> Vec<&str> {
        let mut classes: Vec<&str> = Vec::new();
        for object in self.objects {
            if !classes.contains(&object.class.as_str()) {
                classes.push(&object.class);
            }
        }
        classes
    }

    /// The number of an object's class, counted from 0.
    fn class_of(&self, object: &Object) -> usize {
        self.classes().iter().position(|class| *class == object.class).unwrap_or_default()
    }

    /// Every box: frame counted from 0, the object's number counted from 0, the object, and where it is; by frame, then object.
    fn boxes(&self) -> impl Iterator<Item = (usize, usize, &Object, Annotated)> {
        (0..self.about.frames).flat_map(move |frame| {
            self.objects.iter().zip(self.tracks).enumerate().filter_map(move |(number, (object, track))| {
                track.get(frame).copied().flatten().map(|found| (frame, number, object, found))
            })
        })
    }
}

/// The number of the first pixel is 1.
fn one_based(Rect { x, y, w, h }: Rect) -> [f64; 4] {
    [x + 1.0, y + 1.0, w, h]
}

#[cfg(test)]
mod tests;
