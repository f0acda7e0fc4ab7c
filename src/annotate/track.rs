//! From an object's key frames to its box in every frame.
//!
//! Steps, for each stretch of frames:
//! 1. before the first key frame, if that has a box: the backward pass,
//! 2. between two boxes: both passes, fused,
//! 3. between a box and an absence: the forward pass; from an absence to the next box nothing,
//! 4. after the last key frame, if that has a box: the forward pass.

use serde::{Deserialize, Serialize};

use super::{
    fusion::fuse,
    keys::{Mark, Object},
    passes::{Direction, Leg, PassError, Passes, Pathfinder, Sighting},
};
use crate::geometry::Rect;

/// An object in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Annotated {
    /// Its box, frame coordinates.
    pub box_in_frame: Rect,
    /// Probability that the box overlaps the object by more than one half, in [0, 1]; 1 in a key frame.
    pub confidence: f64,
    /// Whether somebody drew it.
    pub is_key: bool,
}

impl Annotated {
    fn key(box_in_frame: Rect) -> Self {
        Self { box_in_frame, confidence: 1.0, is_key: true }
    }

    fn tracked(box_in_frame: Rect, confidence: f64) -> Self {
        Self { box_in_frame, confidence, is_key: false }
    }
}

impl From<&Sighting> for Annotated {
    fn from(seen: &Sighting) -> Self {
        Self::tracked(seen.box_in_frame, seen.confidence)
    }
}

/// Which ways the tracker goes from a key frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sides {
    /// Forward to the next key frame and backward to the one before.
    #[default]
    Both,
    /// Forward only: what a tracker that is restarted at each correction gives.
    Forward,
}

/// The object's box in each of `count` frames, `None` where it is absent; its key frames are to be checked
/// ([`Object::check`]). Passes that are known are not tracked again, and those that are not needed any more are kept
/// until [`Passes::forget_unused`].
///
/// # Errors
/// [`PassError`]; passes that were completed are known from then on.
pub fn annotate(
    object: &Object,
    count: usize,
    sides: Sides,
    passes: &mut Passes,
    finder: &mut Pathfinder<'_>,
) -> Result<Vec<Option<Annotated>>, PassError> {
    for leg in stretches(object, count, sides).iter().flat_map(Stretch::legs) {
        passes.sightings(finder, &leg)?;
    }
    Ok(known_track(object, count, sides, passes))
}

/// The frames from one key frame to the next, or to an end of the video.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// The forward pass, if the stretch begins at a box.
    pub forward: Option<Leg>,
    /// The backward pass, if it ends at one.
    pub backward: Option<Leg>,
}

impl Stretch {
    /// The passes that are needed.
    pub fn legs(&self) -> impl Iterator<Item = Leg> + use<> {
        self.forward.into_iter().chain(self.backward)
    }
}

/// Where the tracker has to go for an object, in the order of frames; only stretches with frames between their ends.
pub fn stretches(object: &Object, count: usize, sides: Sides) -> Vec<Stretch> {
    let keys: Vec<(usize, Mark)> = object.keys.iter().map(|(&frame, &mark)| (frame, mark)).collect();
    let mut stretches = Vec::new();
    if let Some(&(from, Mark::Box(start))) = keys.first()
        && sides == Sides::Both
        && from > 0
    {
        let backward = Some(Leg { from, start, direction: Direction::Backward, count: from });
        stretches.push(Stretch { forward: None, backward });
    }
    for (at, &(from, mark)) in keys.iter().enumerate() {
        let Mark::Box(start) = mark else { continue };
        let next = keys.get(at + 1).copied();
        let end = next.map_or(count, |(next, _)| next);
        if end <= from + 1 {
            continue;
        }
        let leg = |from, start, direction, count| Leg { from, start, direction, count };
        stretches.push(match next {
            // Both passes reach the other's key frame: what they are off there is their drift.
            Some((next, Mark::Box(last))) if sides == Sides::Both => Stretch {
                forward: Some(leg(from, start, Direction::Forward, next - from)),
                backward: Some(leg(next, last, Direction::Backward, next - from)),
            },
            _ => Stretch {
                forward: Some(leg(from, start, Direction::Forward, end - from - 1)),
                backward: None,
            },
        });
    }
    stretches
}

/// [`annotate`] without tracking: `None` also where no pass that is known has been. Two passes are fused once both are whole; until
/// then the forward one counts as far as it goes, and then the backward one.
pub fn known_track(object: &Object, count: usize, sides: Sides, passes: &Passes) -> Vec<Option<Annotated>> {
    let mut track = vec![None; count];
    for (&frame, mark) in &object.keys {
        if let (Some(slot), Some(drawn)) = (track.get_mut(frame), mark.in_frame()) {
            *slot = Some(Annotated::key(drawn));
        }
    }
    for stretch in stretches(object, count, sides) {
        let seen = |leg: Option<Leg>| leg.map_or(&[][..], |leg| passes.known(&leg));
        let (forward, backward) = (seen(stretch.forward), seen(stretch.backward));
        if let (Some(first), Some(last)) = (stretch.forward, stretch.backward)
            && forward.len() == first.count
            && backward.len() == last.count
        {
            let fused = fuse(first.start, last.start, forward, backward);
            for (slot, fused) in track[first.from + 1..last.from].iter_mut().zip(fused) {
                *slot = Some(Annotated::tracked(fused.box_in_frame, fused.confidence));
            }
            continue;
        }
        if let Some(leg) = stretch.backward {
            let before = track[leg.from - leg.count..leg.from].iter_mut().rev();
            fill(before, backward);
        }
        if let Some(leg) = stretch.forward {
            fill(track[leg.from + 1..=leg.from + leg.count].iter_mut(), forward);
        }
    }
    track
}

/// Puts what a pass saw where nothing was drawn.
fn fill<'a>(slots: impl Iterator<Item = &'a mut Option<Annotated>>, seen: &[Sighting]) {
    for (slot, seen) in slots.zip(seen) {
        if !slot.is_some_and(|found| found.is_key) {
            *slot = Some(seen.into());
        }
    }
}

#[cfg(test)]
mod tests;
