//! Where rows go: a file that becomes whole at the end, or standard output.

use std::io::{self, Write};

use super::OutputError;

/// A writer that can be completed, and that knows what its errors are called.
pub trait Destination: Write {
    /// Makes what was written whole. Called once, after the last byte.
    ///
    /// # Errors
    /// [`OutputError`] if that is impossible.
    fn complete(&mut self) -> Result<(), OutputError>;

    /// The error as a user should read it.
    fn name_error(&self, error: io::Error) -> OutputError;
}

/// Rows on standard output, each as soon as it is known.
#[derive(Debug)]
pub struct StandardOutput(io::Stdout);

impl StandardOutput {
    /// The program's standard output.
    pub fn new() -> Self {
        Self(io::stdout())
    }
}

impl Default for StandardOutput {
    fn default() -> Self {
        Self::new()
    }
}

impl Write for StandardOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Destination for StandardOutput {
    fn complete(&mut self) -> Result<(), OutputError> {
        self.flush().map_err(|error| self.name_error(error))
    }

    fn name_error(&self, error: io::Error) -> OutputError {
        match error.kind() {
            io::ErrorKind::BrokenPipe => OutputError::Closed,
            _ => OutputError::StandardOutput { source: error },
        }
    }
}

/// Bytes in memory, for tests and for callers that send rows elsewhere.
impl Destination for Vec<u8> {
    fn complete(&mut self) -> Result<(), OutputError> {
        Ok(())
    }

    fn name_error(&self, error: io::Error) -> OutputError {
        OutputError::Io { path: "memory".into(), source: error }
    }
}
