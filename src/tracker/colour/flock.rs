//! Several targets at once, and which of them hides which.
//!
//! Steps, each frame, before the targets' own:
//! 1. two targets whose histograms correlate little do not hide each other,
//! 2. nor do two whose predicted boxes do not overlap,
//! 3. of two others the one whose box reaches further down is in front (it is nearer to a camera that looks down on the
//!    ground); equally far, the one seen more clearly. While their boxes overlap this stays so,
//! 4. the target behind counts nothing where the one in front is, and its model is not updated.

use crate::{
    background::BackgroundModel,
    features::colour_histogram::HistogramIntegrals,
    frame::FrameView,
    geometry::Rect,
    parallel::Threads,
    tracker::{
        TrackError,
        estimate::{BoxWarning, Estimate, StageTime, WeightedBox},
        first_box,
        stopwatch::Stopwatch,
    },
};

use super::{
    parameters::CheckedColourParameters,
    target::{Surroundings, Target},
};

/// Targets at most: each has a random stream of its own.
const MOST_TARGETS: usize = 32;
/// Boxes that reach equally far down: within this share of a height.
const LEVEL: f64 = 0.02;

/// Colour-histogram particle filters of several targets in one video.
pub struct ColourFlock {
    parameters: CheckedColourParameters,
    threads: Threads,
    frame_size: (usize, usize),
    background: Option<BackgroundModel>,
    integrals: HistogramIntegrals,
    targets: Vec<Target>,
    /// (front, behind) of the pairs that overlap.
    pairs: Vec<(usize, usize)>,
    stopwatch: Stopwatch,
}

impl ColourFlock {
    /// A flock that works in the thread pool it is called from, or without the feature `threads` on the calling thread.
    pub fn new(parameters: CheckedColourParameters) -> Self {
        Self {
            parameters,
            threads: Threads::default(),
            frame_size: (0, 0),
            background: None,
            integrals: HistogramIntegrals::default(),
            targets: Vec::new(),
            pairs: Vec::new(),
            stopwatch: Stopwatch::default(),
        }
    }

    /// A flock that works in `pool`.
    #[cfg(feature = "threads")]
    pub fn with_pool(parameters: CheckedColourParameters, pool: std::sync::Arc<rayon::ThreadPool>) -> Self {
        Self::with_threads(parameters, Threads::Pool(pool))
    }

    /// A flock that works where `threads` says.
    pub fn with_threads(parameters: CheckedColourParameters, threads: Threads) -> Self {
        Self { threads, ..Self::new(parameters) }
    }

    /// The parameters it runs with.
    pub fn parameters(&self) -> &CheckedColourParameters {
        &self.parameters
    }

    /// Starts on `frame` with these targets, and tells what is odd about each box. Nothing of earlier targets is kept.
    ///
    /// # Errors
    /// [`TrackError::TargetCount`] for no target or more than 32, [`TrackError::BadBox`] or [`TrackError::BoxOutside`];
    /// the flock then stays as it was.
    pub fn init(
        &mut self,
        frame: FrameView<'_>,
        boxes_in_frame: &[Rect],
    ) -> Result<Vec<Vec<BoxWarning>>, TrackError> {
        if boxes_in_frame.is_empty() || boxes_in_frame.len() > MOST_TARGETS {
            return Err(TrackError::TargetCount { given: boxes_in_frame.len(), most: MOST_TARGETS });
        }
        let checked = boxes_in_frame.iter().map(|target| first_box::check(&frame, target));
        let warnings = checked.collect::<Result<_, _>>()?;
        self.in_pool(|flock| flock.start(frame, boxes_in_frame));
        Ok(warnings)
    }

    /// Finds the targets in the next frame, in the order in which they were given.
    ///
    /// # Errors
    /// [`TrackError::NotStarted`] before the first `init`, [`TrackError::SizeChanged`] if the frame differs in size from
    /// the one before; the flock then stays as it was.
    pub fn update(&mut self, frame: FrameView<'_>) -> Result<Vec<Estimate>, TrackError> {
        if self.targets.is_empty() {
            return Err(TrackError::NotStarted);
        }
        let (width, height) = (frame.width(), frame.height());
        let (first_width, first_height) = self.frame_size;
        if (width, height) != self.frame_size {
            return Err(TrackError::SizeChanged { width, height, first_width, first_height });
        }
        self.in_pool(|flock| flock.advance(frame));
        Ok(self.estimates().cloned().collect())
    }

