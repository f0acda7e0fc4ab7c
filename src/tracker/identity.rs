//! Who the target is: a conservative memory of what its part and what others looked like (after Kalal, Mikolajczyk, Matas 2012).
//!
//! Steps:
//! 1. a portrait of a part: its HOG, and the mean colours of a few cells,
//! 2. the memory holds portraits of the target, the first one for ever, and of places that were taken for it and are not; both
//!    are added from trusted frames only, and only if they tell something new,
//! 3. a part's likeness: the distance to the nearest of the others / the sum of that and of the distance to the nearest own one.

use crate::{
    features::{
        hog::Hog,
        region::{CHANNELS, RegionIntegrals},
    },
    geometry::Rect,
};

/// Portraits of the target that are kept.
const OWN: usize = 12;
/// Portraits of others that are kept.
const OTHERS: usize = 24;
/// Cells of a portrait's colours along its width and its height.
const COLOUR_CELLS: (usize, usize) = (2, 4);
/// A difference in a channel, of 255, that counts as much as a squared HOG distance of 1.
const COLOUR_UNIT: f32 = 50.0;
/// An own portrait is new if its distance to the nearest is above this.
const NEW: f32 = 0.15;
/// Another's portrait is new if its likeness to the target is above this.
const CONFUSING: f32 = 0.3;
/// Distances are taken for at least this.
const LEAST_DISTANCE: f32 = 0.02;
/// The distance to the nearest of the others when there is none.
const FAR: f32 = 1.0;

/// What a part looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Portrait {
    hog: Hog,
    colours: [[f32; CHANNELS]; COLOUR_CELLS.0 * COLOUR_CELLS.1],
}

impl Portrait {
    /// The portrait of a part, which the integrals must hold for the most (step 1).
    pub fn of(integrals: &RegionIntegrals, part: Rect) -> Self {
        let (columns, rows) = COLOUR_CELLS;
        let (w, h) = (part.w / columns as f64, part.h / rows as f64);
        let cell =
            |i: usize| Rect::new(part.x + (i % columns) as f64 * w, part.y + (i / columns) as f64 * h, w, h);
        Self {
            hog: Hog::of(integrals, &integrals.to_region(part)),
            colours: std::array::from_fn(|i| integrals.mean_colour(&integrals.to_region(cell(i)))),
        }
    }

    /// 0 for the same, about 1 for unlike ones.
    fn distance(&self, other: &Self) -> f32 {
        let squares = |(a, b): (&[f32; CHANNELS], &[f32; CHANNELS])| -> f32 {
            a.iter().zip(b).map(|(a, b)| ((a - b) / COLOUR_UNIT).powi(2)).sum::<f32>() / CHANNELS as f32
        };
        let colours = self.colours.iter().zip(&other.colours).map(|pair| squares(pair).min(1.0));
        0.5 * (self.hog.squared_distance(&other.hog) + colours.sum::<f32>() / self.colours.len() as f32)
    }
}

/// The memory.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Identity {
    own: Vec<Portrait>,
    others: Vec<Portrait>,
    /// Which of the own (but the first) and of the others is replaced next.
    oldest: (usize, usize),
}

impl Identity {
    /// A memory of the target's first portrait.
    pub fn new(first: Portrait) -> Self {
        let mut own = Vec::with_capacity(OWN);
        own.push(first);
        Self { own, others: Vec::with_capacity(OTHERS), oldest: (0, 0) }
    }

    /// How much more a portrait is like the target than like others, in [0, 1] (step 3).
    pub fn likeness(&self, portrait: &Portrait) -> f32 {
        let own = nearest(&self.own, portrait).unwrap_or(FAR).max(LEAST_DISTANCE);
        let other = nearest(&self.others, portrait).unwrap_or(FAR).clamp(LEAST_DISTANCE, FAR);
        other / (other + own)
    }

    /// Learns from a trusted frame: the target's portrait and those of others (step 2).
    pub fn learn(&mut self, portrait: Portrait, others: impl IntoIterator<Item = Portrait>) {
        for other in others {
            if self.likeness(&other) > CONFUSING {
                keep(&mut self.others, OTHERS, 0, &mut self.oldest.1, other);
            }
        }
        if nearest(&self.own, &portrait).is_none_or(|distance| distance > NEW) {
            keep(&mut self.own, OWN, 1, &mut self.oldest.0, portrait);
        }
    }
}

fn nearest(portraits: &[Portrait], to: &Portrait) -> Option<f32> {
    portraits.iter().map(|one| one.distance(to)).min_by(f32::total_cmp)
}

/// Adds a portrait, in the place of the oldest behind the `fixed` first ones where there is no room.
fn keep(portraits: &mut Vec<Portrait>, room: usize, fixed: usize, oldest: &mut usize, portrait: Portrait) {
    if portraits.len() < room {
        portraits.push(portrait);
    } else {
        portraits[fixed + *oldest] = portrait;
        *oldest = (*oldest + 1) % (room - fixed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        features::region::SearchRegion,
        frame::{Frame, PixelFormat},
    };

    const PART: Rect = Rect { x: 8.0, y: 8.0, w: 16.0, h: 32.0 };

    /// A part of that colour, its lower half darker, before grey.
    fn portrait(colour: [u8; 3]) -> Portrait {
        let pixel = |x: usize, y: usize| {
            if !(8..24).contains(&x) || !(8..40).contains(&y) {
                return [128; 3];
            }
            if y < 24 { colour } else { colour.map(|value| value / 2) }
        };
        let pixels = (0..32 * 48).flat_map(|i| pixel(i % 32, i / 32)).collect();
        let frame = Frame::new(pixels, 32, 48, PixelFormat::Rgb).unwrap();
        let mut integrals = RegionIntegrals::default();
        integrals.compute(&frame.view(), SearchRegion::around(PART, 1));
        Portrait::of(&integrals, PART)
    }

    #[test]
    fn a_portrait_holds_the_mean_colours_of_its_cells() {
        let Portrait { colours, .. } = portrait([200, 100, 40]);
        assert_eq!(colours[..4], [[200.0, 100.0, 40.0]; 4]);
        assert_eq!(colours[4..], [[100.0, 50.0, 20.0]; 4]);
    }

    #[test]
    fn likeness_is_high_for_the_target_and_low_for_who_was_learnt_as_another() {
        let (red, blue) = (portrait([200, 30, 30]), portrait([30, 30, 200]));
        let mut identity = Identity::new(red);
        let before = identity.likeness(&blue);
        identity.learn(red, [blue]);
        assert!(identity.likeness(&red) > 0.9, "{}", identity.likeness(&red));
        assert!(identity.likeness(&blue) < 0.2 && identity.likeness(&blue) < before);
    }

    #[test]
    fn only_what_is_new_is_kept_and_the_first_portrait_for_ever() {
        let mut identity = Identity::new(portrait([0, 0, 0]));
        identity.learn(portrait([3, 3, 3]), []);
        assert_eq!(identity.own.len(), 1);
        for level in 1..=3 * OWN {
            let colour = [level * 83 % 251, level * 151 % 251, level * 199 % 251].map(|value| value as u8);
            identity.learn(portrait(colour), []);
        }
        assert_eq!((identity.own.len(), identity.own[0]), (OWN, portrait([0, 0, 0])));
    }
}
