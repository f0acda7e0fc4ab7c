//! Where the frames of a target are, in whatever layout.

use std::path::PathBuf;

use infopart::{
    geometry::Origin,
    sequence::{FramePlace, SequenceError, benchmark_sequences, otb_images, otb_targets},
};

/// Where the frames of a target are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameFolder {
    /// The sequence's folder, or the file of its ground truth where that lies apart: what [`infopart::sequence::open`] takes.
    pub path: PathBuf,
    /// Which target of the folder, if they are numbered.
    pub target: Option<usize>,
    /// The first frame of the truth, counted from 1 among the frames that [`infopart::sequence::open`] delivers.
    pub first_frame: usize,
    /// The number of the first pixel in its boxes.
    pub origin: Origin,
    /// The file of its ground truth.
    pub ground_truth: PathBuf,
}

/// The frames of a target.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FrameFiles {
    /// Files of images.
    Images {
        /// All of the folder, in the order of their numbers.
        all: Vec<PathBuf>,
        /// Those that rows of the ground truth belong to, as [`infopart::sequence::open`] delivers them.
        covered: Vec<PathBuf>,
    },
    /// A video.
    Video(PathBuf),
}

impl FrameFolder {
    /// Its frames, of which `rows` have a row of ground truth.
    ///
    /// # Errors
    /// [`SequenceError::Io`] if a folder cannot be read.
    pub fn files(&self, rows: usize) -> Result<FrameFiles, SequenceError> {
        if !otb_targets(&self.path)?.is_empty() {
            let images = otb_images(&self.path, rows)?;
            return Ok(FrameFiles::Images { all: images.all, covered: images.covered });
        }
        let found = benchmark_sequences(&self.path)?;
        let own = found.iter().find(|one| found.len() == 1 || one.number == self.target);
        let Some(own) = own else { return Ok(FrameFiles::Images { all: Vec::new(), covered: Vec::new() }) };
        if let FramePlace::Video(video) = &own.frames {
            return Ok(FrameFiles::Video(video.clone()));
        }
        let all = own.images()?;
        let covered = own.covered(&all, rows).map(|covered| all[covered].to_vec()).unwrap_or_default();
        Ok(FrameFiles::Images { all, covered })
    }
}
