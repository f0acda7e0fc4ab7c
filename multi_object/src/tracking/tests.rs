//! The life of a track of blobs.

use infopart::{
    frame::{FrameView, PixelFormat},
    geometry::Rect,
};

use super::{BlobTracker, Detector, TrackState, TrackingParameters, USUAL_MIN_AREA};
use crate::motion::{ConstantTurn, ConstantVelocity, FilterKind};

/// A walker of 20 x 40, 3 pixels a frame.
fn walker(frame: u32) -> Rect {
    Rect::new(50.0 + 3.0 * f64::from(frame), 80.0, 20.0, 40.0)
}

fn tracker(filter: FilterKind) -> BlobTracker<ConstantVelocity, 4> {
    BlobTracker::new(TrackingParameters { filter, ..TrackingParameters::default() }).unwrap()
}

#[test]
fn a_walker_keeps_its_identity_behind_a_tree_with_every_filter() {
    for filter in FilterKind::ALL {
        let mut tracker = tracker(filter);
        for frame in 0..60 {
            let hidden = (30..40).contains(&frame);
            let seen = if hidden { vec![] } else { vec![walker(frame)] };
            let states = tracker.update(&seen).unwrap();
            assert_eq!(states.len(), 1, "{filter:?}, frame {frame}");
            let TrackState { identity, box_in_frame, is_established, detected_in_frame, .. } = states[0];
            assert_eq!((identity, is_established, detected_in_frame.is_some()), (1, frame >= 7, !hidden));
            if frame > 20 {
                let off = box_in_frame.centre_distance(&walker(frame));
                assert!(off < if hidden { 15.0 } else { 10.0 }, "{filter:?}, frame {frame}: {off}");
            }
        }
    }
}

#[test]
fn invisible_for_twenty_frames_a_track_is_gone_and_a_flicker_goes_sooner() {
    let mut walking = tracker(FilterKind::Kalman);
    (0..20).for_each(|frame| assert_eq!(walking.update(&[walker(frame)]).unwrap().len(), 1));
    (0..19).for_each(|_| assert_eq!(walking.update(&[]).unwrap().len(), 1));
    assert_eq!(walking.update(&[]).unwrap().len(), 0);
    let mut flicker = tracker(FilterKind::Kalman);
    flicker.update(&[walker(0)]).unwrap();
    assert_eq!(flicker.update(&[]).unwrap().len(), 0);
}

#[test]
fn far_detections_start_tracks_and_predictions_have_the_size_of_the_detection_before() {
    let mut tracker: BlobTracker<ConstantTurn, 5> = BlobTracker::new(TrackingParameters::default()).unwrap();
    tracker.update(&[walker(0)]).unwrap();
    let grown = Rect { w: 30.0, ..walker(1) };
    let states = tracker.update(&[grown, walker(0).translated(400.0, 200.0)]).unwrap();
    assert_eq!(states.iter().map(|state| state.identity).collect::<Vec<_>>(), [1, 2]);
    assert_eq!(states[0].predicted_in_frame.unwrap().w, 20.0);
    assert_eq!((states[0].box_in_frame.w, states[0].detected_in_frame), (30.0, Some(grown)));
    assert_eq!(states[1].predicted_in_frame, None);
    assert!(tracker.mean_prediction_time().is_some());
}

#[test]
fn a_moving_camera_is_told_once_and_a_static_one_never() {
    let noise = |x: usize, y: usize| ((x * 7919 + y * 104_729) % 128 * 2) as u8;
    let warnings = |pixels_a_frame: usize| -> Vec<u64> {
        let mut detector = Detector::new(USUAL_MIN_AREA).unwrap();
        let frames = (0..80).map(|frame| -> Vec<u8> {
            (0..48 * 64).map(|i| noise(i % 64 + frame * pixels_a_frame, i / 64)).collect()
        });
        frames
            .filter_map(|pixels| {
                let view = FrameView::new(&pixels, 64, 48, 64, PixelFormat::Gray).unwrap();
                detector.detect(view).unwrap().1.map(|warning| warning.frames)
            })
            .collect()
    };
    assert!(warnings(0).is_empty());
    let told = warnings(5);
    assert_eq!(told.len(), 1, "{told:?}");
}
