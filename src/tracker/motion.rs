//! Algorithm 1's transition: a Gaussian random walk of the part's (x, y, w), its height following from the width.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::{
    bayes::{State, Transition},
    geometry::Rect,
};

/// The part's (x, y, w): top left corner and width, frame pixels.
pub(super) type PartState = State<3>;

/// The box of a state; `aspect` is h / w.
pub(super) fn box_of(state: &PartState, aspect: f64) -> Rect {
    Rect::new(state[0], state[1], state[2], aspect * state[2])
}

/// The state of a box.
pub(super) fn state_of(part: &Rect) -> PartState {
    PartState::new(part.x, part.y, part.w)
}

/// Where a part may be: its centre near the frame, its width between two limits.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Limits {
    /// Width of the frame, pixels.
    pub frame_width: f64,
    /// Height of the frame, pixels.
    pub frame_height: f64,
    /// Smallest width, pixels.
    pub narrowest: f64,
    /// Largest width, pixels.
    pub widest: f64,
}

impl Limits {
    /// Limits for a target that starts in `part`: it may shrink to a sixth and grow to six times its width, and its centre
    /// stays in the frame, or as near to it as it started.
    pub fn around(part: &Rect, frame_width: usize, frame_height: usize) -> Self {
        Self {
            frame_width: frame_width as f64,
            frame_height: frame_height as f64,
            narrowest: part.w / 6.0,
            widest: part.w * 6.0,
        }
    }

    /// The nearest state within the limits; `aspect` is h / w.
    pub fn confine(&self, state: PartState, aspect: f64) -> PartState {
        let w = state[2].clamp(self.narrowest, self.widest);
        let (half_w, half_h) = (w / 2.0, aspect * w / 2.0);
        PartState::new(
            state[0].clamp(-half_w, self.frame_width - half_w),
            state[1].clamp(-half_h, self.frame_height - half_h),
            w,
        )
    }
}

/// The random walk. Steps that leave the limits end on them; inside, the density is exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PartWalk {
    /// h / w.
    pub aspect: f64,
    /// Standard deviations of a step in x, y and w, pixels.
    pub sigma: PartState,
    /// Whether a step in width keeps the centre instead of the top left corner.
    pub about_centre: bool,
    /// Where the part may be.
    pub limits: Limits,
}

impl PartWalk {
    /// How far a step of `dw` in width moves the corner.
    fn corner_shift(&self, dw: f64) -> (f64, f64) {
        if self.about_centre { (-dw / 2.0, -self.aspect * dw / 2.0) } else { (0.0, 0.0) }
    }
}

impl Transition<3> for PartWalk {
    fn sample<R: Rng + ?Sized>(&self, previous: &PartState, rng: &mut R) -> PartState {
        let step: PartState = self.sigma.map(|sigma| sigma * rng.sample::<f64, _>(StandardNormal));
        let (dx, dy) = self.corner_shift(step[2]);
        self.limits.confine(previous + step + PartState::new(dx, dy, 0.0), self.aspect)
    }

    fn log_density(&self, next: &PartState, previous: &PartState) -> f64 {
        let (dx, dy) = self.corner_shift(next[2] - previous[2]);
        let step = next - previous - PartState::new(dx, dy, 0.0);
        let half_log_two_pi = 0.5 * std::f64::consts::TAU.ln();
        step.iter()
            .zip(self.sigma.iter())
            .map(|(step, sigma)| -0.5 * (step / sigma).powi(2) - sigma.ln() - half_log_two_pi)
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn walk(about_centre: bool) -> PartWalk {
        let limits = Limits { frame_width: 1e4, frame_height: 1e4, narrowest: 1.0, widest: 1e3 };
        PartWalk { aspect: 2.0, sigma: PartState::new(3.0, 5.0, 1.5), about_centre, limits }
    }

    #[test]
    fn steps_have_the_deviations_asked_for_and_scale_about_what_was_asked_for() {
        for about_centre in [false, true] {
            let walk = walk(about_centre);
            let start = PartState::new(500.0, 600.0, 50.0);
            let mut rng = ChaCha8Rng::seed_from_u64(1);
            let n = 20_000;
            let (mut squares, mut with_width) = (PartState::zeros(), 0.0);
            for _ in 0..n {
                let step = walk.sample(&start, &mut rng) - start;
                squares += step.component_mul(&step);
                with_width += step[0] * step[2];
            }
            let corner = if about_centre { 0.75 } else { 0.0 };
            let expected = [9.0 + corner * 0.75, 25.0 + corner * 3.0, 2.25];
            for (found, expected) in squares.iter().zip(expected) {
                assert!((found / n as f64 / expected - 1.0).abs() < 0.05, "{found} {expected}");
            }
            let covariance = if about_centre { -0.5 * 2.25 } else { 0.0 };
            assert!((with_width / n as f64 - covariance).abs() < 0.15);
        }
    }

    #[test]
    fn the_density_is_highest_where_nothing_moves_and_symmetric() {
        let walk = walk(true);
        let start = PartState::new(500.0, 600.0, 50.0);
        let step = PartState::new(2.0, -1.0, 0.5);
        let (ahead, back) =
            (walk.log_density(&(start + step), &start), walk.log_density(&(start - step), &start));
        assert!((ahead - back).abs() < 1e-12 && walk.log_density(&start, &start) > ahead);
    }

    #[test]
    fn the_centre_stays_in_the_frame_and_the_width_in_its_limits() {
        let part = Rect::new(1.0, 1.0, 10.0, 20.0);
        let mut walk = walk(true);
        walk.limits = Limits::around(&part, 30, 40);
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut state = state_of(&part);
        for _ in 0..500 {
            state = walk.sample(&state, &mut rng);
            let (x, y) = box_of(&state, walk.aspect).centre();
            assert!((-1e-9..=30.0 + 1e-9).contains(&x) && (-1e-9..=40.0 + 1e-9).contains(&y));
            assert!((10.0 / 6.0..=60.0).contains(&state[2]));
        }
    }
}
