//! Frames of a video file or a stream, through a pipe from the ffmpeg program.

use std::path::PathBuf;

use super::{FrameSource, SequenceError, SourceFrame, Wait, range::FrameRange, size_guard::SizeGuard};

mod ffmpeg;
mod input;
mod live;
mod log;
mod pipe;
mod ppm;

use ffmpeg::{Decoder, RawFrame};
pub(super) use input::VideoInput;
pub(super) use live::LiveVideo;
use pipe::Patience;

/// A video's frames, decoded one at a time by a child process that is ended when this is dropped.
#[derive(Debug)]
pub(super) struct VideoFile {
    /// What messages call it.
    path: PathBuf,
    decoder: Decoder,
    range: FrameRange,
    /// Frames decoded so far, so the number of the latest.
    decoded: usize,
    /// The first wanted frame, decoded on opening.
    first: Option<RawFrame>,
    size: SizeGuard,
}

impl VideoFile {
    /// Starts the program that INFOPART_FFMPEG names, else `ffmpeg`, and decodes up to the range's first frame.
    pub(super) fn open(input: VideoInput, range: FrameRange, wait: Wait) -> Result<Self, SequenceError> {
        let program = std::env::var("INFOPART_FFMPEG").ok().filter(|name| !name.is_empty());
        let patience = Patience::with(&input, wait);
        Self::open_with(program.as_deref().unwrap_or("ffmpeg"), &input, range, patience)
    }

    fn open_with(
        program: &str,
        input: &VideoInput,
        range: FrameRange,
        patience: Patience,
    ) -> Result<Self, SequenceError> {
        let (decoder, first) = Decoder::start(program, input, patience)?;
        let mut video = Self {
            path: input.name(),
            decoder,
            range,
            decoded: 1,
            first: Some(first),
            size: SizeGuard::default(),
        };
        video.skip_to_start()?;
        Ok(video)
    }

    /// Goes on decoding whether frames are asked for or not, and delivers the newest.
    pub(super) fn live(self) -> LiveVideo {
        LiveVideo::follow(self)
    }

    fn skip_to_start(&mut self) -> Result<(), SequenceError> {
        while self.decoded < self.range.start {
            self.first = self.decoder.next_frame(&self.path, self.decoded)?;
            if self.first.is_none() {
                let input = self.path.display().to_string();
                return Err(SequenceError::StartBeyondEnd {
                    input,
                    start: self.range.start,
                    frames: self.decoded,
                });
            }
            self.decoded += 1;
        }
        Ok(())
    }

    fn next_raw(&mut self) -> Result<Option<RawFrame>, SequenceError> {
        if let Some(first) = self.first.take() {
            return Ok(Some(first));
        }
        if self.range.end.is_some_and(|end| self.decoded >= end) {
            return Ok(None);
        }
        let next = self.decoder.next_frame(&self.path, self.decoded)?;
        self.decoded += usize::from(next.is_some());
        Ok(next)
    }
}

impl FrameSource for VideoFile {
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, SequenceError> {
        let Some(RawFrame { frame, time }) = self.next_raw()? else {
            return Ok(None);
        };
        let number = self.decoded;
        self.size.check(&frame, || format!("{}, frame {number}", self.path.display()))?;
        Ok(Some(SourceFrame { frame, number, label: format!("frame {number}"), time }))
    }

    fn remaining(&self) -> Option<usize> {
        None
    }
}

#[cfg(all(test, unix))]
mod tests;
