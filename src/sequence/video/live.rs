//! The newest frame of a stream, without a backlog.
//!
//! A thread decodes as fast as frames come and puts each into a slot of one, in place of one that nobody has taken. Frames keep
//! the numbers that they have in the stream, so that what was left out can be told.

use std::{
    sync::{Arc, Condvar, Mutex, PoisonError},
    thread,
};

use super::{FrameSource, SequenceError, SourceFrame, VideoFile, ffmpeg::Stopper};

/// What the thread has for whoever asks.
#[derive(Debug, Default)]
struct Slot {
    newest: Option<SourceFrame>,
    /// How the stream ended, once it has.
    ended: Option<Result<(), SequenceError>>,
}

/// A stream of which the newest frame is delivered.
#[derive(Debug)]
pub(in super::super) struct LiveVideo {
    slot: Arc<(Mutex<Slot>, Condvar)>,
    stopper: Stopper,
}

impl LiveVideo {
    pub(super) fn follow(mut video: VideoFile) -> Self {
        let slot = Arc::new((Mutex::new(Slot::default()), Condvar::new()));
        let stopper = video.decoder.stopper();
        let shared = Arc::clone(&slot);
        thread::spawn(move || {
            loop {
                let next = video.next_frame();
                let (slot, changed) = &*shared;
                let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
                let is_over = !matches!(next, Ok(Some(_)));
                match next {
                    Ok(Some(frame)) => slot.newest = Some(frame),
                    Ok(None) => slot.ended = Some(Ok(())),
                    Err(error) => slot.ended = Some(Err(error)),
                }
                changed.notify_all();
                // Nobody else holds the slot: nobody will ask again.
                if is_over || Arc::strong_count(&shared) == 1 {
                    break;
                }
            }
        });
        Self { slot, stopper }
    }
}

impl FrameSource for LiveVideo {
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, SequenceError> {
        let (slot, changed) = &*self.slot;
        let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            if let Some(frame) = slot.newest.take() {
                return Ok(Some(frame));
            }
            match slot.ended.take() {
                Some(Ok(())) => {
                    slot.ended = Some(Ok(()));
                    return Ok(None);
                }
                Some(Err(error)) => {
                    slot.ended = Some(Ok(()));
                    return Err(error);
                }
                None => slot = changed.wait(slot).unwrap_or_else(PoisonError::into_inner),
            }
        }
    }

    fn remaining(&self) -> Option<usize> {
        None
    }
}

impl Drop for LiveVideo {
    fn drop(&mut self) {
        self.stopper.stop();
    }
}
