//! One object: where it is, how large, how it looks, and what is known of its life.

use image::GrayImage;
use infopart::{
    background::FOREGROUND,
    bayes::{FilterError, State},
    geometry::Rect,
};

use super::{
    claims::STRAY,
    extent::{Segment, count, extent},
};
use crate::{
    appearance::Appearance,
    motion::{CentreModel, CentreNoise, FilterKind, FilterOptions, StateFilter},
};

/// Share of its shorter side by which opposite edges of an object must have gone the same way, for it to have moved.
const MOVED: f64 = 0.4;
/// The same where the sights are fits.
const MOVED_BY_FIT: f64 = 1.0;
/// Share of the longer of two sides from which they are the same.
const SAME_SIDE: f64 = 0.7;
/// Share of its foreground that a part of an object must have to be one of its own.
const LARGE: f64 = 0.35;
/// How much wider than expected a track's parts may be together.
const WIDER: f64 = 1.25;
/// Widths that a track must go with a gap in it for the gap to be no tree or pole before it, but air between two.
const GAP_TRAVEL: f64 = 0.7;
/// Widths of the wider part that no pole before an object has.
const WIDE_GAP: f64 = 0.5;
/// Shorter sides that an object may go between two sights, a frame.
const LEAP: f64 = 1.4;

#[derive(Debug)]
pub(super) struct Track<D, const N: usize> {
    pub identity: u64,
    pub filter: StateFilter<D, N, 2>,
    /// Width and height, smoothed.
    pub size: (f64, f64),
    pub appearance: Option<Appearance>,
    pub predicted: Option<Rect>,
    /// Its box as it was seen in this frame.
    pub detected: Option<Rect>,
    /// Where its movement is measured from.
    moves_from: Rect,
    /// Cells that it usually has when alone.
    pub usual_cells: f64,
    pub sights: u32,
    /// Sights in a region of its own.
    pub sights_alone: u32,
    /// Frames in a row without a sight.
    pub invisible: u32,
    /// Frames from the sight before to the last.
    frames_between: u32,
    /// Whether it has moved, as what only stopped being there does not.
    pub has_moved: bool,
    pub is_established: bool,
    /// Frames in a row in which it nearly coincided with an older track.
    pub doubled: u32,
    /// Frames in a row in which its region was larger than it.
    pub outgrown: u32,
    /// Frames in a row in which it seemed to have another size.
    pub odd: u32,
    /// Its foreground in this frame.
    pub segments: Vec<Segment>,
    /// Frames for which it has rested.
    pub rests: u32,
    rested_at: Rect,
    /// Its centre when it last had parts, and how far it has gone with a gap.
    gap_at: Option<(f64, f64)>,
    gap_travel: f64,
    last_box: Option<Rect>,
}

impl<D: CentreModel<N>, const N: usize> Track<D, N> {
    pub(super) fn new(
        identity: u64,
        seen: Rect,
        segments: Vec<Segment>,
        look: Appearance,
        (filter, options): (FilterKind, FilterOptions),
    ) -> Result<Self, FilterError> {
        let noise = CentreNoise::for_side(seen.area().sqrt());
        let belief = D::first_belief(seen.centre(), noise)?;
        Ok(Self {
            identity,
            filter: StateFilter::new(filter, D::under(noise)?, belief, options.for_track(identity))?,
            size: (seen.w, seen.h),
            appearance: Some(look),
            predicted: None,
            detected: Some(seen),
            moves_from: seen,
            usual_cells: count(&segments) as f64,
            sights: 1,
            sights_alone: 1,
            invisible: 0,
            frames_between: 1,
            has_moved: false,
            is_established: false,
            doubled: 0,
            outgrown: 0,
            odd: 0,
            segments,
            rests: 0,
            rested_at: seen,
            gap_at: None,
            gap_travel: 0.0,
            last_box: None,
        })
    }

    /// The believed centre with the smoothed size.
    pub(super) fn tracked_box(&self) -> Rect {
        let mean = &self.filter.belief().mean;
        let (w, h) = self.size;
        Rect::new(mean[0] - w / 2.0, mean[1] - h / 2.0, w, h)
    }

    /// Takes a sight; the size follows it by the share `gain` of the logarithms, at most `most` times a frame.
    pub(super) fn see(&mut self, seen: Rect, gain: f64, most: f64) {
        let (x, y) = seen.centre();
        // A measurement that the filter cannot take leaves its prediction.
        let _ = self.filter.update(&State::from([x, y]));
        let follow = |old: f64, new: f64| old * (new / old).powf(gain).clamp(1.0 / most, most);
        self.size = (follow(self.size.0, seen.w), follow(self.size.1, seen.h));
        self.detected = Some(seen);
        self.sights += 1;
        self.frames_between = self.invisible.max(1);
        self.invisible = 0;
        // A fit in a shared region may shift, so that it must have gone farther; what grows or is laid bare has not moved by that.
        let is_whole = gain > 0.0;
        if is_whole && !is_of_size(&self.moves_from, &seen) {
            self.moves_from = seen;
        }
        self.has_moved |= has_moved(&self.moves_from, &seen, if is_whole { MOVED } else { MOVED_BY_FIT });
        if self.rested_at.overlap(&seen) > 0.8 {
            self.rests += 1;
        } else {
            (self.rested_at, self.rests) = (seen, 0);
        }
    }

