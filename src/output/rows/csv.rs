//! Comma-separated values. No cell can hold a comma or a quote, so none needs quoting.

use super::Row;

const COLUMNS: &str =
    "frame,x,y,w,h,part_x,part_y,part_w,part_h,confidence,status,effective_sample_size,time_s";

/// The names of the columns.
pub(super) fn header(timing: bool) -> String {
    if timing { format!("{COLUMNS},update_ms") } else { COLUMNS.to_owned() }
}

/// A frame's cells, in the header's order; an unknown time is an empty cell.
pub(super) fn line(row: &Row) -> String {
    let numbers =
        [row.x, row.y, row.w, row.h, row.part_x, row.part_y, row.part_w, row.part_h, row.confidence];
    let mut cells = vec![row.frame.to_string()];
    cells.extend(numbers.iter().map(f64::to_string));
    cells.push(row.status.to_string());
    cells.push(row.effective_sample_size.to_string());
    cells.push(row.time_s.map(|time| time.to_string()).unwrap_or_default());
    cells.extend(row.update_ms.map(|time| time.to_string()));
    cells.join(",")
}
