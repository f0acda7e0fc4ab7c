//! Two passes between two key frames become one track: two-filter smoothing with the key frames as certain ends.
//!
//! Steps:
//! 1. a pass that is still on the object at the far key frame has drifted by what it is off there: that is spread over the
//!    stretch in proportion to the distance from the pass's own key frame,
//! 2. how far each pass is trusted in each frame: log-odds of its confidence, more if it arrived, less with the distance; one that
//!    did not arrive is trusted nowhere more than before,
//! 3. the way with the least doubt from the forward pass at the first key frame to the backward pass at the last: in each frame
//!    the surer pass, changing where the two overlap most (Viterbi's algorithm),
//! 4. the backward pass's share of each frame: 0 or 1 as on that way; where the passes agree, the product of two Gaussian
//!    posteriors, each with a variance that grows with the distance and with doubt,
//! 5. shares are moved no further than they must for the track to move, from frame to frame, by no more than half a box side, or by
//!    what one of the passes moves there.
//!
//! Knows no image and no tracker.

use super::passes::Sighting;
use crate::geometry::Rect;

/// A pass has arrived if it overlaps the far key frame's box by this.
const ARRIVED: f64 = 0.3;
/// Passes that overlap by this mean the same object.
const AGREE: f64 = 0.5;
/// Log-odds that arriving is worth.
const PER_ARRIVAL: f64 = 3.0;
/// Log-odds that trust falls by over a stretch, from one end to the other.
const PER_STRETCH: f64 = 2.0;
/// What changing the pass costs at an overlap of 0, in nats.
const CHANGE: f64 = 6.0;
/// How far, in box sides, the track may move from frame to frame though neither pass does.
const LARGEST_JUMP: f64 = 0.5;
/// Confidences are cut off here, and with them log-odds.
const LEAST_CONFIDENCE: f64 = 0.01;

/// A box between two key frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fused {
    /// The object's box, frame coordinates.
    pub box_in_frame: Rect,
    /// Probability that it overlaps the object by more than one half, as far as the passes tell, in [0, 1].
    pub confidence: f64,
}

/// Boxes of the frames strictly between two key frames. `forward` goes from the frame after the first key frame to the last key
/// frame, `backward` from the frame before the last to the first; both in the order in which they were tracked, so that the last
/// of each is at the other's start. Empty passes have no frame between.
///
/// # Panics
/// If the passes differ in length.
pub fn fuse(first: Rect, last: Rect, forward: &[Sighting], backward: &[Sighting]) -> Vec<Fused> {
    assert_eq!(forward.len(), backward.len(), "both passes cover the same frames");
    let certain = |box_in_frame| Sighting { box_in_frame, confidence: 1.0 };
    let forward: Vec<_> = std::iter::once(certain(first)).chain(forward.iter().copied()).collect();
    let mut backward: Vec<_> = std::iter::once(certain(last)).chain(backward.iter().copied()).collect();
    let n = forward.len() - 1;
    if n < 2 {
        return Vec::new();
    }
    let ways = [Way::towards(last, &forward), {
        let mut way = Way::towards(first, &backward);
        way.boxes.reverse();
        way.trust.reverse();
        way
    }];
    backward.reverse();
    let agreement: Vec<f64> = (0..=n).map(|k| ways[0].boxes[k].overlap(&ways[1].boxes[k])).collect();
    let chosen = least_doubt(&ways, &agreement);
    let mut shares: Vec<f64> =
        (0..=n)
            .map(|k| {
                if agreement[k] >= AGREE {
                    product_share(&ways, k, n)
                } else {
                    f64::from(u8::from(chosen[k]))
                }
            })
            .collect();
    (shares[0], shares[n]) = (0.0, 1.0);
    move_gently(&mut shares, &steepest(&ways));
    (1..n)
        .map(|k| Fused {
            box_in_frame: between(&ways[0].boxes[k], &ways[1].boxes[k], shares[k]),
            confidence: confidence(
                [forward[k].confidence, backward[k].confidence],
                [ways[0].trust[k], ways[1].trust[k]],
                agreement[k],
                shares[k],
            ),
        })
        .collect()
}

/// A pass as it is fused: its boxes with the drift taken out, and log-odds of its being on the object.
struct Way {
    boxes: Vec<Rect>,
    trust: Vec<f64>,
}

