//! Frames by number from any input that can be opened again: those of the stretch at hand are kept decoded.

use std::{error::Error, ops::Range, time::Duration};

use super::passes::Frames;
use crate::{
    frame::{Frame, FrameView},
    sequence::{OpenOptions, SequenceError, SourceFrame, is_stream, open},
};

/// An input's frames. Up to a number of bytes they are kept decoded; of a longer input a stretch is, and is read again when another is
/// asked for.
pub struct KeptFrames {
    input: String,
    options: OpenOptions,
    about: VideoInfo,
    kept: Vec<Frame>,
    /// The number, counted from 0, of the first that is kept.
    first_kept: usize,
    /// How many may be kept.
    most: usize,
}

/// What is known of a video beside its pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct VideoInfo {
    /// The name of the folder or file.
    pub name: String,
    /// How many frames it has.
    pub frames: usize,
    /// Width of a frame, pixels.
    pub width: usize,
    /// Height of a frame, pixels.
    pub height: usize,
    /// The file name of each frame, or `frame N`.
    pub labels: Vec<String>,
    /// Presentation time of each frame since the start; `None` for images.
    pub times: Vec<Option<Duration>>,
    /// A hash of the first frame's pixels.
    pub first_frame_hash: u64,
}

impl KeptFrames {
    /// Reads through the input once; at most `bytes` of decoded frames are kept, but always those of 64 frames.
    ///
    /// # Errors
    /// [`SequenceError`] as of [`open`], for a stream, which cannot be read twice, and for an input without a frame.
    pub fn open(input: &str, options: &OpenOptions, bytes: usize) -> Result<Self, SequenceError> {
        if is_stream(input, options)? {
            let (input, purpose) = (input.to_owned(), "annotating it");
            return Err(SequenceError::ReadOnce { input, purpose });
        }
        let mut sequence = open(input, options)?;
        let mut kept: Vec<Frame> = Vec::new();
        let (mut labels, mut times) = (Vec::new(), Vec::new());
        let mut most = usize::MAX;
        let mut about: Option<(usize, usize, u64)> = None;
        while let Some(SourceFrame { frame, label, time, .. }) = sequence.source.next_frame()? {
            let view = frame.view();
            if about.is_none() {
                let size = view.width() * view.height() * view.format().bytes_per_pixel();
                most = (bytes / size.max(1)).max(64);
                about = Some((view.width(), view.height(), hash(&view)));
            }
            labels.push(label);
            times.push(time);
            if kept.len() < most {
                kept.push(frame);
            }
        }
        let Some((width, height, first_frame_hash)) = about else {
            return Err(SequenceError::NoImages { path: input.into() });
        };
        let (name, frames) = (sequence.name, labels.len());
        let about = VideoInfo { name, frames, width, height, labels, times, first_frame_hash };
        Ok(Self { input: input.to_owned(), options: options.clone(), about, kept, first_kept: 0, most })
    }

    /// What is known of the video.
    pub fn about(&self) -> &VideoInfo {
        &self.about
    }

    fn is_kept(&self, index: usize) -> bool {
        self.kept_range().contains(&index)
    }

    fn kept_range(&self) -> Range<usize> {
        self.first_kept..self.first_kept + self.kept.len()
    }

    /// Reads the stretch around a frame: half of what may be kept on either side, for a pass may go either way.
    fn read_around(&mut self, index: usize) -> Result<(), SequenceError> {
        let first = index.saturating_sub(self.most / 2).min(self.about.frames.saturating_sub(self.most));
        let offset = self.options.start.unwrap_or(1);
        let last = (first + self.most).min(self.about.frames) - 1;
        let options =
            OpenOptions { start: Some(first + offset), end: Some(last + offset), ..self.options.clone() };
        self.kept.clear();
        self.first_kept = first;
        let mut sequence = open(&self.input, &options)?;
        while let Some(next) = sequence.source.next_frame()? {
            self.kept.push(next.frame);
        }
        Ok(())
    }
}

impl Frames for KeptFrames {
    fn view(&mut self, index: usize) -> Result<FrameView<'_>, Box<dyn Error + Send + Sync>> {
        if !self.is_kept(index) {
            self.read_around(index)?;
        }
        let frame = self.kept.get(index.wrapping_sub(self.first_kept));
        frame.map(Frame::view).ok_or_else(|| {
            format!("{}: frame {} is not there any more; the file has changed", self.input, index + 1).into()
        })
    }
}

/// FNV-1a over the pixels.
fn hash(view: &FrameView<'_>) -> u64 {
    let bytes = (0..view.height()).flat_map(|y| view.row(y));
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_frame_is_had_in_any_order_however_few_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        for number in 0..150u8 {
            let picture = image::GrayImage::from_pixel(8, 6, image::Luma([number]));
            picture.save(folder.path().join(format!("{number}.png"))).unwrap();
        }
        let mut frames =
            KeptFrames::open(folder.path().to_str().unwrap(), &OpenOptions::default(), 0).unwrap();
        let about = frames.about();
        assert_eq!(
            (about.frames, about.width, about.height, about.labels[149].as_str()),
            (150, 8, 6, "149.png")
        );
        for index in [0, 149, 63, 64, 65, 20, 148, 1, 75] {
            assert_eq!(usize::from(frames.view(index).unwrap().row(0)[0]), index);
            assert!(frames.kept.len() <= 64);
        }
        std::fs::remove_file(folder.path().join("149.png")).unwrap();
        frames.view(0).unwrap();
        let message = frames.view(149).unwrap_err().to_string();
        assert!(message.contains("frame 150") && message.contains("changed"), "{message}");
    }
}
