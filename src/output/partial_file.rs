//! A file that grows as FILE.partial and is called FILE only when it is whole.

use std::{
    ffi::OsString,
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

use super::{Destination, OutputError};

/// A file that grows as FILE.partial and takes the name FILE in [`complete`](Destination::complete). Dropped before that, it
/// stays as FILE.partial, unless nothing was written to it. Devices and pipes, such as `/dev/null`, are written
/// directly.
#[derive(Debug)]
pub struct PartialFile {
    file: File,
    path: PathBuf,
    /// `None` for what cannot be renamed.
    partial: Option<PathBuf>,
    completed: bool,
}

impl PartialFile {
    /// Starts an empty FILE.partial beside `path`; `path` itself stays as it is for now.
    ///
    /// # Errors
    /// [`OutputError`] if `path` is a folder, or FILE.partial cannot be written.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let kind = fs::metadata(path).map(|metadata| metadata.file_type()).ok();
        if kind.is_some_and(|kind| kind.is_dir()) {
            return Err(OutputError::IsFolder { path: path.to_owned() });
        }
        let partial = kind.is_none_or(|kind| kind.is_file()).then(|| partial_path(path));
        let target = partial.as_deref().unwrap_or(path);
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(true)
            .open(target)
            .map_err(|source| OutputError::Io { path: path.to_owned(), source })?;
        Ok(Self { file, path: path.to_owned(), partial, completed: false })
    }

    /// Where the bytes are until the file is whole.
    pub fn partial_path(&self) -> &Path {
        self.partial.as_deref().unwrap_or(&self.path)
    }

    /// The name of the whole file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// FILE.partial for FILE.
fn partial_path(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".partial");
    PathBuf::from(name)
}

impl Write for PartialFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Destination for PartialFile {
    fn complete(&mut self) -> Result<(), OutputError> {
        if let Some(partial) = &self.partial {
            fs::rename(partial, &self.path).map_err(|error| self.name_error(error))?;
        }
        self.completed = true;
        Ok(())
    }

    fn name_error(&self, error: io::Error) -> OutputError {
        OutputError::Io { path: self.path.clone(), source: error }
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        let Some(partial) = self.partial.as_deref().filter(|_| !self.completed) else { return };
        if fs::metadata(partial).is_ok_and(|metadata| metadata.len() == 0) {
            // Nothing is lost with an empty file, and there is nobody left to tell if it stays.
            let _ = fs::remove_file(partial);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_has_its_name_only_once_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.txt");
        fs::write(&path, "an earlier run").unwrap();
        let mut file = PartialFile::create(&path).unwrap();
        file.write_all(b"1,2,3,4\n").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "an earlier run");
        assert_eq!(fs::read_to_string(folder.path().join("rows.txt.partial")).unwrap(), "1,2,3,4\n");
        file.complete().unwrap();
        drop(file);
        assert_eq!(fs::read_to_string(&path).unwrap(), "1,2,3,4\n");
        assert!(!folder.path().join("rows.txt.partial").exists());
    }

    #[test]
    fn dropped_early_it_keeps_its_rows_but_leaves_no_empty_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.txt");
        let partial = folder.path().join("rows.txt.partial");
        drop(PartialFile::create(&path).unwrap());
        assert!(!partial.exists());
        PartialFile::create(&path).unwrap().write_all(b"row\n").unwrap();
        assert_eq!(fs::read_to_string(&partial).unwrap(), "row\n");
        assert!(!path.exists());
    }

    #[test]
    fn a_path_that_cannot_be_written_is_named_before_anything_is_tracked() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("no/such/folder/rows.txt");
        let message = PartialFile::create(&missing).unwrap_err().to_string();
        assert!(
            message.contains("no/such/folder/rows.txt") && message.contains("choose another path"),
            "{message}"
        );
        assert!(matches!(PartialFile::create(folder.path()), Err(OutputError::IsFolder { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_to_and_never_replaced() {
        let mut device = PartialFile::create(Path::new("/dev/null")).unwrap();
        device.write_all(b"row\n").unwrap();
        device.complete().unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
