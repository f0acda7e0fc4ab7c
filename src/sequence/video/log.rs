//! What ffmpeg writes beside the frames: their times, and its messages.

use std::{
    collections::VecDeque,
    io::{BufRead, BufReader, Read},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver, Sender},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

const KEPT_LINES: usize = 20;

/// ffmpeg logs a frame's time before it sends the frame; no honest delay comes near this.
const PATIENCE: Duration = Duration::from_secs(2);

/// Follows ffmpeg's log in a thread of its own, for a full pipe would stop ffmpeg.
#[derive(Debug)]
pub(super) struct LogReader {
    times: Receiver<Option<f64>>,
    thread: Option<JoinHandle<VecDeque<String>>>,
    is_text: Arc<AtomicBool>,
}

impl LogReader {
    pub(super) fn follow(log: impl Read + Send + 'static) -> Self {
        let (sender, times) = mpsc::channel();
        let is_text = Arc::new(AtomicBool::new(false));
        let found_text = Arc::clone(&is_text);
        Self { times, thread: Some(thread::spawn(move || follow(log, &sender, &found_text))), is_text }
    }

    /// The next frame's time in seconds as the container has it, if it has one.
    pub(super) fn next_time(&self) -> Option<f64> {
        self.times.recv_timeout(PATIENCE).ok().flatten()
    }

    /// Whether ffmpeg took the file for text, of which it draws a terminal. Known once there is a time.
    pub(super) fn is_text(&self) -> bool {
        self.is_text.load(Ordering::Relaxed)
    }

    /// The last messages; waits for the log's end, so only for a process that has ended.
    pub(super) fn last_lines(&mut self) -> Vec<String> {
        self.thread.take().and_then(|thread| thread.join().ok()).map(Vec::from).unwrap_or_default()
    }
}

fn follow(log: impl Read, times: &Sender<Option<f64>>, found_text: &AtomicBool) -> VecDeque<String> {
    let mut kept = VecDeque::with_capacity(KEPT_LINES);
    let mut log = BufReader::new(log);
    let mut bytes = Vec::new();
    while log.read_until(b'\n', &mut bytes).is_ok_and(|length| length > 0) {
        let line = String::from_utf8_lossy(&bytes);
        match time_of(&line) {
            // Nobody waiting for times is no reason to stop emptying the pipe.
            Some(time) => drop(times.send(time)),
            None if line.contains("Parsed_showinfo") || line.trim().is_empty() => {}
            None => {
                if line.starts_with("Input #0, tty,") {
                    found_text.store(true, Ordering::Relaxed);
                }
                kept.truncate(KEPT_LINES - 1);
                kept.push_front(line.trim().to_owned());
            }
        }
        bytes.clear();
    }
    kept.into_iter().rev().collect()
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
        let mut reader = LogReader::follow(log.as_bytes());
        assert_eq!(reader.next_time(), Some(0.3));
        assert_eq!(reader.next_time(), None);
        assert!(!reader.is_text());
        assert_eq!(reader.last_lines(), ["Input #0, avi, from 'x':", "Conversion failed!"]);
    }

    #[test]
    fn only_the_last_messages_are_kept() {
        let log: String = (0..100).map(|number| format!("line {number}\n")).collect();
        let kept = LogReader::follow(std::io::Cursor::new(log)).last_lines();
        assert_eq!((kept.len(), kept[0].as_str(), kept[19].as_str()), (20, "line 80", "line 99"));
    }
}
