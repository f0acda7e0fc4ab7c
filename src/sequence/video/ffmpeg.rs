//! The ffmpeg process: its arguments, its frames, its end.

use std::{
    ffi::OsString,
    io::{self, BufReader},
    path::Path,
    process::{Child, ChildStdout, Command, Stdio},
    time::Duration,
};

use super::{super::SequenceError, log::LogReader, ppm::read_ppm};
use crate::frame::Frame;

/// The option that makes ffmpeg neither drop nor repeat frames, new and old spelling.
const NO_RESAMPLING: [&str; 2] = ["-fps_mode", "-vsync"];

/// A decoded frame and its time since the video's first.
#[derive(Debug)]
pub(super) struct RawFrame {
    pub(super) frame: Frame,
    pub(super) time: Option<Duration>,
}

/// A running ffmpeg, ended on drop.
#[derive(Debug)]
pub(super) struct Decoder {
    child: Child,
    frames: BufReader<ChildStdout>,
    log: LogReader,
    first_time: Option<f64>,
}

impl Decoder {
    /// Starts ffmpeg on a file and waits for its first frame.
    pub(super) fn start(program: &str, path: &Path) -> Result<(Self, RawFrame), SequenceError> {
        let [new, old] = NO_RESAMPLING;
        match Self::try_start(program, path, new)? {
            Ok(started) => Ok(started),
            Err(lines) if lines.iter().any(|line| line.contains("fps_mode")) => {
                Self::try_start(program, path, old)?.map_err(|lines| bad_video(path, &lines))
            }
            Err(lines) => Err(bad_video(path, &lines)),
        }
    }

    /// The inner error: ffmpeg's last lines where it gave no frame.
    fn try_start(
        program: &str,
        path: &Path,
        no_resampling: &str,
    ) -> Result<Result<(Self, RawFrame), Vec<String>>, SequenceError> {
        let mut decoder = Self::spawn(program, path, no_resampling)?;
        match read_ppm(&mut decoder.frames) {
            Ok(Some(frame)) => {
                let first = decoder.timed(frame);
                if decoder.log.is_text() {
                    return Ok(Err(vec!["the file is text".to_owned()]));
                }
                Ok(Ok((decoder, first)))
            }
            Ok(None) | Err(_) => {
                decoder.end();
                Ok(Err(decoder.log.last_lines()))
            }
        }
    }

    fn spawn(program: &str, path: &Path, no_resampling: &str) -> Result<Self, SequenceError> {
        let failed = |source| SequenceError::FfmpegMissing {
            path: path.to_owned(),
            program: program.to_owned(),
            source,
        };
        let mut child = Command::new(program)
            .args(["-nostdin", "-hide_banner", "-nostats", "-loglevel", "info", "-i"])
            .arg(as_ffmpeg_input(path))
            .args(["-map", "0:v:0", "-vf", "showinfo", no_resampling, "passthrough"])
            .args(["-f", "image2pipe", "-c:v", "ppm", "-pix_fmt", "rgb24", "-"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        match (child.stdout.take(), child.stderr.take()) {
            (Some(stdout), Some(stderr)) => Ok(Self {
                child,
                frames: BufReader::new(stdout),
                log: LogReader::follow(stderr),
                first_time: None,
            }),
            _ => Err(failed(io::Error::other("it has no output"))),
        }
    }

    /// The next frame after number `last_good`, or `None` at the video's proper end.
    pub(super) fn next_frame(
        &mut self,
        path: &Path,
        last_good: usize,
    ) -> Result<Option<RawFrame>, SequenceError> {
        let read = read_ppm(&mut self.frames);
        if let Ok(Some(frame)) = read {
            return Ok(Some(self.timed(frame)));
        }
        let ended_well = matches!(read, Ok(None)) && self.child.wait().is_ok_and(|status| status.success());
        if ended_well {
            return Ok(None);
        }
        self.end();
        let lines = self.log.last_lines();
        let message =
            last_message(&lines).map_or_else(|| "ffmpeg stopped without a message".to_owned(), str::to_owned);
        Err(SequenceError::VideoBroken { path: path.to_owned(), last_good, message })
    }

    fn timed(&mut self, frame: Frame) -> RawFrame {
        let in_container = self.log.next_time();
        let first = *self.first_time.get_or_insert(in_container.unwrap_or(0.0));
        let time = in_container.and_then(|time| Duration::try_from_secs_f64(time - first).ok());
        RawFrame { frame, time }
    }

    /// Ends the process and collects it. Neither can fail in a way that matters: it may have ended by itself.
    fn end(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Decoder {
    fn drop(&mut self) {
        self.end();
    }
}

/// With the protocol named, no path is taken for an option, a URL or a pattern.
fn as_ffmpeg_input(path: &Path) -> OsString {
    let mut input = OsString::from("file:");
    input.push(path);
    input
}

fn bad_video(path: &Path, lines: &[String]) -> SequenceError {
    let message = last_message(lines).unwrap_or("it gives no frame");
    let own_name = format!("file:{}: ", path.display());
    let message = message.strip_prefix(&own_name).unwrap_or(message).to_owned();
    SequenceError::BadVideo { path: path.to_owned(), message }
}

/// The last line that tells a reason; what ffmpeg says about its own farewell does not.
fn last_message(lines: &[String]) -> Option<&str> {
    let farewell = ["Conversion failed!", "Error opening input file", "Exiting normally", "To ignore this"];
    let tells = |line: &&String| !farewell.iter().any(|start| line.starts_with(start));
    lines.iter().rev().find(tells).or(lines.last()).map(String::as_str)
}
