//! Ctrl-C: the first stops the loop after the frame at hand, the second the program at once.

use std::{
    process,
    sync::atomic::{AtomicBool, Ordering},
};

use anyhow::{Context, Result};

use super::exit;

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Watches for Ctrl-C from now on; the flag is true once it came.
pub fn watch() -> Result<&'static AtomicBool> {
    let on_interrupt = || {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            // Every row is on disk as soon as it is known, so nothing is lost.
            process::exit(exit::INTERRUPTED.into());
        }
    };
    ctrlc::set_handler(on_interrupt).context("Ctrl-C cannot be watched for")?;
    Ok(&INTERRUPTED)
}
