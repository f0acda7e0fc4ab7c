//! Frames on which the target is hidden or out of view, so that the benchmark starts no run of TRE there: its lists
//! `initOmit/NAME.txt`, a range of frames a line, by the numbers in the files' names.

use std::{
    collections::BTreeMap,
    fs, io,
    ops::RangeInclusive,
    path::{Path, PathBuf},
};

use sha2::{Digest, Sha256};
use thiserror::Error;

use crate::catalogue;

/// Ranges of a sequence's frames, by the numbers in the files' names.
type Ranges = Vec<RangeInclusive<usize>>;

/// The lists of hidden frames of some sequences.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HiddenFrames {
    by_name: BTreeMap<String, Ranges>,
}

/// Lists of hidden frames that cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum HiddenError {
    /// The file system refused.
    #[error("{path}: cannot be read: {source}; give --init-omit a folder of NAME.txt, a range of frames a line", path = path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// No list in the folder.
    #[error("{path}: no lists there; give --init-omit a folder of NAME.txt, a range of frames a line", path = path.display())]
    Nothing {
        /// The folder.
        path: PathBuf,
    },
    /// A line that is no range.
    #[error("{path}, line {line}: `{}` is no range of frames; write the numbers of the first and the last, such as 8 27", text.escape_debug(), path = path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The line as it stands.
        text: String,
    },
}

impl Default for HiddenFrames {
    /// The benchmark's own 27 lists.
    fn default() -> Self {
        let list = |line: &str| {
            let (name, ranges) = line.split_once('\t')?;
            Some((name.to_owned(), ranges.split(' ').filter_map(|words| range(words, '-')).collect()))
        };
        // That every line of the table gives a list is tested.
        Self { by_name: include_str!("init_omit.tsv").lines().filter_map(list).collect() }
    }
}

impl HiddenFrames {
    /// No list at all.
    pub fn none() -> Self {
        Self { by_name: BTreeMap::new() }
    }

    /// The benchmark's lists, and in their place or besides them those of a folder, `NAME.txt` in any spelling.
    ///
    /// # Errors
    /// [`HiddenError`], naming the file and line.
    pub fn with_folder(mut self, folder: &Path) -> Result<Self, HiddenError> {
        let io_error = |source| HiddenError::Io { path: folder.to_owned(), source };
        let mut found = false;
        for entry in fs::read_dir(folder).map_err(io_error)? {
            let path = entry.map_err(io_error)?.path();
            if path.extension().is_some_and(|end| end == "txt") {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                self.by_name.insert(key(&stem), ranges_in(&path)?);
                found = true;
            }
        }
        if found { Ok(self) } else { Err(HiddenError::Nothing { path: folder.to_owned() }) }
    }

    /// A sequence's hidden rows of truth, counted from 0. The truth of TB-100's targets starts with the benchmark's first frame,
    /// that of others with frame 1.
    pub fn rows(&self, sequence: &str) -> Vec<RangeInclusive<usize>> {
        let first = catalogue::find(sequence).map_or(1, |known| known.first_frame);
        let ranges = self.by_name.get(&key(sequence)).into_iter().flatten();
        let rows = |range: &RangeInclusive<usize>| {
            Some(range.start().saturating_sub(first)..=range.end().checked_sub(first)?)
        };
        ranges.filter_map(rows).collect()
    }

    /// SHA-256 of the lists, hexadecimal: what decides where TRE starts, besides the truth.
    pub fn digest(&self) -> String {
        let text = format!("{:?}", self.by_name);
        Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// The benchmark's name, or a sequence's own in small letters.
fn key(name: &str) -> String {
    catalogue::find(name).map_or_else(|| name.to_lowercase(), |known| known.name.to_owned())
}

fn ranges_in(path: &Path) -> Result<Ranges, HiddenError> {
    let text = fs::read(path).map_err(|source| HiddenError::Io { path: path.to_owned(), source })?;
    let text = String::from_utf8_lossy(&text);
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let read = |(index, line): (usize, &str)| {
        let bad = || HiddenError::Line { path: path.to_owned(), line: index + 1, text: line.to_owned() };
        range(&line.replace([',', '\t'], " "), ' ').ok_or_else(bad)
    };
    lines.map(read).collect()
}

fn range(words: &str, between: char) -> Option<RangeInclusive<usize>> {
    let mut numbers =
        words.split(between).filter(|word| !word.is_empty()).map(|word| word.trim().parse().ok());
    let (first, last): (usize, usize) = (numbers.next()??, numbers.next()??);
    (numbers.next().is_none() && first <= last).then_some(first..=last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_table_is_a_list_of_a_known_target() {
        let built_in = HiddenFrames::default();
        assert_eq!(built_in.by_name.len(), 27);
        let ranges: usize = built_in.by_name.values().map(Vec::len).sum();
        let lines = include_str!("init_omit.tsv").lines().filter(|line| !line.starts_with('#'));
        assert_eq!(ranges, lines.map(|line| line.split(' ').count()).sum::<usize>());
        for name in built_in.by_name.keys() {
            assert_eq!(catalogue::find(name).map(|known| known.name), Some(name.as_str()));
        }
    }

    #[test]
    fn rows_are_counted_from_the_first_frame_of_the_benchmark() {
        let built_in = HiddenFrames::default();
        assert_eq!(built_in.rows("jogging_1"), [60..=82]);
        assert_eq!(built_in.rows("Tiger1")[..2], [3..=9, 12..=23], "frames 9-15 of a truth from frame 6 on");
        assert!(built_in.rows("Couple").is_empty() && HiddenFrames::none().rows("Woman").is_empty());
    }

    #[test]
    fn lists_of_a_folder_stand_in_for_the_built_in_ones() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |folder: &Path| HiddenFrames::default().with_folder(folder).unwrap_err().to_string();
        assert!(refused(folder.path()).contains("no lists there"));
        fs::write(folder.path().join("Jogging_1.txt"), "10\t12\r\n\r\n20 20\n").unwrap();
        fs::write(folder.path().join("Mine.txt"), "1,4").unwrap();
        let lists = HiddenFrames::default().with_folder(folder.path()).unwrap();
        assert_eq!(lists.rows("Jogging-1"), [9..=11, 19..=19]);
        assert_eq!(lists.rows("mine"), [0..=3]);
        assert_eq!(lists.rows("Woman"), HiddenFrames::default().rows("Woman"));
        assert_ne!(lists.digest(), HiddenFrames::default().digest());
        fs::write(folder.path().join("Mine.txt"), "1 4\n7 \u{1b}5\n").unwrap();
        let told = refused(folder.path());
        assert!(told.contains("Mine.txt, line 2: `7 \\u{1b}5`"), "{told}");
        fs::write(folder.path().join("Mine.txt"), "9 4\n").unwrap();
        assert!(refused(folder.path()).contains("line 1"));
        assert!(refused(&folder.path().join("none")).contains("none: cannot be read"));
    }
}
