//! Cells in stretches along rows, and the boxes that hold them.

use infopart::geometry::Rect;

/// A stretch of cells in one row, of one connected region of foreground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Segment {
    pub row: u32,
    pub start: u32,
    /// One after its last cell.
    pub end: u32,
    /// The region's name.
    pub region: usize,
}

impl Segment {
    pub(super) fn cells(&self) -> usize {
        (self.end - self.start) as usize
    }

    /// Where it lies in a picture of that width.
    pub(super) fn range(&self, width: u32) -> std::ops::Range<usize> {
        let row = self.row as usize * width as usize;
        row + self.start as usize..row + self.end as usize
    }
}

pub(super) fn count(segments: &[Segment]) -> usize {
    segments.iter().map(Segment::cells).sum()
}

/// The box of cells without a share of `stray` of them at each of its sides; `None` without cells.
pub(super) fn extent(segments: &[Segment], stray: f64) -> Option<Rect> {
    let left = segments.iter().map(|segment| segment.start).min()? as usize;
    let right = segments.iter().map(|segment| segment.end).max()? as usize;
    let top = segments.iter().map(|segment| segment.row).min()? as usize;
    let bottom = segments.iter().map(|segment| segment.row).max()? as usize + 1;
    let mut rows = vec![0usize; bottom - top];
    // Where stretches begin and end: the sum up to a column is its cells.
    let mut steps = vec![0i64; right - left + 1];
    for segment in segments {
        rows[segment.row as usize - top] += segment.cells();
        steps[segment.start as usize - left] += 1;
        steps[segment.end as usize - left] -= 1;
    }
    let mut sum = 0;
    let columns: Vec<usize> = steps[..right - left]
        .iter()
        .map(|step| {
            sum += step;
            sum as usize
        })
        .collect();
    let most = (stray * count(segments) as f64) as usize;
    let ((top_cut, bottom_cut), (left_cut, right_cut)) = (cuts(&rows, most), cuts(&columns, most));
    Some(Rect::new(
        (left + left_cut) as f64,
        (top + top_cut) as f64,
        (columns.len() - left_cut - right_cut) as f64,
        (rows.len() - top_cut - bottom_cut) as f64,
    ))
}

/// How many entries at each end hold at most `most` together.
fn cuts(counts: &[usize], most: usize) -> (usize, usize) {
    fn beyond<'a>(counts: impl Iterator<Item = &'a usize>, most: usize) -> usize {
        let mut sum = 0;
        counts
            .take_while(|count| {
                sum += **count;
                sum <= most
            })
            .count()
    }
    (beyond(counts.iter(), most), beyond(counts.iter().rev(), most))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(row: u32, start: u32, end: u32) -> Segment {
        Segment { row, start, end, region: 0 }
    }

    #[test]
    fn a_box_holds_all_cells_and_without_the_stray_ones_the_bulk() {
        // A block of 10 x 10 with one cell far to the left of it.
        let mut cells: Vec<Segment> = (5..15).map(|row| segment(row, 20, 30)).collect();
        assert_eq!(extent(&cells, 0.0), Some(Rect::new(20.0, 5.0, 10.0, 10.0)));
        cells.push(segment(9, 3, 4));
        assert_eq!(count(&cells), 101);
        assert_eq!(extent(&cells, 0.0), Some(Rect::new(3.0, 5.0, 27.0, 10.0)));
        assert_eq!(extent(&cells, 0.01), Some(Rect::new(20.0, 5.0, 10.0, 10.0)));
        assert_eq!(extent(&[], 0.01), None);
        assert_eq!(segment(2, 3, 5).range(10), 23..25);
    }
}
