//! Where in a window the cues that look over it answer together.
//!
//! Steps:
//! 1. their sum at every cell, for a box of one size centred there,
//! 2. cells that no neighbour exceeds, best first, each placed between the cells by parabolas, and at most so many,
//! 3. without those that are far below the best, or lie on a better one.

use crate::{correlation::window::Window, geometry::Rect};

/// Peaks that are kept.
const PEAKS: usize = 6;
/// Peaks lower than the best by more than this share of its height (or of the least height) are left out.
const DEPTH: f64 = 0.75;
const LEAST_HEIGHT: f64 = 10.0;
/// A peak nearer to a better one than these shares of the box's width and height is the same.
const APART: (f64, f64) = (0.6, 0.5);
/// Cells at the window's border that are not looked at.
const BORDER: usize = 2;

/// A place that the cues answer to.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Peak {
    /// Frame pixels from the left edge.
    pub x: f64,
    /// Frame pixels from the top edge.
    pub y: f64,
    /// The sum of the cues' log-likelihoods there.
    pub height: f64,
}

impl Peak {
    /// A box moved to the peak.
    pub fn of(&self, target: &Rect) -> Rect {
        let (x, y) = target.centre();
        target.translated(self.x - x, self.y - y)
    }
}

/// Scratch for finding peaks. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct EvidenceMap {
    values: Vec<f64>,
    summits: Vec<usize>,
    peaks: Vec<Peak>,
}

impl EvidenceMap {
    /// The peaks found last, best first.
    pub fn peaks(&self) -> &[Peak] {
        &self.peaks
    }

    /// Finds the peaks of `evidence` over a window of `cells` x `cells`, for boxes of the size of `target` (steps 1 to 3).
    pub fn find_peaks(
        &mut self,
        window: Window,
        cells: usize,
        target: &Rect,
        evidence: impl Fn(&Rect) -> f64,
    ) {
        let half = (cells / 2).saturating_sub(BORDER) as i64;
        let side = (2 * half + 1) as usize;
        let cell = window.side / cells as f64;
        let at = |column: f64, row: f64| Peak {
            x: window.x + (column - half as f64) * cell,
            y: window.y + (row - half as f64) * cell,
            height: 0.0,
        };
        self.values.clear();
        let places = (0..side * side).map(|i| at((i % side) as f64, (i / side) as f64));
        self.values.extend(places.map(|place| evidence(&place.of(target))));
        self.find_summits(side);
        self.peaks.clear();
        let Some(&best) = self.summits.first() else { return };
        let best = self.values[best];
        let lowest = best - DEPTH * best.abs().max(LEAST_HEIGHT);
        for &summit in &self.summits {
            let height = self.values[summit];
            if height < lowest || self.peaks.len() >= PEAKS {
                break;
            }
            let (across, along) = (self.offset(summit, 1), self.offset(summit, side));
            let peak = at((summit % side) as f64 + across, (summit / side) as f64 + along);
            let is_near = |other: &Peak| {
                (other.x - peak.x).abs() < APART.0 * target.w && (other.y - peak.y).abs() < APART.1 * target.h
            };
            if !self.peaks.iter().any(is_near) {
                self.peaks.push(Peak { height, ..peak });
            }
        }
    }

    /// Step 2, without the offsets.
    fn find_summits(&mut self, side: usize) {
        let Self { values, summits, .. } = self;
        summits.clear();
        for row in 1..side.saturating_sub(1) {
            for column in 1..side - 1 {
                let here = row * side + column;
                let higher = |other: usize| values[other] > values[here];
                let rows = [here - side, here, here + side];
                if !rows.iter().any(|&row| higher(row - 1) || higher(row) || higher(row + 1)) {
                    summits.push(here);
                }
            }
        }
        summits.sort_unstable_by(|a, b| values[*b].total_cmp(&values[*a]).then(a.cmp(b)));
    }

    /// How far a parabola through a summit and its neighbours `step` before and after peaks from it, in cells.
    fn offset(&self, summit: usize, step: usize) -> f64 {
        let [before, here, after] = [summit - step, summit, summit + step].map(|i| self.values[i]);
        let curvature = before - 2.0 * here + after;
        if curvature < 0.0 { (0.5 * (before - after) / curvature).clamp(-0.5, 0.5) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Window = Window { x: 50.0, y: 40.0, side: 64.0 };

    fn hill(centre: (f64, f64), height: f64, at: (f64, f64)) -> f64 {
        height * (-0.01 * ((at.0 - centre.0).powi(2) + (at.1 - centre.1).powi(2))).exp()
    }

    #[test]
    fn peaks_come_best_first_between_the_cells_and_without_low_ones() {
        let (mut map, target) = (EvidenceMap::default(), Rect::new(0.0, 0.0, 8.0, 16.0));
        map.find_peaks(WINDOW, 32, &target, |full| {
            let at = full.centre();
            hill((60.7, 33.1), 40.0, at) + hill((35.0, 55.3), 30.0, at) + hill((32.0, 25.0), 5.0, at)
        });
        let found: Vec<_> = map.peaks().iter().map(|peak| (peak.x.round(), peak.y.round())).collect();
        assert_eq!(found, [(61.0, 33.0), (35.0, 55.0)]);
        assert!((map.peaks()[0].x - 60.7).abs() < 0.1 && (map.peaks()[0].y - 33.1).abs() < 0.1);
        let moved = map.peaks()[1].of(&target);
        assert!((moved.centre().0 - 35.0).abs() < 0.2 && (moved.w, moved.h) == (8.0, 16.0));
    }

    #[test]
    fn a_peak_on_a_better_one_is_the_same() {
        let evidence = |full: &Rect| {
            let at = full.centre();
            hill((50.0, 40.0), 40.0, at).max(hill((62.0, 40.0), 38.0, at))
        };
        for (width, count) in [(10.0, 2), (40.0, 1)] {
            let mut map = EvidenceMap::default();
            map.find_peaks(WINDOW, 32, &Rect::new(0.0, 0.0, width, 30.0), evidence);
            assert_eq!(map.peaks().len(), count);
        }
    }

    #[test]
    fn an_even_window_has_its_peaks_and_a_tiny_one_none() {
        let mut map = EvidenceMap::default();
        map.find_peaks(WINDOW, 4, &Rect::new(0.0, 0.0, 8.0, 16.0), |_| 1.0);
        assert!(map.peaks().is_empty());
        map.find_peaks(WINDOW, 32, &Rect::new(0.0, 0.0, 8.0, 16.0), |_| -3.0);
        assert!(map.peaks().len() <= PEAKS && map.peaks().iter().all(|peak| peak.height == -3.0));
    }
}
