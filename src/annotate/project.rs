//! The project file: objects with their key frames, and what was tracked for them, as JSON.
//!
//! A file of key frames made by hand is the same without what was tracked:
//! `{"version": 1, "objects": [{"name": "walker", "keys": [{"frame": 1, "box": [120, 80, 40, 110]}, {"frame": 90, "absent": true}]}]}`.
//! Frames count from 1, boxes are left, top, width, height in pixels, the first pixel being 0.

use std::{collections::BTreeMap, fs, io::Write, path::Path};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{
    keys::{Colour, Mark, Object},
    passes::Passes,
};
use crate::{
    geometry::Rect,
    output::{Destination, OutputError, PartialFile},
};

/// Version of project files. It grows when a key changes its meaning.
pub const PROJECT_VERSION: u64 = 1;

/// Objects, and what was tracked for them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Project {
    /// The objects.
    pub objects: Vec<Object>,
    /// What the passes follow from beside the key frames: tracker, parameters and video.
    pub tracked_by: String,
    /// Passes of each object.
    pub passes: Vec<Passes>,
}

/// A project file that cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ProjectError {
    /// The file cannot be read.
    #[error("{path}: cannot be read: {source}; check the path and its permissions")]
    Unreadable {
        /// The file.
        path: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The file ends early.
    #[error("{path}: is cut short; use an earlier copy, or FILE.partial beside it if that is whole")]
    CutShort {
        /// The file.
        path: String,
    },
    /// The file is of another version.
    #[error(
        "{path}: is of version {found}, and this program reads version {PROJECT_VERSION}; use the program that wrote it"
    )]
    Version {
        /// The file.
        path: String,
        /// Its version.
        found: String,
    },
    /// The file is no project.
    #[error("{path}: {reason}; `infopart annotate --help` shows what a file of key frames looks like")]
    Malformed {
        /// The file.
        path: String,
        /// What is wrong, with the line where that is known.
        reason: String,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ProjectFile {
    version: u64,
    objects: Vec<ObjectEntry>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    tracked_by: String,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ObjectEntry {
    name: String,
    #[serde(default = "no_class")]
    class: String,
    colour: Option<Colour>,
    keys: Vec<KeyEntry>,
    #[serde(default)]
    passes: Passes,
}

fn no_class() -> String {
    "object".to_owned()
}

/// A key frame as files have it.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyEntry {
    /// The frame, counted from 1.
    pub frame: usize,
    /// Left, top, width, height in pixels, the first pixel being 0.
    #[serde(default, rename = "box", skip_serializing_if = "Option::is_none")]
    pub rect: Option<[f64; 4]>,
    /// Whether the object is absent from this frame on.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub absent: bool,
}

/// Key frames by frame counted from 0.
///
/// # Errors
/// What is wrong with an entry.
pub fn keys_of(entries: &[KeyEntry]) -> Result<BTreeMap<usize, Mark>, String> {
    let mut keys = BTreeMap::new();
    for entry in entries {
        let frame = entry.frame;
        let index = frame.checked_sub(1).ok_or("a key frame is 0; frames count from 1")?;
        let mark = match (entry.rect, entry.absent) {
            (Some([x, y, w, h]), false) => Mark::Box(Rect::new(x, y, w, h)),
            (None, true) => Mark::Absent,
            _ => {
                return Err(format!(
                    "key frame {frame} needs either \"box\": [x, y, w, h] or \"absent\": true"
                ));
            }
        };
        if keys.insert(index, mark).is_some() {
            return Err(format!(
                "frame {frame} is there twice among the key frames of an object; leave one out"
            ));
        }
    }
    Ok(keys)
}

fn entries_of(keys: &BTreeMap<usize, Mark>) -> Vec<KeyEntry> {
    let entry = |(index, mark): (&usize, &Mark)| {
        let rect = mark.in_frame().map(|Rect { x, y, w, h }| [x, y, w, h]);
        KeyEntry { frame: index + 1, rect, absent: rect.is_none() }
    };
    keys.iter().map(entry).collect()
}

impl Project {
    /// Reads a project, or key frames alone.
    ///
    /// # Errors
    /// [`ProjectError`], naming the file and what to do.
    pub fn read(path: &Path) -> Result<Self, ProjectError> {
        let name = path.display().to_string();
        let text = fs::read_to_string(path)
            .map_err(|source| ProjectError::Unreadable { path: name.clone(), source })?;
        Self::parse(&text, &name)
    }

    /// A project from the text of a file that messages call `name`.
    ///
    /// # Errors
    /// [`ProjectError`].
    pub fn parse(text: &str, name: &str) -> Result<Self, ProjectError> {
        let path = || name.to_owned();
        let malformed = |error: serde_json::Error| {
            if error.is_eof() {
                ProjectError::CutShort { path: path() }
            } else {
                ProjectError::Malformed { path: path(), reason: error.to_string() }
            }
        };
        let value: serde_json::Value = serde_json::from_str(text).map_err(malformed)?;
        match value.get("version") {
            Some(version) if version.as_u64() == Some(PROJECT_VERSION) => {}
            Some(version) => {
                return Err(ProjectError::Version { path: path(), found: version.to_string() });
            }
            None => {
                let reason = format!("there is no \"version\": {PROJECT_VERSION}");
                return Err(ProjectError::Malformed { path: path(), reason });
            }
        }
        // From the text again, so that messages have lines.
        let file: ProjectFile = serde_json::from_str(text).map_err(malformed)?;
        let mut project = Self { tracked_by: file.tracked_by, ..Self::default() };
        for (index, entry) in file.objects.into_iter().enumerate() {
            let keys = keys_of(&entry.keys).map_err(|reason| {
                let reason = format!("object {:?}: {reason}", entry.name);
                ProjectError::Malformed { path: path(), reason }
            })?;
            let colour = entry.colour.unwrap_or(Colour::of_object(index));
            project.objects.push(Object { name: entry.name, class: entry.class, colour, keys });
            project.passes.push(entry.passes);
        }
        Ok(project)
    }

    /// Keeps the passes only if they follow from the same tracker, parameters and video, and says that they do from now on.
    pub fn forget_what_others_tracked(&mut self, tracked_by: String) {
        if self.tracked_by != tracked_by {
            self.passes = vec![Passes::default(); self.objects.len()];
            self.tracked_by = tracked_by;
        }
    }

    /// Writes the project beside `path` and gives it that name when it is whole and on the disk.
    ///
    /// # Errors
    /// [`OutputError`]; an earlier file of that name then stays as it was.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let mut file = PartialFile::create(path)?;
        let text = self.to_text().map_err(|error| file.name_error(error.into()))?;
        file.write_all(text.as_bytes()).map_err(|error| file.name_error(error))?;
        file.complete()
    }

    /// The text of a project file.
    ///
    /// # Errors
    /// None that is known: whatever a project can hold can be written.
    pub fn to_text(&self) -> serde_json::Result<String> {
        let objects = self.objects.iter().enumerate().map(|(index, object)| ObjectEntry {
            name: object.name.clone(),
            class: object.class.clone(),
            colour: Some(object.colour),
            keys: entries_of(&object.keys),
            passes: self.passes.get(index).cloned().unwrap_or_default(),
        });
        let file = ProjectFile {
            version: PROJECT_VERSION,
            objects: objects.collect(),
            tracked_by: self.tracked_by.clone(),
        };
        Ok(serde_json::to_string(&file)? + "\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::annotate::{Direction, Pass, Sighting};

    const BY_HAND: &str = r#"{"version": 1, "objects": [
        {"name": "a <b> \"c\"", "keys": [{"frame": 1, "box": [1, 2, 3.5, 4]}, {"frame": 9, "absent": true}]}]}"#;

    #[test]
    fn key_frames_by_hand_are_a_project_without_passes() {
        let project = Project::parse(BY_HAND, "k.json").unwrap();
        let object = &project.objects[0];
        assert_eq!((object.name.as_str(), object.class.as_str()), ("a <b> \"c\"", "object"));
        assert_eq!(object.colour, Colour::of_object(0));
        let keys = [(0, Mark::Box(Rect::new(1.0, 2.0, 3.5, 4.0))), (8, Mark::Absent)];
        assert_eq!(object.keys, keys.into_iter().collect());
        assert_eq!(project.passes, [Passes::default()]);
    }

    #[test]
    fn a_project_is_read_as_it_was_written_to_the_last_digit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("p.json");
        let mut project = Project::parse(BY_HAND, "k.json").unwrap();
        let pass = Pass {
            from: 3,
            start: Rect::new(0.1, 1.0 / 3.0, 5.0, 6.0),
            direction: Direction::Backward,
            sightings: vec![Sighting { box_in_frame: Rect::new(0.7, 2.0 / 3.0, 5.0, 6.1), confidence: 0.3 }],
        };
        project.passes = vec![serde_json::from_value(serde_json::json!([pass])).unwrap()];
        project.tracked_by = "somebody".into();
        project.write(&path).unwrap();
        let read = Project::read(&path).unwrap();
        assert_eq!(read, project);
        assert_eq!(read.passes[0].iter().next(), Some(&pass));
        assert!(!folder.path().join("p.json.partial").exists());
    }

    #[test]
    fn other_versions_cut_files_and_nonsense_are_refused_with_the_remedy() {
        let message = |text: &str| Project::parse(text, "k.json").unwrap_err().to_string();
        for (text, reason) in [
            (&BY_HAND[..BY_HAND.len() - 5], "k.json: is cut short; use an earlier copy"),
            ("", "k.json: is cut short"),
            (r#"{"version": 2, "objects": []}"#, "is of version 2, and this program reads version 1"),
            (r#"{"version": "1", "objects": []}"#, "is of version \"1\""),
            (r#"{"objects": []}"#, "there is no \"version\": 1"),
            ("[]", "there is no \"version\": 1"),
            ("frame,x,y", "--help"),
            (
                r#"{"version": 1, "objects": [{"name": "a", "keys": [{"frame": 0, "absent": true}]}]}"#,
                "frames count from 1",
            ),
            (
                r#"{"version": 1, "objects": [{"name": "a", "keys": [{"frame": 4}]}]}"#,
                "object \"a\": key frame 4 needs either",
            ),
            (
                r#"{"version": 1, "objects": [{"name": "a", "keys": [{"frame": 4, "absent": true}, {"frame": 4, "absent": true}]}]}"#,
                "frame 4 is there twice",
            ),
            (r#"{"version": 1, "objects": [{"name": "a", "keyz": []}]}"#, "keyz"),
            (r#"{"version": 1, "objects": [{"name": "a", "colour": "red", "keys": []}]}"#, "#rrggbb"),
        ] {
            let message = message(text);
            assert!(message.contains(reason), "{text}: {message}");
        }
    }
}
