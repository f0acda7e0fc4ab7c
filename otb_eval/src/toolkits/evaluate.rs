//! Scores one result against one truth under any toolkit's rules.
//!
//! Steps, in the order of the toolkits that have them:
//! 1. refuse what the toolkit fails on,
//! 2. replace lost boxes by the box before,
//! 3. bring both files to one length,
//! 4. overwrite the first row with the truth,
//! 5. compute overlap, centre error and normalised centre error of each frame, and what a frame without a valid truth
//!    is worth,
//! 6. count the thresholds that each of them reaches.

use infopart::geometry::Rect;

use super::{
    Crash, Denominator, FirstFrame, Hits, InvalidError, Lengths, LostBoxes, Normalisation, OverlapFormula,
    Rules, Toolkit, Validity, curves::Histogram,
};

/// Stands for a row that the result does not have.
const ABSENT: Rect = Rect::new(f64::NAN, f64::NAN, f64::NAN, f64::NAN);

/// What a benchmark says of each frame besides the true box; each list is empty, or has an entry a row.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FrameNotes<'a> {
    /// Whether the target is absent.
    pub absent: &'a [bool],
    /// Its visible eighths.
    pub cover: &'a [u8],
    /// Width and height of the frames, to which rules that count what can be seen clip boxes.
    pub resolution: Option<(usize, usize)>,
}

impl FrameNotes<'_> {
    fn is_absent(&self, index: usize) -> bool {
        self.absent.get(index).copied().unwrap_or(false)
    }

    fn is_visible(&self, index: usize) -> bool {
        self.cover.get(index).is_none_or(|eighths| *eighths > 0)
    }
}

/// Scores the rows of a result against those of the truth, both as they stand in their files.
///
/// # Errors
/// [`Crash`] where the toolkit itself would fail.
pub fn evaluate(rules: &Rules, truth: &[Rect], result: &[Rect]) -> Result<Hits, Crash> {
    evaluate_with(rules, truth, FrameNotes::default(), result)
}

/// As [`evaluate`], with what the benchmark says of the frames of the truth.
///
/// # Errors
/// [`Crash`] where the toolkit itself would fail.
pub fn evaluate_with(
    rules: &Rules,
    truth: &[Rect],
    notes: FrameNotes<'_>,
    result: &[Rect],
) -> Result<Hits, Crash> {
    check_lengths(rules, truth, result)?;
    check_boxes(rules, truth, result)?;
    let mut histogram = Histogram::new(rules);
    let (mut before, mut valid_frames, mut counted) = (ABSENT, 0, 0);
    let frames = frames(rules, truth.len(), result.len());
    for (index, &true_box) in truth.iter().enumerate().take(frames) {
        let row = match result.get(index) {
            Some(&row) if index > 0 && is_lost(rules.lost_boxes, row, true_box) => before,
            Some(&row) => row,
            None => ABSENT,
        };
        before = row;
        let overwritten = index == 0 && rules.first_frame == FirstFrame::Truth;
        let row = if overwritten { true_box } else { row };
        if rules.toolkit == Toolkit::Jwlim && row.area() + true_box.area() == 0.0 {
            return Err(Crash::NoArea { toolkit: rules.toolkit, row: index + 1 });
        }
        if rules.counts_visible && (index == 0 || !notes.is_visible(index)) {
            continue;
        }
        counted += 1;
        if rules.absent_is_miss && notes.is_absent(index) {
            histogram.count(-1.0, f64::INFINITY, f64::INFINITY);
            continue;
        }
        let (row, true_box) = match notes.resolution.filter(|_| rules.counts_visible) {
            Some(size) => (clipped(row, size), clipped(true_box, size)),
            None => (row, true_box),
        };
        valid_frames += usize::from(is_valid(rules.valid_for_overlap, true_box));
        histogram.count(
            overlap(rules, row, true_box),
            error(rules, row, true_box),
            normalised_error(rules, row, true_box),
        );
    }
    Ok(histogram.hits(match rules.denominator {
        Denominator::Frames => counted,
        Denominator::ValidFrames => valid_frames,
    }))
}

/// Step 1, and what step 3 refuses.
fn check_lengths(rules: &Rules, truth: &[Rect], result: &[Rect]) -> Result<(), Crash> {
    let (longer, shorter) = (result.len() > truth.len(), result.len() < truth.len());
    let fails = match rules.lengths {
        Lengths::Common | Lengths::Misses => false,
        Lengths::Fail => longer || shorter,
        Lengths::FailIfShorter => shorter,
        Lengths::FailOnValid => {
            longer || truth[result.len()..].iter().any(|row| is_valid(rules.valid_for_overlap, *row))
        }
        Lengths::ResultsOrFail => longer,
    };
    if fails {
        return Err(Crash::Lengths { toolkit: rules.toolkit, result: result.len(), truth: truth.len() });
    }
    Ok(())
}

fn check_boxes(rules: &Rules, truth: &[Rect], result: &[Rect]) -> Result<(), Crash> {
    let toolkit = rules.toolkit;
    if rules.lost_boxes == LostBoxes::ZeroCarriedElseRefused {
        let refused = |row: &Rect| has_nan(*row) || row.w < 0.0 || row.h < 0.0;
        if let Some(index) = result.iter().position(refused) {
            return Err(Crash::BadBox { toolkit, row: index + 1 });
        }
    }
    if rules.refuses_nan_truth
        && let Some(index) = truth.iter().position(|row| has_nan(*row))
    {
        return Err(Crash::NanTruth { toolkit, row: index + 1 });
    }
    Ok(())
}

