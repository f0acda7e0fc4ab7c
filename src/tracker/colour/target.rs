//! One target: its particles, its looks, and a step of its filter.

use image::GrayImage;
use rand::RngExt;

use crate::{
    background::FOREGROUND,
    bayes::particle::ParticleFilter,
    features::{
        colour_histogram::{HistogramIntegrals, HistogramOptions, Normalisation},
        region::SearchRegion,
    },
    frame::FrameView,
    geometry::Rect,
    tracker::{
        confidence::status,
        estimate::{Estimate, Status, WeightedBox},
        motion::{Limits, PartState, box_of, state_of},
        streams::{Use, stream},
    },
};

use super::{
    appearance::{Appearance, FrameObservation},
    motion::{Velocity, VelocityWalk},
    parameters::ColourParameters,
};

/// Cells that a search region may have at most.
const MAX_REGION_CELLS: f64 = 262_144.0;
/// Cells along a side of a search region at most.
const MAX_REGION_SIDE: f64 = 8192.0;
/// A target of which other targets leave less than this share to be seen is not looked for: it goes on as it went.
const LEAST_VISIBLE: f64 = 0.35;
/// Its confidence meanwhile.
const HIDDEN_CONFIDENCE: f64 = 0.2;
/// The share of a box that must be foreground before the target is described by its foreground.
const LEAST_FOREGROUND: f32 = 0.2;
/// Brightness is compensated by at most this factor.
const LARGEST_GAIN: f64 = 2.0;

/// Everything known of one target.
pub(super) struct Target {
    /// The target's place in its flock, which chooses its random stream.
    number: usize,
    /// h / w.
    aspect: f64,
    limits: Limits,
    /// Frames since `init`.
    frame: u64,
    particles: ParticleFilter<3>,
    pub velocity: Velocity,
    pub appearance: Appearance,
    /// Whether the appearance is that of the foreground alone.
    of_foreground: bool,
    first_brightness: f64,
    pub estimate: Estimate,
}

/// What a step sees besides the frame.
pub(super) struct Surroundings<'a> {
    /// The raw foreground mask, once the background is known.
    pub foreground: Option<&'a GrayImage>,
    /// Boxes of the targets in front of this one.
    pub hidden_by: &'a [Rect],
}

impl Target {
    /// Step 1: particles around the first box, and the reference histograms.
    pub fn new(
        parameters: &ColourParameters,
        frame: &FrameView<'_>,
        integrals: &mut HistogramIntegrals,
        target: Rect,
        number: usize,
    ) -> Self {
        let region = search_region(target, &target, parameters.max_target_cells);
        let options = HistogramOptions { gradient: parameters.gradient, gain: 1.0 };
        integrals.compute(frame, region, options, |_, _| true);
        let mut rng = stream(parameters.seed, 0, Use::Particles(number));
        let spread = parameters.initial_spread;
        let mut offset = || if spread > 0.0 { rng.random_range(-spread..=spread) } else { 0.0 };
        let states =
            (0..parameters.particles).map(|_| state_of(&target) + PartState::new(offset(), offset(), 0.0));
        let mut estimate = Estimate::new(target, target, 1.0, Status::Tracking);
        estimate.effective_sample_size = parameters.particles as f64;
        Self {
            number,
            aspect: target.h / target.w,
            limits: Limits::around(&target, frame.width(), frame.height()),
            frame: 0,
            particles: ParticleFilter::new(states.collect(), parameters.filter_options()),
            velocity: Velocity::new(parameters),
            appearance: Appearance::of(integrals, &target, parameters.halves),
            of_foreground: false,
            first_brightness: brightness(frame, &target),
            estimate,
        }
    }

    /// Where the target would be if it went on as it went.
    pub fn predicted(&self) -> Rect {
        let (vx, vy) = self.velocity.mean();
        self.estimate.box_in_frame.translated(vx, vy)
    }

    pub fn hypotheses(&self) -> Vec<WeightedBox> {
        let weighted = self.particles.states().iter().zip(self.particles.weights());
        weighted
            .map(|(state, &weight)| WeightedBox { box_in_frame: box_of(state, self.aspect), weight })
            .collect()
    }

