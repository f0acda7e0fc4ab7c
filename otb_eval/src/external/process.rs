//! A tracker's process: started in a group of its own, read by threads of their own, and ended whatever it does.

use std::{
    collections::VecDeque,
    ffi::OsStr,
    io::{self, BufRead, BufReader, Read, Write},
    process::{Child, ChildStdin, Command, ExitStatus, Stdio},
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel},
    },
    thread,
    time::{Duration, Instant},
};

use infopart::trax::PREFIX;

use super::{ExternalOptions, supervisor::shell};
use crate::words::printable;

/// Lines of standard error that are kept, and letters of each.
const KEPT_LINES: usize = 8;
const KEPT_LETTERS: usize = 300;
/// A line that is longer than this many bytes is no message.
const LONGEST_LINE: u64 = 1 << 16;
/// How often a wait is broken to see whether it is to go on.
const GLANCE: Duration = Duration::from_millis(20);
/// How long a program that was told to end, or that closed its output, may take to end by itself.
const LAST_MOMENT: Duration = Duration::from_secs(2);

/// What was heard of a tracker's process.
pub(super) enum Heard {
    /// A line that begins as a message.
    Line(String),
    /// Its output ended.
    End,
    /// Nothing until the deadline.
    Silence,
    /// Nothing until the wait was called off.
    CalledOff,
}

/// A running process. Dropped, it is killed with all that it started.
pub(super) struct Process {
    child: Child,
    input: Option<ChildStdin>,
    lines: Receiver<io::Result<String>>,
    complaints: Arc<Mutex<VecDeque<String>>>,
    status: Option<ExitStatus>,
}

impl Process {
    pub fn start(line: &str, options: &ExternalOptions, seed: u64) -> io::Result<Self> {
        let mut command = match options.supervisor.split_first() {
            Some((program, words)) => {
                let mut command = Command::new(program);
                command.args(words).arg(line);
                command
            }
            None => shell(OsStr::new(line)),
        };
        command.env("INFOPART_SEED", seed.to_string());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let (sender, lines) = sync_channel(16);
        if let Some(output) = child.stdout.take() {
            thread::spawn(move || read_messages(output, &sender));
        }
        let complaints = Arc::default();
        if let Some(errors) = child.stderr.take() {
            let complaints = Arc::clone(&complaints);
            thread::spawn(move || read_complaints(errors, &complaints));
        }
        Ok(Self { input: child.stdin.take(), child, lines, complaints, status: None })
    }

    /// Writes a line.
    pub fn say(&mut self, line: &str) -> io::Result<()> {
        let Some(input) = &mut self.input else { return Err(io::ErrorKind::BrokenPipe.into()) };
        input.write_all(line.as_bytes())?;
        input.write_all(b"\n")?;
        input.flush()
    }

    /// Waits for the next message.
    pub fn hear(&self, timeout: Duration, called_off: &dyn Fn() -> bool) -> io::Result<Heard> {
        let since = Instant::now();
        loop {
            match self.lines.recv_timeout(GLANCE) {
                Ok(line) => return line.map(Heard::Line),
                Err(RecvTimeoutError::Disconnected) => return Ok(Heard::End),
                Err(RecvTimeoutError::Timeout) if called_off() => return Ok(Heard::CalledOff),
                Err(RecvTimeoutError::Timeout) if since.elapsed() > timeout => return Ok(Heard::Silence),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    /// How it ended, if it ends soon, and the last lines of its standard error.
    pub fn last_words(&mut self) -> String {
        let status = self.wait_a_moment();
        // What it said last may still be on its way.
        thread::sleep(GLANCE);
        let complaints = self.complaints.lock().unwrap_or_else(PoisonError::into_inner);
        let lines: Vec<&str> = complaints.iter().map(String::as_str).collect();
        let said = match lines.join(" | ") {
            none if none.is_empty() => "nothing on standard error".to_owned(),
            lines => format!("last on standard error: {lines}"),
        };
        match status {
            Some(status) => format!("{status}; {said}"),
            None => said,
        }
    }

    /// Lets it end by itself, for a moment.
    pub fn end(&mut self) {
        self.input = None;
        self.wait_a_moment();
    }

    fn wait_a_moment(&mut self) -> Option<ExitStatus> {
        let since = Instant::now();
        while self.status.is_none() && since.elapsed() < LAST_MOMENT {
            self.status = self.child.try_wait().ok().flatten();
            if self.status.is_none() {
                thread::sleep(Duration::from_millis(2));
            }
        }
        self.status
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        #[cfg(unix)]
        if let Some(group) = i32::try_from(self.child.id()).ok().and_then(rustix::process::Pid::from_raw) {
            // The group may be gone already.
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
        if self.status.is_none() {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

/// Hands on the lines that begin as messages.
fn read_messages(output: impl Read, sender: &SyncSender<io::Result<String>>) {
    let mut output = BufReader::new(output);
    let mut line = Vec::new();
    let mut is_rest = false;
    loop {
        line.clear();
        match output.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line) {
            Ok(0) => return,
            Ok(_) => {
                // The rest of a line that is too long is no line of its own.
                let is_message = !is_rest && line.starts_with(PREFIX.as_bytes());
                is_rest = !line.ends_with(b"\n");
                if is_message && sender.send(Ok(String::from_utf8_lossy(&line).into_owned())).is_err() {
                    return;
                }
            }
            Err(error) => {
                let _ = sender.send(Err(error));
                return;
            }
        }
    }
}

/// Keeps the last lines.
fn read_complaints(errors: impl Read, kept: &Mutex<VecDeque<String>>) {
    let mut errors = BufReader::new(errors);
    let mut line = Vec::new();
    loop {
        line.clear();
        match errors.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line) {
            Ok(1..) => {
                let text: String =
                    String::from_utf8_lossy(&line).trim_end().chars().take(KEPT_LETTERS).collect();
                let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
                if !text.is_empty() {
                    kept.push_back(printable(&text));
                }
                while kept.len() > KEPT_LINES {
                    kept.pop_front();
                }
            }
            Ok(0) | Err(_) => return,
        }
    }
}
