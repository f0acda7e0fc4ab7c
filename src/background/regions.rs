//! Connected regions of a mask, as runs of pixels: a row with few borders costs little more than being looked at.
//!
//! Steps:
//! 1. cut each row into runs of the value wanted,
//! 2. join a run with those of the row above that touch it; the earliest run of a region is its root.

use image::GrayImage;

/// A stretch of one row that belongs to a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Run {
    /// The row.
    pub row: u32,
    /// Its first pixel.
    pub start: u32,
    /// One after its last pixel.
    pub end: u32,
    /// Index of the region's first run, which names the region.
    pub region: usize,
}

/// The runs of all pixels of `value`, row by row; regions are 8-connected if `diagonal`, else 4-connected.
pub fn runs(mask: &GrayImage, value: u8, diagonal: bool) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut above = 0..0;
    for (y, row) in mask.chunks_exact(mask.width().max(1) as usize).enumerate() {
        let first = runs.len();
        push_runs(row, y as u32, value, &mut runs);
        let mut candidate = above.start;
        for index in first..runs.len() {
            let Run { start, end, .. } = runs[index];
            let reach = u32::from(diagonal);
            while candidate < above.end && runs[candidate].end + reach <= start {
                candidate += 1;
            }
            // The last run that touches this one may touch the next, too.
            let mut touching = candidate;
            while touching < above.end && runs[touching].start < end + reach {
                join(&mut runs, touching, index);
                touching += 1;
            }
        }
        above = first..runs.len();
    }
    // A run's link is to an earlier one, whose root is known by then.
    for index in 0..runs.len() {
        runs[index].region = runs[runs[index].region].region;
    }
    runs
}

fn push_runs(row: &[u8], y: u32, value: u8, runs: &mut Vec<Run>) {
    let mut x = 0;
    while let Some(start) = row[x..].iter().position(|&pixel| pixel == value).map(|found| x + found) {
        let length = row[start..].iter().position(|&pixel| pixel != value).unwrap_or(row.len() - start);
        x = start + length;
        runs.push(Run { row: y, start: start as u32, end: x as u32, region: runs.len() });
    }
}

/// The first run of a region as far as it is known; shortens the way there for the next call.
fn root(runs: &mut [Run], mut index: usize) -> usize {
    while runs[index].region != index {
        runs[index].region = runs[runs[index].region].region;
        index = runs[index].region;
    }
    index
}

fn join(runs: &mut [Run], a: usize, b: usize) {
    let (a, b) = (root(runs, a), root(runs, b));
    runs[a.max(b)].region = a.min(b);
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Luma;
    use imageproc::region_labelling::{Connectivity, connected_components};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn regions_are_those_of_labelling_each_pixel(
            cells in prop::collection::vec(any::<bool>(), 13 * 9), diagonal in any::<bool>(),
        ) {
            let mask = GrayImage::from_fn(13, 9, |x, y| Luma([u8::from(cells[(y * 13 + x) as usize])]));
            let connectivity = if diagonal { Connectivity::Eight } else { Connectivity::Four };
            let labels = connected_components(&mask, connectivity, Luma([0]));
            let mut region_of_pixel = vec![None; 13 * 9];
            for run in runs(&mask, 1, diagonal) {
                region_of_pixel[(run.row * 13 + run.start) as usize..(run.row * 13 + run.end) as usize].fill(Some(run.region));
            }
            let pixels: Vec<(u32, Option<usize>)> = labels.iter().copied().zip(region_of_pixel).collect();
            for &(label, region) in &pixels {
                prop_assert_eq!(label == 0, region.is_none());
                for &(other_label, other_region) in &pixels {
                    prop_assert_eq!(label == other_label, region == other_region);
                }
            }
        }
    }
}
