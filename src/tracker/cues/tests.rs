use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::{
    features::region::SearchRegion,
    frame::{Frame, PixelFormat},
    geometry::Region,
};

const FULL: Rect = Rect { x: 60.0, y: 40.0, w: 24.0, h: 48.0 };
const SIZE: (usize, usize) = (160, 130);

/// A figure of red stripes on a texture without red.
fn scene(full: Rect) -> Frame {
    let (width, height) = SIZE;
    let mut data = Vec::with_capacity(3 * width * height);
    for y in 0..height {
        for x in 0..width {
            let (u, v) = ((x as f64 + 0.5 - full.x) / full.w, (y as f64 + 0.5 - full.y) / full.h);
            let noise = ((x * 7919 + y * 104_729) % 61) as u8;
            let inside = (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v);
            let stripe = ((v * 6.0) as usize).is_multiple_of(2) || u < 0.3;
            data.extend(match (inside, stripe) {
                (false, _) => [20 + noise / 4, 90 + noise, 110 + noise / 2],
                (true, true) => [210, 40 + noise / 4, 40],
                (true, false) => [120, 20, 90 + noise / 4],
            });
        }
    }
    Frame::new(data, width, height, PixelFormat::Rgb).unwrap()
}

struct Setting {
    frame: Frame,
    integrals: RegionIntegrals,
    parameters: Parameters,
    cues: Cues,
}

/// Cues of a preset that have learnt the figure.
fn setting(preset: &str) -> Setting {
    let parameters = Parameters::preset(preset).unwrap();
    let frame = scene(FULL);
    let mut integrals = RegionIntegrals::default();
    let (width, height) = SIZE;
    integrals.compute(&frame.view(), SearchRegion { x: 0, y: 0, width, height, step: 1 });
    let part = parameters.region.part_from_full(FULL);
    let template = integrals.to_region(part);
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let (w, h) = (f64::from(template.w), f64::from(template.h));
    let pool = HaarFeature::random_pool(parameters.feature_pool, w, h, 3, &mut rng);
    let mut cues = Cues::new(&parameters, pool, Hog::of(&integrals, &template), FULL);
    cues.see(&frame.view(), FULL);
    let (mut of_part, of_window) = cues.split();
    of_part.learn(&Lesson { integrals: &integrals, part, others: &[], counts: (30, 60) }, &mut rng);
    if let Some(mut of_window) = of_window {
        of_window.learn(&frame.view(), FULL);
    }
    cues.see(&frame.view(), FULL);
    cues.look(&FULL);
    cues.look_closer(&FULL);
    Setting { frame, integrals, parameters, cues }
}

impl Setting {
    fn hypothesis(&self, full: Rect) -> Hypothesis<'_> {
        self.cues.hypothesis(&self.integrals, self.parameters.region.part_from_full(full), full)
    }

    /// What each cue says of a whole box.
    fn terms(&self, full: Rect) -> Vec<f64> {
        let hypothesis = self.hypothesis(full);
        let mut cues: Vec<&dyn Cue> = vec![&self.cues.classifier, &self.cues.gradients];
        cues.extend(self.cues.window.iter().flat_map(|window| window.cues.each()));
        cues.iter().map(|cue| cue.log_likelihood(&hypothesis)).collect()
    }

    fn total(&self, full: Rect) -> f64 {
        self.cues.log_likelihood(&self.hypothesis(full))
    }
}

fn grown(full: Rect, scale: f64) -> Rect {
    let (x, y) = full.centre();
    Rect::new(x - scale * full.w / 2.0, y - scale * full.h / 2.0, scale * full.w, scale * full.h)
}

#[test]
fn every_cue_prefers_the_target_and_the_likelihood_is_their_sum() {
    for (preset, cues) in [("default", 5), ("paper", 2)] {
        let setting = setting(preset);
        let at_target = setting.terms(FULL);
        assert_eq!(at_target.len(), cues);
        let beside = FULL.translated(-20.0, 10.0);
        let larger = grown(FULL, 1.2);
        for (cue, at_target) in at_target.iter().enumerate() {
            // The size filter, the fourth, looks at sizes only.
            let elsewhere = if cue == 3 { larger } else { beside };
            let other = setting.terms(elsewhere)[cue];
            assert!(at_target - other > 1.0, "{preset}, cue {cue}: {at_target} there, {other} elsewhere");
        }
        for full in [FULL, beside, larger, FULL.translated(3.0, -2.0)] {
            let sum: f64 = setting.terms(full).iter().sum();
            assert!((setting.total(full) - sum).abs() < 1e-9);
        }
    }
}

#[test]
fn the_cues_over_the_window_find_a_target_that_moved_and_name_its_double() {
    let mut setting = setting("default");
    let moved = FULL.translated(9.0, -6.0);
    let frame = scene(moved);
    setting.cues.see(&frame.view(), FULL);
    setting.cues.look(&FULL);
    let found = setting.cues.found(&FULL).unwrap();
    assert!(found.centre_distance(&moved) < 2.0, "{found:?}");
    assert_eq!((found.w, found.h), (FULL.w, FULL.h));
    assert!(setting.cues.answered_elsewhere(found, 0.4).all(|other| other.overlap(&found) < 0.4));
    // Asked about a box elsewhere, the target is among the others.
    let elsewhere = moved.translated(-30.0, 0.0);
    assert!(setting.cues.answered_elsewhere(elsewhere, 0.4).any(|other| other.overlap(&moved) > 0.7));
}

#[test]
fn a_hard_negative_lowers_the_score_of_what_it_shows() {
    let mut setting = setting("paper");
    // A copy of the figure's place: its stripes seen one stripe lower.
    let other = setting.parameters.region.part_from_full(FULL.translated(0.0, 16.0));
    let part = setting.parameters.region.part_from_full(FULL);
    let score = |setting: &Setting| setting.cues.fit(&setting.hypothesis(FULL.translated(0.0, 16.0))).score;
    let before = score(&setting);
    let Setting { cues, integrals, .. } = &mut setting;
    for seed in 0..4 {
        let lesson = Lesson { integrals, part, others: &[other], counts: (10, 0) };
        cues.split().0.learn(&lesson, &mut ChaCha8Rng::seed_from_u64(seed));
    }
    let after = score(&setting);
    assert!(after < before, "{before} {after}");
    assert!(setting.cues.fit(&setting.hypothesis(FULL)).score > after + 5.0);
}

#[test]
fn without_cues_over_a_window_nothing_is_found_by_them() {
    let setting = setting("paper");
    assert!(!setting.cues.look_over_window() && setting.cues.found(&FULL).is_none());
    assert_eq!(setting.cues.answered_elsewhere(FULL, 1.0).count(), 0);
    assert_eq!(setting.parameters.region, Region::Part);
    assert_eq!(setting.frame.view().width(), SIZE.0);
}
