//! One JSON object a line.

use super::Row;

/// A frame's object; an unknown time is null.
pub(super) fn line(row: &Row) -> String {
    // A row is numbers and words only, which always serialise; the empty object keeps one line a frame.
    serde_json::to_string(row).unwrap_or_else(|_| "{}".to_owned())
}
