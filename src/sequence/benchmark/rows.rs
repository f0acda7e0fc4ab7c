//! The rows of a benchmark's ground truth: boxes, corners, polygons, masks.

use std::path::Path;

use super::super::{RowProblem, SequenceError};
use crate::geometry::Rect;

/// A row without a target.
pub(super) const ABSENT: Rect = Rect::new(f64::NAN, f64::NAN, f64::NAN, f64::NAN);

/// How a polygon becomes a box. Most users take [`MinMax`](Self::MinMax).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PolygonBox {
    /// The upright box between the smallest and the largest coordinates.
    #[default]
    MinMax,
    /// The upright box of the area of the polygon about the mean of its corners, as the GOT-10k toolkit and pysot have it for VOT:
    /// the sides of the upright box times s, plus 1, where s is the root of the quotient of both areas.
    EqualArea,
}

/// How rows are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RowForm {
    /// `x,y,w,h`.
    Box,
    /// `x1,y1,x2,y2`.
    Corners,
    /// `id x1 y1 x2 y2 frame lost ...`, the last of them words, as Need for Speed has them at 240 frames a second.
    Track,
    /// `x,y,w,h`, a polygon `x1,y1,...,xn,yn`, or a mask `mX,Y,W,H,zeros,ones,...`, as VOT has them.
    Region(PolygonBox),
}

/// The rows of a text, and whether the file itself says that the target is absent there; `path` only names it in errors.
pub(super) fn parse(text: &str, path: &Path, form: RowForm) -> Result<Vec<(Rect, bool)>, SequenceError> {
    let rows = text.trim_start_matches('\u{feff}').trim_end();
    let row = |(index, line): (usize, &str)| {
        of_line(line, form).map_err(|problem| SequenceError::GroundTruth {
            path: path.to_owned(),
            line: index + 1,
            text: line.chars().take(120).collect(),
            problem,
        })
    };
    rows.lines().enumerate().map(row).collect()
}

fn of_line(line: &str, form: RowForm) -> Result<(Rect, bool), RowProblem> {
    if form == RowForm::Track { of_track(line) } else { of_other(line, form).map(|row| (row, false)) }
}

fn of_other(line: &str, form: RowForm) -> Result<Rect, RowProblem> {
    if let (RowForm::Region(_), Some(mask)) = (form, line.trim().strip_prefix('m')) {
        return of_mask(&numbers(mask.trim_start_matches(':'))?);
    }
    let numbers = numbers(line)?;
    match (form, &numbers[..]) {
        (RowForm::Corners, &[left, top, right, bottom]) => Ok(between(left, top, right, bottom)),
        (_, &[x, y, w, h]) => Ok(Rect::new(x, y, w, h)),
        (RowForm::Region(rule), corners) if corners.len() >= 6 && corners.len() % 2 == 0 => {
            Ok(of_polygon(corners, rule))
        }
        // VOT writes one number where there is no box.
        (RowForm::Region(_), [_]) => Ok(ABSENT),
        _ => Err(RowProblem::Count(numbers.len())),
    }
}

/// The numbers of a line, separated by commas, tabs, spaces or a mix of them.
fn numbers(line: &str) -> Result<Vec<f64>, RowProblem> {
    if line.trim().is_empty() {
        return Err(RowProblem::Blank);
    }
    let words = line.split([',', '\t', ' ']).map(str::trim).filter(|word| !word.is_empty());
    words.map(number).collect()
}

fn number(word: &str) -> Result<f64, RowProblem> {
    let number: f64 = word.parse().map_err(|_| RowProblem::NotANumber)?;
    if number.is_infinite() { Err(RowProblem::Infinite) } else { Ok(number) }
}

fn between(left: f64, top: f64, right: f64, bottom: f64) -> Rect {
    Rect::new(left, top, right - left, bottom - top)
}

fn of_track(line: &str) -> Result<(Rect, bool), RowProblem> {
    let words: Vec<&str> = line.split_whitespace().collect();
    if words.is_empty() {
        return Err(RowProblem::Blank);
    }
    let [_, left, top, right, bottom, _, lost, ..] = words[..] else {
        return Err(RowProblem::Count(words.len()));
    };
    let row = between(number(left)?, number(top)?, number(right)?, number(bottom)?);
    Ok((row, number(lost)? == 1.0))
}

fn of_polygon(corners: &[f64], rule: PolygonBox) -> Rect {
    if corners.iter().any(|number| number.is_nan()) {
        return ABSENT;
    }
    let along = |first: usize| corners.iter().skip(first).step_by(2).copied();
    let ends = |first: usize| {
        (along(first).fold(f64::INFINITY, f64::min), along(first).fold(f64::NEG_INFINITY, f64::max))
    };
    let ((left, right), (top, bottom)) = (ends(0), ends(1));
    if rule == PolygonBox::MinMax || corners.len() != 8 {
        return between(left, top, right, bottom);
    }
    let centre = |first: usize| along(first).sum::<f64>() / 4.0;
    let side = |from: usize| (corners[from] - corners[from + 2]).hypot(corners[from + 1] - corners[from + 3]);
    let share = (side(0) * side(2) / ((right - left) * (bottom - top))).sqrt();
    let (w, h) = (share * (right - left) + 1.0, share * (bottom - top) + 1.0);
    Rect::new(centre(0) - w / 2.0, centre(1) - h / 2.0, w, h)
}

