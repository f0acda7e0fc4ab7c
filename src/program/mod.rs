//! What every program of this project shares: exit codes, how an error is told, and Ctrl-C.

mod completions;
mod exit;
mod interrupt;

pub use completions::{CompletionsArgs, completions, completions_examples};
pub use exit::{BAD_INPUT, BadInput, INTERNAL_FAILURE, INTERRUPTED, report, report_with};
pub use interrupt::{interrupted, watch};
