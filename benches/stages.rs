//! A benchmark for each stage of a frame, on the synthetic walker, and one for whole updates.
//!
//! `cargo bench -- --quick` gives a first impression; `cargo bench -- update` runs what has `update` in its name.

use std::hint::black_box;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use infopart::{
    bayes::{
        Observation, State,
        particle::{ParticleFilter, ParticleFilterOptions},
        random_walk::RandomWalk,
        resampling::Resampling,
    },
    boosting::{BoostingOptions, GentleAdaBoost, Label, SampleMemory, StrongClassifier},
    features::{
        haar::HaarFeature,
        hog::Hog,
        region::{BoxInRegion, RegionIntegrals, SearchRegion},
    },
    frame::Frame,
    geometry::{Rect, Region},
    sequence::{FrameSource, Walker, WalkerOptions},
    tracker::{InfoPart, Parameters, Tracker},
};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

// The sizes of the default parameters.
const PARTICLES: usize = 800;
const POOL: usize = 300;
const STUMPS: usize = 40;
const FIRST_SAMPLES: usize = 90;
const RECENT_SAMPLES: usize = 400;
const BOOSTING: BoostingOptions = BoostingOptions { rounds: STUMPS, balanced: true, turns: 1 };

/// Frames of the walker, and the person's box in each.
fn walk() -> (Vec<Frame>, Vec<Rect>) {
    let mut walker = Walker::new(WalkerOptions { frames: 60, ..WalkerOptions::default() });
    let truth = walker.ground_truth().into_iter().flatten().collect();
    let frames = std::iter::from_fn(|| walker.next_frame().expect("the walker renders"));
    (frames.map(|frame| frame.frame).collect(), truth)
}

/// A search region with its integral images, and boxes in it as a frame's particles are.
struct Scene {
    frame: Frame,
    part: Rect,
    integrals: RegionIntegrals,
    hypotheses: Vec<BoxInRegion>,
}

impl Scene {
    fn new() -> Self {
        let (mut frames, truth) = walk();
        let frame = frames.swap_remove(0);
        let part = Region::Part.part_from_full(truth[0]);
        let mut integrals = RegionIntegrals::default();
        integrals.compute(&frame.view(), search_region(&part));
        let mut rng = rng();
        let hypotheses = (0..PARTICLES)
            .map(|_| {
                let reach = |side: f64, rng: &mut ChaCha8Rng| rng.random_range(-side / 2.0..side / 2.0);
                let moved = part.translated(reach(part.w, &mut rng), reach(part.h, &mut rng));
                integrals.to_region(moved)
            })
            .collect();
        Self { frame, part, integrals, hypotheses }
    }

    fn pool(&self) -> Vec<HaarFeature> {
        let here = self.integrals.to_region(self.part);
        HaarFeature::random_pool(POOL, f64::from(here.w), f64::from(here.h), 3, &mut rng())
    }
}

/// A part and as much around it as particles usually reach.
fn search_region(part: &Rect) -> SearchRegion {
    let field = Rect::new(part.x - part.w, part.y - part.h, 3.0 * part.w, 3.0 * part.h);
    SearchRegion::around(field, 1)
}

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(1)
}

/// As many samples as the tracker remembers at most, a third of them targets that differ a little in every feature.
fn memory(samples: usize, rng: &mut impl Rng) -> SampleMemory {
    let mut memory = SampleMemory::new(POOL, FIRST_SAMPLES, RECENT_SAMPLES);
    for number in 0..samples {
        let (label, shift) = if number % 3 == 0 { (Label::Target, 10.0) } else { (Label::Background, 0.0) };
        let values: Vec<f32> = (0..POOL).map(|_| shift + rng.random_range(-40.0..40.0f32)).collect();
        memory.add(&values, label);
    }
    memory
}

fn features(c: &mut Criterion) {
    let scene = Scene::new();
    let Scene { frame, part, hypotheses, .. } = &scene;
    let mut integrals = scene.integrals.clone();
    let region = search_region(part);
    c.bench_function("integral images of the search region", |b| {
        b.iter(|| integrals.compute(black_box(&frame.view()), region));
    });
    let coarse = SearchRegion::around(
        Rect::new(region.x as f64, region.y as f64, region.width as f64, region.height as f64),
        2,
    );
    c.bench_function("integral images, 2 x 2 pixels a cell", |b| {
        b.iter(|| integrals.compute(black_box(&frame.view()), coarse));
    });
    let integrals = &scene.integrals;
    let read_by_stumps = &scene.pool()[..STUMPS];
    c.bench_function("Haar-like features, 40 x 800 boxes", |b| {
        b.iter(|| {
            let of = |hypothesis| read_by_stumps.iter().map(move |f| f.evaluate(integrals, hypothesis));
            hypotheses.iter().flat_map(of).sum::<f32>()
        });
    });
    let template = Hog::of(integrals, &hypotheses[0]);
    c.bench_function("HOG and its distance, 800 boxes", |b| {
        let distance = |hypothesis| Hog::of(integrals, hypothesis).squared_distance(&template);
        b.iter(|| hypotheses.iter().map(distance).sum::<f32>());
    });
}

