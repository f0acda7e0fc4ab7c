//! The life of a track.

use infopart::geometry::Rect;

use super::{
    BoxFilterParameters, BoxNoise, BoxTracker, ByteParameters, ByteTracker, OcParameters, OcTracker,
    Reported, ScoredBox, Sort, SortParameters,
};
use crate::{camera_motion::CameraMotion, motion::FilterKind};

const HERE: Rect = Rect::new(100.0, 50.0, 20.0, 40.0);

/// What is reported in each frame of detections.
fn run(frames: &[&[Rect]], parameters: SortParameters) -> Vec<Vec<u64>> {
    let mut sort = Sort::new(parameters);
    let identities = |reported: &[Reported]| reported.iter().map(|one| one.identity).collect();
    frames.iter().map(|seen| identities(sort.update(seen, None).unwrap())).collect()
}

#[test]
fn a_late_track_is_reported_at_its_third_update_after_the_first_sight() {
    let none: &[Rect] = &[];
    let here: &[Rect] = &[HERE];
    let found = run(&[none, none, none, here, here, here, here, here], SortParameters::default());
    assert_eq!(found, [vec![], vec![], vec![], vec![], vec![], vec![], vec![1], vec![1]]);
}

#[test]
fn one_missed_frame_is_survived_but_starts_the_streak_again_and_two_end_the_track() {
    let none: &[Rect] = &[];
    let here: &[Rect] = &[HERE];
    let one_gap = run(&[here, here, here, here, none, here, here, here], SortParameters::default());
    assert_eq!(one_gap, [vec![1], vec![1], vec![1], vec![1], vec![], vec![], vec![], vec![1]]);
    let two_gaps = run(&[here, here, here, none, none, here, here, here, here], SortParameters::default());
    assert_eq!(two_gaps.last().unwrap(), &[2]);
    let patient = SortParameters { max_age: 2, ..SortParameters::default() };
    assert_eq!(run(&[here, here, here, none, none, here, here, here], patient).last().unwrap(), &[1]);
}

#[test]
fn the_youngest_is_reported_first_and_a_shrinking_box_does_not_break_its_track() {
    let far = HERE.translated(300.0, 0.0);
    assert_eq!(run(&[&[HERE, far]], SortParameters::default()), [vec![2, 1]]);
    // The area falls by more than what will be left of it.
    let halves =
        [40.0, 20.0, 10.0, 5.0].map(|side| Rect::new(100.0 - side / 2.0, 100.0 - side / 2.0, side, side));
    let mut sort = Sort::new(SortParameters { min_overlap: 0.2, ..SortParameters::default() });
    for seen in halves {
        sort.update(&[seen], None).unwrap();
    }
    for _ in 0..2 {
        assert!(sort.update(&[], None).unwrap().is_empty());
    }
}

fn in_proportion(kind: FilterKind) -> BoxFilterParameters {
    BoxFilterParameters { kind, noise: BoxNoise::Proportional, ..BoxFilterParameters::default() }
}

#[test]
fn under_noise_in_proportion_every_filter_follows_a_walker() {
    for filter in FilterKind::ALL {
        let mut sort =
            Sort::new(SortParameters { filter: in_proportion(filter), ..SortParameters::default() });
        for frame in 0..40 {
            let seen = HERE.translated(2.0 * f64::from(frame), f64::from(frame));
            let reported = sort.update(&[seen], None).unwrap();
            assert_eq!(
                reported.iter().map(|one| one.identity).collect::<Vec<_>>(),
                [1],
                "{filter:?}, {frame}"
            );
            assert!(reported[0].tracked_box.overlap(&seen) > 0.7, "{filter:?}, {frame}: {reported:?}");
        }
    }
}

/// Two who stand still before a camera that pans by more than a box in one frame; who is told under which name.
fn names_after_a_pan(mut tracker: Box<dyn BoxTracker>, is_told: bool) -> Vec<(u64, Option<u32>, usize)> {
    let pan = CameraMotion { shift: [-35.0, 12.0], ..CameraMotion::NONE };
    let seen = |off: bool| {
        [(0.0, 5), (200.0, 6)].map(|(x, class)| {
            let area = HERE.translated(x, 0.0);
            let area = if off { pan.of_box(&area) } else { area };
            ScoredBox { area, confidence: 0.9, class: Some(class) }
        })
    };
    (0..6).for_each(|_| assert_eq!(tracker.track(&seen(false)).unwrap().len(), 2));
    if is_told {
        tracker.move_camera(&pan);
    }
    let mut names: Vec<_> = (0..4)
        .flat_map(|_| tracker.track(&seen(true)).unwrap().to_vec())
        .map(|one| (one.identity, one.class, one.detection))
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}

#[test]
fn what_is_remembered_moves_with_the_camera_under_every_method_and_filter() {
    let kept = [(1, Some(5), 0), (2, Some(6), 1)];
    for filter in FilterKind::ALL {
        let filter = in_proportion(filter);
        let trackers = || -> [Box<dyn BoxTracker>; 3] {
            [
                Box::new(Sort::new(SortParameters { filter, ..SortParameters::default() })),
                Box::new(ByteTracker::new(ByteParameters {
                    filter,
                    enlarged: 0.0,
                    ..ByteParameters::default()
                })),
                Box::new(OcTracker::new(OcParameters { filter, ..OcParameters::default() })),
            ]
        };
        for (method, tracker) in trackers().into_iter().enumerate() {
            assert_eq!(names_after_a_pan(tracker, true), kept, "{method}, {:?}", filter.kind);
        }
        for (method, tracker) in trackers().into_iter().enumerate() {
            assert_ne!(names_after_a_pan(tracker, false), kept, "{method}, {:?}", filter.kind);
        }
    }
}