impl Way {
    /// Steps 1 and 2, in the order of the pass.
    fn towards(end: Rect, pass: &[Sighting]) -> Self {
        let n = pass.len() - 1;
        let raw: Vec<Rect> = pass.iter().map(|seen| seen.box_in_frame).collect();
        let arrived = raw[n].overlap(&end) >= ARRIVED;
        let boxes = if arrived { without_drift(&raw, end) } else { raw };
        let mut lowest = f64::INFINITY;
        let trust = pass.iter().enumerate().map(|(k, seen)| {
            let fallen = PER_STRETCH * k as f64 / n as f64;
            if arrived {
                return log_odds(seen.confidence) + PER_ARRIVAL - fallen;
            }
            lowest = lowest.min(log_odds(seen.confidence));
            lowest - fallen
        });
        Self { trust: trust.collect(), boxes }
    }
}

/// Step 1. Without effect if the track would so move further in one frame than [`LARGEST_JUMP`] allows.
fn without_drift(raw: &[Rect], end: Rect) -> Vec<Rect> {
    let n = raw.len() - 1;
    let drift = Shape::of(&end).less(&Shape::of(&raw[n]));
    let corrected: Vec<Rect> = raw
        .iter()
        .enumerate()
        .map(
            |(k, rect)| {
                if k == n { end } else { Shape::of(rect).plus(&drift, k as f64 / n as f64).to_rect() }
            },
        )
        .collect();
    let moves_too_far = |k: usize| {
        let moved = corrected[k].centre_distance(&corrected[k + 1]);
        moved > allowed(&corrected[k], &corrected[k + 1]).max(raw[k].centre_distance(&raw[k + 1]))
    };
    if (0..n).any(moves_too_far) { raw.to_vec() } else { corrected }
}

/// Centre and logarithms of the sides: what drifts.
#[derive(Clone, Copy)]
struct Shape([f64; 4]);

impl Shape {
    fn of(rect: &Rect) -> Self {
        let (x, y) = rect.centre();
        Self([x, y, rect.w.ln(), rect.h.ln()])
    }

    fn less(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }

    fn plus(&self, other: &Self, times: f64) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + times * other.0[i]))
    }

    fn to_rect(self) -> Rect {
        let [x, y, w, h] = self.0;
        let (w, h) = (w.exp(), h.exp());
        Rect::new(x - w / 2.0, y - h / 2.0, w, h)
    }
}

/// `a` at share 0, `b` at share 1; linear in the centre and in the logarithms of the sides.
fn between(a: &Rect, b: &Rect, share: f64) -> Rect {
    if share <= 0.0 {
        return *a;
    }
    if share >= 1.0 {
        return *b;
    }
    let start = Shape::of(a);
    start.plus(&Shape::of(b).less(&start), share).to_rect()
}

fn log_odds(confidence: f64) -> f64 {
    let p = confidence.clamp(LEAST_CONFIDENCE, 1.0 - LEAST_CONFIDENCE);
    (p / (1.0 - p)).ln()
}

/// -ln of the logistic function.
fn doubt(log_odds: f64) -> f64 {
    (-log_odds).max(0.0) + (-log_odds.abs()).exp().ln_1p()
}

/// Step 3: for each frame whether the way is on the backward pass.
fn least_doubt(ways: &[Way; 2], agreement: &[f64]) -> Vec<bool> {
    let n = agreement.len() - 1;
    // The cost of each pass in frame k: -ln of the probability that it, and not the other, is to be followed.
    let costs = |k: usize| {
        let margin = ways[0].trust[k] - ways[1].trust[k];
        [doubt(margin), doubt(-margin)]
    };
    let mut total = [0.0, f64::INFINITY];
    let mut came_from = Vec::with_capacity(n);
    for k in 1..=n {
        let change = CHANGE * (1.0 - agreement[k - 1].min(agreement[k]));
        let cost = costs(k);
        let from: [bool; 2] = [total[1] + change < total[0], total[1] <= total[0] + change];
        total = [
            if from[0] { total[1] + change } else { total[0] } + cost[0],
            if from[1] { total[1] } else { total[0] + change } + cost[1],
        ];
        came_from.push(from);
    }
    let mut chosen = vec![true; n + 1];
    for k in (1..=n).rev() {
        chosen[k - 1] = came_from[k - 1][usize::from(chosen[k])];
    }
    chosen
}

