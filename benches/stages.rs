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
    correlation::{
        filter::{CorrelationFilter, FilterOptions},
        grid::{CHANNELS, Grid},
        scale::{ScaleFilter, ScaleOptions},
        spectrum::PlaneSpectra,
        window::Window,
    },
    features::{
        blocks::BlockIntegrals,
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
const PARTICLES: usize = 100;
const POOL: usize = 150;
const STUMPS: usize = 20;
const TURNS: usize = 5;
const FIRST_SAMPLES: usize = 90;
const RECENT_SAMPLES: usize = 120;
const BOOSTING: BoostingOptions = BoostingOptions { rounds: STUMPS, balanced: true, turns: TURNS };
const CELLS: usize = 32;
const WINDOW: f64 = 4.0;
const FILTER: FilterOptions =
    FilterOptions { side: CELLS, label_sigma: 0.0625, temporal: 20.0, rounds: 2, support: 1.0 };
const SCALES: ScaleOptions = ScaleOptions { sizes: 17, ratio: 1.03, rate: 0.025 };

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
    full: Rect,
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
        integrals.compute(&frame.view(), around(&part));
        let mut rng = rng();
        let hypotheses = (0..PARTICLES)
            .map(|_| {
                let reach = |side: f64, rng: &mut ChaCha8Rng| rng.random_range(-side / 2.0..side / 2.0);
                let moved = part.translated(reach(part.w, &mut rng), reach(part.h, &mut rng));
                integrals.to_region(moved)
            })
            .collect();
        Self { frame, full: truth[0], part, integrals, hypotheses }
    }

    fn pool(&self) -> Vec<HaarFeature> {
        let here = self.integrals.to_region(self.part);
        HaarFeature::random_pool(POOL, f64::from(here.w), f64::from(here.h), 3, &mut rng())
    }
}

/// About what the particles cover.
fn around(part: &Rect) -> SearchRegion {
    SearchRegion::around(Rect::new(part.x - part.w, part.y - part.h, 3.0 * part.w, 3.0 * part.h), 1)
}

/// The correlation filter's window around a target.
fn search_region(full: &Rect) -> SearchRegion {
    SearchRegion::around(Window::around(full, WINDOW).to_rect(), 1)
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
    let Scene { frame, full, hypotheses, .. } = &scene;
    let mut integrals = scene.integrals.clone();
    let (window, covered) = (search_region(full), integrals.region());
    let mut blocks = BlockIntegrals::default();
    for block in [1, 2, 4] {
        c.bench_function(&format!("sums over the window, blocks of {block} x {block} pixels"), |b| {
            b.iter(|| blocks.compute(black_box(&frame.view()), window, block));
        });
    }
    c.bench_function("integral images of what the particles cover", |b| {
        b.iter(|| integrals.compute(black_box(&frame.view()), covered));
    });
    let integrals = &scene.integrals;
    let read_by_stumps = &scene.pool()[..STUMPS];
    c.bench_function("Haar-like features, 20 x 100 boxes", |b| {
        b.iter(|| {
            let of = |hypothesis| read_by_stumps.iter().map(move |f| f.evaluate(integrals, hypothesis));
            hypotheses.iter().flat_map(of).sum::<f32>()
        });
    });
    let template = Hog::of(integrals, &hypotheses[0]);
    c.bench_function("HOG and its distance, 100 boxes", |b| {
        let distance = |hypothesis| Hog::of(integrals, hypothesis).squared_distance(&template);
        b.iter(|| hypotheses.iter().map(distance).sum::<f32>());
    });
}

