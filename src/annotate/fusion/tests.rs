use proptest::prelude::*;

use super::*;

fn seen(x: f64, confidence: f64) -> Sighting {
    Sighting { box_in_frame: Rect::new(x, 50.0, 20.0, 40.0), confidence }
}

fn at(x: f64) -> Rect {
    seen(x, 1.0).box_in_frame
}

/// Passes in the order of frames, from key frame to key frame; a pass's own key frame is left out.
fn fused(first: Rect, last: Rect, forward: &[Sighting], backward: &[Sighting]) -> Vec<Fused> {
    let reversed: Vec<_> = backward.iter().rev().copied().collect();
    fuse(first, last, forward, &reversed)
}

fn centres(found: &[Fused]) -> Vec<f64> {
    found.iter().map(|fused| fused.box_in_frame.centre().0 - 10.0).collect()
}

#[test]
fn neighbouring_key_frames_have_nothing_between() {
    assert!(fuse(at(0.0), at(1.0), &[seen(0.5, 0.9)], &[seen(0.5, 0.9)]).is_empty());
}

#[test]
fn what_a_pass_is_off_at_the_far_key_frame_is_taken_out_in_proportion() {
    // Both passes stand still while the object moves by 4: each has drifted by 1 a frame.
    let found = fused(
        at(0.0),
        at(4.0),
        &[seen(0.0, 0.9); 4],
        &[seen(4.0, 0.9), seen(4.0, 0.9), seen(4.0, 0.9), seen(4.0, 0.9)],
    );
    for (found, expected) in centres(&found).iter().zip([1.0, 2.0, 3.0]) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}

#[test]
fn sizes_go_from_one_key_frame_to_the_other_by_equal_factors() {
    let wide = Rect::new(-10.0, 50.0, 40.0, 40.0);
    let still = |rect| Sighting { box_in_frame: rect, confidence: 0.9 };
    let found = fused(at(0.0), wide, &[still(at(0.0)); 2], &[still(wide); 2]);
    assert!((found[0].box_in_frame.w - 20.0 * 2f64.sqrt()).abs() < 1e-9);
    assert!((found[0].box_in_frame.centre().0 - 10.0).abs() < 1e-9);
}

#[test]
fn where_both_are_equally_sure_the_nearer_key_frame_counts_more() {
    // They arrive exactly and disagree by 3 pixels on the way: the product of variances 1 : 3, 2 : 2 and 3 : 1.
    let forward = [seen(0.0, 0.9), seen(0.0, 0.9), seen(0.0, 0.9), seen(0.0, 0.9)];
    let backward = [seen(0.0, 0.9), seen(3.0, 0.9), seen(3.0, 0.9), seen(3.0, 0.9)];
    let found = centres(&fused(at(0.0), at(0.0), &forward, &backward));
    assert!((found[1] - 1.5).abs() < 1e-6 && found[0] < 1.0 && found[2] > 2.0, "{found:?}");
}

#[test]
fn a_pass_that_lost_the_object_is_left_where_the_two_meet() {
    // The object goes from 0 to 100; the forward pass stays behind at 40 with low confidence, the backward pass holds on.
    let truth: Vec<f64> = (0..=20).map(|k| 5.0 * f64::from(k)).collect();
    let forward: Vec<_> =
        truth[1..].iter().map(|&x| if x <= 40.0 { seen(x, 0.9) } else { seen(40.0, 0.2) }).collect();
    let backward: Vec<_> = truth[..20].iter().map(|&x| seen(x, 0.9)).collect();
    let found = fused(at(0.0), at(100.0), &forward, &backward);
    for (found, truth) in centres(&found).iter().zip(&truth[1..20]) {
        assert!((found - truth).abs() < 1.0, "{found} {truth}");
    }
    assert!(found.iter().all(|fused| fused.confidence > 0.6), "{found:?}");
}

#[test]
fn passes_that_both_lose_the_object_are_each_followed_where_they_are_sure() {
    // Hidden in the middle: both stop there, the forward pass at 45, the backward pass at 55.
    let truth: Vec<f64> = (0..=20).map(|k| 5.0 * f64::from(k)).collect();
    let forward: Vec<_> =
        truth[1..].iter().map(|&x| seen(x.min(45.0), if x <= 45.0 { 0.9 } else { 0.1 })).collect();
    let backward: Vec<_> =
        truth[..20].iter().map(|&x| seen(x.max(55.0), if x >= 55.0 { 0.9 } else { 0.1 })).collect();
    let found = centres(&fused(at(0.0), at(100.0), &forward, &backward));
    for (found, truth) in found.iter().zip(&truth[1..20]) {
        assert!((found - truth).abs() < 5.1, "{found} {truth}");
    }
}