/// Step 4 where the passes agree.
fn product_share(ways: &[Way; 2], k: usize, n: usize) -> f64 {
    // A drift that is a random walk has a variance in proportion to the distance from where it was nought.
    let variance = |way: &Way, distance: usize| distance as f64 * (1.0 + (-way.trust[k]).exp());
    let (forward, backward) = (variance(&ways[0], k), variance(&ways[1], n - k));
    forward / (forward + backward)
}

/// How far a track may move from one of these boxes to the other.
fn allowed(a: &Rect, b: &Rect) -> f64 {
    LARGEST_JUMP * a.w.min(a.h).min(b.w).min(b.h)
}

/// How much the share may change from each frame to the next.
fn steepest(ways: &[Way; 2]) -> Vec<f64> {
    let [forward, backward] = [&ways[0].boxes, &ways[1].boxes];
    (1..forward.len())
        .map(|k| {
            let moved = [forward, backward]
                .map(|boxes| boxes[k - 1].centre_distance(&boxes[k]))
                .into_iter()
                .fold(0.0, f64::max);
            let allowed = allowed(&forward[k - 1], &forward[k]).min(allowed(&backward[k - 1], &backward[k]));
            // Either distance would do; the larger one is the same in both directions of time.
            let apart = forward[k - 1]
                .centre_distance(&backward[k - 1])
                .max(forward[k].centre_distance(&backward[k]));
            let left = (allowed - moved).max(0.0);
            if apart <= left { 1.0 } else { left / apart }
        })
        .collect()
}

/// Step 5: the shares, from 0 at the start to 1 at the end, changed as little as can be so that none differs from the next by more
/// than `steepest` says. Where the ends are too far apart for that, all steps are longer by one factor.
fn move_gently(shares: &mut [f64], steepest: &[f64]) {
    let n = steepest.len();
    let reach: f64 = steepest.iter().sum();
    let even = 1.0 / n as f64;
    let step = |k: usize| match reach {
        reach if reach >= 1.0 => steepest[k],
        reach if reach > 0.0 => steepest[k] / reach,
        _ => even,
    };
    let (mut from_start, mut to_end) = (0.0, (0..n).map(step).sum::<f64>());
    for (k, share) in shares.iter_mut().enumerate() {
        // Not `clamp`: where the ends are only just within reach, rounding may put its limits in the wrong order.
        *share = share.max(1.0 - to_end).min(from_start).clamp(0.0, 1.0);
        if k < n {
            from_start += step(k);
            to_end -= step(k);
        }
    }
    // The mean of the least function above and the greatest below that are nowhere steeper.
    let mut above = shares.to_vec();
    let mut below = shares.to_vec();
    for k in 1..=n {
        above[k] = above[k].min(above[k - 1] + step(k - 1));
        below[k] = below[k].max(below[k - 1] - step(k - 1));
    }
    for k in (0..n).rev() {
        above[k] = above[k].min(above[k + 1] + step(k));
        below[k] = below[k].max(below[k + 1] - step(k));
    }
    for (share, (above, below)) in shares.iter_mut().zip(above.iter().zip(&below)) {
        *share = (above + below) / 2.0;
    }
    (shares[0], shares[n]) = (0.0, 1.0);
}

/// Two passes that agree may be wrong only together; of two that do not, the one that is followed is believed as far as it is
/// trusted against the other. A box between two that disagree is nobody's.
fn confidence(of_passes: [f64; 2], trust: [f64; 2], agreement: f64, share: f64) -> f64 {
    let [forward, backward] = of_passes;
    let together = 1.0 - (1.0 - forward) * (1.0 - backward);
    let weight = |margin: f64| 1.0 / (1.0 + (-margin).exp());
    let margin = trust[0] - trust[1];
    let followed = (1.0 - share) * forward * weight(margin) + share * backward * weight(-margin);
    let on_one = (2.0 * share - 1.0).powi(2);
    let agreed = (agreement / AGREE).min(1.0);
    agreed * together + (1.0 - agreed) * followed * on_one
}

#[cfg(test)]
mod tests;
