//! How every tracker followed each sequence over time, and which of its frames tell most.

use infopart::geometry::Rect;

use crate::{
    dataset::{Dataset, Target},
    report::Timeline,
    results::Results,
    scoring::Table,
};

/// Values of a sequence and tracker; of a longer one every second frame, every third and so on are told.
const MOST_VALUES: usize = 1500;

/// A tracker has failed below this overlap, if it stays there for so many frames.
const FAILED: f64 = 0.1;
const STAYS: usize = 5;

/// Frames after a failure's first at which it can be seen.
const SEEN_AFTER: usize = 2;

/// The timelines of a table's sequences, each tracker's first seed.
pub fn timelines(dataset: &Dataset, results: &Results, table: &Table) -> Vec<Timeline> {
    let of = |name: &String| Some(timeline(dataset.target(name)?, &boxes_of(dataset.target(name)?, results)));
    table.sequences.iter().filter_map(of).collect()
}

/// Each tracker's boxes of a sequence, from its first seed; none where it has no result.
pub(super) fn boxes_of(target: &Target, results: &Results) -> Vec<Vec<Rect>> {
    let rows = |tracker: &crate::results::TrackerResults| {
        let first = tracker.seeds.first().and_then(|seed| seed.read(&target.name, None));
        let mut file = first.and_then(Result::ok).unwrap_or_default();
        target.align(&mut file.rows);
        if file.first_is_given
            && let (Some(first), Some(given)) = (file.rows.first_mut(), target.truth.first())
        {
            *first = *given;
        }
        file.rows
    };
    results.trackers.iter().map(rows).collect()
}

fn timeline(target: &Target, boxes: &[Vec<Rect>]) -> Timeline {
    let frames = target.truth.len();
    let every = frames.div_ceil(MOST_VALUES).max(1);
    let of = |value: fn(&Rect, &Rect) -> f64| -> Vec<Vec<Option<f64>>> {
        let values = |rows: &Vec<Rect>| {
            let at = |index: usize| {
                let truth = present(target, index)?;
                rows.get(index).filter(|row| !row.x.is_nan()).map(|row| value(row, truth))
            };
            (0..frames).step_by(every).map(at).collect()
        };
        boxes.iter().map(values).collect()
    };
    Timeline {
        sequence: target.name.clone(),
        frames,
        every,
        overlaps: of(|row, truth| row.overlap(truth)),
        errors: of(|row, truth| row.centre_distance(truth)),
    }
}

/// The true box of a frame in which the target is present.
fn present(target: &Target, index: usize) -> Option<&Rect> {
    let is_absent = target.annotations.absent.get(index).copied().unwrap_or(false);
    target.truth.get(index).filter(|row| row.is_proper() && !is_absent)
}

/// Rows to show: those in which trackers begin to fail, the most of them first, and then those farthest from any that is shown, the
/// last among them. Ascending; never the first row, whose box is given.
pub(super) fn telling(target: &Target, boxes: &[Vec<Rect>], count: usize) -> Vec<usize> {
    let last = target.truth.len().saturating_sub(1);
    let mut onsets: Vec<usize> = boxes.iter().flat_map(|rows| onsets(target, rows)).collect();
    onsets.sort_unstable();
    // Failures that begin within a few frames are seen in one picture.
    let mut groups: Vec<(usize, usize)> = Vec::new();
    for onset in onsets {
        match groups.last_mut() {
            Some((first, trackers)) if onset <= *first + STAYS => *trackers += 1,
            _ => groups.push((onset, 1)),
        }
    }
    groups.sort_by_key(|&(onset, trackers)| (std::cmp::Reverse(trackers), onset));
    let mut shown: Vec<usize> = groups
        .iter()
        .take(count.saturating_sub(1))
        .map(|(onset, _)| (onset + SEEN_AFTER).min(last))
        .collect();
    shown.push(last);
    shown.sort_unstable();
    shown.dedup();
    while shown.len() < count.min(last.max(1)) {
        let distance =
            |row: usize| shown.iter().map(|one| one.abs_diff(row)).min().unwrap_or(usize::MAX).min(row);
        match (1..=last).max_by_key(|row| (distance(*row), std::cmp::Reverse(*row))) {
            Some(farthest) if distance(farthest) > 0 => shown.push(farthest),
            _ => break,
        }
        shown.sort_unstable();
    }
    shown
}

/// Rows in which a tracker begins to fail.
fn onsets(target: &Target, rows: &[Rect]) -> Vec<usize> {
    let has_failed = |index: usize| {
        let truth = present(target, index)?;
        rows.get(index).map(|row| row.overlap(truth) < FAILED)
    };
    let (mut onsets, mut is_following) = (Vec::new(), true);
    for index in 1..target.truth.len() {
        let Some(failed) = has_failed(index) else { continue };
        if !failed {
            is_following = true;
        } else if is_following && (index..index + STAYS).all(|later| has_failed(later) != Some(false)) {
            onsets.push(index);
            is_following = false;
        }
    }
    onsets
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::Annotations;

    const BOX: Rect = Rect::new(10.0, 20.0, 30.0, 40.0);

    fn target(rows: usize) -> Target {
        Target {
            name: "s".into(),
            truth: vec![BOX; rows],
            hidden: vec![],
            frames: None,
            annotations: Annotations::default(),
        }
    }

    /// Lost from one row to another.
    fn lost(rows: usize, from: usize, to: usize) -> Vec<Rect> {
        (0..rows).map(|row| if (from..to).contains(&row) { BOX.translated(90.0, 0.0) } else { BOX }).collect()
    }

    #[test]
    fn frames_where_trackers_fail_come_first_and_gaps_are_filled() {
        let boxes = [lost(100, 40, 100), lost(100, 42, 60), lost(100, 80, 100), lost(100, 20, 23)];
        assert_eq!(telling(&target(100), &boxes, 3), [42, 82, 99], "a slip of three frames is no failure");
        assert_eq!(telling(&target(100), &boxes, 5), [21, 42, 62, 82, 99]);
        assert_eq!(telling(&target(100), &[], 4), [24, 49, 74, 99]);
        assert_eq!(telling(&target(2), &boxes, 6), [1]);
        assert_eq!(telling(&target(1), &boxes, 6), [0]);
    }

    #[test]
    fn a_timeline_has_nothing_where_the_target_is_absent_or_no_row_is() {
        let mut target = target(3200);
        target.truth[0] = Rect::new(f64::NAN, 0.0, 0.0, 0.0);
        target.annotations.absent = (0..3200).map(|row| row == 3).collect();
        let found = timeline(&target, &[vec![BOX.translated(3.0, 4.0); 7], vec![]]);
        assert_eq!((found.every, found.frames, found.overlaps[0].len()), (3, 3200, 1067));
        assert_eq!(found.overlaps[0][..4], [None, None, Some(BOX.overlap(&BOX.translated(3.0, 4.0))), None]);
        assert_eq!((found.errors[0][2], found.errors[1][2]), (Some(5.0), None));
    }
}
