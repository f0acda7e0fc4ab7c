//! Algorithm 6: InfoPart.
//!
//! Steps:
//! 1. in the first frame, set up n particle sets on the part of the box that changes least,
//! 2. sample the part and its surroundings (Algorithm 5), train the classifier F (Algorithm 4), and let the correlation
//!    filter learn,
//! 3. in each later frame:
//!    a. correlate, move the particles by the walk or to the filter's peak (and meanwhile look at the sizes there), compute
//!    integral images of what they cover, weigh and resample them (Algorithm 1),
//!    b. estimate the part from the sets and recover the whole box from it,
//!    c. judge the estimate,
//!    d. if it is due and the estimate is trusted, sample the new part and retrain F,
//!    e. likewise let the filter learn.
//!
//! The correlation filter is the step that the paper names as its next; without it (weight 0) all else is as printed.

use std::sync::Arc;

use crate::{
    bayes::particle::{ParticleEstimate, ParticleFilter, ParticleFilterOptions},
    features::{
        haar::HaarFeature,
        hog::Hog,
        region::{CHANNELS, RegionIntegrals, SearchRegion},
    },
    frame::{FrameStamp, FrameView, PixelFormat},
    geometry::Rect,
};
use rand::RngExt;

use super::{
    TrackError, Tracker,
    appearance::{Appearance, Fit, FrameObservation},
    confidence::{Belief, Judge, status},
    estimate::{BoxWarning, Estimate, Evidence, StageTime, Status, WeightedBox},
    first_box,
    locator::Locator,
    motion::{Limits, PartState, PartWalk, box_of, state_of},
    parameters::CheckedParameters,
    proposal::PeakProposal,
    sampling::Sampler,
    stopwatch::Stopwatch,
    streams::{Use, stream},
};

/// Cells that a search region may have at most; larger ones are averaged down further.
const MAX_REGION_CELLS: f64 = 1_048_576.0;

/// Cells along a side of a search region at most.
const MAX_REGION_SIDE: f64 = 16_384.0;

/// The InfoPart tracker.
pub struct InfoPart {
    parameters: CheckedParameters,
    pool: Option<Arc<rayon::ThreadPool>>,
    target: Option<Target>,
    integrals: RegionIntegrals,
    stopwatch: Stopwatch,
}

/// Everything known of the target being tracked.
struct Target {
    frame_size: (usize, usize),
    /// h / w of the part.
    aspect: f64,
    limits: Limits,
    /// Frames since `init`.
    frame: u64,
    sets: Vec<ParticleFilter<3>>,
    appearance: Appearance,
    estimate: Estimate,
    /// How probable the last frame alone made its estimate, in (0, 1).
    trust: f64,
    judge: Judge,
    set_estimates: Vec<ParticleEstimate<3>>,
    locator: Option<Locator>,
}

impl InfoPart {
    /// A tracker that works in the thread pool it is called from (rayon's global one unless that is changed).
    pub fn new(parameters: CheckedParameters) -> Self {
        Self {
            parameters,
            pool: None,
            target: None,
            integrals: RegionIntegrals::default(),
            stopwatch: Stopwatch::default(),
        }
    }

    /// A tracker that works in `pool`.
    pub fn with_pool(parameters: CheckedParameters, pool: Arc<rayon::ThreadPool>) -> Self {
        Self { pool: Some(pool), ..Self::new(parameters) }
    }

    /// The parameters it runs with.
    pub fn parameters(&self) -> &CheckedParameters {
        &self.parameters
    }

    fn in_pool<T: Send>(&mut self, work: impl FnOnce(&mut Self) -> T + Send) -> T {
        match self.pool.clone() {
            Some(pool) => pool.install(|| work(self)),
            // Into rayon's pool once, instead of once for each loop that it shares out.
            None => rayon::scope(|_| work(self)),
        }
    }

