//! What ffmpeg writes beside the frames: their times, and its messages.

use std::{
    collections::VecDeque,
    io::{BufRead, BufReader, Read},
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, Receiver, Sender},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

const KEPT_LINES: usize = 20;

/// A line may be garbage without an end.
const LONGEST_LINE: u64 = 1 << 16;

/// ffmpeg logs a frame's time before it sends the frame; no honest delay comes near this.
const PATIENCE: Duration = Duration::from_secs(2);

/// A decoder holds back some frames, and sends them after it has told of an error at the end.
const HELD_BACK: usize = 32;

/// Follows ffmpeg's log in a thread of its own, for a full pipe would stop ffmpeg.
#[derive(Debug)]
pub(super) struct LogReader {
    times: Receiver<Option<f64>>,
    thread: JoinHandle<()>,
    told: Arc<Mutex<Told>>,
}

/// What the log has told so far.
#[derive(Debug, Default)]
struct Told {
    /// The last messages, the latest first.
    lines: VecDeque<String>,
    /// Whether ffmpeg took the file for text, of which it draws a terminal.
    is_text: bool,
    /// The container's duration.
    duration: Option<Duration>,
    /// Frames a second of the video.
    rate: Option<f64>,
    has_audio: bool,
    frames: usize,
    /// The last error, and how many frames there were before it.
    error: Option<(String, usize)>,
}

impl LogReader {
    pub(super) fn follow(log: impl Read + Send + 'static) -> Self {
        let (sender, times) = mpsc::channel();
        let told = Arc::new(Mutex::new(Told::default()));
        let telling = Arc::clone(&told);
        Self { times, thread: thread::spawn(move || follow(log, &sender, &telling)), told }
    }

    /// The next frame's time in seconds as the container has it, if it has one.
    pub(super) fn next_time(&self) -> Option<f64> {
        self.times.recv_timeout(PATIENCE).ok().flatten()
    }

    /// Whether ffmpeg took the file for text, of which it draws a terminal. Known once there is a time.
    pub(super) fn is_text(&self) -> bool {
        self.told.lock().unwrap_or_else(PoisonError::into_inner).is_text
    }

    /// The last messages of a process that has ended.
    pub(super) fn last_lines(&self) -> Vec<String> {
        self.wait();
        self.told.lock().unwrap_or_else(PoisonError::into_inner).lines.iter().rev().cloned().collect()
    }

    /// Why a video that seems to have ended was not whole: its container promises more, or its last frames came with errors.
    /// `last` is the time of the last frame since the first, and `frames` their number.
    pub(super) fn early_end(&self, last: Option<Duration>, frames: usize) -> Option<String> {
        self.wait();
        let told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((error, before)) = &told.error
            && frames.saturating_sub(*before) <= HELD_BACK
        {
            return Some(error.clone());
        }
        let (promised, rate) = (told.duration?.as_secs_f64(), told.rate.filter(|rate| *rate > 0.0)?);
        let shown = last?.as_secs_f64() + 1.0 / rate;
        // Sound may go on a little longer than the pictures, and times are rounded.
        let tolerated = if told.has_audio { (0.1 * promised).max(2.0) } else { (2.5 / rate).max(0.1) };
        (shown + tolerated < promised)
            .then(|| format!("it has {shown:.2} s of the {promised:.2} s that it promises"))
    }

    /// Waits for the log's end, but not forever: what the process started may hold it open.
    fn wait(&self) {
        let since = Instant::now();
        while !self.thread.is_finished() && since.elapsed() < PATIENCE {
            thread::sleep(Duration::from_millis(1));
        }
    }
}

fn follow(log: impl Read, times: &Sender<Option<f64>>, told: &Mutex<Told>) {
    let mut log = BufReader::new(log);
    let mut bytes = Vec::new();
    while log.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes).is_ok_and(|length| length > 0) {
        let line = String::from_utf8_lossy(&bytes);
        let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
        match time_of(&line) {
            Some(time) => {
                told.frames += 1;
                // Nobody waiting for times is no reason to stop emptying the pipe.
                let _ = times.send(time);
            }
            None if line.contains("Parsed_showinfo") || line.trim().is_empty() => {}
            None => told.hear(&line),
        }
        drop(told);
        bytes.clear();
    }
}

impl Told {
    fn hear(&mut self, line: &str) {
        let is_error = ["[error]", "[fatal]", "corrupt input packet"].iter().any(|mark| line.contains(mark));
        let text = without_level(line.trim());
        if text.starts_with("Input #0, tty,") {
            self.is_text = true;
        }
        let is_of_input = self.rate.is_none();
        if let Some(duration) = text.strip_prefix("Duration: ") {
            self.duration = duration.split(',').next().and_then(clock_time);
        } else if text.starts_with("Stream #0") && is_of_input {
            self.has_audio |= text.contains(": Audio: ");
            let rate = text.split(", ").find_map(|part| part.trim().strip_suffix(" fps"));
            self.rate = rate.and_then(|rate| rate.parse().ok());
        } else if text.starts_with("Stream #0:") && text.contains(": Audio: ") {
            self.has_audio = true;
        }
        if is_error {
            self.error = Some((text.clone(), self.frames));
        }
        self.lines.truncate(KEPT_LINES - 1);
        self.lines.push_front(text);
    }
}

