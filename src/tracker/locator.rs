//! A correlation filter on the target: part of the observation, and what the particles' proposal is drawn from.

use crate::{
    correlation::{
        filter::{CorrelationFilter, FilterOptions},
        grid::{CHANNELS, Grid},
        response::Peak,
        window::Window,
    },
    features::region::RegionIntegrals,
    geometry::{Rect, Region},
};

use super::parameters::Parameters;

/// Where a correlation filter sees the target. It looks at a region of the whole box of its own, in general not the
/// tracked part.
pub(super) struct Locator {
    filter: CorrelationFilter,
    grid: Grid,
    colour: f32,
    /// Window side / sqrt(area of the filter's region).
    window_scale: f64,
    tracked: Region,
    seen: Region,
    peak: Peak,
}

impl Locator {
    /// A locator of the target with that whole box; it has learnt nothing yet.
    pub fn new(parameters: &Parameters, full: Rect) -> Self {
        let seen = parameters.correlation_region.part_from_full(full);
        let window_side = Window::around(&seen, parameters.correlation_window).side;
        let options = FilterOptions {
            side: 2 * parameters.correlation_cells.div_ceil(2),
            label_sigma: parameters.correlation_label_sigma,
            temporal: parameters.correlation_temporal as f32,
            rounds: parameters.correlation_rounds,
            support: parameters.correlation_support,
        };
        let (width, height) = (seen.w / window_side, seen.h / window_side);
        Self {
            grid: Grid::new(options.side),
            filter: CorrelationFilter::new(options, CHANNELS, width, height),
            colour: parameters.correlation_colour as f32,
            window_scale: parameters.correlation_window,
            tracked: parameters.region,
            seen: parameters.correlation_region,
            peak: Peak { x: 0.0, y: 0.0, value: 1.0, sharpness: 1.0 },
        }
    }

    /// What the filter looks at around a tracked part.
    pub fn window(&self, part: Rect) -> Window {
        Window::around(&self.seen_from_part(part), self.window_scale)
    }

    /// Learns the target with that part. Its window should lie in the region of `integrals`; what does not counts as flat.
    pub fn learn(&mut self, integrals: &RegionIntegrals, part: Rect) {
        self.grid.describe(integrals, self.window(part), self.colour);
        self.filter.learn(self.grid.planes());
    }

    /// Looks for the target around where its part was.
    pub fn look(&mut self, integrals: &RegionIntegrals, part: Rect) {
        let window = self.window(part);
        self.grid.describe(integrals, window, self.colour);
        self.peak = self.filter.respond(self.grid.planes(), window).peak();
    }

    /// The response of the last look for a hypothesis of the part.
    pub fn response(&self, part: Rect) -> f32 {
        let (x, y) = self.seen_from_part(part).centre();
        self.filter.response().at(x, y)
    }

    /// Centre of the part that has the last look's peak, the size being that of `part`.
    pub fn peak_of_part(&self, part: Rect) -> (f64, f64) {
        let ((x, y), (seen_x, seen_y)) = (part.centre(), self.seen_from_part(part).centre());
        (self.peak.x + x - seen_x, self.peak.y + y - seen_y)
    }

    /// How far the last look's peak stands above the rest of the window, in standard deviations of the rest.
    pub fn sharpness(&self) -> f64 {
        f64::from(self.peak.sharpness)
    }

    fn seen_from_part(&self, part: Rect) -> Rect {
        self.seen.part_from_full(self.tracked.full_from_part(part))
    }
}
