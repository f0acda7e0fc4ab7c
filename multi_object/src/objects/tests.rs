//! The life of objects in drawn frames.

use infopart::{
    frame::{FrameView, PixelFormat},
    geometry::Rect,
};

use super::{ObjectParameters, ObjectTracker};
use crate::{
    motion::{ConstantTurn, ConstantVelocity, FilterKind},
    tracking::TrackState,
};

const WIDTH: usize = 240;
const HEIGHT: usize = 120;

/// A textured wall with coloured objects before it.
fn picture(objects: &[(Rect, [u8; 3])]) -> Vec<u8> {
    (0..WIDTH * HEIGHT)
        .flat_map(|i| {
            let (x, y) = (i % WIDTH, i / WIDTH);
            let inside = |area: &Rect| {
                (area.x..area.right()).contains(&(x as f64)) && (area.y..area.bottom()).contains(&(y as f64))
            };
            let wall = (80 + (x * 7 + y * 13) % 20) as u8;
            objects.iter().rev().find(|(area, _)| inside(area)).map_or([wall; 3], |one| one.1)
        })
        .collect()
}

fn tracker() -> ObjectTracker<ConstantVelocity, 4> {
    let mut tracker = ObjectTracker::new(ObjectParameters::default().check().unwrap());
    for _ in 0..20 {
        tracker.learn(view(&picture(&[]))).unwrap();
    }
    tracker
}

fn view(pixels: &[u8]) -> FrameView<'_> {
    FrameView::new(pixels, WIDTH, HEIGHT, 3 * WIDTH, PixelFormat::Rgb).unwrap()
}

fn established(states: &[TrackState]) -> Vec<TrackState> {
    states.iter().filter(|state| state.is_established).copied().collect()
}

const RED: [u8; 3] = [220, 40, 40];
const BLUE: [u8; 3] = [40, 60, 230];

fn walker(left: f64) -> Rect {
    Rect::new(left, 30.0, 20.0, 60.0)
}

#[test]
fn a_walker_is_one_track_with_every_filter_and_its_box_fits() {
    fn run<D: crate::motion::CentreModel<N>, const N: usize>(filter: FilterKind) {
        let parameters = ObjectParameters { filter, ..ObjectParameters::default() };
        let mut tracker = ObjectTracker::<D, N>::new(parameters.check().unwrap());
        (0..20).for_each(|_| tracker.learn(view(&picture(&[]))).unwrap());
        for frame in 0..40 {
            let truth = walker(20.0 + 3.0 * f64::from(frame));
            let states = established(tracker.update(view(&picture(&[(truth, RED)]))).unwrap());
            if frame >= 10 {
                assert_eq!(states.len(), 1, "{filter:?}, frame {frame}");
                assert!(
                    states[0].box_in_frame.overlap(&truth) > 0.7,
                    "{filter:?}, frame {frame}: {states:?}"
                );
            }
        }
        assert!(tracker.mean_prediction_time().is_some());
    }
    FilterKind::ALL.into_iter().for_each(run::<ConstantVelocity, 4>);
    [FilterKind::Ekf, FilterKind::Ukf, FilterKind::Pf].into_iter().for_each(run::<ConstantTurn, 5>);
}

#[test]
fn two_who_pass_each_other_keep_their_names_and_sizes() {
    let mut tracker = tracker();
    let mut names: Vec<(u64, u64)> = Vec::new();
    for frame in 0..60 {
        let t = f64::from(frame);
        let (red, blue) = (walker(20.0 + 3.0 * t), walker(200.0 - 3.0 * t));
        let states = established(tracker.update(view(&picture(&[(red, RED), (blue, BLUE)]))).unwrap());
        let name_of = |truth: &Rect| {
            let best = states
                .iter()
                .max_by(|a, b| a.box_in_frame.overlap(truth).total_cmp(&b.box_in_frame.overlap(truth)));
            best.map(|state| (state.identity, state.box_in_frame))
        };
        if !(15..50).contains(&frame) || (24..37).contains(&frame) {
            continue;
        }
        let ((a, box_a), (b, box_b)) = (name_of(&red).unwrap(), name_of(&blue).unwrap());
        assert!((14.0..30.0).contains(&box_a.w) && (14.0..30.0).contains(&box_b.w), "{frame}: {states:?}");
        names.push((a, b));
    }
    names.dedup();
    assert_eq!(names.len(), 1, "{names:?}");
    assert_ne!(names[0].0, names[0].1);
}

#[test]
fn one_who_stops_is_not_swallowed_by_the_background() {
    let mut tracker = tracker();
    for frame in 0..400 {
        let truth = walker(20.0 + 3.0 * f64::from(frame.min(30)));
        let states = established(tracker.update(view(&picture(&[(truth, RED)]))).unwrap());
        if frame > 10 {
            assert_eq!(states.len(), 1, "frame {frame}");
            assert_eq!(states[0].identity, 1);
            assert!(states[0].detected_in_frame.is_some());
        }
    }
}

#[test]
fn the_ghost_of_who_stood_there_is_taken_over_and_is_no_object() {
    let mut tracker = ObjectTracker::<ConstantVelocity, 4>::new(ObjectParameters::default().check().unwrap());
    (0..40).for_each(|_| tracker.learn(view(&picture(&[(walker(60.0), RED)]))).unwrap());
    let mut seen = Vec::new();
    for frame in 0..80 {
        // He goes; where he stood the wall is seen for the first time.
        let truth = walker(60.0 + 4.0 * f64::from(frame.min(35)));
        let states = established(tracker.update(view(&picture(&[(truth, RED)]))).unwrap());
        seen.push(states.len());
        let at_ghost = states.iter().filter(|one| one.box_in_frame.overlap(&walker(60.0)) > 0.5).count();
        assert!(frame < 10 || at_ghost == 0, "frame {frame}: {states:?}");
    }
    assert_eq!(seen[40..], [1; 40]);
    let ghost = Rect::new(58.0, 28.0, 24.0, 64.0);
    assert!(tracker.detections().iter().all(|area| area.overlap(&ghost) < 0.1), "{:?}", tracker.detections());
}

#[test]
fn nothing_outside_the_regions_of_interest_is_an_object() {
    let regions_in_frame = vec![Rect::new(120.0, 0.0, 120.0, 120.0)];
    let parameters = ObjectParameters { regions_in_frame, ..ObjectParameters::default() };
    let mut tracker = ObjectTracker::<ConstantVelocity, 4>::new(parameters.check().unwrap());
    (0..20).for_each(|_| tracker.learn(view(&picture(&[]))).unwrap());
    for frame in 0..20 {
        let t = f64::from(frame);
        tracker
            .update(view(&picture(&[(walker(20.0 + 3.0 * t), RED), (walker(150.0 + 3.0 * t), BLUE)])))
            .unwrap();
        assert_eq!(tracker.detections().len(), 1, "frame {frame}");
        assert!(tracker.detections()[0].x >= 120.0);
    }
}

#[test]
fn parameters_and_frames_that_cannot_be_are_refused() {
    let mut parameters = ObjectParameters::default();
    parameters.background.noise_sigma = -1.0;
    assert!(parameters.check().unwrap_err().to_string().contains("`noise_sigma` is -1"));
    let mut tracker = tracker();
    let pixels = vec![0; 64 * 48];
    let other = FrameView::new(&pixels, 64, 48, 64, PixelFormat::Gray).unwrap();
    assert!(tracker.update(other).unwrap_err().to_string().contains("the frame is 64x48"));
}
