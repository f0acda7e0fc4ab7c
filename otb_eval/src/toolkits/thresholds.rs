//! The thresholds, to the last bit: "0, 0.05, ..., 1" is three different lists of numbers.

use infopart::metrics::{PRECISION_THRESHOLDS, SUCCESS_THRESHOLDS};

/// x / 20, as the Python benchmark makes them.
pub const TWENTIETHS: [f64; SUCCESS_THRESHOLDS] = [
    0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9,
    0.95, 1.0,
];

/// x * 0.05, as numpy's `arange` and `linspace` and torch's `arange` make them.
pub const ARANGE: [f64; SUCCESS_THRESHOLDS] = [
    0.0,
    0.05,
    0.1,
    0.150_000_000_000_000_02,
    0.2,
    0.25,
    0.300_000_000_000_000_04,
    0.350_000_000_000_000_03,
    0.4,
    0.45,
    0.5,
    0.55,
    0.600_000_000_000_000_1,
    0.65,
    0.700_000_000_000_000_1,
    0.75,
    0.8,
    0.850_000_000_000_000_1,
    0.9,
    0.950_000_000_000_000_1,
    1.0,
];

/// MATLAB's `0:0.05:1`, built from both ends, after a model of its colon operator. An overlap of exactly 0.65 is a success
/// at 0.65 only here.
pub const MATLAB: [f64; SUCCESS_THRESHOLDS] = [
    0.0,
    0.05,
    0.1,
    0.150_000_000_000_000_02,
    0.2,
    0.25,
    0.300_000_000_000_000_04,
    0.350_000_000_000_000_03,
    0.4,
    0.45,
    0.5,
    0.55,
    0.6,
    0.649_999_999_999_999_9,
    0.7,
    0.75,
    0.8,
    0.85,
    0.9,
    0.95,
    1.0,
];

/// Thresholds of the normalised precision: 0, 0.01, ..., 0.5.
pub const NORMALISED_THRESHOLDS: usize = PRECISION_THRESHOLDS;

/// Thresholds that an overlap is strictly greater than; a NaN passes none.
pub(super) fn passed(thresholds: &[f64; SUCCESS_THRESHOLDS], overlap: f64) -> usize {
    // The thresholds are multiples of 0.05 but for their last bits, so this is one off at most.
    let mut count = ((overlap * 20.0) as usize).min(SUCCESS_THRESHOLDS);
    while count < SUCCESS_THRESHOLDS && overlap > thresholds[count] {
        count += 1;
    }
    while count > 0 && overlap <= thresholds[count - 1] {
        count -= 1;
    }
    count
}

/// Index of the first of 0, 1, ..., 50 pixels that an error is not greater than; 51 if there is none, or for a NaN.
pub(super) fn first_pixel(error: f64) -> usize {
    first_reached(&PIXELS, error, error)
}

/// Index of the first of 0, 0.01, ..., 0.5 that a normalised error is not greater than, likewise.
pub(super) fn first_hundredth(error: f64) -> usize {
    first_reached(&HUNDREDTHS, error, error * 100.0)
}

const PIXELS: [f64; PRECISION_THRESHOLDS] = quotients(1.0);
const HUNDREDTHS: [f64; NORMALISED_THRESHOLDS] = quotients(100.0);

/// 0, 1, 2, ... by a divisor.
const fn quotients(divisor: f64) -> [f64; PRECISION_THRESHOLDS] {
    let mut all = [0.0; PRECISION_THRESHOLDS];
    let mut index = 0;
    while index < PRECISION_THRESHOLDS {
        all[index] = index as f64 / divisor;
        index += 1;
    }
    all
}

/// The search begins about `near`, where all but few errors end it.
fn first_reached(thresholds: &[f64; PRECISION_THRESHOLDS], error: f64, near: f64) -> usize {
    let guess = if near.is_nan() { PRECISION_THRESHOLDS } else { near as usize };
    let mut index = guess.min(PRECISION_THRESHOLDS);
    while index < PRECISION_THRESHOLDS && error > thresholds[index] {
        index += 1;
    }
    while index > 0 && error <= thresholds[index - 1] {
        index -= 1;
    }
    index
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Numbers about thresholds: themselves, the next above and below, and any.
    fn number() -> impl Strategy<Value = f64> {
        let about = |value: f64| prop::sample::select(vec![value, value.next_up(), value.next_down()]);
        let threshold = prop_oneof![
            prop::sample::select([TWENTIETHS, ARANGE, MATLAB].concat()),
            (0..=52_i32).prop_map(f64::from),
            (0..=52_i32).prop_map(|index| f64::from(index) / 100.0),
        ];
        prop_oneof![
            8 => threshold.prop_flat_map(about),
            2 => -2.0..60.0,
            1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, 1e300]),
        ]
    }

    proptest! {
        #[test]
        fn thresholds_are_those_counted_one_by_one(number in number()) {
            for thresholds in [&TWENTIETHS, &ARANGE, &MATLAB] {
                let above = thresholds.iter().filter(|threshold| number > **threshold).count();
                prop_assert_eq!(passed(thresholds, number), above);
            }
            let first = |divisor: f64| {
                let all = 0..PRECISION_THRESHOLDS;
                all.into_iter().find(|index| number <= *index as f64 / divisor).unwrap_or(PRECISION_THRESHOLDS)
            };
            prop_assert_eq!(first_pixel(number), first(1.0));
            prop_assert_eq!(first_hundredth(number), first(100.0));
        }
    }
}
