//! A process between the evaluation and a tracker. The evaluation may be killed by a signal that it cannot see; the
//! supervisor, which the signal was not sent to, then ends the tracker and all that the tracker started.

use std::{
    ffi::OsStr,
    process::{Command, ExitStatus},
};

/// Runs a line for the shell with the input and output that it has itself, and gives its exit code, 128 and the signal's number
/// if a signal ended it. If its own parent ends first, it ends with the whole process group, whose leader it must be.
///
/// # Errors
/// If the shell cannot be started or waited for.
pub fn supervise(command: &OsStr) -> std::io::Result<u8> {
    #[cfg(unix)]
    end_with_parent();
    let status = shell(command).status()?;
    Ok(exit_code(status))
}

/// The shell with a line.
pub(super) fn shell(line: &OsStr) -> Command {
    let (program, flag) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let mut command = Command::new(program);
    command.arg(flag).arg(line);
    command
}

fn exit_code(status: ExitStatus) -> u8 {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return 128_u8.saturating_add(u8::try_from(signal).unwrap_or(127));
    }
    status.code().and_then(|code| u8::try_from(code & 0xff).ok()).unwrap_or(1)
}

#[cfg(unix)]
fn end_with_parent() {
    use std::{os::unix::process::parent_id, thread, time::Duration};

    let parent = parent_id();
    thread::spawn(move || {
        while parent_id() == parent {
            thread::sleep(Duration::from_millis(100));
        }
        // The group is that of this process, so this ends it too.
        let _ = rustix::process::kill_current_process_group(rustix::process::Signal::KILL);
    });
}
