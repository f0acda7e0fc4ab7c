//! Where a correlation filter sees the target: part of the observation, and what particles are drawn from.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::{
    bayes::{Proposal, Transition},
    correlation::{
        grid::{CHANNELS, Grid},
        filter::{CorrelationFilter, FilterOptions},
        window::Window,
        response::Peak,
    },
    features::region::RegionIntegrals,
    geometry::Rect,
};

use super::{
    motion::{PartState, PartWalk, box_of},
    parameters::Parameters,
};

/// A correlation filter on a target's box.
pub(super) struct Locator {
    filter: CorrelationFilter,
    grid: Grid,
    colour: f32,
    /// Window side / sqrt(box area).
    window: f64,
    pub peak: Peak,
}

impl Locator {
    pub fn new(parameters: &Parameters, target: &Rect) -> Self {
        let side = parameters.correlation_window * target.area().sqrt();
        let options = FilterOptions {
            side: parameters.correlation_cells,
            label_sigma: parameters.correlation_sigma,
            temporal: parameters.correlation_temporal as f32,
            rounds: parameters.correlation_rounds,
            support: parameters.correlation_support,
            rho: parameters.correlation_rho as f32,
            growth: parameters.correlation_growth as f32,
        };
        Self {
            filter: CorrelationFilter::new(options, CHANNELS, target.w / side, target.h / side),
            grid: Grid::new(parameters.correlation_cells),
            colour: parameters.correlation_colour as f32,
            window: parameters.correlation_window,
            peak: Peak { x: 0.0, y: 0.0, value: 1.0, sharpness: 10.0 },
        }
    }

    pub fn window(&self, target: &Rect) -> Window {
        let (x, y) = target.centre();
        Window { x, y, side: self.window * target.area().sqrt() }
    }

    pub fn learn(&mut self, integrals: &RegionIntegrals, target: &Rect) {
        self.grid.describe(integrals, self.window(target), self.colour);
        self.filter.learn(self.grid.planes());
    }

    pub fn look(&mut self, integrals: &RegionIntegrals, target: &Rect) {
        let window = self.window(target);
        self.grid.describe(integrals, window, self.colour);
        self.peak = self.filter.respond(self.grid.planes(), window).peak();
    }

    /// Response at a box's centre.
    pub fn at(&self, target: &Rect) -> f32 {
        let (x, y) = target.centre();
        self.filter.response().at(x, y)
    }
}

/// A walk, mixed with draws around where the correlation filter peaks.
pub(super) struct PeakProposal {
    pub walk: PartWalk,
    /// Centre of the part that belongs to the peak.
    pub peak: (f64, f64),
    /// Standard deviation around the peak, pixels.
    pub spread: f64,
    /// Share of draws around the peak.
    pub share: f64,
}

impl PeakProposal {
    fn centre(&self, state: &PartState) -> (f64, f64) {
        box_of(state, self.walk.aspect).centre()
    }
}

impl Proposal<3> for PeakProposal {
    fn sample<R: Rng + ?Sized>(&self, previous: &PartState, rng: &mut R) -> PartState {
        if rng.random::<f64>() >= self.share {
            return self.walk.sample(previous, rng);
        }
        let mut draw = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
        let (dx, dy, dw) = (draw(self.spread), draw(self.spread), draw(self.walk.sigma[2]));
        let w = previous[2] + dw;
        self.walk.confine(PartState::new(
            self.peak.0 + dx - w / 2.0,
            self.peak.1 + dy - self.walk.aspect * w / 2.0,
            w,
        ))
    }

    fn log_density(&self, next: &PartState, previous: &PartState) -> f64 {
        let normal = |d: f64, sigma: f64| -0.5 * (d / sigma).powi(2) - sigma.ln() - 0.5 * std::f64::consts::TAU.ln();
        let (x, y) = self.centre(next);
        let around = normal(x - self.peak.0, self.spread)
            + normal(y - self.peak.1, self.spread)
            + normal(next[2] - previous[2], self.walk.sigma[2]);
        let walked = self.walk.log_density(next, previous);
        let (a, b) = ((1.0 - self.share).ln() + walked, self.share.ln() + around);
        let most = a.max(b);
        most + ((a - most).exp() + (b - most).exp()).ln()
    }
}
