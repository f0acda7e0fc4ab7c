//! Frames from a pipe, read by a thread of their own, so that a wait for the next can be given up.

use std::{
    io::{self, BufReader, Read},
    path::{Path, PathBuf},
    sync::{
        atomic::Ordering,
        mpsc::{Receiver, RecvTimeoutError, sync_channel},
    },
    thread,
    time::{Duration, Instant},
};

use super::{input::VideoInput, ppm::read_ppm};
use crate::{frame::Frame, sequence::Wait};

/// How long a file may give no frame. The slowest seek or drive does not come near this.
const LONGEST_SILENCE: Duration = Duration::from_secs(60);

/// When it is told that a stream is waited for.
const TOLD_AFTER: Duration = Duration::from_secs(5);

/// How often it is looked whether to go on waiting.
const GLANCE: Duration = Duration::from_millis(100);

/// How long frames are waited for.
#[derive(Debug, Clone)]
pub(super) struct Patience {
    name: PathBuf,
    /// `None`: without end.
    limit: Option<Duration>,
    wait: Wait,
}

impl Patience {
    /// A file is given up after a while; a camera, or whoever writes into a pipe, may have nothing to show for as long as it likes.
    pub(super) fn with(input: &VideoInput, wait: Wait) -> Self {
        let limit = matches!(input, VideoInput::File(_)).then_some(LONGEST_SILENCE);
        Self { name: input.name(), limit, wait }
    }

    #[cfg(test)]
    pub(super) fn limited(limit: Option<Duration>, wait: Wait) -> Self {
        Self { name: PathBuf::from("some.mp4"), limit, wait }
    }

    fn is_stopped(&self) -> bool {
        self.wait.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

/// Why there is no frame, nor an end.
#[derive(Debug)]
pub(super) enum Trouble {
    /// What came is no frame.
    Broken,
    /// Nothing came for so long.
    Silent(Duration),
    /// The wait was called off.
    Stopped,
}

/// The frames that a process writes.
#[derive(Debug)]
pub(super) struct Frames {
    frames: Receiver<io::Result<Option<Frame>>>,
    patience: Patience,
    is_told: bool,
}

impl Frames {
    /// Follows a pipe, at most two frames ahead of what is asked for. It is closed soon after this is dropped, at the latest when
    /// the process writes more or ends.
    pub(super) fn follow(pipe: impl Read + Send + 'static, patience: Patience) -> Self {
        let (sender, frames) = sync_channel(1);
        thread::spawn(move || {
            let mut pipe = BufReader::new(pipe);
            loop {
                let frame = read_ppm(&mut pipe);
                let is_over = !matches!(frame, Ok(Some(_)));
                if sender.send(frame).is_err() || is_over {
                    return;
                }
            }
        });
        Self { frames, patience, is_told: false }
    }

    /// The next frame, or `None` where they end.
    pub(super) fn next(&mut self) -> Result<Option<Frame>, Trouble> {
        let since = Instant::now();
        loop {
            match self.frames.recv_timeout(GLANCE) {
                Ok(frame) => return frame.map_err(|_| Trouble::Broken),
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {}
            }
            let silence = since.elapsed();
            if self.patience.is_stopped() {
                return Err(Trouble::Stopped);
            }
            match self.patience.limit {
                Some(limit) if silence >= limit => return Err(Trouble::Silent(limit)),
                None if silence >= TOLD_AFTER => self.tell(),
                _ => {}
            }
        }
    }

    fn tell(&mut self) {
        if let (false, Some(tell)) = (self.is_told, self.patience.wait.tell) {
            let name: &Path = &self.patience.name;
            tell(name);
        }
        self.is_told = true;
    }
}