/// The likelihood of a part as the tracker has it, without threads: a trained classifier and HOG.
fn likelihood(c: &mut Criterion) {
    let scene = Scene::new();
    let integrals = &scene.integrals;
    let pool = scene.pool();
    let template = Hog::of(integrals, &integrals.to_region(scene.part));
    let mut classifier = StrongClassifier::default();
    GentleAdaBoost::new(BOOSTING).train(&memory(FIRST_SAMPLES, &mut rng()), &mut classifier);
    c.bench_function("likelihood, 800 boxes, 1 thread", |b| {
        b.iter(|| {
            let of = |hypothesis: &BoxInRegion| {
                let score = classifier.score(|k| pool[k].evaluate(integrals, hypothesis));
                let distance = Hog::of(integrals, hypothesis).squared_distance(&template);
                3.0 / (STUMPS as f32).sqrt() * score - 20.0 * distance
            };
            scene.hypotheses.iter().map(of).sum::<f32>()
        });
    });
}

fn training(c: &mut Criterion) {
    for (name, samples) in [
        ("training, 90 samples x 300 features x 40 rounds", FIRST_SAMPLES),
        ("training, 490 samples x 300 features x 40 rounds", FIRST_SAMPLES + RECENT_SAMPLES),
    ] {
        let memory = memory(samples, &mut rng());
        let mut trainer = GentleAdaBoost::new(BOOSTING);
        let mut classifier = StrongClassifier::default();
        c.bench_function(name, |b| b.iter(|| trainer.train(black_box(&memory), &mut classifier)));
    }
}

/// A likelihood that costs next to nothing, so that what is measured is the filter.
struct NearOrigin;

impl Observation<3> for NearOrigin {
    fn log_likelihood(&self, state: &State<3>) -> f64 {
        -0.5 * state.norm_squared()
    }
}

fn filtering(c: &mut Criterion) {
    let raw: Vec<f64> = {
        let mut rng = rng();
        (0..PARTICLES).map(|_| rng.random::<f64>().powi(4)).collect()
    };
    let sum: f64 = raw.iter().sum();
    let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
    for (name, scheme) in [
        ("resampling, multinomial, 800 particles", Resampling::Multinomial),
        ("resampling, stratified, 800 particles", Resampling::Stratified),
        ("resampling, systematic, 800 particles", Resampling::Systematic),
        ("resampling, residual, 800 particles", Resampling::Residual),
    ] {
        let (mut rng, mut ancestors) = (rng(), Vec::with_capacity(PARTICLES));
        c.bench_function(name, |b| b.iter(|| scheme.draw(black_box(&weights), &mut rng, &mut ancestors)));
    }
    let walk = RandomWalk::new(State::<3>::new(1.0, 1.0, 0.1));
    let start = ParticleFilter::new(vec![State::zeros(); PARTICLES], ParticleFilterOptions::default());
    c.bench_function("particle filter, 800 particles, trivial likelihood", |b| {
        let mut rng = rng();
        b.iter_batched_ref(
            || start.clone(),
            |filter| filter.step(&walk, &NearOrigin, &mut rng),
            BatchSize::SmallInput,
        );
    });
}

/// Whole updates, the training of every fourth frame among them. The walk runs forth and back, so that it never ends.
fn updates(c: &mut Criterion) {
    let (frames, truth) = walk();
    for (name, region) in [("update, part", Region::Part), ("update, whole", Region::Whole)] {
        let mut parameters = Parameters::default();
        parameters.region = region;
        let mut tracker = InfoPart::new(parameters.check().expect("the defaults are valid"));
        tracker.init(frames[0].view(), truth[0]).expect("the walker starts inside the frame");
        let mut forth_and_back = (1..frames.len()).chain((0..frames.len() - 1).rev()).cycle();
        c.bench_function(name, |b| {
            b.iter(|| {
                let index = forth_and_back.next().expect("the walk never ends");
                tracker.update(frames[index].view()).expect("all frames have one size")
            });
        });
    }
}

criterion_group!(stages, features, likelihood, training, filtering, updates);
criterion_main!(stages);
