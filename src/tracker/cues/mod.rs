//! What the tracker looks at: each cue is a file, and all stand behind one trait. A new cue is a file here and an entry of
//! [`Cues`].

mod classifier;
mod colour;
mod gradients;
mod place;
mod size;

use rand::Rng;

use crate::{
    features::{
        foreground::ForegroundModel,
        haar::HaarFeature,
        hog::Hog,
        region::{BoxInRegion, RegionIntegrals},
    },
    frame::FrameView,
    geometry::Rect,
    parallel::for_each,
};

use super::{evidence_map::EvidenceMap, parameters::Parameters, window_view::WindowView};
use classifier::Classifier;
pub(super) use classifier::Lesson;
use colour::Colour;
use gradients::Gradients;
use place::Place;
use size::Size;

/// A box that the target may have.
pub(super) struct Hypothesis<'a> {
    /// Integral images of what the particles cover.
    pub integrals: &'a RegionIntegrals,
    /// The part, in their cells.
    pub part_in_region: BoxInRegion,
    /// The whole box, frame pixels.
    pub full: Rect,
    /// The window around where the target was, if any cue looks over it.
    pub view: Option<&'a WindowView>,
}

/// Something that tells the target from what surrounds it.
pub(super) trait Cue: Send + Sync {
    /// Looks over the window around where the target was, before particles are moved.
    fn look(&mut self, _view: &WindowView) {}

    /// Looks closer at the whole box where all cues together found the target.
    fn look_closer(&mut self, _view: &WindowView, _found: Rect) {}

    /// What a whole box's place in the window adds to the logarithm of the likelihood, as far as the look over the window
    /// tells: 0 from a cue that looks at single hypotheses only.
    fn over_window(&self, _view: &WindowView, _full: &Rect) -> f64 {
        0.0
    }

    /// What the cue adds to the logarithm of the likelihood of a hypothesis.
    fn log_likelihood(&self, hypothesis: &Hypothesis<'_>) -> f64;

    /// Learns that the target has that whole box, around which the view is.
    fn learn(&mut self, _view: &WindowView, _full: Rect) {}
}

/// How well a box fits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fit {
    /// conf: the classifier's score, in [-s, s].
    pub score: f32,
    /// Squared HOG distance to the template, in [0, 2].
    pub hog_distance: f32,
    /// The place filter's response at the box's centre, about 1 where the target is as learnt; `None` without the filter.
    pub response: Option<f64>,
}

/// Every cue in use.
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Cues {
    classifier: Classifier,
    gradients: Gradients,
    /// Those that look over a window; none in the method as printed.
    window: Option<Window>,
}

/// The cues that look over a window around the target, what they share, and where they together answer.
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Window {
    view: WindowView,
    cues: WindowCues,
    map: EvidenceMap,
}

/// The cues that look over a window.
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct WindowCues {
    place: Place,
    size: Size,
    colour: Colour,
}

impl WindowCues {
    fn new(parameters: &Parameters, full: &Rect) -> Self {
        Self {
            place: Place::new(parameters, full),
            size: Size::new(parameters, full),
            colour: Colour::new(parameters),
        }
    }

    fn each(&self) -> [&dyn Cue; 3] {
        [&self.place, &self.size, &self.colour]
    }

    fn each_mut(&mut self) -> [&mut dyn Cue; 3] {
        [&mut self.place, &mut self.size, &mut self.colour]
    }
}

impl Cues {
    /// Cues for a target with that whole box, whose part has that HOG; nothing else is learnt yet.
    pub fn new(parameters: &Parameters, pool: Vec<HaarFeature>, template: Hog, full: Rect) -> Self {
        Self {
            classifier: Classifier::new(parameters, pool),
            gradients: Gradients::new(parameters, template),
            window: (parameters.correlation_weight > 0.0).then(|| Window {
                view: WindowView::new(parameters, full),
                cues: WindowCues::new(parameters, &full),
                map: EvidenceMap::default(),
            }),
        }
    }

    /// Whether any cue looks over a window.
    pub fn look_over_window(&self) -> bool {
        self.window.is_some()
    }

    /// Computes what the cues see of the window around a whole box.
    pub fn see(&mut self, frame: &FrameView<'_>, full: Rect) {
        if let Some(window) = &mut self.window {
            window.view.see(frame, full);
        }
    }

    /// Looks over the window last seen, around where the target was.
    pub fn look(&mut self, full: &Rect) {
        let Some(Window { view, cues, map }) = &mut self.window else { return };
        cues.each_mut().into_iter().for_each(|cue| cue.look(view));
        let cues = cues.each();
        let evidence = |full: &Rect| cues.iter().map(|cue| cue.over_window(view, full)).sum();
        map.find_peaks(view.window(), view.side(), full, evidence);
    }

