//! Step 3f: looking for a target that was lost (the plan is in `search.rs`).

use crate::{features::region::RegionIntegrals, frame::FrameView, geometry::Rect};

use super::{
    super::{
        confidence::{self, Belief, status},
        estimate::Estimate,
        parameters::CheckedParameters,
        search::{SearchExtent, Suspect},
    },
    Target, search_region,
};

/// Places in a window that are looked at closer.
const SUSPECTS: usize = 2;
/// The least merit of a suspect: its probability from the frame alone times its likeness.
const MERIT: f64 = 0.55;

impl Target {
    /// Looks for the target if it is not seen, and goes where it was found.
    pub(super) fn search(
        &mut self,
        parameters: &CheckedParameters,
        frame: &FrameView<'_>,
        integrals: &mut RegionIntegrals,
    ) {
        self.searched.clear();
        let Estimate { box_in_frame: full, status, evidence, .. } = self.estimate;
        let (Some(window), Some(evidence)) = (self.cues.window(), evidence) else { return };
        if parameters.search == SearchExtent::Off || !self.search.goes_on(&full, status) {
            return;
        }
        let mut best =
            Suspect { full, merit: MERIT.max(confidence::of_frame(&evidence) * evidence.likeness) };
        let mut is_met = self.find_better(parameters, frame, integrals, full, &mut best);
        if parameters.search == SearchExtent::Frame {
            for place in self.places(frame, window.w).into_iter().flatten() {
                self.cues.see(frame, place);
                self.cues.look(&place);
                self.searched.extend(self.cues.window());
                is_met |= self.find_better(parameters, frame, integrals, place, &mut best);
            }
        }
        if self.search.meets(is_met.then_some(best.full)) {
            self.resume(parameters, frame, integrals, best.full);
        }
    }

    /// Where to look in this frame: whole boxes in the middles of windows.
    fn places(&mut self, frame: &FrameView<'_>, window: f64) -> [Option<Rect>; 2] {
        match self.search.suspect() {
            Some(suspect) => [Some(suspect), None],
            None => {
                let colours = self.cues.foreground_model();
                let by_colour = colours.and_then(|model| self.search.best_by_colour(frame, model, window));
                [by_colour, Some(self.search.next_of_tour(frame, window))]
            }
        }
    }

    /// Whether the cues answer in the window last looked over, around a whole box, to a place of more merit than the best; it is
    /// the best then.
    fn find_better(
        &mut self,
        parameters: &CheckedParameters,
        frame: &FrameView<'_>,
        integrals: &mut RegionIntegrals,
        around: Rect,
        best: &mut Suspect,
    ) -> bool {
        let is_inside = |full: &Rect| {
            let (x, y) = full.centre();
            (0.0..frame.width() as f64).contains(&x) && (0.0..frame.height() as f64).contains(&y)
        };
        let mut is_better = false;
        let answers: [Option<Rect>; SUSPECTS] = {
            let mut answers = self.cues.answers(around);
            std::array::from_fn(|_| answers.next())
        };
        for full in answers.into_iter().flatten().filter(is_inside) {
            let part = parameters.region.part_from_full(full);
            integrals.compute(frame, search_region(part, &part, parameters.max_part_cells));
            let (_, evidence) = self.evidence(parameters, frame, integrals, part, full);
            let merit = confidence::of_frame(&evidence) * evidence.likeness;
            if merit > best.merit {
                (*best, is_better) = (Suspect { full, merit }, true);
            }
        }
        is_better
    }

    /// The target is there again: particles and estimate begin anew.
    fn resume(
        &mut self,
        parameters: &CheckedParameters,
        frame: &FrameView<'_>,
        integrals: &mut RegionIntegrals,
        full: Rect,
    ) {
        let part = parameters.region.part_from_full(full);
        integrals.compute(frame, search_region(part, &part, parameters.max_part_cells));
        let (_, mut evidence) = self.evidence(parameters, frame, integrals, part, full);
        let Belief { confidence, .. } = self.judge.believe(&mut evidence);
        self.estimate = Estimate::new(full, part, confidence, status(confidence));
        self.estimate.evidence = Some(evidence);
        // As in the first frame: the particles begin anew.
        self.estimate.effective_sample_size = parameters.particles as f64;
        self.restart_sets(parameters, &part);
    }
}