/// A message without the word that says how bad it is.
fn without_level(line: &str) -> String {
    const LEVELS: [&str; 7] =
        ["[info] ", "[error] ", "[warning] ", "[fatal] ", "[panic] ", "[verbose] ", "[debug] "];
    LEVELS.iter().fold(line.to_owned(), |line, level| line.replacen(level, "", 1)).trim().to_owned()
}

/// `HH:MM:SS.CC`.
fn clock_time(text: &str) -> Option<Duration> {
    let parts: Vec<f64> = text.trim().split(':').map(|part| part.parse().ok()).collect::<Option<_>>()?;
    let [hours, minutes, seconds] = parts[..] else { return None };
    Duration::try_from_secs_f64(hours * 3600.0 + minutes * 60.0 + seconds).ok()
}

/// The time in a line that describes a frame; the outer `None` for every other line.
fn time_of(line: &str) -> Option<Option<f64>> {
    let (_, rest) = line.split_once("pts_time:").filter(|_| line.contains("showinfo"))?;
    Some(
        rest.split_whitespace()
            .next()
            .and_then(|word| word.parse().ok())
            .filter(|time: &f64| time.is_finite()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_told_from_messages() {
        let log = "Input #0, avi, from 'x':\n\
            [Parsed_showinfo_0 @ 0x55] config in time_base: 1/10, frame_rate: 10/1\n\
            [Parsed_showinfo_0 @ 0x55] n:   0 pts:      3 pts_time:0.3     pos: 4 fmt:yuv420p\n\
            [Parsed_showinfo_0 @ 0x55] n:   1 pts: NOPTS pts_time:NOPTS   fmt:yuv420p\n\
            \n\
            Conversion failed!\n";
        let reader = LogReader::follow(log.as_bytes());
        assert_eq!(reader.next_time(), Some(0.3));
        assert_eq!(reader.next_time(), None);
        assert!(!reader.is_text());
        assert_eq!(reader.last_lines(), ["Input #0, avi, from 'x':", "Conversion failed!"]);
    }

    /// A log of a video of ten frames a second that promises five seconds.
    fn promising(more: &str) -> LogReader {
        let frame = "[Parsed_showinfo_0 @ 0x5] [info] n: 0 pts_time:0.1 fmt:x\n";
        let head = "[info]   Duration: 00:00:05.00, start: 0.000000, bitrate: 20 kb/s\n\
            [info]   Stream #0:0: Video: h264 (High), yuv420p, 64x48, 10 fps, 10 tbr, 1k tbn\n";
        LogReader::follow(std::io::Cursor::new(head.to_owned() + &more.replace("FRAME\n", frame)))
    }

    #[test]
    fn a_container_that_promises_more_has_ended_early() {
        let at = |seconds: f64| Some(Duration::from_secs_f64(seconds));
        assert_eq!(promising("").early_end(at(4.9), 50), None);
        assert_eq!(promising("").early_end(at(4.7), 48), None, "rounded times");
        let told = promising("").early_end(at(2.9), 30).unwrap();
        assert_eq!(told, "it has 3.00 s of the 5.00 s that it promises");
        let sound = "[info]   Stream #0:1: Audio: aac, 44100 Hz\n";
        assert_eq!(promising(sound).early_end(at(3.5), 36), None, "the sound may go on");
        assert!(promising(sound).early_end(at(1.0), 11).is_some());
        assert_eq!(promising("").early_end(None, 50), None);
    }

    #[test]
    fn errors_at_the_end_count_and_those_long_before_do_not() {
        let error = "[h264 @ 0x5] [error] error while decoding MB 3 4\n";
        let late = format!("{}{error}FRAME\nFRAME\n", "FRAME\n".repeat(40));
        let told = promising(&late).early_end(Some(Duration::from_secs_f64(4.9)), 42).unwrap();
        assert_eq!(told, "[h264 @ 0x5] error while decoding MB 3 4");
        let early = format!("FRAME\n{error}{}", "FRAME\n".repeat(40));
        assert_eq!(promising(&early).early_end(Some(Duration::from_secs_f64(4.9)), 41), None);
    }

    #[test]
    fn only_the_last_messages_are_kept() {
        let log: String = (0..100).map(|number| format!("line {number}\n")).collect();
        let kept = LogReader::follow(std::io::Cursor::new(log)).last_lines();
        assert_eq!((kept.len(), kept[0].as_str(), kept[19].as_str()), (20, "line 80", "line 99"));
    }
}