/// Step 2.
fn is_lost(rule: LostBoxes, row: Rect, true_box: Rect) -> bool {
    match rule {
        LostBoxes::AsGiven => false,
        LostBoxes::Carried => !row.is_proper(),
        LostBoxes::CarriedUnlessTruthIsNan => {
            let all_nan = [row.x, row.y, row.w, row.h].iter().all(|number| number.is_nan());
            (all_nan || row.w <= 0.0 || row.h <= 0.0) && !has_nan(true_box)
        }
        LostBoxes::ZeroCarriedElseRefused => (row.w == 0.0 || row.h == 0.0) && !has_nan(true_box),
    }
}

/// Step 3: how many rows are scored.
fn frames(rules: &Rules, truth: usize, result: usize) -> usize {
    match rules.lengths {
        Lengths::Common | Lengths::ResultsOrFail => truth.min(result),
        Lengths::Fail | Lengths::FailIfShorter | Lengths::FailOnValid | Lengths::Misses => truth,
    }
}

/// A box in frames of that size as the GOT-10k toolkit clips it: its corner moves into the frame without its sides getting shorter by
/// that, then its sides are cut at the far edges.
fn clipped(row: Rect, (width, height): (usize, usize)) -> Rect {
    let along = |start: f64, side: f64, end: f64| {
        let start = start.max(0.0).min(end);
        (start, side.max(0.0).min(end - start))
    };
    let ((x, w), (y, h)) = (along(row.x, row.w, width as f64), along(row.y, row.h, height as f64));
    if has_nan(row) { row } else { Rect::new(x, y, w, h) }
}

fn is_valid(validity: Validity, true_box: Rect) -> bool {
    let Rect { x, y, w, h } = true_box;
    match validity {
        Validity::Any => true,
        Validity::Proper => true_box.is_proper(),
        Validity::FourPositive => x > 0.0 && y > 0.0 && w > 0.0 && h > 0.0,
        Validity::SidesPositive => w > 0.0 && h > 0.0,
        Validity::CentrePositive => {
            let (x, y) = pixel_centre(true_box);
            x > 0.0 && y > 0.0
        }
    }
}

/// Step 5: the overlap, or -1 for a frame that is a miss whatever the result.
fn overlap(rules: &Rules, row: Rect, true_box: Rect) -> f64 {
    if !is_valid(rules.valid_for_overlap, true_box) {
        return -1.0;
    }
    if has_nan(row) || has_nan(true_box) {
        return f64::NAN;
    }
    let shared = |pixel: f64| {
        let side = |a: f64, a_side: f64, b: f64, b_side: f64| {
            ((a + a_side - pixel).min(b + b_side - pixel) - a.max(b) + pixel).max(0.0)
        };
        side(row.x, row.w, true_box.x, true_box.w) * side(row.y, row.h, true_box.y, true_box.h)
    };
    let union = |shared: f64| row.w * row.h + true_box.w * true_box.h - shared;
    match rules.overlap {
        OverlapFormula::Areas => row.overlap(&true_box),
        OverlapFormula::Pixels => shared(1.0) / union(shared(1.0)),
        OverlapFormula::ClippedAreas => (shared(0.0) / union(shared(0.0))).clamp(0.0, 1.0),
        OverlapFormula::ClippedAreasEps => {
            (shared(0.0) / (union(shared(0.0)) + f64::EPSILON)).clamp(0.0, 1.0)
        }
    }
}

/// Step 5: the centre error in pixels; -1 for a hit and infinite for a miss whatever the result.
fn error(rules: &Rules, row: Rect, true_box: Rect) -> f64 {
    if !is_valid(rules.valid_for_error, true_box) {
        return match rules.invalid_error {
            InvalidError::Hit => -1.0,
            InvalidError::Miss => f64::INFINITY,
        };
    }
    let ((x, y), (true_x, true_y)) = (pixel_centre(row), pixel_centre(true_box));
    let error = ((x - true_x).powi(2) + (y - true_y).powi(2)).sqrt();
    match rules.error_decimals {
        Some(decimals) => (error * 10_f64.powi(decimals)).round() / 10_f64.powi(decimals),
        None => error,
    }
}

/// Step 5: the centre error in sides of the truth. Toolkits that have it take a frame without a valid truth as a hit.
fn normalised_error(rules: &Rules, row: Rect, true_box: Rect) -> f64 {
    let Some(normalisation) = rules.normalisation else { return f64::NAN };
    if !is_valid(rules.valid_for_error, true_box) {
        return if rules.toolkit == Toolkit::Plain { f64::INFINITY } else { -1.0 };
    }
    let added = match normalisation {
        Normalisation::Sides => 0.0,
        Normalisation::SidesEps => 1e-16,
    };
    let ((x, y), (true_x, true_y)) = (pixel_centre(row), pixel_centre(true_box));
    let (w, h) = (true_box.w + added, true_box.h + added);
    ((x / w - true_x / w).powi(2) + (y / h - true_y / h).powi(2)).sqrt()
}

/// The centre as all toolkits have it, of a box whose last pixel is x + w - 1.
fn pixel_centre(row: Rect) -> (f64, f64) {
    (row.x + (row.w - 1.0) / 2.0, row.y + (row.h - 1.0) / 2.0)
}

fn has_nan(row: Rect) -> bool {
    [row.x, row.y, row.w, row.h].iter().any(|number| number.is_nan())
}
