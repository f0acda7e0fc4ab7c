//! Algorithm 6: InfoPart.
//!
//! Steps:
//! 1. in the first frame, set up n particle sets on the part of the box that changes least,
//! 2. sample the part and its surroundings (Algorithm 5), train the classifier F (Algorithm 4), and let the other cues
//!    learn,
//! 3. in each later frame:
//!    a. look over the window around the target, move the particles by the walk or to where the cues answer (and meanwhile
//!    look at the sizes there), compute integral images of what they cover, weigh and resample them (Algorithm 1),
//!    b. estimate the part from the sets and recover the whole box from it,
//!    c. judge the estimate,
//!    d. if it is due and the estimate is trusted, sample the new part, its surroundings and the other places that the cues
//!    answer to, and retrain F,
//!    e. likewise let the cues over the window learn,
//!    f. if the target was lost, look for it elsewhere (`infopart/recovery.rs`).
//!
//! The correlation filter is the step that the paper names as its next; without the cues over the window (weight 0) all else is
//! as printed.

use crate::{
    bayes::{
        Observation,
        particle::{ParticleEstimate, ParticleFilter, ParticleFilterOptions},
    },
    features::{
        haar::HaarFeature,
        hog::Hog,
        region::{CHANNELS, RegionIntegrals, SearchRegion},
    },
    frame::{FrameStamp, FrameView, PixelFormat},
    geometry::{Rect, Region},
    parallel::{Threads, join},
};
use rand::RngExt;

mod judging;
mod recovery;

use super::{
    TrackError, Tracker,
    confidence::Judge,
    cues::{Cues, Fit, Lesson},
    estimate::{BoxWarning, Elsewhere, Estimate, StageTime, Status, WeightedBox},
    first_box,
    identity::{Identity, Portrait},
    learning_gate::LearningGate,
    motion::{Limits, PartState, PartWalk, box_of, state_of},
    parameters::CheckedParameters,
    proposal::PeakProposal,
    sampling::Sampler,
    scene::Scene,
    search::Search,
    stopwatch::Stopwatch,
    streams::{Use, stream},
};

/// Cells that a search region may have at most; larger ones are averaged down further.
const MAX_REGION_CELLS: f64 = 1_048_576.0;

/// Cells along a side of a search region at most.
const MAX_REGION_SIDE: f64 = 16_384.0;

/// Places that the cues answer to are others if they overlap the target by less than this.
const OTHERS_OVERLAP: f64 = 0.4;

/// The least confidence of a frame that identity learns from.
const SURE: f64 = 0.85;

/// The InfoPart tracker.
pub struct InfoPart {
    parameters: CheckedParameters,
    threads: Threads,
    target: Option<Target>,
    integrals: RegionIntegrals,
    stopwatch: Stopwatch,
}

/// What a tracker is but for scratch and threads.
#[cfg(feature = "save")]
pub(super) struct Unsaved<'a> {
    pub parameters: &'a CheckedParameters,
    pub target: Option<&'a Target>,
}

/// Everything known of the target being tracked.
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Target {
    frame_size: (usize, usize),
    /// h / w of the part.
    aspect: f64,
    limits: Limits,
    /// Frames since `init`.
    frame: u64,
    sets: Vec<ParticleFilter<3>>,
    cues: Cues,
    estimate: Estimate,
    /// Whether the last frame's estimate may be learnt.
    learnable: bool,
    identity: Identity,
    /// What it stands before; only where cues look over a window.
    scene: Option<Scene>,
    judge: Judge,
    /// The whole box when the target was last tracked, frame pixels.
    last_seen: Rect,
    /// Frames in a row that it has been hidden by the scenery.
    hidden: u32,
    search: Search,
    gate: LearningGate,
    #[cfg_attr(feature = "save", serde(skip))]
    set_estimates: Vec<ParticleEstimate<3>>,
    /// Whole boxes where the cues answer and the target is not.
    competitors: Vec<Rect>,
    /// Scratch: their parts.
    others: Vec<Rect>,
    /// Windows looked over for a lost target.
    searched: Vec<Rect>,
}

impl InfoPart {
    /// A tracker that works in the thread pool it is called from, or without the feature `threads` on the calling thread.
    pub fn new(parameters: CheckedParameters) -> Self {
        Self {
            parameters,
            threads: Threads::default(),
            target: None,
            integrals: RegionIntegrals::default(),
            stopwatch: Stopwatch::default(),
        }
    }

    /// A tracker that works in `pool`.
    #[cfg(feature = "threads")]
    pub fn with_pool(parameters: CheckedParameters, pool: std::sync::Arc<rayon::ThreadPool>) -> Self {
        Self::with_threads(parameters, Threads::Pool(pool))
    }

    /// A tracker that works where `threads` says.
    pub fn with_threads(parameters: CheckedParameters, threads: Threads) -> Self {
        Self { threads, ..Self::new(parameters) }
    }

    /// Works where `threads` says from now on.
    pub fn set_threads(&mut self, threads: Threads) {
        self.threads = threads;
    }

