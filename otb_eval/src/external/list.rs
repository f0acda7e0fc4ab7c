//! trackers.toml: trackers of other people by name.
//!
//! ```toml
//! [mil]
//! command = "python -m infopart.trax infopart.rivals:MIL"
//! version = "opencv 5.0"     # told apart by this, besides the command and its introduction
//! seeds = 1                  # it draws nothing: more seeds would give the same
//! frame_timeout = 30         # seconds
//! ```

use std::{
    collections::BTreeMap,
    fs, io,
    path::{Path, PathBuf},
    time::Duration,
};

use serde::Deserialize;
use thiserror::Error;

use super::{ExternalOptions, ExternalTracker};

/// A list that cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ListError {
    /// The file system refused.
    #[error("{path}: {source}; give a TOML file with a table for each tracker", path = path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// It is not such a list.
    #[error("{path}: {message}", path = path.display())]
    Toml {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the line.
        message: String,
    },
    /// A value is out of its range, or a name no folder can have.
    #[error("tracker `{name}`: {problem}")]
    Value {
        /// The tracker.
        name: String,
        /// What is wrong, and what to give.
        problem: &'static str,
    },
    /// Two trackers of one name.
    #[error("the tracker `{name}` is given twice; give each its own name")]
    Twice {
        /// The name.
        name: String,
    },
    /// A version of no tracker.
    #[error(
        "--tracker-version {name}=...: there is no tracker of that name; give it with --tracker or --trackers-file"
    )]
    NoTracker {
        /// The name.
        name: String,
    },
}

/// Trackers by name.
#[derive(Debug, Clone, Default)]
pub struct TrackerList {
    entries: BTreeMap<String, Entry>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    command: String,
    version: Option<String>,
    seeds: Option<u64>,
    frame_timeout: Option<f64>,
}

impl TrackerList {
    /// Reads a file.
    ///
    /// # Errors
    /// [`ListError`], naming the tracker and the key.
    pub fn read(path: &Path) -> Result<Self, ListError> {
        let text =
            fs::read_to_string(path).map_err(|source| ListError::Io { path: path.to_owned(), source })?;
        let entries: BTreeMap<String, Entry> = toml::from_str(&text).map_err(|error| ListError::Toml {
            path: path.to_owned(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        for (name, entry) in &entries {
            let refuse = |problem| Err(ListError::Value { name: name.clone(), problem });
            let is_plain = |letter: char| letter.is_alphanumeric() || "-_.+".contains(letter);
            if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
                return refuse("the name is no name for a folder; use letters, digits, -, _, + and .");
            }
            if entry.command.trim().is_empty() {
                return refuse("`command` is empty; give a line for the shell");
            }
            if entry.seeds == Some(0) {
                return refuse("`seeds` is 0; give at least 1");
            }
            if entry.frame_timeout.is_some_and(|seconds| !(seconds > 0.0 && seconds < 1e9)) {
                return refuse("`frame_timeout` is no time; give seconds, for example 30");
            }
        }
        Ok(Self { entries })
    }

    /// Adds a tracker.
    ///
    /// # Errors
    /// [`ListError::Twice`].
    pub fn add(&mut self, name: &str, command: &str) -> Result<(), ListError> {
        let entry = Entry { command: command.to_owned(), version: None, seeds: None, frame_timeout: None };
        match self.entries.insert(name.to_owned(), entry) {
            Some(_) => Err(ListError::Twice { name: name.to_owned() }),
            None => Ok(()),
        }
    }

    /// Says by what else a tracker's results are told apart.
    ///
    /// # Errors
    /// [`ListError::NoTracker`].
    pub fn set_version(&mut self, name: &str, version: &str) -> Result<(), ListError> {
        let entry =
            self.entries.get_mut(name).ok_or_else(|| ListError::NoTracker { name: name.to_owned() })?;
        entry.version = Some(version.to_owned());
        Ok(())
    }

    /// The trackers, by name.
    pub fn into_trackers(self, options: &ExternalOptions) -> Vec<ExternalTracker> {
        let tracker = |(name, entry): (String, Entry)| {
            let mut options = options.clone();
            if let Some(seconds) = entry.frame_timeout {
                options.answer_timeout = Duration::from_secs_f64(seconds);
            }
            let tracker = ExternalTracker::new(name, entry.command, entry.version, options);
            match entry.seeds {
                Some(most) => tracker.with_most_seeds(most),
                None => tracker,
            }
        };
        self.entries.into_iter().map(tracker).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runner::TrackerFactory;

    fn read(text: &str) -> Result<TrackerList, ListError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trackers.toml");
        fs::write(&path, text).unwrap();
        TrackerList::read(&path)
    }

    #[test]
    fn a_list_is_read_with_what_it_says_of_each() {
        let mut list = read(
            "[mil]\ncommand = \"mil --fast\"\nseeds = 1\nframe_timeout = 2.5\n\n[dimp]\ncommand = \"dimp\"\nversion = \"7\"",
        )
        .unwrap();
        list.add("more", "more").unwrap();
        list.set_version("mil", "5.0").unwrap();
        let options = ExternalOptions { answer_timeout: Duration::from_secs(9), supervisor: Vec::new() };
        let trackers = list.into_trackers(&options);
        let names: Vec<_> = trackers.iter().map(TrackerFactory::name).collect();
        assert_eq!(names, ["dimp", "mil", "more"]);
        assert_eq!(trackers[1].most_seeds(), Some(1));
        assert_eq!(trackers[1].options.answer_timeout, Duration::from_millis(2500));
        assert_eq!(trackers[0].options.answer_timeout, Duration::from_secs(9));
        assert_eq!(trackers[1].parameters()["command"], "mil --fast");
        let versions = [&trackers[0], &trackers[1]].map(|tracker| tracker.parameters()["version"].clone());
        assert_eq!(versions, ["7", "5.0"]);
    }

    #[test]
    fn what_is_wrong_names_the_tracker_or_the_key() {
        for (text, said) in [
            ("[mil]\nseeds = 1", "command"),
            ("[mil]\ncommand = \"\"", "`mil`: `command` is empty"),
            ("[mil]\ncommand = \"a\"\nseed = 1", "seed"),
            ("[mil]\ncommand = \"a\"\nseeds = 0", "`seeds` is 0"),
            ("[mil]\ncommand = \"a\"\nframe_timeout = nan", "`frame_timeout`"),
            ("[\"a/b\"]\ncommand = \"a\"", "no name for a folder"),
            ("command = \"a\"", "command"),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.contains(said), "{text}: {message}");
        }
        let mut list = TrackerList::default();
        list.add("a", "b").unwrap();
        assert!(list.add("a", "c").unwrap_err().to_string().contains("twice"));
        assert!(list.set_version("b", "1").unwrap_err().to_string().contains("no tracker"));
    }
}
