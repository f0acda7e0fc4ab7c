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
    passes::{Direction, PassError, Passes, Pathfinder, Sighting},
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
    let mut track = vec![None; count];
    let keys: Vec<(usize, Mark)> = object.keys.iter().map(|(&frame, &mark)| (frame, mark)).collect();
    if let Some(&(frame, Mark::Box(start))) = keys.first()
        && sides == Sides::Both
    {
        let seen = passes.sightings(finder, frame, start, Direction::Backward, frame)?;
        for (slot, seen) in track[..frame].iter_mut().rev().zip(seen) {
            *slot = Some(seen.into());
        }
    }
    for (at, &(frame, mark)) in keys.iter().enumerate() {
        let Mark::Box(start) = mark else { continue };
        track[frame] = Some(Annotated::key(start));
        let next = keys.get(at + 1).copied();
        let end = next.map_or(count, |(next, _)| next);
        let between = end - frame - 1;
        match next {
            Some((next, Mark::Box(last))) if sides == Sides::Both => {
                if between == 0 {
                    continue;
                }
                let length = next - frame;
                let forward = passes.sightings(finder, frame, start, Direction::Forward, length)?.to_vec();
                let backward = passes.sightings(finder, next, last, Direction::Backward, length)?;
                for (slot, fused) in
                    track[frame + 1..end].iter_mut().zip(fuse(start, last, &forward, backward))
                {
                    *slot = Some(Annotated::tracked(fused.box_in_frame, fused.confidence));
                }
            }
            _ => {
                let seen = passes.sightings(finder, frame, start, Direction::Forward, between)?;
                for (slot, seen) in track[frame + 1..end].iter_mut().zip(seen) {
                    *slot = Some(seen.into());
                }
            }
        }
    }
    Ok(track)
}

#[cfg(test)]
mod tests;
