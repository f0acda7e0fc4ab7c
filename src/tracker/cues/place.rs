//! Correlation filters on the whole box, over place: beta times the mean of their responses at the hypothesis's centre.
//!
//! Steps:
//! 1. two filters look at the same window: one learns only the cells inside the box that are likely the target's own, which
//!    holds it when its surroundings change; the other learns it with what surrounds it, which holds it when somebody passes
//!    before it,
//! 2. each is credited with a running mean of what it answered at the estimate, before it learnt that frame,
//! 3. the mean response is weighted by a power of the credits,
//! 4. learning: in the first frame both, later in turns.

use crate::{
    correlation::{
        filter::{CorrelationFilter, FilterOptions},
        grid::CHANNELS,
        response::Peak,
        window::Window,
    },
    geometry::Rect,
};

use super::{Cue, Hypothesis, Parameters, WindowView};

/// How fast credits follow.
const CREDIT_RATE: f64 = 0.1;
/// The power of the credits that responses are weighted by.
const CREDIT_POWER: i32 = 6;
/// The least credit, so that no filter is left out for ever.
const LEAST_CREDIT: f64 = 0.01;

/// The filters and their weight.
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Place {
    members: Vec<Member>,
    /// beta.
    weight: f64,
    lessons: usize,
}

#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Member {
    filter: CorrelationFilter,
    /// Whether it learns the target's own cells only.
    confined: bool,
    /// In [0, 1] or a little above.
    credit: f64,
    /// Its weight in the mean response.
    share: f64,
    peak: Peak,
}

impl Place {
    pub fn new(parameters: &Parameters, full: &Rect) -> Self {
        let side = Window::around(full, parameters.correlation_window).side;
        let filters = [
            (parameters.correlation_support, parameters.correlation_own_cells),
            (parameters.correlation_surroundings, false),
        ];
        let count = parameters.correlation_filters;
        let member = |&(support, confined): &(f64, bool)| {
            let options = FilterOptions {
                side: WindowView::cells(parameters),
                label_sigma: parameters.correlation_label_sigma,
                temporal: parameters.correlation_temporal as f32,
                rounds: parameters.correlation_rounds,
                support,
            };
            Member {
                filter: CorrelationFilter::new(options, CHANNELS, full.w / side, full.h / side),
                confined,
                credit: 1.0,
                share: 1.0 / count as f64,
                peak: Peak { x: 0.0, y: 0.0, value: 1.0, sharpness: 1.0 },
            }
        };
        Self {
            members: filters[..count].iter().map(member).collect(),
            weight: parameters.correlation_weight,
            lessons: 0,
        }
    }

    /// How far the last look's peaks stand above the rest of the window, in standard deviations of the rest.
    pub fn sharpness(&self) -> f64 {
        self.members.iter().map(|member| member.share * f64::from(member.peak.sharpness)).sum()
    }

    /// The last look's mean response at the centre of a whole box, about 1 where the target is as learnt (step 3).
    pub fn response(&self, full: &Rect) -> f64 {
        self.members.iter().map(|member| member.share * member.answer(full)).sum()
    }

    /// Credits the filters with what they answered at the estimate (steps 2 and 3).
    pub fn credit(&mut self, full: &Rect) {
        for member in &mut self.members {
            member.credit += CREDIT_RATE * (member.answer(full).max(0.0) - member.credit);
        }
        let power = |member: &Member| member.credit.max(LEAST_CREDIT).powi(CREDIT_POWER);
        let total: f64 = self.members.iter().map(power).sum();
        for member in &mut self.members {
            member.share = power(member) / total;
        }
    }
}

impl Member {
    fn answer(&self, full: &Rect) -> f64 {
        let (x, y) = full.centre();
        f64::from(self.filter.response().at(x, y))
    }
}

impl Cue for Place {
    fn look(&mut self, view: &WindowView) {
        for member in &mut self.members {
            member.peak = member.filter.respond(view.spectra(), view.window()).peak();
        }
    }

    fn over_window(&self, _view: &WindowView, full: &Rect) -> f64 {
        self.weight * self.response(full)
    }

    fn log_likelihood(&self, hypothesis: &Hypothesis<'_>) -> f64 {
        self.weight * self.response(&hypothesis.full)
    }

    fn learn(&mut self, view: &WindowView, _full: Rect) {
        let (turn, count) = (self.lessons % self.members.len(), self.lessons);
        for (number, member) in self.members.iter_mut().enumerate() {
            if count == 0 || number == turn {
                member.filter.learn(view.spectra(), member.confined.then(|| view.own_cells()));
            }
        }
        self.lessons += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Frame, PixelFormat};

    const FULL: Rect = Rect { x: 40.0, y: 30.0, w: 20.0, h: 40.0 };

    /// A still texture about the target, or a flat one.
    fn frame(is_flat: bool) -> Frame {
        let level = |x: usize, y: usize| {
            let inside = (40..60).contains(&x) && (30..70).contains(&y);
            if is_flat && !inside { 90 } else { ((x * 7919 + y * 104_729) % 251) as u8 }
        };
        let pixels = (0..120 * 110).map(|i| level(i % 120, i / 120)).collect();
        Frame::new(pixels, 120, 110, PixelFormat::Gray).unwrap()
    }

    #[test]
    fn the_filter_that_answers_less_loses_weight_and_the_weights_sum_to_one() {
        let parameters = Parameters { correlation_surroundings: 3.0, ..Parameters::default() };
        let (mut place, mut view) = (Place::new(&parameters, &FULL), WindowView::new(&parameters, FULL));
        let first = frame(false);
        view.see(&first.view(), FULL);
        view.learn(&first.view(), FULL);
        place.learn(&view, FULL);
        // The surroundings are gone: the filter that learnt them answers less.
        let changed = frame(true);
        for _ in 0..20 {
            view.see(&changed.view(), FULL);
            place.look(&view);
            place.credit(&FULL);
        }
        let [own, wide] = [&place.members[0], &place.members[1]];
        assert!(own.answer(&FULL) > wide.answer(&FULL) && own.share > 0.6, "{} {}", own.share, wide.share);
        assert!((own.share + wide.share - 1.0).abs() < 1e-12);
        let mean = own.share * own.answer(&FULL) + wide.share * wide.answer(&FULL);
        assert!((place.response(&FULL) - mean).abs() < 1e-12);
    }
}
