//! Scores worked out by hand.

use infopart::geometry::Rect;

use super::{Counts, Rules, Scores};
use crate::motchallenge::TrackRow;

const BOTH: [Rules; 2] = [Rules::Motmetrics, Rules::Trackeval];

/// An object at `place`; places do not overlap.
fn at(frame: u32, identity: u64, place: u32) -> TrackRow {
    shifted(frame, identity, place, 0.0)
}

fn shifted(frame: u32, identity: u64, place: u32, by: f64) -> TrackRow {
    TrackRow {
        frame,
        identity,
        box_in_file: Rect::new(f64::from(place) * 100.0 + by, 1.0, 10.0, 20.0),
        confidence: 1.0,
    }
}

fn scores(truth: &[TrackRow], result: &[TrackRow], rules: Rules) -> Scores {
    Counts::of(truth, result, rules).scores()
}

/// Objects 1 and 2 over four frames, each in its own place.
fn two_objects() -> Vec<TrackRow> {
    (1..=4).flat_map(|frame| [at(frame, 1, 1), at(frame, 2, 2)]).collect()
}

#[test]
fn an_identity_swap_is_two_switches_and_half_of_the_identities() {
    // Tracks 7 and 8 change places after the second frame.
    let result: Vec<TrackRow> = (1..=4)
        .flat_map(|frame| {
            if frame <= 2 { [at(frame, 7, 1), at(frame, 8, 2)] } else { [at(frame, 8, 1), at(frame, 7, 2)] }
        })
        .collect();
    for rules in BOTH {
        let scores = scores(&two_objects(), &result, rules);
        assert_eq!((scores.switches, scores.misses, scores.false_positives, scores.fragments), (2, 0, 0, 0));
        assert_eq!(scores.mota, Some(1.0 - 2.0 / 8.0));
        assert_eq!((scores.idf1, scores.idp, scores.idr), (Some(0.5), Some(0.5), Some(0.5)));
        assert_eq!((scores.motp_distance, scores.motp_overlap), (Some(0.0), Some(1.0)));
        // Every pair is together in 2 of the 6 frames that either has.
        assert_eq!(scores.deta, Some(1.0));
        assert!((scores.assa.unwrap() - 1.0 / 3.0).abs() < 1e-12);
        assert!((scores.hota.unwrap() - (1.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }
    // Both tracks had been matched before, and both objects too.
    let scores = scores(&two_objects(), &result, Rules::Motmetrics);
    assert_eq!((scores.transfers, scores.ascents, scores.migrations), (Some(2), Some(0), Some(0)));
}

#[test]
fn a_gap_is_a_fragment_and_a_new_name_after_it_a_switch() {
    let truth: Vec<TrackRow> = (1..=10).map(|frame| at(frame, 1, 1)).collect();
    let with_gap = |name_after| -> Vec<TrackRow> {
        (1..=10)
            .filter(|frame| ![4, 5].contains(frame))
            .map(|f| at(f, if f > 5 { name_after } else { 3 }, 1))
            .collect()
    };
    let same = scores(&truth, &with_gap(3), Rules::Motmetrics);
    assert_eq!((same.fragments, same.switches, same.misses), (1, 0, 2));
    assert_eq!((same.mostly_tracked, same.partially_tracked), (1, 0));
    let new = scores(&truth, &with_gap(4), Rules::Motmetrics);
    assert_eq!((new.fragments, new.switches, new.ascents, new.transfers), (1, 1, Some(1), Some(0)));
    // 80 % is not above 80 %, and a frame without any track ends no piece.
    let other = scores(&truth, &with_gap(4), Rules::Trackeval);
    assert_eq!(
        (other.mostly_tracked, other.partially_tracked, other.fragments, other.switches),
        (0, 1, 0, 1)
    );
    let watched: Vec<TrackRow> = [with_gap(4), vec![at(4, 9, 5), at(5, 9, 5)]].concat();
    assert_eq!(scores(&truth, &watched, Rules::Trackeval).fragments, 1);
}

#[test]
fn all_missed_is_no_precision_and_a_mota_of_nothing() {
    for rules in BOTH {
        let nothing = scores(&two_objects(), &[], rules);
        assert_eq!((nothing.mota, nothing.recall, nothing.precision), (Some(0.0), Some(0.0), None));
        assert_eq!((nothing.mostly_lost, nothing.misses, nothing.fragments), (2, 8, 0));
        assert_eq!((nothing.motp_distance, nothing.idf1, nothing.hota), (None, Some(0.0), Some(0.0)));
        // As many boxes as there should be, all in the wrong place.
        let wrong: Vec<TrackRow> = (1..=4).flat_map(|frame| [at(frame, 1, 4), at(frame, 2, 5)]).collect();
        let wrong = scores(&two_objects(), &wrong, rules);
        assert_eq!((wrong.mota, wrong.false_positives_per_frame), (Some(-1.0), Some(2.0)));
        assert_eq!((wrong.precision, wrong.hota), (Some(0.0), Some(0.0)));
    }
}

#[test]
fn an_old_pairing_is_kept_by_one_toolkit_over_any_gap_and_by_the_other_only_from_the_frame_before() {
    // Track 3 goes, and comes back shifted beside track 4, which fits better.
    let truth: Vec<TrackRow> = (1..=3).map(|frame| at(frame, 1, 1)).collect();
    let result = [at(1, 3, 1), at(2, 9, 6), shifted(3, 3, 1, 2.0), at(3, 4, 1)];
    assert_eq!(scores(&truth, &result, Rules::Motmetrics).switches, 0);
    assert_eq!(scores(&truth, &result, Rules::Trackeval).switches, 1);
}

#[test]
fn an_overlap_of_exactly_a_half_matches_and_less_does_not() {
    // A shift by a third of the width leaves 2/3 of it: an overlap of (2/3) / (4/3).
    let truth =
        [TrackRow { frame: 1, identity: 1, box_in_file: Rect::new(0.0, 0.0, 3.0, 1.0), confidence: 1.0 }];
    let moved =
        |x| [TrackRow { frame: 1, identity: 1, box_in_file: Rect::new(x, 0.0, 3.0, 1.0), confidence: 1.0 }];
    for rules in BOTH {
        assert_eq!(scores(&truth, &moved(1.0), rules).misses, 0);
        assert_eq!(scores(&truth, &moved(1.01), rules).misses, 1);
    }
}

#[test]
fn sequences_add_up_by_their_boxes() {
    let good: Vec<TrackRow> = two_objects();
    let good = Counts::of(&good, &good, Rules::Motmetrics);
    let bad = Counts::of(&[at(1, 1, 1), at(2, 1, 1)], &[], Rules::Motmetrics);
    let all = Counts::total([&good, &bad]).unwrap().scores();
    assert_eq!((all.mota, all.recall, all.objects, all.mostly_lost), (Some(0.8), Some(0.8), 3, 1));
    assert!((all.deta.unwrap() - 0.8).abs() < 1e-12);
    assert_eq!(all.assa, Some(1.0));
    assert_eq!(Counts::total([]), None);
}