/// Corner and size of the mask, then the lengths of its runs, row by row, of pixels outside and inside in turn.
fn of_mask(numbers: &[f64]) -> Result<Rect, RowProblem> {
    let whole = numbers.iter().all(|number| number.fract() == 0.0 && number.abs() < 1e9);
    let ([left, top, width, _, runs @ ..], true) = (numbers, whole) else {
        return Err(RowProblem::Count(numbers.len()));
    };
    let width = width.max(1.0) as u64;
    let (mut at, mut ends) = (0_u64, None::<(u64, u64, u64, u64)>);
    for (index, run) in runs.iter().enumerate() {
        let next = at + run.max(0.0) as u64;
        if index % 2 == 1 && next > at {
            let (first, last) = ((at / width, at % width), ((next - 1) / width, (next - 1) % width));
            // A run over the end of a row reaches both sides.
            let (from, to) = if first.0 == last.0 { (first.1, last.1) } else { (0, width - 1) };
            ends = Some(match ends {
                None => (from, first.0, to, last.0),
                Some((l, t, r, b)) => (l.min(from), t.min(first.0), r.max(to), b.max(last.0)),
            });
        }
        at = next;
    }
    Ok(ends.map_or(ABSENT, |(l, t, r, b)| {
        Rect::new(left + l as f64, top + t as f64, (r - l + 1) as f64, (b - t + 1) as f64)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(line: &str, form: RowForm) -> Rect {
        of_line(line, form).unwrap().0
    }

    const MIN_MAX: RowForm = RowForm::Region(PolygonBox::MinMax);

    #[test]
    fn every_form_gives_the_box_that_it_means() {
        let expected = Rect::new(10.0, 20.0, 30.0, 40.0);
        for (line, form) in [
            ("10,20,30,40", RowForm::Box),
            ("10\t20 30, 40", RowForm::Box),
            ("10,20,40,60", RowForm::Corners),
            ("0 10 20 40 60 1 0 0 0 \"ball\"", RowForm::Track),
            ("10,20,30,40", MIN_MAX),
            ("10,60,40,60,40,20,10,20", MIN_MAX),
            ("10,60,40,60,25,20", MIN_MAX),
        ] {
            assert_eq!(row(line, form), expected, "{line}");
        }
        for line in ["0", "NaN,NaN,NaN,NaN,NaN,NaN,NaN,NaN"] {
            assert!(row(line, MIN_MAX).x.is_nan(), "{line}");
        }
        assert!(of_line("0 1 2 3 4 9 1 0 0 \"ball\"", RowForm::Track).unwrap().1, "lost");
    }

    /// `ImageVOT._corner2rect` of got10k 0.1.3 on the same corners; benchmark/golden in otb_eval has more of its numbers.
    #[test]
    fn a_polygon_of_equal_area_is_got10ks() {
        let found = row(
            "334.02,128.36,438.19,188.78,396.39,260.83,292.23,200.41",
            RowForm::Region(PolygonBox::EqualArea),
        );
        let expected = [312.1420511293659, 146.38778561323034, 106.13089774126823, 96.41442877353934];
        assert!((found.x - expected[0]).abs() < 1e-12 && (found.y - expected[1]).abs() < 1e-12, "{found:?}");
        assert!((found.w - expected[2]).abs() < 1e-12 && (found.h - expected[3]).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_masks_box_holds_its_pixels() {
        // Four pixels wide: ..##, ##.., then a lone one below the second column.
        assert_eq!(row("m10,20,4,3,2,4,3,1", MIN_MAX), Rect::new(10.0, 20.0, 4.0, 3.0));
        assert_eq!(row("m:0,0,4,3,5,2,5", MIN_MAX), Rect::new(1.0, 1.0, 2.0, 1.0));
        assert!(row("m0,0,4,3,12", MIN_MAX).x.is_nan());
    }

    #[test]
    fn what_is_no_row_is_refused() {
        for (line, form, problem) in [
            ("1,2,3", RowForm::Box, RowProblem::Count(3)),
            ("1,2,3,4,5", MIN_MAX, RowProblem::Count(5)),
            ("", RowForm::Box, RowProblem::Blank),
            ("1,2,inf,4", RowForm::Corners, RowProblem::Infinite),
            ("0 1 2 x 4 5 0", RowForm::Track, RowProblem::NotANumber),
            ("m1,2", MIN_MAX, RowProblem::Count(2)),
        ] {
            assert_eq!(of_line(line, form), Err(problem), "{line}");
        }
    }
}