    /// Parts with from the claim what is another object: large parts side by side that together are too wide, that have a gap as
    /// no pole before an object has, or that have gone some way with a gap between them. What it parts with is written to `left`.
    pub(super) fn split(&mut self, segments: &mut Vec<Segment>, predicted: &Rect, left: &mut GrayImage) {
        let parts = large_parts(segments);
        let centre = predicted.centre();
        let step = self.gap_at.replace(centre).map_or(0.0, |at| (at.0 - centre.0).hypot(at.1 - centre.1));
        let gap =
            parts.windows(2).filter_map(|pair| gap_between(&pair[0].1, &pair[1].1)).max_by(f64::total_cmp);
        let Some(gap) = gap else {
            self.gap_travel = (self.gap_travel - step).max(0.0);
            return;
        };
        self.gap_travel += step;
        let whole = parts.iter().map(|part| part.1).reduce(|a, b| a.union(&b)).unwrap_or(*predicted);
        let are_two = self.gap_travel > GAP_TRAVEL * predicted.w || gap > WIDE_GAP;
        if !are_two && whole.w < WIDER * predicted.w {
            return;
        }
        let kept = match are_two {
            true => parts.iter().max_by_key(|part| part.2),
            false => parts.iter().max_by(|a, b| a.1.overlap(predicted).total_cmp(&b.1.overlap(predicted))),
        };
        let kept = kept.map(|part| part.0);
        let is_other =
            |one: &Segment| Some(one.region) != kept && parts.iter().any(|part| part.0 == one.region);
        let width = left.width();
        for segment in segments.iter().filter(|one| is_other(one)) {
            (**left)[segment.range(width)].fill(FOREGROUND);
        }
        segments.retain(|one| !is_other(one));
        if are_two && let Some(own) = extent(segments, STRAY) {
            let pixels = self.size.0 / predicted.w;
            self.size = (own.w * pixels, own.h * pixels);
            self.usual_cells = count(segments) as f64;
        }
        self.gap_travel = 0.0;
    }

    /// Whether it went farther since its last sight than one object does.
    pub(super) fn has_leapt(&mut self) -> bool {
        let now = self.tracked_box();
        self.last_box.replace(now).is_some_and(|before| {
            let side = now.w.min(now.h).min(before.w.min(before.h));
            before.centre_distance(&now) > LEAP * side * f64::from(self.frames_between)
        })
    }
}

/// Whether the sides are the same but for a swinging limb.
fn is_of_size(a: &Rect, b: &Rect) -> bool {
    let alike = |a: f64, b: f64| a.min(b) > SAME_SIDE * a.max(b);
    alike(a.w, b.w) && alike(a.h, b.h)
}

/// Whether a pair of opposite edges has gone the same way.
fn has_moved(first: &Rect, now: &Rect, share: f64) -> bool {
    let least = share * first.w.min(first.h).min(now.w.min(now.h));
    let went = |low: f64, high: f64| low * high > 0.0 && low.abs().min(high.abs()) > least;
    went(now.x - first.x, now.right() - first.right()) || went(now.y - first.y, now.bottom() - first.bottom())
}

/// Region, box and cells of each large part, from left to right.
fn large_parts(segments: &[Segment]) -> Vec<(usize, Rect, usize)> {
    let mut regions: Vec<usize> = segments.iter().map(|one| one.region).collect();
    regions.sort_unstable();
    regions.dedup();
    let least = LARGE * count(segments) as f64;
    let mut parts: Vec<(usize, Rect, usize)> = (regions.into_iter())
        .filter_map(|region| {
            let own: Vec<Segment> = segments.iter().filter(|one| one.region == region).copied().collect();
            let cells = count(&own);
            (cells as f64 >= least).then(|| extent(&own, STRAY).map(|area| (region, area, cells))).flatten()
        })
        .collect();
    parts.sort_by(|a, b| a.1.centre().0.total_cmp(&b.1.centre().0));
    parts
}

/// The gap between parts side by side, in widths of the wider; below 0 where they overlap a little, `None` where one is above the
/// other, as a body is above its legs.
fn gap_between(left: &Rect, right: &Rect) -> Option<f64> {
    let shared = left.right().min(right.right()) - left.x.max(right.x);
    (shared < 0.5 * left.w.min(right.w)).then_some(-shared / left.w.max(right.w))
}
