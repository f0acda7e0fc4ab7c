//! The ffmpeg process: its arguments, its frames, its end.

use std::{
    io,
    path::Path,
    process::{Child, Command, ExitStatus, Stdio},
    sync::{Arc, Mutex, PoisonError},
    thread,
    time::{Duration, Instant},
};

use super::{
    super::SequenceError,
    input::VideoInput,
    log::LogReader,
    pipe::{Frames, Patience, Trouble},
};
use crate::frame::Frame;

/// What differs between ffmpegs.
#[derive(Debug, Clone, Copy)]
struct Dialect {
    /// The option that makes ffmpeg neither drop nor repeat frames.
    no_resampling: &'static str,
    /// The filter that tells each frame's time. Its checksums, nearly half of the work of a decode, are left out where they can be.
    times: &'static str,
}

const NEW: Dialect = Dialect { no_resampling: "-fps_mode", times: "showinfo=checksum=0" };
/// Before version 5.1.
const OLD: Dialect = Dialect { no_resampling: "-vsync", times: "showinfo" };

/// How long a process may take to end once it has closed its output.
const PATIENCE: Duration = Duration::from_secs(5);

/// A decoded frame and its time since the video's first.
#[derive(Debug)]
pub(super) struct RawFrame {
    pub(super) frame: Frame,
    pub(super) time: Option<Duration>,
}

/// A running ffmpeg, ended on drop.
#[derive(Debug)]
pub(super) struct Decoder {
    child: Stopper,
    /// `None` once it is given up.
    frames: Option<Frames>,
    log: LogReader,
    first_time: Option<f64>,
    last_time: Option<Duration>,
}

/// Ends an ffmpeg from wherever.
#[derive(Debug, Clone)]
pub(super) struct Stopper(Arc<Mutex<Child>>);

impl Stopper {
    /// Ends the process and collects it. Neither can fail in a way that matters: it may have ended by itself.
    pub(super) fn stop(&self) {
        let mut child = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let _ = child.kill();
        let _ = child.wait();
    }

    /// How the process ended, if it does within some time after it has closed its output.
    fn ended(&self) -> Option<ExitStatus> {
        let since = Instant::now();
        while since.elapsed() < PATIENCE {
            let status = self.0.lock().unwrap_or_else(PoisonError::into_inner).try_wait();
            match status {
                Ok(None) => thread::sleep(Duration::from_millis(2)),
                Ok(status) => return status,
                Err(_) => return None,
            }
        }
        None
    }
}

impl Decoder {
    /// Starts ffmpeg on an input and waits for its first frame.
    pub(super) fn start(
        program: &str,
        input: &VideoInput,
        patience: Patience,
    ) -> Result<(Self, RawFrame), SequenceError> {
        match Self::try_start(program, input, NEW, patience.clone())? {
            Ok(started) => Ok(started),
            Err(lines) if lines.iter().any(|line| line.contains("fps_mode")) => {
                Self::try_start(program, input, OLD, patience)?.map_err(|lines| bad_video(input, &lines))
            }
            Err(lines) => Err(bad_video(input, &lines)),
        }
    }

    /// The inner error: ffmpeg's last lines where it gave no frame.
    fn try_start(
        program: &str,
        input: &VideoInput,
        dialect: Dialect,
        patience: Patience,
    ) -> Result<Result<(Self, RawFrame), Vec<String>>, SequenceError> {
        let mut decoder = Self::spawn(program, input, dialect, patience)?;
        match decoder.read() {
            Ok(Some(frame)) => {
                let first = decoder.timed(frame);
                if decoder.log.is_text() {
                    return Ok(Err(vec!["the file is text".to_owned()]));
                }
                Ok(Ok((decoder, first)))
            }
            Err(Trouble::Silent(limit)) => {
                decoder.end();
                Ok(Err(vec![silent(limit)]))
            }
            Err(Trouble::Stopped) => {
                decoder.end();
                Ok(Err(vec!["interrupted before its first frame".to_owned()]))
            }
            Ok(None) | Err(Trouble::Broken) => {
                decoder.end();
                Ok(Err(decoder.log.last_lines()))
            }
        }
    }

