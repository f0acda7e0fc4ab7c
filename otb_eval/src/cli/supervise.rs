//! `otb_eval supervise`: a tracker's command, ended with whoever started it.

use std::{ffi::OsString, process::ExitCode};

use clap::Args;
use infopart::program::INTERNAL_FAILURE;

#[derive(Debug, Args)]
pub struct SuperviseArgs {
    /// A line for the shell
    #[arg(allow_hyphen_values = true)]
    command: OsString,
}

pub fn supervise(args: &SuperviseArgs) -> ExitCode {
    match otb_eval::external::supervise(&args.command) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("error: the shell cannot be started: {error}");
            ExitCode::from(INTERNAL_FAILURE)
        }
    }
}