    /// Steps 5 (of the frame before) and 2 to 4.
    pub fn step(
        &mut self,
        parameters: &ColourParameters,
        frame: &FrameView<'_>,
        integrals: &mut HistogramIntegrals,
        surroundings: &Surroundings<'_>,
    ) {
        self.frame += 1;
        let before = self.estimate.box_in_frame;
        let visible = visible_share(&self.predicted(), surroundings.hidden_by);
        self.predict(parameters);
        if visible < LEAST_VISIBLE {
            self.coast();
            return;
        }
        self.observe(parameters, frame, integrals, surroundings);
        self.correct(parameters, integrals);
        let now = self.estimate.box_in_frame;
        let ((x0, y0), (x1, y1)) = (before.centre(), now.centre());
        self.velocity.add((x1 - x0, y1 - y0));
        let seen = self.estimate.status == Status::Tracking;
        if parameters.model_rate > 0.0 && seen && surroundings.hidden_by.is_empty() {
            self.appearance.age_towards(integrals, &now, parameters.model_rate);
        }
    }

    /// Step 5: the particles' update.
    fn predict(&mut self, parameters: &ColourParameters) {
        let target = self.estimate.box_in_frame;
        let walk = VelocityWalk {
            aspect: self.aspect,
            velocity: self.velocity.mean(),
            sigma: PartState::new(
                parameters.noise_x * target.w,
                parameters.noise_y * target.h,
                parameters.noise_w * target.w,
            ),
            limits: self.limits,
        };
        self.particles.predict(&walk, &mut stream(parameters.seed, self.frame, Use::Particles(self.number)));
    }

    /// The histograms of the region that the particles cover.
    fn observe(
        &mut self,
        parameters: &ColourParameters,
        frame: &FrameView<'_>,
        integrals: &mut HistogramIntegrals,
        surroundings: &Surroundings<'_>,
    ) {
        let predicted = self.predicted();
        let region = search_region(self.extent(&predicted), &predicted, parameters.max_target_cells);
        let gain = if parameters.brightness { self.gain(frame) } else { 1.0 };
        let options = HistogramOptions { gradient: parameters.gradient, gain };
        let is_hidden = |x: usize, y: usize| {
            let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
            surroundings
                .hidden_by
                .iter()
                .any(|front| x >= front.x && x < front.right() && y >= front.y && y < front.bottom())
        };
        if let Some(mask) = surroundings.foreground {
            let is_foreground = |x: usize, y: usize| mask.get_pixel(x as u32, y as u32).0[0] == FOREGROUND;
            integrals.compute(frame, region, options, |x, y| is_foreground(x, y) && !is_hidden(x, y));
            if self.of_foreground || self.describe_foreground(parameters, integrals, &region) {
                return;
            }
        }
        integrals.compute(frame, region, options, |x, y| !is_hidden(x, y));
    }

    /// Takes the target's foreground for its looks, if there is enough of it where the target is thought to be.
    fn describe_foreground(
        &mut self,
        parameters: &ColourParameters,
        integrals: &HistogramIntegrals,
        region: &SearchRegion,
    ) -> bool {
        let predicted = self.predicted();
        let cells = predicted.area() / (region.step * region.step) as f64;
        if integrals.histogram(&predicted).cells() < LEAST_FOREGROUND * cells as f32 {
            return false;
        }
        self.appearance = Appearance::of(integrals, &predicted, parameters.halves);
        self.of_foreground = true;
        true
    }

    /// Steps 2 to 4: weights, position, resampling.
    fn correct(&mut self, parameters: &ColourParameters, integrals: &HistogramIntegrals) {
        let observation =
            FrameObservation { integrals, appearance: &self.appearance, parameters, aspect: self.aspect };
        // Past the prediction's draws: the frame's second half of the stream numbers.
        let mut rng = stream(parameters.seed, self.frame | 1 << 40, Use::Particles(self.number));
        let found = self.particles.correct(&observation, &mut rng);
        let target = box_of(&found.mean, self.aspect);
        let confidence = self.appearance.similarity(integrals, &target, Normalisation::L2);
        self.estimate = Estimate::new(target, target, confidence, status(confidence));
        self.estimate.effective_sample_size = found.effective_sample_size;
        self.estimate.covariance = std::array::from_fn(|r| std::array::from_fn(|c| found.covariance[(r, c)]));
    }

    /// Goes on without looking.
    fn coast(&mut self) {
        let weighted = self.particles.states().iter().zip(self.particles.weights());
        let mean = weighted.fold(PartState::zeros(), |sum, (state, &weight)| sum + state * weight);
        let target = box_of(&mean, self.aspect);
        self.estimate = Estimate::new(target, target, HIDDEN_CONFIDENCE, status(HIDDEN_CONFIDENCE));
    }

