//! An annotated video, made by the ffmpeg program from raw pictures on its standard input.

use std::{
    env, io,
    io::{Read, Write},
    path::Path,
    process::{Child, ChildStderr, Command, Stdio},
    thread::JoinHandle,
    time::Duration,
};

use image::RgbImage;

use super::{Destination, FrameEvent, Observer, OutputError, PartialFile, annotate};

/// File extensions that stand for a video.
pub const VIDEO_EXTENSIONS: [&str; 4] = ["mp4", "mkv", "mov", "avi"];

/// Frames per second where the source knows no times.
const USUAL_RATE: f64 = 25.0;
/// Frames that are waited for to learn the rate from their times.
const FRAMES_FOR_RATE: usize = 5;

/// Pipes annotated frames to ffmpeg (H.264, padded to even sides). The video grows as FILE.partial and is renamed when it is
/// whole. The program is `ffmpeg`, or what INFOPART_FFMPEG names.
#[derive(Debug)]
pub struct VideoWriter {
    file: PartialFile,
    program: String,
    container: &'static str,
    /// Pictures that wait until the rate is known, with their times.
    waiting: Vec<(RgbImage, Option<Duration>)>,
    encoder: Option<Encoder>,
}

impl VideoWriter {
    /// Makes sure that `path` can be written and that ffmpeg can be started; nothing is encoded yet.
    ///
    /// # Errors
    /// [`OutputError`] if either is not so.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let program = env::var("INFOPART_FFMPEG").unwrap_or_else(|_| "ffmpeg".to_owned());
        Self::with_program(path, program)
    }

    fn with_program(path: &Path, program: String) -> Result<Self, OutputError> {
        let file = PartialFile::create(path)?;
        quiet(&program).arg("-version").stdout(Stdio::null()).status().map_err(|source| {
            OutputError::NoFfmpeg { path: path.to_owned(), program: program.clone(), source }
        })?;
        Ok(Self { file, program, container: container(path), waiting: Vec::new(), encoder: None })
    }

    /// Adds a picture, of the size of those before, with its time in the source. The video is whole after
    /// [`finish`](Observer::finish).
    ///
    /// # Errors
    /// [`OutputError`] if ffmpeg does not take it.
    pub fn write(&mut self, picture: RgbImage, time: Option<Duration>) -> Result<(), OutputError> {
        if self.encoder.is_some() {
            return self.encode(&picture);
        }
        self.waiting.push((picture, time));
        if time.is_some() && self.waiting.len() < FRAMES_FOR_RATE { Ok(()) } else { self.start() }
    }

    /// Starts ffmpeg on the pictures that wait.
    fn start(&mut self) -> Result<(), OutputError> {
        let waiting = std::mem::take(&mut self.waiting);
        let Some((first, _)) = waiting.first() else { return Ok(()) };
        let times: Vec<Duration> = waiting.iter().filter_map(|(_, time)| *time).collect();
        let command = self.command(first.dimensions(), rate(&times));
        self.encoder = Some(Encoder::start(command, &self.program, self.file.path())?);
        waiting.iter().try_for_each(|(picture, _)| self.encode(picture))
    }

    fn command(&self, (width, height): (u32, u32), rate: f64) -> Command {
        let mut command = quiet(&self.program);
        command
            .args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24"])
            .args([
                "-video_size",
                &format!("{width}x{height}"),
                "-framerate",
                &rate.to_string(),
                "-i",
                "pipe:0",
            ])
            .args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-pix_fmt", "yuv420p"])
            .args(["-crf", "20", "-preset", "veryfast", "-f", self.container])
            .arg(self.file.partial_path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        command
    }

    fn encode(&mut self, picture: &RgbImage) -> Result<(), OutputError> {
        let Some(encoder) = &mut self.encoder else { return Ok(()) };
        if encoder.write(picture).is_ok() {
            return Ok(());
        }
        // The pipe only breaks if ffmpeg has ended, and then it has said why.
        self.close().and(Err(OutputError::Ffmpeg {
            path: self.file.path().to_owned(),
            message: "it ended before the last frame".to_owned(),
        }))
    }

    /// Lets ffmpeg write the video's end and waits for it.
    fn close(&mut self) -> Result<(), OutputError> {
        self.start()?;
        let Some(encoder) = self.encoder.take() else { return Ok(()) };
        encoder.close().map_err(|message| OutputError::Ffmpeg { path: self.file.path().to_owned(), message })
    }
}

impl Observer for VideoWriter {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        self.write(annotate(event), event.time)
    }

    fn finish(&mut self) -> Result<(), OutputError> {
        self.close()?;
        self.file.complete()
    }

    fn flush(&mut self) -> Result<(), OutputError> {
        self.close()
    }
}

/// A command that reads no keyboard and that Ctrl-C on the terminal does not reach: the video's end is still to be written.
fn quiet(program: &str) -> Command {
    let mut command = Command::new(program);
    command.stdin(Stdio::null()).stderr(Stdio::null());
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command
}

/// ffmpeg's name of the container; FILE.partial does not tell it.
fn container(path: &Path) -> &'static str {
    match path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("mkv") => "matroska",
        Some("mov") => "mov",
        Some("avi") => "avi",
        _ => "mp4",
    }
}

