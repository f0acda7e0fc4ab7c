//! What is kept beside a result, in `SEQ[_SEGMENT].result.json`: where its run starts, and by what the file is known to be
//! whole.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::StoreError;

/// What is known of a result besides its boxes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Record {
    /// The row of the truth, counted from 1, that the result's first row is of; `None` if that is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_row: Option<usize>,
    /// Rows of the result.
    pub rows: usize,
    /// SHA-256 of the result's file, hexadecimal.
    pub sha256: String,
}

impl Record {
    /// Of the text of a result with that many rows, whose first is of the row `start` of the truth, counted from 0.
    pub fn new(text: &[u8], rows: usize, start: Option<usize>) -> Self {
        Self { first_row: start.map(|start| start + 1), rows, sha256: hexadecimal(text) }
    }

    /// Where it stands, beside the result at `result`.
    pub fn path(result: &Path) -> PathBuf {
        result.with_extension("result.json")
    }

    /// The file's text.
    pub fn text(&self) -> String {
        // A struct of numbers and strings can always be written as JSON.
        serde_json::to_string(self).unwrap_or_default() + "\n"
    }

    /// Reads what stands beside a result; `None` if nothing does.
    ///
    /// # Errors
    /// [`StoreError::BadRecord`], [`StoreError::Io`].
    pub fn beside(result: &Path) -> Result<Option<Self>, StoreError> {
        let path = Self::path(result);
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(StoreError::Io { path, source }),
        };
        let record: Option<Self> = serde_json::from_slice(&bytes).ok();
        // No sequence has as many rows, so that sums with them stay numbers.
        let is_sound = |record: &Self| record.first_row.is_none_or(|row| (1..1_000_000_000).contains(&row));
        record.filter(is_sound).map(Some).ok_or(StoreError::BadRecord { path })
    }

    /// Whether these are the bytes of the result.
    pub fn is_of(&self, bytes: &[u8]) -> bool {
        self.sha256 == hexadecimal(bytes)
    }

    /// The row of the truth, counted from 0, that the result's first row is of.
    pub fn start(&self) -> Option<usize> {
        Some(self.first_row? - 1)
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
