//! What particles are drawn from: the walk, mixed with a Gaussian around the place that the cues over the window answer to. The
//! weights take p / q, so that their view guides the particles without counting twice.

use std::f64::consts::TAU;

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::bayes::{Proposal, Transition};

use super::motion::{PartState, PartWalk, box_of};

/// A walk mixed with draws around a peak.
pub(super) struct PeakProposal {
    pub walk: PartWalk,
    /// Centre of the part that belongs to the peak, frame pixels.
    pub peak: (f64, f64),
    /// Standard deviation around the peak along each axis, pixels.
    pub spread: f64,
    /// Share of draws around the peak, in [0, 1).
    pub share: f64,
}

impl Proposal<3> for PeakProposal {
    fn sample<R: Rng + ?Sized>(&self, previous: &PartState, rng: &mut R) -> PartState {
        if rng.random::<f64>() >= self.share {
            return self.walk.sample(previous, rng);
        }
        let mut draw = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
        let (dx, dy, dw) = (draw(self.spread), draw(self.spread), draw(self.walk.sigma[2]));
        let w = previous[2] + dw;
        let (x, y) = (self.peak.0 + dx - w / 2.0, self.peak.1 + dy - self.walk.aspect * w / 2.0);
        self.walk.limits.confine(PartState::new(x, y, w), self.walk.aspect)
    }

    fn log_density(&self, next: &PartState, previous: &PartState) -> f64 {
        let (x, y) = box_of(next, self.walk.aspect).centre();
        let around = log_normal(x - self.peak.0, self.spread)
            + log_normal(y - self.peak.1, self.spread)
            + log_normal(next[2] - previous[2], self.walk.sigma[2]);
        let walked = self.walk.log_density(next, previous);
        log_sum((1.0 - self.share).ln() + walked, self.share.ln() + around)
    }
}

fn log_normal(difference: f64, sigma: f64) -> f64 {
    -0.5 * (difference / sigma).powi(2) - sigma.ln() - 0.5 * TAU.ln()
}

/// ln(e^a + e^b).
fn log_sum(a: f64, b: f64) -> f64 {
    let most = a.max(b);
    if most == f64::NEG_INFINITY { most } else { most + ((a - most).exp() + (b - most).exp()).ln() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracker::motion::Limits;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    const START: [f64; 3] = [100.0, 100.0, 20.0];

    /// The peak is far from where the walk leads.
    fn proposal(share: f64) -> PeakProposal {
        let limits = Limits { frame_width: 1e4, frame_height: 1e4, narrowest: 1.0, widest: 1e3 };
        let sigma = PartState::new(3.0, 3.0, 0.5);
        let walk = PartWalk { aspect: 2.0, sigma, about_centre: true, limits };
        PeakProposal { walk, peak: (400.0, 300.0), spread: 2.0, share }
    }

    #[test]
    fn the_share_is_of_draws_around_the_peak() {
        for share in [0.0, 0.2, 0.9] {
            let proposal = proposal(share);
            let mut rng = ChaCha8Rng::seed_from_u64(3);
            let draws = 5000;
            let at_peak =
                (0..draws).filter(|_| proposal.sample(&PartState::from(START), &mut rng)[0] > 300.0).count();
            assert!((at_peak as f64 / f64::from(draws) - share).abs() < 0.03, "{share}: {at_peak}");
        }
    }

    #[test]
    fn the_density_has_the_same_shares() {
        let (proposal, start) = (proposal(0.2), PartState::from(START));
        let at_peak = PartState::new(390.0, 280.0, 20.0);
        let around = 1.0 / (TAU * 4.0) / (TAU.sqrt() * 0.5);
        assert!((proposal.log_density(&at_peak, &start) - (0.2 * around).ln()).abs() < 1e-9);
        let walked = 1.0 / (TAU * 9.0) / (TAU.sqrt() * 0.5);
        assert!((proposal.log_density(&start, &start) - (0.8 * walked).ln()).abs() < 1e-9);
    }
}
