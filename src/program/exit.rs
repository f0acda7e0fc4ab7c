//! The one place where an error is told, and where it becomes an exit code.

use std::process::ExitCode;

use crate::{
    output::OutputError,
    run::{RunError, RunFailure},
    sequence::SequenceError,
    tracker::ParameterError,
};
use anyhow::Error;
use thiserror::Error as ThisError;

/// Exit code of a failure that the user cannot put right.
pub const INTERNAL_FAILURE: u8 = 1;
/// Exit code of bad input: a flag, a file or a box.
pub const BAD_INPUT: u8 = 2;
/// Exit code after Ctrl-C. As shells report a program that SIGINT ended: 128 + 2.
pub const INTERRUPTED: u8 = 130;

/// Something the user can put right; the message says how.
#[derive(Debug, ThisError)]
#[error("{0}")]
pub struct BadInput(pub String);

/// Tells an error on standard error and gives the program's exit code.
pub fn report(outcome: Result<(), Error>) -> ExitCode {
    report_with(outcome, |_| None)
}

/// [`report`] for a program with errors of its own, for which `own_code` gives the exit code; an error whose code is 0
/// is not told.
pub fn report_with(outcome: Result<(), Error>, own_code: impl Fn(&Error) -> Option<u8>) -> ExitCode {
    let Err(error) = outcome else { return ExitCode::SUCCESS };
    let code = own_code(&error).unwrap_or_else(|| code_of(&error));
    if code != 0 {
        eprintln!("error: {}", message(&error));
    }
    ExitCode::from(code)
}

/// The chain of causes, but for those that the text before already tells.
fn message(error: &Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |told, cause| {
        if told.is_empty() {
            cause
        } else if told.contains(&cause) {
            told
        } else {
            format!("{told}: {cause}")
        }
    })
}

fn code_of(error: &Error) -> u8 {
    if let Some(stopped) = error.downcast_ref::<RunError>() {
        return match &*stopped.failure {
            RunFailure::Interrupted => INTERRUPTED,
            RunFailure::Output(OutputError::Closed) => 0,
            _ => BAD_INPUT,
        };
    }
    if let Some(output) = error.downcast_ref::<OutputError>() {
        return if matches!(output, OutputError::Closed) { 0 } else { BAD_INPUT };
    }
    let user_can_fix = error.is::<BadInput>() || error.is::<SequenceError>() || error.is::<ParameterError>();
    if user_can_fix { BAD_INPUT } else { INTERNAL_FAILURE }
}

#[cfg(test)]
mod tests {
    use anyhow::{Context, anyhow};

    use super::*;

    #[test]
    fn codes_follow_the_cause_through_contexts() {
        let bad = Err::<(), _>(BadInput("give --init".into())).context("INPUT").unwrap_err();
        assert_eq!(code_of(&bad), BAD_INPUT);
        assert_eq!(code_of(&anyhow!("the pool broke")), INTERNAL_FAILURE);
        assert_eq!(code_of(&OutputError::Closed.into()), 0);
    }

    #[test]
    fn a_cause_is_told_once() {
        let source = std::io::Error::other("disk on fire");
        let error = Error::new(OutputError::Io { path: "a.txt".into(), source }).context("--out a.txt");
        let text = message(&error);
        assert_eq!(text.matches("disk on fire").count(), 1, "{text}");
        assert!(text.starts_with("--out a.txt: a.txt: cannot be written"), "{text}");
    }
}
