//! The loop on literal frames.

use std::{num::NonZeroUsize, path::PathBuf, sync::atomic::AtomicU64};

use super::*;
use crate::{
    frame::{Frame, FrameView, PixelFormat},
    output::testing::StillTracker,
};

const BOX: Rect = Rect::new(2.0, 2.0, 4.0, 8.0);

/// Delivers `good` frames, then an error or the end.
struct FakeSource {
    good: usize,
    delivered: usize,
    fails: bool,
}

impl FrameSource for FakeSource {
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, SequenceError> {
        if self.delivered == self.good {
            let missing = || std::io::Error::from(std::io::ErrorKind::NotFound);
            let error = || SequenceError::Io { path: PathBuf::from("0006.jpg"), source: missing() };
            return if self.fails { Err(error()) } else { Ok(None) };
        }
        self.delivered += 1;
        let frame = Frame::new(vec![0; 300], 20, 15, PixelFormat::Gray).unwrap();
        Ok(Some(SourceFrame {
            frame,
            number: self.delivered,
            label: format!("{:04}.jpg", self.delivered),
            time: None,
        }))
    }

    fn remaining(&self) -> Option<usize> {
        Some(self.good - self.delivered)
    }
}

fn frames(good: usize) -> FakeSource {
    FakeSource { good, delivered: 0, fails: false }
}

/// Notes what it is told; stops the loop after `stop_after` frames, or fails in `fail_at`.
#[derive(Default)]
struct Notes<'a> {
    said: Vec<String>,
    stop_after: Option<(usize, &'a AtomicBool)>,
    fail_at: Option<usize>,
}

impl Observer for Notes<'_> {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        if self.fail_at == Some(event.number) {
            return Err(OutputError::Closed);
        }
        self.said.push(format!("{} {}", event.number, event.warnings.len()));
        if let Some((_, flag)) = self.stop_after.filter(|(after, _)| *after == event.number) {
            flag.store(true, Ordering::Relaxed);
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), OutputError> {
        self.said.push("finish".into());
        Ok(())
    }

    fn flush(&mut self) -> Result<(), OutputError> {
        self.said.push("flush".into());
        Ok(())
    }
}

fn track(
    source: &mut FakeSource,
    truth: &[Option<Rect>],
    first: Rect,
    notes: &mut Notes<'_>,
) -> Result<RunReport, RunError> {
    let never = AtomicBool::new(false);
    let flag = notes.stop_after.map_or(&never, |(_, flag)| flag);
    run(source, truth, &mut StillTracker::default(), first, &mut [notes], flag)
}

#[test]
fn every_frame_is_shown_once_and_counted_by_status() {
    let mut notes = Notes::default();
    let report = track(&mut frames(9), &[], Rect { w: 1.0, ..BOX }, &mut notes).unwrap();
    assert_eq!(notes.said, ["1 1", "2 0", "3 0", "4 0", "5 0", "6 0", "7 0", "8 0", "9 0", "finish"]);
    assert_eq!((report.frames, report.tracking_frames, report.lost_frames), (9, 7, 2));
    assert_eq!(report.warnings, [BoxWarning::Tiny]);
    let speed = report.frames_per_second.unwrap();
    assert!((speed * report.update_seconds - 8.0).abs() < 1e-6, "speed counts updates, not the first frame");
}

#[test]
fn scores_count_only_frames_with_ground_truth() {
    let far = BOX.translated(100.0, 0.0);
    let truth = [Some(BOX), None, Some(far), None, Some(BOX), Some(BOX)];
    let report = track(&mut frames(8), &truth, BOX, &mut Notes::default()).unwrap();
    let scores = report.scores.unwrap();
    assert_eq!((scores.frames, scores.r1, scores.r2), (4, 75.0, 75.0));
    assert_eq!(track(&mut frames(3), &[], BOX, &mut Notes::default()).unwrap().scores, None);
}

#[test]
fn an_unreadable_frame_flushes_and_tells_the_last_good_one() {
    let mut notes = Notes::default();
    let mut source = FakeSource { fails: true, ..frames(5) };
    let error = track(&mut source, &[], BOX, &mut notes).unwrap_err();
    assert_eq!(
        (error.frames_done, error.last_good.as_ref().unwrap().to_string()),
        (5, "frame 5 (0005.jpg)".into())
    );
    assert!(error.to_string().contains("0006.jpg"));
    assert!(matches!(*error.failure, RunFailure::Source(_)));
    assert_eq!(notes.said.last().unwrap(), "flush");
    assert!(!notes.said.contains(&"finish".to_owned()));
}

#[test]
fn an_interruption_ends_the_loop_after_the_frame_at_hand() {
    let flag = AtomicBool::new(false);
    let mut notes = Notes { stop_after: Some((3, &flag)), ..Notes::default() };
    let error = track(&mut frames(9), &[], BOX, &mut notes).unwrap_err();
    assert!(matches!(*error.failure, RunFailure::Interrupted));
    assert_eq!(error.frames_done, 3);
    assert_eq!(notes.said, ["1 0", "2 0", "3 0", "flush"]);
}

#[test]
fn a_frame_that_could_not_be_written_is_not_good() {
    let mut notes = Notes { fail_at: Some(4), ..Notes::default() };
    let error = track(&mut frames(9), &[], BOX, &mut notes).unwrap_err();
    assert!(matches!(*error.failure, RunFailure::Output(OutputError::Closed)));
    assert_eq!(error.frames_done, 3);
}

