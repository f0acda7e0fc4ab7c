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
    thresholds.partition_point(|&threshold| overlap > threshold)
}

/// Index of the first of 0, 1, ..., 50 pixels that an error is not greater than; 51 if there is none, or for a NaN.
pub(super) fn first_pixel(error: f64) -> usize {
    first_reached(error, |index| index as f64)
}

/// Index of the first of 0, 0.01, ..., 0.5 that a normalised error is not greater than, likewise.
pub(super) fn first_hundredth(error: f64) -> usize {
    first_reached(error, |index| index as f64 / 100.0)
}

fn first_reached(error: f64, threshold: impl Fn(usize) -> f64) -> usize {
    let (mut low, mut high) = (0, PRECISION_THRESHOLDS);
    while low < high {
        let middle = (low + high) / 2;
        if error <= threshold(middle) { high = middle } else { low = middle + 1 }
    }
    low
}
