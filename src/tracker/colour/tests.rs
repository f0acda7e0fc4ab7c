use super::*;
use crate::{
    frame::{Frame, PixelFormat},
    tracker::Status,
};

const WIDTH: usize = 200;
const HEIGHT: usize = 90;
const SIZE: (f64, f64) = (16.0, 32.0);

/// A person: red above, blue below, with some texture.
fn person(x: usize, y: usize) -> [u8; 3] {
    let texture = ((x * 5 + y * 3) % 24) as u8;
    if y < 16 { [200 + texture, 40, 30 + texture] } else { [30, 50 + texture, 190 + texture] }
}

/// Grey-green ground, and persons with their top left corners at `places`, later ones in front.
fn scene(places: &[(f64, f64)], brightness: f64) -> Frame {
    let mut data = Vec::new();
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let texture = ((x * 13 + y * 7) % 40) as u8;
            let mut colour = [90 + texture, 110 + texture, 80 + texture];
            for place in places {
                let (left, top) = (place.0.round() as usize, place.1.round() as usize);
                if (left..left + 16).contains(&x) && (top..top + 32).contains(&y) {
                    colour = person(x - left, y - top);
                }
            }
            data.extend(colour.map(|level| (f64::from(level) * brightness).min(255.0) as u8));
        }
    }
    Frame::new(data, WIDTH, HEIGHT, PixelFormat::Rgb).unwrap()
}

fn at(place: (f64, f64)) -> Rect {
    Rect::new(place.0, place.1, SIZE.0, SIZE.1)
}

fn walk(i: usize) -> (f64, f64) {
    (20.0 + 2.5 * i as f64, 30.0 + 6.0 * (i as f64 / 8.0).sin())
}

/// The lowest overlap on a walk of 40 frames.
fn worst_overlap(parameters: ColourParameters, brightness: impl Fn(usize) -> f64) -> f64 {
    let mut tracker = ColourTracker::new(parameters.check().unwrap());
    tracker.init(scene(&[walk(0)], 1.0).view(), at(walk(0))).unwrap();
    let overlaps = (1..40).map(|i| {
        let found = tracker.update(scene(&[walk(i)], brightness(i)).view()).unwrap();
        found.box_in_frame.overlap(&at(walk(i)))
    });
    overlaps.fold(1.0, f64::min)
}

#[test]
fn every_scheme_and_variant_follows_a_walk() {
    use ColourResampling::{Multinomial, Regularised, Residual, Stratified, Systematic};
    for resampling in [Multinomial, Stratified, Systematic, Residual, Regularised] {
        let worst = worst_overlap(ColourParameters { resampling, ..Default::default() }, |_| 1.0);
        assert!(worst > 0.5, "{resampling:?}: {worst}");
    }
    for velocity in [VelocityModel::None, VelocityModel::Window] {
        let worst = worst_overlap(ColourParameters { velocity, ..Default::default() }, |_| 1.0);
        assert!(worst > 0.5, "{velocity:?}: {worst}");
    }
    for halves in [Halves::Mean, Halves::Whole] {
        let parameters = ColourParameters { halves, gradient: true, noise_w: 0.01, ..Default::default() };
        let worst = worst_overlap(parameters, |_| 1.0);
        assert!(worst > 0.4, "{halves:?}: {worst}");
    }
}

#[test]
fn without_resampling_the_weights_gather_on_few_particles() {
    let mut sizes = [ColourResampling::None, ColourResampling::Systematic].map(|resampling| {
        let parameters = ColourParameters { resampling, ..Default::default() };
        let mut tracker = ColourTracker::new(parameters.check().unwrap());
        tracker.init(scene(&[walk(0)], 1.0).view(), at(walk(0))).unwrap();
        let sizes = (1..30).map(|i| tracker.update(scene(&[walk(i)], 1.0).view()).unwrap());
        sizes.map(|estimate| estimate.effective_sample_size).last().unwrap()
    });
    sizes[0] *= 5.0;
    assert!(sizes[0] < sizes[1], "{sizes:?}");
}

#[test]
fn brightness_is_compensated() {
    let dimmed = |i: usize| if i < 10 { 1.0 } else { 0.7 };
    let confidence = |brightness| {
        let parameters = ColourParameters { brightness, ..Default::default() };
        let mut tracker = ColourTracker::new(parameters.check().unwrap());
        tracker.init(scene(&[walk(0)], 1.0).view(), at(walk(0))).unwrap();
        (1..20)
            .map(|i| tracker.update(scene(&[walk(i)], dimmed(i)).view()).unwrap().confidence)
            .last()
            .unwrap()
    };
    assert!(confidence(true) > confidence(false) + 0.2);
    let parameters = ColourParameters { brightness: true, ..Default::default() };
    assert!(worst_overlap(parameters, dimmed) > 0.5);
}