    /// Looks closer where the target was found, its whole box being as large as that.
    pub fn look_closer(&mut self, full: &Rect) {
        let found = self.found(full).unwrap_or(*full);
        if let Some(Window { view, cues, .. }) = &mut self.window {
            cues.each_mut().into_iter().for_each(|cue| cue.look_closer(view, found));
        }
    }

    /// The window last seen, if any cue looks over one, frame pixels.
    pub fn window(&self) -> Option<Rect> {
        self.window.as_ref().map(|window| window.view.window().to_rect())
    }

    /// The colours of the target and of what surrounds it, if any cue looks over a window.
    pub fn foreground_model(&self) -> Option<&ForegroundModel> {
        self.window.as_ref().map(|window| window.view.foreground_model())
    }

    /// The whole boxes of that size at the places where the cues that look over the window answer, best first.
    pub fn answers(&self, full: Rect) -> impl Iterator<Item = Rect> {
        let peaks = self.window.as_ref().map_or(&[][..], |window| window.map.peaks());
        peaks.iter().map(move |peak| peak.of(&full))
    }

    /// The whole box of that size where the cues that look over the window together find the target.
    pub fn found(&self, full: &Rect) -> Option<Rect> {
        self.answers(*full).next()
    }

    /// Whole boxes of the size of `full` at the places that they answer to and that overlap it by less than `overlap`.
    pub fn answered_elsewhere(&self, full: Rect, overlap: f64) -> impl Iterator<Item = Rect> {
        self.answers(full).filter(move |other| other.overlap(&full) < overlap)
    }

    /// A hypothesis of the part inside the region of `integrals`, and of the whole box with it.
    pub fn hypothesis<'a>(
        &'a self,
        integrals: &'a RegionIntegrals,
        part: Rect,
        full: Rect,
    ) -> Hypothesis<'a> {
        let view = self.window.as_ref().map(|window| &window.view);
        Hypothesis { integrals, part_in_region: integrals.to_region(part), full, view }
    }

    /// The logarithm of the likelihood of a hypothesis, up to a constant.
    pub fn log_likelihood(&self, hypothesis: &Hypothesis<'_>) -> f64 {
        let of_part = self.classifier.log_likelihood(hypothesis) + self.gradients.log_likelihood(hypothesis);
        let of_window = self
            .window
            .as_ref()
            .map_or(0.0, |window| window.cues.each().iter().map(|cue| cue.log_likelihood(hypothesis)).sum());
        of_part + of_window
    }

    /// How well a hypothesis fits what the target looks like.
    pub fn fit(&self, hypothesis: &Hypothesis<'_>) -> Fit {
        Fit {
            score: self.classifier.score(hypothesis),
            hog_distance: self.gradients.distance(hypothesis),
            response: self.window.as_ref().map(|window| window.cues.place.response(&hypothesis.full)),
        }
    }

    /// Tells the cues that weigh themselves where the estimate is, before anything learns it.
    pub fn credit(&mut self, full: &Rect) {
        if let Some(window) = &mut self.window {
            window.cues.place.credit(full);
        }
    }

    /// How far the place filters' last peaks stand above the rest of the window, in standard deviations of the rest.
    pub fn peak_sharpness(&self) -> Option<f64> {
        self.window.as_ref().map(|window| window.cues.place.sharpness())
    }

    /// The two halves of learning, which do not touch each other: what looks at the part, and what looks over the window.
    pub fn split(&mut self) -> (PartCues<'_>, Option<Learner<'_>>) {
        let Self { classifier, gradients, window } = self;
        (PartCues { classifier, gradients }, window.as_mut().map(Learner))
    }
}

/// The cues that look at the part.
pub(super) struct PartCues<'a> {
    classifier: &'a mut Classifier,
    gradients: &'a mut Gradients,
}

impl PartCues<'_> {
    /// Trains the classifier on a lesson.
    pub fn learn<R: Rng + ?Sized>(&mut self, lesson: &Lesson<'_>, rng: &mut R) {
        self.classifier.train(lesson, rng);
    }

    /// Lets the HOG template follow the part.
    pub fn age_template(&mut self, integrals: &RegionIntegrals, part: Rect) {
        self.gradients.age(integrals, &integrals.to_region(part));
    }
}

/// The cues that look over the window, when they learn.
pub(super) struct Learner<'a>(&'a mut Window);

impl Learner<'_> {
    /// Learns that the target has that whole box in the frame last seen.
    pub fn learn(&mut self, frame: &FrameView<'_>, full: Rect) {
        let Window { view, cues, .. } = &mut *self.0;
        view.learn(frame, full);
        let view = &*view;
        for_each(cues.each_mut().as_mut_slice(), 1, |_, cue| cue.learn(view, full));
    }
}

#[cfg(test)]
mod tests;