#[test]
fn passes_that_never_meet_leave_a_doubtful_place() {
    let forward = [seen(0.0, 0.6); 9].to_vec();
    let backward = [seen(200.0, 0.6); 9].to_vec();
    let found = fused(at(0.0), at(200.0), &forward, &backward);
    assert!(found.iter().any(|fused| fused.confidence < 0.1), "{found:?}");
    assert!(centres(&found).windows(2).all(|pair| pair[0] <= pair[1] + 1e-9));
}

/// A walk of boxes with the confidences beside it.
fn pass(length: usize) -> impl Strategy<Value = Vec<(f64, f64, f64, f64)>> {
    let step = (-12.0..12.0f64, -12.0..12.0f64, -0.1..0.1f64, 0.0..1.0f64);
    proptest::collection::vec(step, length)
}

fn walk(start: Rect, steps: &[(f64, f64, f64, f64)]) -> Vec<Sighting> {
    let mut rect = start;
    steps
        .iter()
        .map(|&(dx, dy, grow, confidence)| {
            rect = Rect::new(rect.x + dx, rect.y + dy, rect.w * grow.exp(), rect.h * grow.exp());
            Sighting { box_in_frame: rect, confidence }
        })
        .collect()
}

proptest! {
    /// However passes and key frames are, the track never jumps by more than half a box side where neither pass does, unless the key
    /// frames are too far apart to be joined so.
    #[test]
    fn tracks_never_jump_by_themselves(
        (forward, backward) in (2usize..40).prop_flat_map(|n| (pass(n), pass(n))),
        ends in (-60.0..60.0f64, -60.0..60.0f64),
    ) {
        let (first, last) = (at(0.0), at(0.0).translated(ends.0, ends.1));
        let (forward, backward) = (walk(first, &forward), walk(last, &backward));
        let n = forward.len();
        let found = fuse(first, last, &forward, &backward);
        prop_assert_eq!(found.len(), n - 1);
        let of = |pass: &[Sighting], start: Rect| {
            std::iter::once(start).chain(pass.iter().map(|seen| seen.box_in_frame)).collect::<Vec<_>>()
        };
        let raw_forward = of(&forward, first);
        let mut raw_backward = of(&backward, last);
        raw_backward.reverse();
        let way = |pass: &[Sighting], start, end| {
            let pass: Vec<_> = std::iter::once(Sighting { box_in_frame: start, confidence: 1.0 }).chain(pass.iter().copied()).collect();
            Way::towards(end, &pass)
        };
        let ways = [way(&forward, first, last), {
            let mut way = way(&backward, last, first);
            way.boxes.reverse();
            way
        }];
        let reachable = steepest(&ways).iter().sum::<f64>() >= 1.0;
        let track: Vec<Rect> =
            std::iter::once(first).chain(found.iter().map(|fused| fused.box_in_frame)).chain([last]).collect();
        for k in 0..n {
            let moved = track[k].centre_distance(&track[k + 1]);
            let allowed = 0.5 * [&ways[0].boxes, &ways[1].boxes].iter().flat_map(|boxes| [boxes[k], boxes[k + 1]])
                .map(|rect| rect.w.min(rect.h)).fold(f64::INFINITY, f64::min);
            let by_a_pass = raw_forward[k].centre_distance(&raw_forward[k + 1])
                .max(raw_backward[k].centre_distance(&raw_backward[k + 1]));
            prop_assert!(!reachable || moved <= allowed.max(by_a_pass) + 1e-9, "{} {} {}", moved, allowed, by_a_pass);
        }
        for fused in &found {
            prop_assert!(fused.box_in_frame.is_proper());
            prop_assert!((0.0..=1.0).contains(&fused.confidence));
        }
    }

    /// Time has no direction: the reversed passes give the reversed track.
    #[test]
    fn the_track_is_the_same_from_the_other_end((forward, backward) in (2usize..20).prop_flat_map(|n| (pass(n), pass(n)))) {
        let (first, last) = (at(0.0), at(7.0));
        let (forward, backward) = (walk(first, &forward), walk(last, &backward));
        let there = fuse(first, last, &forward, &backward);
        let mut back = fuse(last, first, &backward, &forward);
        back.reverse();
        for (a, b) in there.iter().zip(&back) {
            prop_assert!(a.box_in_frame.overlap(&b.box_in_frame) > 1.0 - 1e-6, "{:?} {:?}", a, b);
        }
    }

    /// Passes that both follow the object exactly are left as they are.
    #[test]
    fn perfect_passes_give_the_truth(steps in (2usize..30).prop_flat_map(pass)) {
        let first = at(0.0);
        let forward = walk(first, &steps);
        let last = forward[forward.len() - 1].box_in_frame;
        let mut backward: Vec<_> = forward[..forward.len() - 1].to_vec();
        backward.insert(0, Sighting { box_in_frame: first, confidence: 0.8 });
        backward.reverse();
        for (found, truth) in fuse(first, last, &forward, &backward).iter().zip(&forward) {
            prop_assert!(found.box_in_frame.overlap(&truth.box_in_frame) > 1.0 - 1e-9);
        }
    }
}