    /// The parameters it runs with.
    pub fn parameters(&self) -> &CheckedParameters {
        &self.parameters
    }

    /// What is saved of it.
    #[cfg(feature = "save")]
    pub(super) fn unsaved(&self) -> Unsaved<'_> {
        Unsaved { parameters: &self.parameters, target: self.target.as_ref() }
    }

    /// A tracker that goes on with what was saved.
    #[cfg(feature = "save")]
    pub(super) fn resumed(parameters: CheckedParameters, target: Option<Target>) -> Self {
        Self { target, ..Self::new(parameters) }
    }

    fn in_pool<T: Send>(&mut self, work: impl FnOnce(&mut Self) -> T + Send) -> T {
        self.threads.clone().run(|| work(self))
    }

    /// Steps 1 and 2.
    fn start(&mut self, frame: FrameView<'_>, box_in_frame: Rect) {
        self.stopwatch.start();
        let parameters = &self.parameters;
        let part = parameters.region.part_from_full(box_in_frame);
        let field = Sampler::new(parameters).field(&part);
        self.integrals.compute(&frame, search_region(field, &part, parameters.max_part_cells));
        self.stopwatch.lap("integral images");
        let mut target = Target::new(parameters, &frame, &self.integrals, box_in_frame, part);
        target.cues.see(&frame, box_in_frame);
        self.stopwatch.lap("window");
        target.learn_first(parameters, &frame, &self.integrals);
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
        let (part, full) = (target.estimate.part_in_frame, target.estimate.box_in_frame);
        if target.cues.look_over_window() {
            target.cues.see(&frame, full);
            self.stopwatch.lap("window");
            target.cues.look(&full);
            self.stopwatch.lap("look");
        }
        target.predict(parameters);
        self.stopwatch.lap("prediction");
        self.integrals.compute(&frame, search_region(target.extent(), &part, parameters.max_part_cells));
        self.stopwatch.lap("integral images");
        target.correct(parameters, &self.integrals);
        self.stopwatch.lap("likelihood");
        target.see_scene(&frame);
        let fit = target.judge(parameters, &frame, &self.integrals);
        self.stopwatch.lap("estimate");
        target.learn(parameters, &frame, &mut self.integrals, &fit);
        self.stopwatch.lap("learning");
        target.search(parameters, &frame, &mut self.integrals);
        self.stopwatch.lap("search");
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
        let cues = Cues::new(parameters, pool, Hog::of(integrals, &template), box_in_frame);
        Self {
            frame_size: (frame.width(), frame.height()),
            aspect: part.h / part.w,
            limits: Limits::around(&part, frame.width(), frame.height()),
            frame: 0,
            sets: particle_sets(parameters, &part),
            estimate,
            learnable: true,
            identity: Identity::new(Portrait::of(integrals, part)),
            scene: cues.look_over_window().then(|| Scene::new(frame, box_in_frame)),
            cues,
            judge: Judge::default(),
            last_seen: box_in_frame,
            hidden: 0,
            search: Search::new(&box_in_frame),
            gate: LearningGate::new(parameters),
            set_estimates: Vec::with_capacity(parameters.particle_sets),
            competitors: Vec::new(),
            others: Vec::new(),
            searched: Vec::new(),
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

    /// Particles begin anew around a part.
    fn restart_sets(&mut self, parameters: &CheckedParameters, part: &Rect) {
        self.sets = particle_sets(parameters, part);
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
        let full = self.estimate.box_in_frame;
        let found = self.cues.found(&full).filter(|_| parameters.peak_share > 0.0);
        let proposal = found.map(|found| PeakProposal {
            walk,
            peak: parameters.region.part_from_full(found).centre(),
            spread: parameters.peak_spread * part.area().sqrt(),
            share: parameters.peak_share,
        });
        let Self { sets, frame, cues, .. } = self;
        let mut move_particles = || {
            for (set, particles) in sets.iter_mut().enumerate() {
                let mut rng = stream(parameters.seed, *frame, Use::Particles(set));
                match &proposal {
                    Some(proposal) => particles.propose(proposal, &walk, &mut rng),
                    None => particles.predict(&walk, &mut rng),
                }
            }
        };
        if cues.look_over_window() {
            join(move_particles, || cues.look_closer(&full));
        } else {
            move_particles();
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
        let observation =
            FrameObservation { integrals, cues: &self.cues, aspect: self.aspect, region: parameters.region };
        self.set_estimates.clear();
        for (set, particles) in self.sets.iter_mut().enumerate() {
            // Past the prediction's draws: the frame's second half of the stream numbers.
            let mut rng = stream(parameters.seed, self.frame | 1 << 40, Use::Particles(set));
            self.set_estimates.push(particles.correct(&observation, &mut rng));
        }
    }

    /// Step 2.
    fn learn_first(
        &mut self,
        parameters: &CheckedParameters,
        frame: &FrameView<'_>,
        integrals: &RegionIntegrals,
    ) {
        let Estimate { part_in_frame: part, box_in_frame: full, .. } = self.estimate;
        let (mut of_part, of_window) = self.cues.split();
        let counts = (parameters.first_targets, parameters.first_backgrounds);
        let lesson = Lesson { integrals, part, others: &[], counts };
        of_part.learn(&lesson, &mut stream(parameters.seed, 0, Use::Samples));
        if let Some(mut of_window) = of_window {
            of_window.learn(frame, full);
        }
    }

    /// Steps 3d and 3e, side by side.
    fn learn(
        &mut self,
        parameters: &CheckedParameters,
        frame: &FrameView<'_>,
        integrals: &mut RegionIntegrals,
        fit: &Fit,
    ) {
        let is_due = |interval: usize| self.learnable && self.frame.is_multiple_of(interval as u64);
        let train = is_due(parameters.update_interval) && f64::from(fit.score) > parameters.update_score;
        let correlate = is_due(parameters.correlation_interval);
        if train {
            let parts = self.competitors.iter().map(|full| parameters.region.part_from_full(*full));
            self.others.clear();
            self.others.extend(parts);
        }
        let Self { cues, estimate, frame: number, others, identity, .. } = self;
        let Estimate { part_in_frame: part, box_in_frame: full, .. } = *estimate;
        // Without the window's cues samples are taken where the particles are, as printed.
        let cover_samples = cues.look_over_window();
        let (mut of_part, of_window) = cues.split();
        join(
            || {
                if !train {
                    return;
                }
                if cover_samples {
                    let field = others.iter().fold(Sampler::new(parameters).field(&part), |field, other| {
                        field.union(&Sampler::field_of_other(other))
                    });
                    integrals.compute(frame, search_region(field, &part, parameters.max_part_cells));
                }
                of_part.age_template(integrals, part);
                let portraits = others.iter().map(|other| Portrait::of(integrals, *other));
                if estimate.confidence >= SURE {
                    identity.learn(Portrait::of(integrals, part), portraits);
                }
                let counts = (parameters.targets, parameters.backgrounds);
                let lesson = Lesson { integrals, part, others, counts };
                of_part.learn(&lesson, &mut stream(parameters.seed, *number, Use::Samples));
            },
            || {
                if let Some(mut of_window) = of_window.filter(|_| correlate) {
                    of_window.learn(frame, full);
                }
            },
        );
    }

    /// Where the window's cues answer and the target is not.
    fn find_competitors(&mut self) {
        let Self { cues, competitors, estimate, .. } = self;
        competitors.clear();
        competitors.extend(cues.answered_elsewhere(estimate.box_in_frame, OTHERS_OVERLAP));
    }
}

/// A frame as an observation of the part's state.
struct FrameObservation<'a> {
    integrals: &'a RegionIntegrals,
    cues: &'a Cues,
    /// h / w of the part.
    aspect: f64,
    region: Region,
}

impl Observation<3> for FrameObservation<'_> {
    fn log_likelihood(&self, state: &PartState) -> f64 {
        let part = box_of(state, self.aspect);
        let full = self.region.full_from_part(part);
        self.cues.log_likelihood(&self.cues.hypothesis(self.integrals, part, full))
    }
}