    /// The targets' estimates in the frame that was seen last.
    pub fn estimates(&self) -> impl Iterator<Item = &Estimate> {
        self.targets.iter().map(|target| &target.estimate)
    }

    /// The hypotheses of one target, weighed in the last frame; none if there is no such target.
    pub fn hypotheses(&self, target: usize) -> Vec<WeightedBox> {
        self.targets.get(target).map(Target::hypotheses).unwrap_or_default()
    }

    /// How long each stage of the last `init` or `update` took.
    pub fn stage_times(&self) -> &[StageTime] {
        self.stopwatch.times()
    }

    /// Which targets hid which in the last frame: (front, behind).
    pub fn hidden_pairs(&self) -> &[(usize, usize)] {
        &self.pairs
    }

    fn in_pool<T: Send>(&mut self, work: impl FnOnce(&mut Self) -> T + Send) -> T {
        self.threads.clone().run(|| work(self))
    }

    fn start(&mut self, frame: FrameView<'_>, boxes_in_frame: &[Rect]) {
        self.stopwatch.start();
        self.frame_size = (frame.width(), frame.height());
        self.pairs.clear();
        self.background = None;
        if self.parameters.foreground
            && let Ok(parameters) = self.parameters.background.clone().check()
        {
            self.background = Some(BackgroundModel::new(parameters));
        }
        self.learn_background(frame);
        let Self { parameters, integrals, .. } = self;
        let numbered = boxes_in_frame.iter().enumerate();
        self.targets = numbered
            .map(|(number, target)| Target::new(parameters, &frame, integrals, *target, number))
            .collect();
        self.stopwatch.lap("first histograms");
    }

    fn advance(&mut self, frame: FrameView<'_>) {
        self.stopwatch.start();
        self.learn_background(frame);
        self.find_hidden();
        let known = |model: &&BackgroundModel| model.frames() > self.parameters.foreground_after as u64;
        let foreground = self.background.as_ref().filter(known).map(BackgroundModel::mask);
        // The front ones first, so that those behind know where they are.
        let mut order: Vec<usize> = (0..self.targets.len()).collect();
        order.sort_by(|&a, &b| {
            let bottom = |target: usize| self.targets[target].predicted().bottom();
            bottom(b).total_cmp(&bottom(a))
        });
        let mut hidden_by = Vec::new();
        for behind in order {
            let fronts = self.pairs.iter().filter(|pair| pair.1 == behind);
            hidden_by.clear();
            hidden_by.extend(fronts.map(|pair| self.targets[pair.0].estimate.box_in_frame));
            let surroundings = Surroundings { foreground, hidden_by: &hidden_by };
            self.targets[behind].step(&self.parameters, &frame, &mut self.integrals, &surroundings);
        }
        self.stopwatch.lap("targets");
    }

    fn learn_background(&mut self, frame: FrameView<'_>) {
        // The size was checked, so it cannot fail; without a mask everything would count.
        if let Some(model) = &mut self.background
            && model.apply(frame).is_ok()
        {
            self.stopwatch.lap("background");
        }
    }

    /// Steps 1 to 3.
    fn find_hidden(&mut self) {
        let mut pairs = Vec::new();
        for b in 1..self.targets.len() {
            for a in 0..b {
                let (one, other) = (&self.targets[a], &self.targets[b]);
                let correlates =
                    one.appearance.correlation(&other.appearance) >= self.parameters.occlusion_correlation;
                if !correlates || one.predicted().intersection_area(&other.predicted()) == 0.0 {
                    continue;
                }
                let as_before = self.pairs.iter().find(|pair| [(a, b), (b, a)].contains(pair));
                let a_is_front = is_in_front(one, other);
                pairs.push(as_before.copied().unwrap_or(if a_is_front { (a, b) } else { (b, a) }));
            }
        }
        self.pairs = pairs;
    }
}

/// Step 3.
fn is_in_front(one: &Target, other: &Target) -> bool {
    let (a, b) = (one.predicted(), other.predicted());
    let lower_by = a.bottom() - b.bottom();
    if lower_by.abs() > LEVEL * a.h.min(b.h) {
        lower_by > 0.0
    } else {
        one.estimate.confidence >= other.estimate.confidence
    }
}