    /// Steps 1 and 2.
    fn start(&mut self, frame: FrameView<'_>, box_in_frame: Rect) {
        self.stopwatch.start();
        let parameters = &self.parameters;
        let part = parameters.region.part_from_full(box_in_frame);
        let mut locator =
            (parameters.correlation_weight > 0.0).then(|| Locator::new(parameters, box_in_frame));
        let field = Sampler::new(parameters).field(&part);
        self.integrals.compute(&frame, search_region(field, &part, parameters.max_part_cells));
        self.stopwatch.lap("integral images");
        if let Some(locator) = &mut locator {
            locator.see(&frame, part);
            self.stopwatch.lap("integral images of blocks");
        }
        let mut target = Target::new(parameters, &frame, &self.integrals, box_in_frame, part, locator);
        target.appearance.learn(
            &self.integrals,
            &part,
            (parameters.first_targets, parameters.first_backgrounds),
            &mut stream(parameters.seed, 0, Use::Samples),
        );
        if let Some(locator) = &mut target.locator {
            locator.learn(part);
        }
        self.stopwatch.lap("learning");
        self.target = Some(target);
    }

    /// Step 3.
    fn advance(&mut self, frame: FrameView<'_>) -> Result<Estimate, TrackError> {
        let target = self.target.as_mut().ok_or(TrackError::NotStarted)?;
        target.check_size(&frame)?;
        let parameters = &self.parameters;
        self.stopwatch.start();
        target.frame += 1;
        let part = target.estimate.part_in_frame;
        if let Some(locator) = &mut target.locator {
            locator.see(&frame, part);
            self.stopwatch.lap("integral images of blocks");
            locator.look(part);
            self.stopwatch.lap("correlation");
        }
        target.predict(parameters);
        self.stopwatch.lap("prediction");
        self.integrals.compute(&frame, search_region(target.extent(), &part, parameters.max_part_cells));
        self.stopwatch.lap("integral images");
        target.correct(parameters, &self.integrals);
        self.stopwatch.lap("likelihood");
        let fit = target.judge(parameters, &self.integrals);
        self.stopwatch.lap("estimate");
        target.learn(parameters, &frame, &mut self.integrals, &fit);
        self.stopwatch.lap("learning");
        Ok(target.estimate.clone())
    }
}

impl Target {
    fn new(
        parameters: &CheckedParameters,
        frame: &FrameView<'_>,
        integrals: &RegionIntegrals,
        box_in_frame: Rect,
        part: Rect,
        locator: Option<Locator>,
    ) -> Self {
        let template = integrals.to_region(part);
        let channels = if frame.format() == PixelFormat::Gray { 1 } else { CHANNELS };
        let pool = HaarFeature::random_pool(
            parameters.feature_pool,
            f64::from(template.w),
            f64::from(template.h),
            channels,
            &mut stream(parameters.seed, 0, Use::Pool),
        );
        let mut estimate = Estimate::new(box_in_frame, part, 1.0, Status::Tracking);
        estimate.effective_sample_size = parameters.particles as f64;
        Self {
            frame_size: (frame.width(), frame.height()),
            aspect: part.h / part.w,
            limits: Limits::around(&part, frame.width(), frame.height()),
            frame: 0,
            sets: (0..parameters.particle_sets).map(|set| particle_set(parameters, &part, set)).collect(),
            appearance: Appearance::new(parameters, pool, Hog::of(integrals, &template)),
            estimate,
            trust: 1.0,
            judge: Judge::default(),
            set_estimates: Vec::with_capacity(parameters.particle_sets),
            locator,
        }
    }

    fn check_size(&self, frame: &FrameView<'_>) -> Result<(), TrackError> {
        let (first_width, first_height) = self.frame_size;
        let (width, height) = (frame.width(), frame.height());
        if (width, height) == self.frame_size {
            return Ok(());
        }
        Err(TrackError::SizeChanged { width, height, first_width, first_height })
    }

    /// Step 3a, prediction.
    fn predict(&mut self, parameters: &CheckedParameters) {
        let part = self.estimate.part_in_frame;
        let walk = PartWalk {
            aspect: self.aspect,
            sigma: PartState::new(
                parameters.noise_x * part.w.max(part.h / 2.0),
                parameters.noise_y * part.h,
                parameters.noise_w * part.w,
            ),
            about_centre: parameters.scale_about_centre,
            limits: self.limits,
        };
        let proposal =
            self.locator.as_ref().filter(|_| parameters.peak_share > 0.0).map(|locator| PeakProposal {
                walk,
                peak: locator.peak_of_part(part),
                spread: parameters.peak_spread * part.area().sqrt(),
                share: parameters.peak_share,
            });
        let Self { sets, frame, locator, .. } = self;
        let mut move_particles = || {
            for (set, particles) in sets.iter_mut().enumerate() {
                let mut rng = stream(parameters.seed, *frame, Use::Particles(set));
                match &proposal {
                    Some(proposal) => particles.propose(proposal, &walk, &mut rng),
                    None => particles.predict(&walk, &mut rng),
                }
            }
        };
        match locator {
            Some(locator) => {
                rayon::join(move_particles, || locator.look_at_sizes(part));
            }
            None => move_particles(),
        }
    }

