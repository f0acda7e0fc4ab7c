//! What can be wrong with an input. Every message says what to do.

use std::path::PathBuf;

use thiserror::Error;

/// An input that cannot be read as meant.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// The file system refused.
    #[error("{path}: {source}; check that it exists and can be read", path = path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
}