fn particle_sets(parameters: &CheckedParameters, part: &Rect) -> Vec<ParticleFilter<3>> {
    (0..parameters.particle_sets).map(|set| particle_set(parameters, part, set)).collect()
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

    fn elsewhere(&self) -> Elsewhere {
        let Some(target) = &self.target else { return Elsewhere::default() };
        Elsewhere {
            competitors: target.competitors.clone(),
            searched: target.searched.clone(),
            suspect: target.search.suspect(),
        }
    }

    fn stage_times(&self) -> &[StageTime] {
        self.stopwatch.times()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(mean: [f64; 3], variance: f64, log_evidence: f64) -> ParticleEstimate<3> {
        ParticleEstimate {
            mean: PartState::from(mean),
            covariance: nalgebra::Matrix3::identity() * variance,
            effective_sample_size: 1.0,
            log_evidence,
            resampled: false,
        }
    }

    #[test]
    fn sets_merge_by_their_evidence_and_their_disagreement_is_part_of_the_covariance() {
        let (a, b) = (set([0.0, 0.0, 10.0], 1.0, 0.0), set([8.0, 0.0, 14.0], 3.0, 3f64.ln()));
        let (mean, covariance) = merge(&[a, b]);
        // Weights 1/4 and 3/4.
        assert!((mean - PartState::new(6.0, 0.0, 13.0)).norm() < 1e-12);
        let between = 0.25 * 0.75;
        let expected = [
            [2.5 + between * 64.0, 0.0, between * 32.0],
            [0.0, 2.5, 0.0],
            [between * 32.0, 0.0, 2.5 + between * 16.0],
        ];
        for (found, expected) in covariance.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((found - expected).abs() < 1e-12, "{covariance:?}");
        }
    }

    #[test]
    fn sets_without_any_evidence_count_alike() {
        let none = f64::NEG_INFINITY;
        let (mean, _) = merge(&[set([0.0; 3], 1.0, none), set([4.0; 3], 1.0, none)]);
        assert_eq!(mean, PartState::new(2.0, 2.0, 2.0));
    }
}
