//! Ctrl-C: the first stops the loop after the frame at hand, the second the program at once.

use std::{
    process,
    sync::atomic::{AtomicBool, Ordering},
};

use super::INTERRUPTED as INTERRUPTED_CODE;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Whether Ctrl-C came, once it is watched for.
pub fn interrupted() -> &'static AtomicBool {
    &INTERRUPTED
}

/// Watches for Ctrl-C from now on; the flag is true once it came.
///
/// # Errors
/// If the system does not let the program watch, or it watches already.
pub fn watch() -> Result<&'static AtomicBool, ctrlc::Error> {
    let on_interrupt = || {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            // Every row is on disk as soon as it is known, so nothing is lost.
            process::exit(INTERRUPTED_CODE.into());
        }
    };
    ctrlc::set_handler(on_interrupt)?;
    Ok(&INTERRUPTED)
}
