//! Measures by hand, and samples of a walker.

use infopart::geometry::Rect;

use super::{FrameMeasures, Visibility, mean_over_frames, paper_row, run_filter};
use crate::{
    motion::{ConstantVelocity, FilterKind},
    tracking::TrackingParameters,
};

#[test]
fn measures_are_over_boxes_in_a_frame_and_then_over_frames() {
    let truth = Rect::new(0.0, 0.0, 10.0, 10.0);
    let far = Rect::new(100.0, 0.0, 10.0, 10.0);
    // 3-4-5 off; exact; and, in another frame, a box inside the truth with the same centre.
    let inside = Rect::new(2.5, 2.5, 5.0, 5.0);
    let frames =
        FrameMeasures::of([(1, truth, truth.translated(3.0, 4.0)), (1, far, far), (4, truth, inside)]);
    assert_eq!(
        frames.iter().map(|frame| (frame.frame, frame.measures.boxes)).collect::<Vec<_>>(),
        [(1, 2), (4, 1)]
    );
    let first = frames[0].measures;
    assert!((first.rmse - 12.5f64.sqrt()).abs() < 1e-12);
    assert!((first.overlap - (42.0 / 158.0 + 1.0) / 2.0).abs() < 1e-12);
    assert!((first.accuracy - 0.71).abs() < 1e-12);
    assert_eq!((frames[1].measures.overlap, frames[1].measures.accuracy), (0.25, 1.0));
    let mean = mean_over_frames(&frames).unwrap();
    assert!((mean.rmse - 12.5f64.sqrt() / 2.0).abs() < 1e-12 && mean.boxes == 3);
    assert_eq!(mean_over_frames(&[]), None);
}

#[test]
fn samples_tell_free_overlapping_and_hidden_apart() {
    let walker = |frame: usize| Rect::new(100.0 + 4.0 * frame as f64, 50.0, 20.0, 40.0);
    let other = |frame: usize| Rect::new(300.0 - 4.0 * frame as f64, 80.0, 20.0, 40.0);
    let detections: Vec<Vec<Rect>> = (0..40)
        .map(|frame| match frame {
            10..=12 => vec![walker(frame)],
            _ => vec![walker(frame), other(frame)],
        })
        .collect();
    let run = run_filter::<ConstantVelocity, 4>(&detections, TrackingParameters::default()).unwrap();
    let hidden: Vec<_> =
        run.samples.iter().filter(|sample| sample.visibility == Visibility::Hidden).collect();
    // Frames count from 1.
    assert_eq!(
        hidden.iter().map(|sample| (sample.frame, sample.identity)).collect::<Vec<_>>(),
        [(11, 2), (12, 2), (13, 2)]
    );
    for sample in hidden {
        assert!((sample.truth.x - other(sample.frame - 1).x).abs() < 1e-9 && sample.corrected.is_none());
        assert!(sample.truth.centre_distance(&sample.predicted) < 3.0);
    }
    // They pass each other where 100 + 4 f = 300 - 4 f.
    let near: Vec<usize> = (run.samples.iter())
        .filter(|sample| sample.visibility == Visibility::Overlapping && sample.identity == 1)
        .map(|sample| sample.frame - 1)
        .collect();
    assert!(near.contains(&25) && near.iter().all(|frame| (21..=29).contains(frame)), "{near:?}");
    assert!(run.samples.is_sorted_by_key(|sample| sample.frame));
    assert!(run.samples.iter().all(|sample| sample.frame > 1));
}

#[test]
fn the_papers_rows_are_found_by_the_videos_name() {
    assert_eq!(paper_row("view1_vtest", FilterKind::Pf).unwrap().rmse, 4.2151);
    assert_eq!(paper_row("Sample2", FilterKind::Ukf).unwrap().accuracy, 0.8614);
    assert_eq!(paper_row("Sample2", FilterKind::Kalman), None);
    assert_eq!(paper_row("mall", FilterKind::Ekf), None);
}