#[test]
fn with_foreground_only_what_moves_counts() {
    // A standing look-alike is background: it cannot catch the target that passes before it.
    let decoy = (140.0, 30.0);
    let place = |i: usize| (4.0 + 4.0 * i as f64, 34.0);
    let parameters = ColourParameters { foreground: true, foreground_after: 20, ..Default::default() };
    let mut tracker = ColourTracker::new(parameters.check().unwrap());
    tracker.init(scene(&[decoy, place(0)], 1.0).view(), at(place(0))).unwrap();
    let mut overlaps = Vec::new();
    for i in 1..45 {
        let found = tracker.update(scene(&[decoy, place(i)], 1.0).view()).unwrap();
        overlaps.push(found.box_in_frame.overlap(&at(place(i))));
    }
    assert!(overlaps[43] > 0.4, "{overlaps:?}");
    // Gone, it leaves nothing that counts, whatever the ground looks like.
    let gone = tracker.update(scene(&[decoy], 1.0).view()).unwrap();
    assert_eq!((gone.status, gone.confidence), (Status::Lost, 0.0));
}

#[test]
fn two_look_alikes_that_cross_keep_their_names() {
    // One from the left and further up, so behind; one from the right.
    let places = |i: usize| [(20.0 + 3.0 * i as f64, 30.0), (150.0 - 3.0 * i as f64, 34.0)];
    for seed in 1..=5 {
        // Steps as wide as the default's would reach the other one, which looks the same.
        let parameters = ColourParameters { seed, noise_x: 0.2, noise_y: 0.1, ..Default::default() };
        let mut flock = ColourFlock::new(parameters.check().unwrap());
        flock.init(scene(&places(0), 1.0).view(), &places(0).map(at)).unwrap();
        let (mut hidden, mut unsure) = (Vec::new(), false);
        for i in 1..44 {
            let found = flock.update(scene(&places(i), 1.0).view()).unwrap();
            if !flock.hidden_pairs().is_empty() {
                assert_eq!(flock.hidden_pairs(), [(1, 0)], "the nearer one is in front");
                hidden.push(i);
            }
            assert!(found[1].box_in_frame.overlap(&at(places(i)[1])) > 0.4, "seed {seed}, frame {i}: front");
            if i > 32 {
                let overlap = found[0].box_in_frame.overlap(&at(places(i)[0]));
                assert!(overlap > 0.4, "seed {seed}, frame {i}: behind {overlap}");
            }
            unsure |= (20..=24).contains(&i) && found[0].status != Status::Tracking;
        }
        assert!(unsure, "seed {seed}: nearly wholly hidden");
        // They overlap for 32 / 6 frames, give or take an error of a box.
        assert!((4..=9).contains(&hidden.len()), "{hidden:?}");
    }
}

#[test]
fn targets_of_other_colours_do_not_hide_each_other() {
    let parameters = ColourParameters { occlusion_correlation: 1.1, ..Default::default() };
    let places = [(20.0, 30.0), (26.0, 34.0)];
    let mut flock = ColourFlock::new(parameters.check().unwrap());
    flock.init(scene(&places, 1.0).view(), &places.map(at)).unwrap();
    flock.update(scene(&places, 1.0).view()).unwrap();
    assert_eq!(flock.hidden_pairs(), []);
}

#[cfg(feature = "threads")]
#[test]
fn threads_change_nothing_and_bad_calls_are_typed_errors() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let parameters = ColourParameters { foreground: true, foreground_after: 3, ..Default::default() };
        let mut tracker = ColourTracker::with_pool(parameters.check().unwrap(), std::sync::Arc::new(pool));
        tracker.init(scene(&[walk(0)], 1.0).view(), at(walk(0))).unwrap();
        (1..8).map(|i| tracker.update(scene(&[walk(i)], 1.0).view()).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(run(1), run(3));
    let mut flock = ColourFlock::new(CheckedColourParameters::default());
    let frame = scene(&[], 1.0);
    assert_eq!(flock.update(frame.view()), Err(TrackError::NotStarted));
    assert!(matches!(flock.init(frame.view(), &[]), Err(TrackError::TargetCount { given: 0, most: 32 })));
    let many = [at((5.0, 5.0)); 33];
    assert!(flock.init(frame.view(), &many).unwrap_err().to_string().contains("33 targets"));
    flock.init(frame.view(), &many[..2]).unwrap();
    let other = Frame::new(vec![0; 12], 4, 3, PixelFormat::Gray).unwrap();
    assert!(matches!(flock.update(other.view()), Err(TrackError::SizeChanged { width: 4, .. })));
}
