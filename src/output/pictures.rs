//! A folder of annotated pictures, one a frame.

use std::{
    fs::{self, File},
    io::{BufWriter, Write},
    path::{Path, PathBuf},
};

use image::{ImageError, RgbImage, codecs::jpeg::JpegEncoder};

use super::{FrameEvent, Observer, OutputError, annotate};

/// JPEG quality at which lines and letters show no fringes.
const JPEG_QUALITY: u8 = 90;

/// Writes each annotated frame to FOLDER/000001.jpg, FOLDER/000002.jpg, ... by the frame's number.
#[derive(Debug)]
pub struct PictureFolder {
    folder: PathBuf,
}

impl PictureFolder {
    /// Makes `folder` if it is not there. Pictures of the same name in it are replaced.
    ///
    /// # Errors
    /// [`OutputError`] if the folder cannot be made.
    pub fn create(folder: &Path) -> Result<Self, OutputError> {
        fs::create_dir_all(folder).map_err(|source| OutputError::Io { path: folder.to_owned(), source })?;
        Ok(Self { folder: folder.to_owned() })
    }

    /// Writes the picture of frame `number`.
    ///
    /// # Errors
    /// [`OutputError`] if that is impossible.
    pub fn write(&self, picture: &RgbImage, number: usize) -> Result<(), OutputError> {
        let path = self.folder.join(format!("{number:06}.jpg"));
        write_jpeg(picture, &path).map_err(|source| OutputError::Picture { path, source })
    }
}

impl Observer for PictureFolder {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        self.write(&annotate(event), event.number)
    }
}

fn write_jpeg(picture: &RgbImage, path: &Path) -> Result<(), ImageError> {
    let mut file = BufWriter::new(File::create(path)?);
    picture.write_with_encoder(JpegEncoder::new_with_quality(&mut file, JPEG_QUALITY))?;
    Ok(file.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{geometry::Rect, output::testing::EventParts};

    #[test]
    fn pictures_are_named_by_frame_and_can_be_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("deep/pictures");
        let mut pictures = PictureFolder::create(&target).unwrap();
        let mut parts = EventParts::new(Rect::new(10.0, 12.0, 8.0, 20.0));
        parts.number = 12;
        pictures.on_frame(&parts.event()).unwrap();
        assert_eq!(image::open(target.join("000012.jpg")).unwrap().width(), 256);
    }

    #[test]
    fn a_file_in_the_folders_place_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let taken = folder.path().join("taken");
        fs::write(&taken, "").unwrap();
        let message = PictureFolder::create(&taken).unwrap_err().to_string();
        assert!(message.contains("taken") && message.contains("choose another path"), "{message}");
    }
}
