//! `x,y,w,h`, as the OTB toolkit reads results.

use super::Row;

/// The full box; `{}` gives the fewest digits that read back as the same number.
pub(super) fn line(row: &Row) -> String {
    format!("{},{},{},{}", row.x, row.y, row.w, row.h)
}