#[test]
fn a_bad_box_and_an_empty_source_have_errors_of_their_own() {
    let error = track(&mut frames(2), &[], Rect { w: 0.0, ..BOX }, &mut Notes::default()).unwrap_err();
    assert!(error.to_string().starts_with("frame 1 (0001.jpg): the box 2,2,0,8"), "{error}");
    let error = track(&mut frames(0), &[], BOX, &mut Notes::default()).unwrap_err();
    assert!(matches!(*error.failure, RunFailure::NoFrames));
    assert_eq!((error.frames_done, error.last_good), (0, None));
}

#[test]
fn stage_means_are_over_updates() {
    let mut totals = Vec::new();
    let time = |stage, millis| StageTime { stage, time: Duration::from_millis(millis) };
    add_stages(&mut totals, &[time("a", 2), time("b", 3)]);
    add_stages(&mut totals, &[time("a", 4)]);
    let report = RunReport { frames: 3, ..RunReport::default() };
    let progress = Progress {
        report,
        last_good: None,
        scored: Vec::new(),
        stage_totals: totals,
        update_seconds: Vec::new(),
    };
    let means: Vec<f64> =
        progress.into_report(Pace::EveryFrame).stages.iter().map(|mean| mean.mean_milliseconds).collect();
    assert!((means[0] - 3.0).abs() < 1e-9 && (means[1] - 1.5).abs() < 1e-9, "{means:?}");
}

/// Moves by two pixels a frame, by the frame's number, and takes so long for an update as its clock is told to go on.
struct SteadyTracker<'a> {
    first: Rect,
    seen: Vec<u64>,
    clock_millis: &'a AtomicU64,
    update_millis: u64,
}

impl Tracker for SteadyTracker<'_> {
    fn name(&self) -> &str {
        "Steady"
    }

    fn init(&mut self, _: FrameView<'_>, given: Rect) -> Result<Vec<BoxWarning>, TrackError> {
        self.first = given;
        Ok(Vec::new())
    }

    fn update_at(&mut self, _: FrameView<'_>, stamp: FrameStamp) -> Result<Estimate, TrackError> {
        let index = stamp.index.unwrap();
        self.seen.push(index);
        self.clock_millis.fetch_add(self.update_millis, Ordering::Relaxed);
        let moved = self.first.translated(2.0 * index as f64, 0.0);
        Ok(Estimate::new(moved, moved, 0.9, Status::Tracking))
    }

    fn estimate(&self) -> Option<&Estimate> {
        None
    }
}

/// Left edges of all rows.
#[derive(Default)]
struct Lefts(Vec<f64>);

impl Observer for Lefts {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        self.0.push(event.estimate.box_in_frame.x - BOX.x);
        Ok(())
    }
}

/// What the tracker saw, what the rows said and the report, of ten frames with updates of `millis`.
fn paced(pace: Pace, millis: u64) -> (Vec<u64>, Vec<f64>, RunReport) {
    let (clock, mut lefts) = (AtomicU64::new(0), Lefts::default());
    let mut tracker =
        SteadyTracker { first: BOX, seen: Vec::new(), clock_millis: &clock, update_millis: millis };
    let truth: Vec<_> = (0..10).map(|i| Some(BOX.translated(2.0 * f64::from(i), 0.0))).collect();
    let now = || Duration::from_millis(clock.load(Ordering::Relaxed));
    let mut session = Session::new(pace, &mut tracker, BOX, &now);
    session.all_frames(&mut frames(10), &truth, &mut [&mut lefts], &AtomicBool::new(false)).unwrap();
    let report = session.progress.into_report(pace);
    (tracker.seen, lefts.0, report)
}

#[test]
fn with_a_stride_the_frames_between_are_predicted_and_scored() {
    let stride = |k| Pace::Stride(NonZeroUsize::new(k).unwrap());
    let (seen, lefts, report) = paced(stride(3), 20);
    assert_eq!(seen, [3, 6, 9]);
    // Before the second answer there is no velocity; then the constant one is right.
    assert_eq!(lefts, [0.0, 0.0, 0.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0]);
    assert_eq!((report.frames, report.skipped_frames, report.updates()), (10, 6, 3));
    assert_eq!(report.scores.unwrap().frames, 10);
    assert!((report.update_seconds - 0.06).abs() < 1e-12);
    assert!((report.sustained_frames_per_second.unwrap() - 150.0).abs() < 1e-6, "three frames an update");
    let (seen, lefts, report) = paced(stride(1), 20);
    assert_eq!((seen.len(), lefts[9], report.skipped_frames), (9, 18.0, 0));
}

#[test]
fn in_real_time_frames_that_a_busy_tracker_misses_are_answered_from_what_is_known_then() {
    let at = |frames_per_second| Pace::RealTime { frames_per_second };
    let (seen, lefts, report) = paced(at(10.0), 240);
    // 1 is done at 340 ms, 3 (waiting since 300) at 580, 5 (waiting since 500) at 820, 8 at 1060.
    assert_eq!(seen, [1, 3, 5, 8]);
    // While 3 is worked on, only 0 and 1 are known: 4 goes on from these.
    assert_eq!(lefts, [0.0, 2.0, 0.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0]);
    assert_eq!(report.skipped_frames, 5);
    let sustained = report.sustained_frames_per_second.unwrap();
    assert!((sustained - 1.0 / 0.24).abs() < 1e-6, "{sustained}");
    assert_eq!(paced(at(sustained), 240).2.skipped_frames, 0);
    assert_eq!(paced(at(1e9), 240).0, [1], "a tracker that is never free again");
}
