//! What a benchmark says of a sequence: `SEQ/seqinfo.ini` beside `SEQ/gt/gt.txt`.

use std::path::{Path, PathBuf};

use super::MotError;

/// The number of frames that `SEQ/seqinfo.ini` gives for the ground truth `SEQ/gt/gt.txt`; `None` if there is no such file.
///
/// # Errors
/// [`MotError`] if the file cannot be read or has no whole number above 0 as its `seqLength`.
pub fn sequence_length(truth: &Path) -> Result<Option<u32>, MotError> {
    let Some(path) = beside(truth).filter(|path| path.is_file()) else { return Ok(None) };
    let read = std::fs::read_to_string(&path);
    let text = read.map_err(|source| MotError::Unreadable { path: path.clone(), source })?;
    let given = value(&text, "seqLength");
    match given.and_then(|text| text.parse().ok()).filter(|&length: &u32| length > 0) {
        Some(length) => Ok(Some(length)),
        None => {
            let what = match given {
                Some(text) => format!("seqLength is {text:?}, not a number of frames; correct it"),
                None => "no seqLength in it; add seqLength=FRAMES, or remove the file".to_owned(),
            };
            Err(MotError::Sequences { path, what })
        }
    }
}

fn beside(truth: &Path) -> Option<PathBuf> {
    let folder = truth.parent().filter(|folder| folder.file_name().is_some_and(|name| name == "gt"))?;
    Some(folder.parent()?.join("seqinfo.ini"))
}

/// What stands behind `KEY =`, keys being written in capitals or not.
fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    text.lines().find_map(|line| {
        let (name, value) = line.split_once('=')?;
        name.trim().eq_ignore_ascii_case(key).then_some(value.trim())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_length_is_that_of_the_file_beside() {
        let folder = tempfile::tempdir().unwrap();
        let truth = folder.path().join("A/gt/gt.txt");
        std::fs::create_dir_all(truth.parent().unwrap()).unwrap();
        assert_eq!(sequence_length(&truth).unwrap(), None);
        let write = |text: &str| std::fs::write(folder.path().join("A/seqinfo.ini"), text).unwrap();
        write("[Sequence]\r\nname=A\r\nframeRate=30\r\nseqlength = 525\r\n");
        assert_eq!(sequence_length(&truth).unwrap(), Some(525));
        assert_eq!(sequence_length(&folder.path().join("A/other.txt")).unwrap(), None);
        for (text, part) in [("seqLength=many", "\"many\""), ("seqLength=0", "\"0\""), ("", "no seqLength")] {
            write(text);
            let message = sequence_length(&truth).unwrap_err().to_string();
            assert!(message.contains("seqinfo.ini") && message.contains(part), "{message}");
        }
    }
}
