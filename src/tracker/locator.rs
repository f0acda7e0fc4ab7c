//! Correlation filters on the target, over place and over size: part of the observation, and what the particles' proposal is
//! drawn from.

use crate::{
    correlation::{
        filter::{CorrelationFilter, FilterOptions},
        grid::{CHANNELS, Grid},
        response::Peak,
        scale::{ScaleFilter, ScaleOptions},
        window::Window,
    },
    features::{blocks::BlockIntegrals, region::SearchRegion},
    frame::FrameView,
    geometry::{Rect, Region},
};

use super::parameters::Parameters;

/// Pixels along the side of a grid's cell from which on they are averaged, so that none is of more than this.
const PIXELS_PER_CELL: f64 = 10.0;
/// Entries that the integral images have along a grid's cell at least, where it has as many pixels.
const BLOCKS_PER_CELL: f64 = 3.0;

/// Where and how large correlation filters see the target. They look at a region of the whole box of their own, in general
/// not the tracked part.
pub(super) struct Locator {
    filter: CorrelationFilter,
    integrals: BlockIntegrals,
    grid: Grid,
    colour: f32,
    /// beta.
    weight: f64,
    /// What judges the size, and its weight.
    scale: Option<(ScaleFilter, f64)>,
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
        let scale = ScaleOptions {
            sizes: parameters.scale_sizes | 1,
            ratio: parameters.scale_ratio,
            rate: parameters.scale_rate as f32,
        };
        let (width, height) = (seen.w / window_side, seen.h / window_side);
        Self {
            integrals: BlockIntegrals::default(),
            grid: Grid::new(options.side),
            filter: CorrelationFilter::new(options, CHANNELS, width, height),
            colour: parameters.correlation_colour as f32,
            weight: parameters.correlation_weight,
            scale: (parameters.scale_weight > 0.0)
                .then(|| (ScaleFilter::new(scale, seen.h / seen.w), parameters.scale_weight)),
            window_scale: parameters.correlation_window,
            tracked: parameters.region,
            seen: parameters.correlation_region,
            peak: Peak { x: 0.0, y: 0.0, value: 1.0, sharpness: 1.0 },
        }
    }

    /// Learns the target with that part in the frame last looked at. What its window has outside that of the last look
    /// counts as flat.
    pub fn learn(&mut self, part: Rect) {
        let (window, seen) = (self.window(part), self.seen_from_part(part));
        let Self { grid, integrals, filter, scale, colour, .. } = self;
        rayon::join(
            || {
                grid.describe(integrals, window, *colour);
                filter.learn(grid.planes());
            },
            || {
                if let Some((scale, _)) = scale {
                    scale.learn(integrals, seen);
                }
            },
        );
    }

    /// Computes what the filter sees of a frame around where the part was.
    pub fn see(&mut self, frame: &FrameView<'_>, part: Rect) {
        let window = self.window(part);
        let cell = window.side / self.grid.side() as f64;
        let step = (cell / PIXELS_PER_CELL).ceil().max(1.0);
        let block = (cell / step / BLOCKS_PER_CELL).floor().max(1.0) as usize;
        self.integrals.compute(frame, SearchRegion::around(window.to_rect(), step as usize), block);
    }

    /// Looks for the target's place in the frame last seen, around where its part was.
    pub fn look(&mut self, part: Rect) {
        let window = self.window(part);
        self.grid.describe(&self.integrals, window, self.colour);
        self.peak = self.filter.respond(self.grid.planes(), window).peak();
    }

    /// Looks at the sizes that the target may have where the last look found it, if its part is still as large as that.
    pub fn look_at_sizes(&mut self, part: Rect) {
        let seen = self.seen_from_part(part);
        if let Some((scale, _)) = &mut self.scale {
            let (x, y) = seen.centre();
            scale.look(&self.integrals, seen.translated(self.peak.x - x, self.peak.y - y));
        }
    }

    /// What the filters' last look adds to the logarithm of the likelihood of a hypothesis of the part.
    pub fn log_likelihood(&self, part: Rect) -> f64 {
        let seen = self.seen_from_part(part);
        let (x, y) = seen.centre();
        let of_scale =
            self.scale.as_ref().map_or(0.0, |(scale, weight)| weight * f64::from(scale.at(seen.w)));
        self.weight * f64::from(self.filter.response().at(x, y)) + of_scale
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

    fn window(&self, part: Rect) -> Window {
        Window::around(&self.seen_from_part(part), self.window_scale)
    }

    fn seen_from_part(&self, part: Rect) -> Rect {
        self.seen.part_from_full(self.tracked.full_from_part(part))
    }
}