/// The correlation filters: cells of the window, the response, and learning for the first time and later; sizes.
fn correlation(c: &mut Criterion) {
    let Scene { full, frame, .. } = Scene::new();
    let window = Window::around(&full, WINDOW);
    let mut integrals = BlockIntegrals::default();
    integrals.compute(&frame.view(), search_region(&full), 2);
    let mut grid = Grid::new(CELLS);
    let own = vec![0.5; CELLS * CELLS];
    c.bench_function("grid of 32 x 32 cells", |b| {
        b.iter(|| grid.describe(black_box(&integrals), window, &own));
    });
    let mut spectra = PlaneSpectra::new(CELLS, CHANNELS);
    c.bench_function("spectra of its planes", |b| b.iter(|| spectra.compute(black_box(grid.planes()))));
    let (width, height) = (full.w / window.side, full.h / window.side);
    let fresh = CorrelationFilter::new(FILTER, CHANNELS, width, height);
    c.bench_function("correlation, learning in the first frame", |b| {
        b.iter_batched_ref(
            || fresh.clone(),
            |filter| filter.learn(black_box(&spectra), None),
            BatchSize::SmallInput,
        );
    });
    let mut filter = fresh.clone();
    filter.learn(&spectra, None);
    c.bench_function("correlation, learning in a later frame", |b| {
        b.iter(|| filter.learn(black_box(&spectra), None));
    });
    c.bench_function("correlation, response and its peak", |b| {
        b.iter(|| filter.respond(black_box(&spectra), window).peak());
    });
    let centres: Vec<(f64, f64)> = {
        let mut rng = rng();
        let mut reach = || rng.random_range(-full.w..full.w);
        (0..PARTICLES).map(|_| (window.x + reach(), window.y + reach())).collect()
    };
    c.bench_function("correlation, response at 100 places", |b| {
        b.iter(|| centres.iter().map(|&(x, y)| filter.response().at(x, y)).sum::<f32>());
    });
    let mut scale = ScaleFilter::new(SCALES, full.h / full.w);
    c.bench_function("scale filter, learning", |b| b.iter(|| scale.learn(black_box(&integrals), full)));
    c.bench_function("scale filter, a look", |b| b.iter(|| scale.look(black_box(&integrals), full)));
}

/// The likelihood of a part as the tracker has it, without threads: a trained classifier and HOG.
fn likelihood(c: &mut Criterion) {
    let scene = Scene::new();
    let integrals = &scene.integrals;
    let pool = scene.pool();
    let template = Hog::of(integrals, &integrals.to_region(scene.part));
    let mut classifier = StrongClassifier::default();
    GentleAdaBoost::new(BOOSTING).train(&memory(FIRST_SAMPLES, &mut rng()), &mut classifier);
    c.bench_function("likelihood, 100 boxes, 1 thread", |b| {
        b.iter(|| {
            let of = |hypothesis: &BoxInRegion| {
                let score = classifier.score(|k| pool[k].evaluate(integrals, hypothesis));
                let distance = Hog::of(integrals, hypothesis).squared_distance(&template);
                0.75 / (STUMPS as f32).sqrt() * score - 20.0 * distance
            };
            scene.hypotheses.iter().map(of).sum::<f32>()
        });
    });
}

fn training(c: &mut Criterion) {
    for (name, samples, turns) in [
        ("training, 90 samples x 150 features x 20 rounds, 5 turns", FIRST_SAMPLES, TURNS),
        ("training, 210 samples x 150 features x 20 rounds, 5 turns", FIRST_SAMPLES + RECENT_SAMPLES, TURNS),
        ("training, 210 samples x 150 features x 20 rounds, 1 turn", FIRST_SAMPLES + RECENT_SAMPLES, 1),
    ] {
        let memory = memory(samples, &mut rng());
        let mut trainer = GentleAdaBoost::new(BoostingOptions { turns, ..BOOSTING });
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
        ("resampling, multinomial, 100 particles", Resampling::Multinomial),
        ("resampling, stratified, 100 particles", Resampling::Stratified),
        ("resampling, systematic, 100 particles", Resampling::Systematic),
        ("resampling, residual, 100 particles", Resampling::Residual),
    ] {
        let (mut rng, mut ancestors) = (rng(), Vec::with_capacity(PARTICLES));
        c.bench_function(name, |b| b.iter(|| scheme.draw(black_box(&weights), &mut rng, &mut ancestors)));
    }
    let walk = RandomWalk::new(State::<3>::new(1.0, 1.0, 0.1));
    let start = ParticleFilter::new(vec![State::zeros(); PARTICLES], ParticleFilterOptions::default());
    c.bench_function("particle filter, 100 particles, trivial likelihood", |b| {
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
    for (name, preset, region) in [
        ("update, part", "default", Region::Part),
        ("update, whole", "default", Region::Whole),
        ("update, preset paper, part", "paper", Region::Part),
        ("update, preset paper, whole", "paper", Region::Whole),
    ] {
        let mut parameters = Parameters::preset(preset).expect("a preset of this name");
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

criterion_group!(stages, features, correlation, likelihood, training, filtering, updates);
criterion_main!(stages);
