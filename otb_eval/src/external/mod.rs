//! Trackers of other people: programs in any language that speak TraX on standard input and output.
//!
//! Each job starts its own process, so that a crash, a hang or nonsense fails that job alone. What a tracker prints that is no
//! message is passed over, and the last lines of its standard error are told with a failure.

mod list;
mod process;
mod record;
mod session;
mod supervisor;

use std::{path::PathBuf, time::Duration};

use serde_json::{Value, json};

use crate::runner::{FactoryError, Made, TrackerFactory};

pub use list::{ListError, TrackerList};
pub use supervisor::supervise;

/// How a tracker's program is started and waited for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExternalOptions {
    /// How long one answer may take, the introduction among them.
    pub answer_timeout: Duration,
    /// The words of a command that runs [`supervise`] on the words after them; without it a tracker outlives a killed
    /// evaluation if it does not notice that its input ended.
    pub supervisor: Vec<PathBuf>,
}

/// A tracker that is a command.
#[derive(Debug, Clone)]
pub struct ExternalTracker {
    name: String,
    /// A line for the shell.
    command: String,
    /// What the user says of it.
    version: Option<String>,
    options: ExternalOptions,
    most_seeds: Option<u64>,
    introduction: Option<Introduction>,
}

/// What a tracker says of itself.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Introduction {
    pub name: String,
    pub identifier: String,
}

impl ExternalTracker {
    /// The tracker that a shell starts by `command`, under a name.
    pub fn new(
        name: impl Into<String>,
        command: impl Into<String>,
        version: Option<String>,
        options: ExternalOptions,
    ) -> Self {
        Self {
            name: name.into(),
            command: command.into(),
            version,
            options,
            most_seeds: None,
            introduction: None,
        }
    }

    /// Of which seeds 1 to `most` are worth running.
    pub fn with_most_seeds(mut self, most: u64) -> Self {
        self.most_seeds = Some(most);
        self
    }
}

impl TrackerFactory for ExternalTracker {
    fn name(&self) -> &str {
        &self.name
    }

    fn parameters(&self) -> Value {
        json!({
            "command": self.command,
            "external": true,
            "version": self.version,
        })
    }

    fn program(&self) -> String {
        let Introduction { name, identifier } = self.introduction.clone().unwrap_or_default();
        format!("external, not promised to be reproducible: {name} ({identifier})")
    }

    /// Starts the program once, to hear what it says of itself.
    fn prepare(&mut self) -> Result<(), FactoryError> {
        let heard = session::Session::start(&self.command, &self.options, 1, &|| false);
        let introduction = heard.and_then(|mut session| session.introduction());
        let introduction = introduction.map_err(|reason| FactoryError::External {
            name: self.name.clone(),
            command: self.command.clone(),
            reason: reason.to_string(),
        })?;
        self.introduction = Some(introduction);
        Ok(())
    }

    fn most_seeds(&self) -> Option<u64> {
        self.most_seeds
    }

    fn create(&self, _seed: u64) -> Result<Made, FactoryError> {
        Ok(Made::Elsewhere(Box::new(self.clone())))
    }
}