/// Frames per second from the first frames' times, or the usual rate.
fn rate(times: &[Duration]) -> f64 {
    let intervals = times.len().saturating_sub(1);
    let span = times.last().zip(times.first()).and_then(|(last, first)| last.checked_sub(*first));
    match span.map(|span| span.as_secs_f64()) {
        Some(seconds) if seconds > 0.0 => (intervals as f64 / seconds).clamp(0.1, 1000.0),
        _ => USUAL_RATE,
    }
}

/// A running ffmpeg; it does not outlive this.
#[derive(Debug)]
struct Encoder {
    child: Child,
    /// Reads what ffmpeg says, so that it never waits for a reader.
    complaints: Option<JoinHandle<String>>,
}

impl Encoder {
    fn start(mut command: Command, program: &str, path: &Path) -> Result<Self, OutputError> {
        let mut child = command.spawn().map_err(|source| OutputError::NoFfmpeg {
            path: path.to_owned(),
            program: program.to_owned(),
            source,
        })?;
        let complaints = child.stderr.take().map(|stderr| std::thread::spawn(move || last_line(stderr)));
        Ok(Self { child, complaints })
    }

    fn write(&mut self, picture: &RgbImage) -> io::Result<()> {
        let Some(pipe) = &mut self.child.stdin else { return Ok(()) };
        pipe.write_all(picture.as_raw())
    }

    /// Ends the input and waits; the error is what ffmpeg said last.
    fn close(mut self) -> Result<(), String> {
        drop(self.child.stdin.take());
        let status = self.child.wait().map_err(|error| error.to_string())?;
        let said = self.complaints.take().and_then(|reader| reader.join().ok()).unwrap_or_default();
        match status.success() {
            true => Ok(()),
            false if said.is_empty() => Err(status.to_string()),
            false => Err(said),
        }
    }
}

impl Drop for Encoder {
    fn drop(&mut self) {
        // Both fail only if the child has already been waited for.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn last_line(mut stderr: ChildStderr) -> String {
    let mut said = Vec::new();
    // What was read before an error is still worth showing.
    let _ = stderr.read_to_end(&mut said);
    let said = String::from_utf8_lossy(&said);
    said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default().trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{geometry::Rect, output::testing::EventParts};

    fn ffmpeg_is_here() -> bool {
        let here = Command::new("ffmpeg").arg("-version").stdout(Stdio::null()).status().is_ok();
        if !here {
            eprintln!("SKIPPED: the ffmpeg program is not installed");
        }
        here
    }

    #[test]
    fn a_video_is_renamed_when_whole_and_stays_partial_when_not() {
        if !ffmpeg_is_here() {
            return;
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.mp4");
        let parts = EventParts::new(Rect::new(10.0, 12.0, 8.0, 20.0));
        for whole in [false, true] {
            let mut video = VideoWriter::with_program(&path, "ffmpeg".into()).unwrap();
            for _ in 0..7 {
                video.on_frame(&parts.event()).unwrap();
            }
            if whole {
                video.finish().unwrap()
            } else {
                video.flush().unwrap()
            }
            drop(video);
            assert_eq!(path.exists(), whole);
            assert_eq!(folder.path().join("out.mp4.partial").exists(), !whole);
        }
        let bytes = std::fs::read(&path).unwrap();
        assert!(bytes.windows(4).any(|tag| tag == b"moov"), "the video has no index");
    }

    #[test]
    fn a_missing_ffmpeg_is_told_before_tracking_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.mp4");
        let error = VideoWriter::with_program(&path, "no-such-ffmpeg".into()).unwrap_err();
        let message = error.to_string();
        assert!(message.contains("no-such-ffmpeg") && message.contains("install"), "{message}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn what_ffmpeg_says_last_is_the_error() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let script = folder.path().join("ffmpeg");
        std::fs::write(&script, "#!/bin/sh\necho 'Unknown encoder libx264' >&2\nexit 1\n").unwrap();
        std::fs::set_permissions(&script, std::fs::Permissions::from_mode(0o755)).unwrap();
        let path = folder.path().join("out.mp4");
        let mut video = VideoWriter::with_program(&path, script.display().to_string()).unwrap();
        let parts = EventParts::new(Rect::new(10.0, 12.0, 8.0, 20.0));
        let outcome = (0..50).try_for_each(|_| video.on_frame(&parts.event())).and_then(|()| video.finish());
        let message = outcome.unwrap_err().to_string();
        assert!(message.contains("Unknown encoder libx264"), "{message}");
        assert!(!path.exists());
    }

    #[test]
    fn the_rate_comes_from_the_times_where_they_are_known() {
        let times = [0, 40, 80, 120, 160].map(Duration::from_millis);
        assert!((rate(&times) - 25.0).abs() < 1e-9);
        assert!((rate(&[0, 20].map(Duration::from_millis)) - 50.0).abs() < 1e-9);
        assert_eq!(rate(&[]), USUAL_RATE);
        assert_eq!(rate(&[40, 0].map(Duration::from_millis)), USUAL_RATE);
    }
}