    /// The smallest box that holds every particle's part.
    fn extent(&self) -> Rect {
        let mut sides = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for state in self.sets.iter().flat_map(|set| set.states()) {
            let part = box_of(state, self.aspect);
            sides = [
                sides[0].min(part.x),
                sides[1].min(part.y),
                sides[2].max(part.right()),
                sides[3].max(part.bottom()),
            ];
        }
        Rect::new(sides[0], sides[1], sides[2] - sides[0], sides[3] - sides[1])
    }

    /// Step 3a, correction, and 3b: the sets' means weighted by their mean likelihoods.
    fn correct(&mut self, parameters: &CheckedParameters, integrals: &RegionIntegrals) {
        let seed = parameters.seed;
        let observation = FrameObservation {
            integrals,
            appearance: &self.appearance,
            aspect: self.aspect,
            locator: self.locator.as_ref(),
        };
        self.set_estimates.clear();
        for (set, particles) in self.sets.iter_mut().enumerate() {
            // Past the prediction's draws: the frame's second half of the stream numbers.
            let mut rng = stream(seed, self.frame | 1 << 40, Use::Particles(set));
            self.set_estimates.push(particles.correct(&observation, &mut rng));
        }
    }

    /// Steps 3b and 3c.
    fn judge(&mut self, parameters: &CheckedParameters, integrals: &RegionIntegrals) -> Fit {
        let (mean, covariance) = merge(&self.set_estimates);
        let part = box_of(&mean, self.aspect);
        let fit = self.appearance.fit(integrals, &integrals.to_region(part));
        let mut evidence = Evidence {
            mean_stump: f64::from(fit.score) / parameters.stumps as f64,
            hog_distance: f64::from(fit.hog_distance),
            peak_sharpness: self.locator.as_ref().map(Locator::sharpness),
            lowest_log_odds: None,
        };
        let Belief { of_frame, confidence } = self.judge.believe(&mut evidence);
        self.trust = of_frame;
        let full = parameters.region.full_from_part(part);
        self.estimate = Estimate::new(full, part, confidence, status(confidence));
        self.estimate.effective_sample_size =
            self.set_estimates.iter().map(|set| set.effective_sample_size).sum();
        self.estimate.covariance = covariance;
        self.estimate.evidence = Some(evidence);
        fit
    }

    /// Step 3d.
    fn update_is_due(&self, parameters: &CheckedParameters, fit: &Fit) -> bool {
        self.frame.is_multiple_of(parameters.update_interval as u64)
            && f64::from(fit.score) > parameters.update_score
            && self.trust > parameters.update_confidence
    }

    /// Step 3e.
    fn learning_is_due(&self, parameters: &CheckedParameters) -> bool {
        self.frame.is_multiple_of(parameters.correlation_interval as u64)
            && self.trust > parameters.update_confidence
    }

    /// Steps 3d and 3e, side by side.
    fn learn(
        &mut self,
        parameters: &CheckedParameters,
        frame: &FrameView<'_>,
        integrals: &mut RegionIntegrals,
        fit: &Fit,
    ) {
        let (train, correlate) = (self.update_is_due(parameters, fit), self.learning_is_due(parameters));
        let Self { appearance, locator, estimate, frame: number, .. } = self;
        let part = estimate.part_in_frame;
        // Without the filters samples are taken where the particles are, as printed.
        let cover_samples = locator.is_some();
        rayon::join(
            || {
                if !train {
                    return;
                }
                if cover_samples {
                    let field = Sampler::new(parameters).field(&part);
                    integrals.compute(frame, search_region(field, &part, parameters.max_part_cells));
                }
                appearance.age_template(integrals, part);
                let counts = (parameters.targets, parameters.backgrounds);
                appearance.learn(
                    integrals,
                    &part,
                    counts,
                    &mut stream(parameters.seed, *number, Use::Samples),
                );
            },
            || {
                if let Some(locator) = locator.as_mut().filter(|_| correlate) {
                    locator.learn(part);
                }
            },
        );
    }
}

