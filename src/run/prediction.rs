//! Boxes for frames that the tracker did not get: the velocity between the last two that it did get goes on. Nothing is used
//! that is known only later.

use crate::{
    geometry::Rect,
    tracker::{Estimate, Status},
};

/// Largest change of a side by prediction, as a factor.
const LARGEST_GROWTH: f64 = 1.5;

/// Remembers the tracker's last answers.
#[derive(Debug, Default)]
pub(super) struct Predictor {
    /// The newest first, each with its frame's number.
    answers: [Option<(usize, Estimate)>; 3],
}

impl Predictor {
    /// Takes an answer of the tracker.
    pub fn learn(&mut self, frame: usize, estimate: &Estimate) {
        self.answers.rotate_right(1);
        self.answers[0] = Some((frame, estimate.clone()));
    }

    /// What a later frame holds, with the status and confidence of the last answer; without the newest answer if that is
    /// still pending. `None` before the first answer.
    pub fn predict(&self, frame: usize, pending: bool) -> Option<Estimate> {
        let mut known = self.answers.iter().skip(usize::from(pending)).flatten();
        let (last_frame, last) = known.next()?;
        let mut predicted =
            Estimate::new(last.box_in_frame, last.part_in_frame, last.confidence, last.status);
        predicted.covariance = last.covariance;
        if let Some((before_frame, before)) = known.next()
            && last.status != Status::Lost
            && before.status != Status::Lost
        {
            let steps = (frame - last_frame) as f64 / (last_frame - before_frame) as f64;
            predicted.box_in_frame = extrapolate(before.box_in_frame, last.box_in_frame, steps);
            predicted.part_in_frame = extrapolate(before.part_in_frame, last.part_in_frame, steps);
        }
        Some(predicted)
    }
}

/// Where the step from `before` to `last`, taken `steps` times more, leads: centre and sides change at a constant velocity.
fn extrapolate(before: Rect, last: Rect, steps: f64) -> Rect {
    let side = |before: f64, last: f64| {
        (last + steps * (last - before)).clamp(last / LARGEST_GROWTH, last * LARGEST_GROWTH)
    };
    let (w, h) = (side(before.w, last.w), side(before.h, last.h));
    let ((x0, y0), (x1, y1)) = (before.centre(), last.centre());
    Rect::new(x1 + steps * (x1 - x0) - w / 2.0, y1 + steps * (y1 - y0) - h / 2.0, w, h)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(x: f64, w: f64, status: Status) -> Estimate {
        let full = Rect::new(x, 10.0, w, 2.0 * w);
        Estimate::new(full, Rect { h: w, ..full }, 0.8, status)
    }

    fn predicted(answers: &[(usize, f64, Status)], frame: usize, pending: bool) -> Estimate {
        let mut predictor = Predictor::default();
        for &(frame, x, status) in answers {
            predictor.learn(frame, &answer(x, 20.0, status));
        }
        predictor.predict(frame, pending).unwrap()
    }

    #[test]
    fn the_last_velocity_goes_on_from_the_last_answer() {
        use Status::{Tracking, Uncertain};
        let answers = [(0, 90.0, Tracking), (3, 100.0, Tracking), (5, 106.0, Uncertain)];
        let estimate = predicted(&answers, 8, false);
        assert_eq!(estimate.box_in_frame, Rect::new(115.0, 10.0, 20.0, 40.0));
        assert_eq!(estimate.part_in_frame, Rect::new(115.0, 10.0, 20.0, 20.0));
        assert_eq!((estimate.status, estimate.confidence), (Uncertain, 0.8));
        assert_eq!(estimate.effective_sample_size, 0.0, "no particle was weighed");
    }

    #[test]
    fn a_pending_answer_is_not_used() {
        use Status::Tracking;
        let answers = [(0, 90.0, Tracking), (3, 96.0, Tracking), (5, 700.0, Status::Lost)];
        let estimate = predicted(&answers, 6, true);
        assert_eq!((estimate.box_in_frame.x, estimate.status), (102.0, Tracking));
        assert_eq!(
            predicted(&answers[..2], 6, true).box_in_frame.x,
            90.0,
            "one known answer has no velocity"
        );
        assert!(Predictor::default().predict(1, false).is_none());
    }

    #[test]
    fn a_lost_target_stays_where_it_was_last_thought_to_be() {
        let answers = [(0, 90.0, Status::Tracking), (1, 100.0, Status::Lost)];
        assert_eq!(predicted(&answers, 3, false).box_in_frame.x, 100.0);
        let answers = [(0, 90.0, Status::Lost), (1, 100.0, Status::Tracking)];
        assert_eq!(predicted(&answers, 3, false).box_in_frame.x, 100.0);
    }

    #[test]
    fn sides_stay_positive_and_grow_about_the_centre() {
        let shrinking = extrapolate(Rect::new(0.0, 0.0, 30.0, 30.0), Rect::new(10.0, 10.0, 10.0, 10.0), 9.0);
        assert!(shrinking.is_proper() && shrinking.centre() == (15.0, 15.0), "{shrinking:?}");
        let growing = extrapolate(Rect::new(1.0, 1.0, 10.0, 10.0), Rect::new(0.0, 0.0, 12.0, 12.0), 2.0);
        assert_eq!(growing, Rect::new(-2.0, -2.0, 16.0, 16.0));
    }
}