    /// The smallest box that holds every particle and `predicted`.
    fn extent(&self, predicted: &Rect) -> Rect {
        let boxes = self.particles.states().iter().map(|state| box_of(state, self.aspect));
        let (mut left, mut top) = (predicted.x, predicted.y);
        let (mut right, mut bottom) = (predicted.right(), predicted.bottom());
        for target in boxes {
            (left, top) = (left.min(target.x), top.min(target.y));
            (right, bottom) = (right.max(target.right()), bottom.max(target.bottom()));
        }
        Rect::new(left, top, right - left, bottom - top)
    }

    /// What makes the target's surroundings as bright as in the first frame.
    fn gain(&self, frame: &FrameView<'_>) -> f64 {
        let now = brightness(frame, &self.predicted());
        (self.first_brightness / now.max(1.0)).clamp(1.0 / LARGEST_GAIN, LARGEST_GAIN)
    }
}

/// The share of a box that no box in front covers, on a grid of 16 x 16 points.
fn visible_share(target: &Rect, hidden_by: &[Rect]) -> f64 {
    if hidden_by.is_empty() {
        return 1.0;
    }
    let at = |i: usize| (i as f64 + 0.5) / 16.0;
    let points = (0..256).map(|i| (target.x + at(i % 16) * target.w, target.y + at(i / 16) * target.h));
    let covered = |(x, y): &(f64, f64)| {
        hidden_by
            .iter()
            .any(|front| *x >= front.x && *x < front.right() && *y >= front.y && *y < front.bottom())
    };
    1.0 - points.filter(covered).count() as f64 / 256.0
}

/// Mean luminance of a box and as much again around it, on a grid of 32 x 32 points inside the frame.
fn brightness(frame: &FrameView<'_>, target: &Rect) -> f64 {
    let around =
        Rect::new(target.x - target.w / 2.0, target.y - target.h / 2.0, 2.0 * target.w, 2.0 * target.h);
    let Some(inside) = around.clipped_to(frame.width(), frame.height()) else { return 0.0 };
    let at = |from: f64, size: f64, i: usize, end: usize| {
        ((from + (i as f64 + 0.5) / 32.0 * size) as usize).min(end - 1)
    };
    let format = frame.format();
    let mut sum = 0.0;
    for i in 0..32 * 32 {
        let x = at(inside.x, inside.w, i % 32, frame.width());
        let row = frame.row(at(inside.y, inside.h, i / 32, frame.height()));
        let pixel = &row[x * format.bytes_per_pixel()..];
        let [red, green, blue] = format.rgb_offsets().map(|offset| f64::from(pixel[offset]));
        sum += (red + 2.0 * green + blue) / 4.0;
    }
    sum / 1024.0
}

/// The cells that hold `extent`, coarse enough that the target has at most `max_target_cells`.
fn search_region(extent: Rect, target: &Rect, max_target_cells: usize) -> SearchRegion {
    let for_target = (target.area() / max_target_cells as f64).sqrt();
    let for_region = (extent.area() / MAX_REGION_CELLS).sqrt();
    let for_side = extent.w.max(extent.h) / MAX_REGION_SIDE;
    SearchRegion::around(extent, for_target.max(for_region).max(for_side).ceil().max(1.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::PixelFormat;

    #[test]
    fn what_is_in_front_hides_its_share() {
        let target = Rect::new(10.0, 10.0, 16.0, 32.0);
        assert_eq!(visible_share(&target, &[]), 1.0);
        assert_eq!(visible_share(&target, &[target.translated(8.0, 0.0)]), 0.5);
        assert_eq!(visible_share(&target, &[target.translated(8.0, 0.0), target.translated(-8.0, 0.0)]), 0.0);
    }

    #[test]
    fn brightness_is_that_of_the_surroundings_inside_the_frame() {
        let data: Vec<u8> = (0..40 * 20).map(|i| if i % 40 < 20 { 40 } else { 120 }).collect();
        let frame = FrameView::new(&data, 40, 20, 40, PixelFormat::Gray).unwrap();
        assert_eq!(brightness(&frame, &Rect::new(15.0, 5.0, 10.0, 10.0)), 80.0);
        assert_eq!(brightness(&frame, &Rect::new(-5.0, 5.0, 10.0, 10.0)), 40.0);
        assert_eq!(brightness(&frame, &Rect::new(-50.0, 5.0, 10.0, 10.0)), 0.0);
    }
}
