//! Algorithm 5: boxes to train on, targets near the target and backgrounds in a band around it.
//!
//! Steps:
//! 1. the target's own box,
//! 2. N+ - 1 boxes of the same size near it,
//! 3. N- boxes of the same size that hold little of it. The legs of a person may be among them: they are not the part,
//! 4. hard negatives: boxes at and about the places that other cues answer to.

use rand::{Rng, RngExt};

use crate::{boosting::Label, geometry::Rect};

use super::parameters::Parameters;

/// Tries to find a background box before an overlapping one is given up.
const TRIES: usize = 50;
/// How far hard negatives lie from such a place along each axis at most, pixels.
const OTHER_JITTER: f64 = 2.0;

/// How boxes are drawn around a target.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Sampler {
    jitter: f64,
    jitter_share: f64,
    reach: f64,
    overlap: f64,
    /// Samples of each place that looks like the target and is not.
    per_other: usize,
}

impl Sampler {
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            jitter: parameters.target_jitter,
            jitter_share: parameters.target_jitter_share,
            reach: parameters.background_reach,
            overlap: parameters.background_overlap,
            per_other: parameters.hard_negatives,
        }
    }

    /// The smallest box that holds every sample of a target, in the target's space.
    pub fn field(&self, part: &Rect) -> Rect {
        let (x, y) = self.background_reach(part);
        let (x, y) = (x.max(self.jitter), y.max(self.jitter));
        Rect::new(part.x - x, part.y - y, part.w + 2.0 * x, part.h + 2.0 * y)
    }

    /// Draws `targets` and `backgrounds` boxes inside `field` and hands each to `sample`. Fewer backgrounds come where
    /// the field has no room for them.
    pub fn draw<R: Rng + ?Sized>(
        &self,
        part: &Rect,
        field: &Rect,
        (targets, backgrounds): (usize, usize),
        rng: &mut R,
        mut sample: impl FnMut(&Rect, Label),
    ) {
        let within =
            |rng: &mut R, reach: f64| if reach > 0.0 { rng.random_range(-reach..=reach) } else { 0.0 };
        let jitter_x = self.jitter.min(self.jitter_share * part.w);
        let jitter_y = self.jitter.min(self.jitter_share * part.h);
        for i in 0..targets {
            let (dx, dy) = if i == 0 { (0.0, 0.0) } else { (within(rng, jitter_x), within(rng, jitter_y)) };
            sample(&part.translated(dx, dy), Label::Target);
        }
        let (reach_x, reach_y) = self.background_reach(part);
        for _ in 0..backgrounds {
            for _ in 0..TRIES {
                let candidate = part.translated(within(rng, reach_x), within(rng, reach_y));
                if candidate.overlap(part) <= self.overlap && holds(field, &candidate) {
                    sample(&candidate, Label::Background);
                    break;
                }
            }
        }
    }

    /// Draws a few boxes about each of `others`, boxes of the part's size, that overlap the part by no more than backgrounds
    /// may, and hands them to `sample`.
    pub fn draw_others<R: Rng + ?Sized>(
        &self,
        part: &Rect,
        others: &[Rect],
        rng: &mut R,
        mut sample: impl FnMut(&Rect),
    ) {
        for other in others {
            for i in 0..self.per_other {
                let mut within = || rng.random_range(-OTHER_JITTER..=OTHER_JITTER);
                let (dx, dy) = if i == 0 { (0.0, 0.0) } else { (within(), within()) };
                let candidate = other.translated(dx, dy);
                if candidate.overlap(part) <= self.overlap {
                    sample(&candidate);
                }
            }
        }
    }

    /// What [`draw_others`](Self::draw_others) may take of such a box.
    pub fn field_of_other(other: &Rect) -> Rect {
        let (x, y) = (other.x - OTHER_JITTER, other.y - OTHER_JITTER);
        Rect::new(x, y, other.w + 2.0 * OTHER_JITTER, other.h + 2.0 * OTHER_JITTER)
    }

    fn background_reach(&self, part: &Rect) -> (f64, f64) {
        (self.reach * part.w.max(part.h / 2.0), self.reach * part.h)
    }
}

fn holds(outer: &Rect, inner: &Rect) -> bool {
    inner.x >= outer.x
        && inner.y >= outer.y
        && inner.right() <= outer.right()
        && inner.bottom() <= outer.bottom()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn draw(parameters: &Parameters, part: &Rect, field: &Rect) -> Vec<(Rect, Label)> {
        let mut samples = Vec::new();
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        Sampler::new(parameters).draw(part, field, (30, 60), &mut rng, |b, l| samples.push((*b, l)));
        samples
    }

    #[test]
    fn targets_are_near_and_backgrounds_overlap_little() {
        let parameters = Parameters::default();
        let part = Rect::new(100.0, 50.0, 20.0, 40.0);
        let field = Sampler::new(&parameters).field(&part);
        let samples = draw(&parameters, &part, &field);
        let of = |label| samples.iter().filter(move |(_, l)| *l == label).collect::<Vec<_>>();
        let (targets, backgrounds) = (of(Label::Target), of(Label::Background));
        assert_eq!((targets.len(), backgrounds.len()), (30, 60));
        assert_eq!(targets[0].0, part);
        for (target, _) in &targets {
            assert!((target.x - part.x).abs() <= 5.0 && (target.y - part.y).abs() <= 5.0);
            assert_eq!((target.w, target.h), (part.w, part.h));
        }
        for (background, _) in &backgrounds {
            assert!(background.overlap(&part) <= parameters.background_overlap && holds(&field, background));
        }
    }

    #[test]
    fn a_field_without_room_gives_fewer_backgrounds_and_still_ends() {
        let part = Rect::new(0.0, 0.0, 20.0, 40.0);
        let samples = draw(&Parameters::default(), &part, &part);
        assert!(samples.iter().all(|(_, label)| *label == Label::Target));
    }

    #[test]
    fn hard_negatives_lie_about_the_others_and_hold_little_of_the_target() {
        let parameters = Parameters::default();
        let part = Rect::new(100.0, 50.0, 20.0, 40.0);
        let (far, near) = (part.translated(60.0, 5.0), part.translated(2.0, 3.0));
        let mut found = Vec::new();
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        Sampler::new(&parameters).draw_others(&part, &[far, near], &mut rng, |other| found.push(*other));
        assert_eq!(found.len(), parameters.hard_negatives);
        assert_eq!(found[0], far);
        assert!(found.iter().all(|other| holds(&Sampler::field_of_other(&far), other)));
    }
}