/// A set of N_s / n particles, uniform within the initial spread of the part.
fn particle_set(parameters: &CheckedParameters, part: &Rect, set: usize) -> ParticleFilter<3> {
    let (all, sets) = (parameters.particles, parameters.particle_sets);
    let count = all / sets + usize::from(set < all % sets);
    let spread = parameters.initial_spread;
    let mut rng = stream(parameters.seed, 0, Use::Particles(set));
    let mut offset = || if spread > 0.0 { rng.random_range(-spread..=spread) } else { 0.0 };
    let states = (0..count).map(|_| state_of(part) + PartState::new(offset(), offset(), 0.0)).collect();
    let options = ParticleFilterOptions {
        resampling: parameters.resampling,
        resampling_threshold: parameters.resampling_threshold,
        epsilon: parameters.epsilon,
        estimate_after_resampling: parameters.estimate_after_resampling,
        regularisation: None,
    };
    ParticleFilter::new(states, options)
}

/// The cells that hold `extent`, coarse enough that the part has at most `max_part_cells`.
fn search_region(extent: Rect, part: &Rect, max_part_cells: usize) -> SearchRegion {
    let for_part = (part.area() / max_part_cells as f64).sqrt();
    let for_region = (extent.area() / MAX_REGION_CELLS).sqrt();
    let for_side = extent.w.max(extent.h) / MAX_REGION_SIDE;
    SearchRegion::around(extent, for_part.max(for_region).max(for_side).ceil().max(1.0) as usize)
}

/// Mean and covariance of a mixture of sets, each weighted by its mean likelihood.
fn merge(sets: &[ParticleEstimate<3>]) -> (PartState, [[f64; 3]; 3]) {
    let best = sets.iter().map(|set| set.log_evidence).fold(f64::NEG_INFINITY, f64::max);
    let weight = |set: &ParticleEstimate<3>| {
        if best == f64::NEG_INFINITY { 1.0 } else { (set.log_evidence - best).exp() }
    };
    let total: f64 = sets.iter().map(weight).sum();
    let mean = sets.iter().fold(PartState::zeros(), |sum, set| sum + set.mean * (weight(set) / total));
    let covariance = sets.iter().fold(nalgebra::Matrix3::zeros(), |sum, set| {
        let d = set.mean - mean;
        sum + (set.covariance + d * d.transpose()) * (weight(set) / total)
    });
    (mean, std::array::from_fn(|r| std::array::from_fn(|c| covariance[(r, c)])))
}

impl Tracker for InfoPart {
    fn name(&self) -> &str {
        "infopart"
    }

    fn init(&mut self, frame: FrameView<'_>, box_in_frame: Rect) -> Result<Vec<BoxWarning>, TrackError> {
        let warnings = first_box::check(&frame, &box_in_frame)?;
        self.in_pool(|tracker| tracker.start(frame, box_in_frame));
        Ok(warnings)
    }

    fn update_at(&mut self, frame: FrameView<'_>, _stamp: FrameStamp) -> Result<Estimate, TrackError> {
        self.in_pool(|tracker| tracker.advance(frame))
    }

    fn estimate(&self) -> Option<&Estimate> {
        self.target.as_ref().map(|target| &target.estimate)
    }

    fn hypotheses(&self) -> Vec<WeightedBox> {
        let Some(target) = &self.target else { return Vec::new() };
        let share = 1.0 / target.sets.len() as f64;
        let weighted = target.sets.iter().flat_map(|set| set.states().iter().zip(set.weights()));
        weighted
            .map(|(state, weight)| WeightedBox {
                box_in_frame: self.parameters.region.full_from_part(box_of(state, target.aspect)),
                weight: weight * share,
            })
            .collect()
    }

    fn stage_times(&self) -> &[StageTime] {
        self.stopwatch.times()
    }
}