    fn spawn(
        program: &str,
        input: &VideoInput,
        dialect: Dialect,
        patience: Patience,
    ) -> Result<Self, SequenceError> {
        let failed =
            |source| SequenceError::FfmpegMissing { path: input.name(), program: program.to_owned(), source };
        let (options, name) = input.arguments();
        let mut child = Command::new(program)
            .args(["-nostdin", "-hide_banner", "-nostats", "-loglevel", "level+info"])
            .args(options)
            .arg("-i")
            .arg(name)
            .args(["-map", "0:v:0", "-vf", dialect.times, dialect.no_resampling, "passthrough"])
            .args(["-f", "image2pipe", "-c:v", "ppm", "-pix_fmt", "rgb24", "-"])
            .stdin(input.stdin())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        match (child.stdout.take(), child.stderr.take()) {
            (Some(stdout), Some(stderr)) => Ok(Self {
                child: Stopper(Arc::new(Mutex::new(child))),
                frames: Some(Frames::follow(stdout, patience)),
                log: LogReader::follow(stderr),
                first_time: None,
                last_time: None,
            }),
            _ => Err(failed(io::Error::other("it has no output"))),
        }
    }

    pub(super) fn stopper(&self) -> Stopper {
        self.child.clone()
    }

    fn read(&mut self) -> Result<Option<Frame>, Trouble> {
        self.frames.as_mut().map_or(Ok(None), Frames::next)
    }

    /// The next frame after number `last_good`, or `None` at the video's proper end.
    pub(super) fn next_frame(
        &mut self,
        path: &Path,
        last_good: usize,
    ) -> Result<Option<RawFrame>, SequenceError> {
        let read = self.read();
        if let Ok(Some(frame)) = read {
            return Ok(Some(self.timed(frame)));
        }
        if matches!(read, Err(Trouble::Stopped)) {
            self.end();
            return Ok(None);
        }
        let broken =
            |message: String| SequenceError::VideoBroken { path: path.to_owned(), last_good, message };
        let ended_well =
            matches!(read, Ok(None)) && self.child.ended().is_some_and(|status| status.success());
        self.end();
        if ended_well {
            return match self.log.early_end(self.last_time, last_good) {
                Some(reason) => Err(broken(reason)),
                None => Ok(None),
            };
        }
        if let Err(Trouble::Silent(limit)) = read {
            return Err(broken(silent(limit)));
        }
        let lines = self.log.last_lines();
        let message =
            last_message(&lines).map_or_else(|| "ffmpeg stopped without a message".to_owned(), str::to_owned);
        Err(broken(message))
    }

    fn timed(&mut self, frame: Frame) -> RawFrame {
        let in_container = self.log.next_time();
        let first = *self.first_time.get_or_insert(in_container.unwrap_or(0.0));
        let time = in_container.and_then(|time| Duration::try_from_secs_f64(time - first).ok());
        self.last_time = time;
        RawFrame { frame, time }
    }

    /// Ends the process, and closes the pipe first: what the process may have started could go on writing into it, and nothing of
    /// it would end while somebody holds the other side.
    fn end(&mut self) {
        drop(self.frames.take());
        self.child.stop();
    }
}

impl Drop for Decoder {
    fn drop(&mut self) {
        self.end();
    }
}

fn silent(limit: Duration) -> String {
    format!("no frame came for {} seconds", limit.as_secs_f64())
}

fn bad_video(input: &VideoInput, lines: &[String]) -> SequenceError {
    let message = last_message(lines).unwrap_or("it gives no frame");
    let path = input.name();
    let names =
        [format!("file:{}: ", path.display()), format!("{}: ", path.display()), "pipe:0: ".to_owned()];
    let message =
        names.iter().find_map(|name| message.strip_prefix(name.as_str())).unwrap_or(message).to_owned();
    SequenceError::BadVideo { path, message }
}

/// The last line that tells a reason; what ffmpeg says about its own farewell does not.
fn last_message(lines: &[String]) -> Option<&str> {
    let farewell = ["Conversion failed!", "Error opening input file", "Exiting normally", "To ignore this"];
    let tells = |line: &&String| !farewell.iter().any(|start| line.starts_with(start));
    lines.iter().rev().find(tells).or(lines.last()).map(String::as_str)
}
