//! OTB's ground truth: one box a line, in any of the dialects the benchmark is written in.

use std::path::Path;

use super::{RowProblem, SequenceError};
use crate::geometry::Rect;

/// Reads a ground truth file: `x,y,w,h` a line, separated by commas, tabs, spaces or a mix of them, with any
/// line ends and with or without a last one.
///
/// The boxes are as they stand in the file; [`Origin::to_frame`](crate::geometry::Origin::to_frame) turns them into
/// frame coordinates. A row is `None` (the target is absent) if one of its numbers is NaN or a side is not positive.
///
/// # Errors
/// [`SequenceError::Io`] if the file cannot be read; [`SequenceError::GroundTruth`], naming the line, if a row has
/// letters, infinite numbers, or more or fewer than four numbers, or is blank with rows after it.
pub fn read_ground_truth(path: &Path) -> Result<Vec<Option<Rect>>, SequenceError> {
    Ok(present(read_boxes(path)?))
}

/// Parses the text of a ground truth file; `path` only names it in errors. See [`read_ground_truth`].
///
/// # Errors
/// [`SequenceError::GroundTruth`], as [`read_ground_truth`].
pub fn parse_ground_truth(text: &str, path: &Path) -> Result<Vec<Option<Rect>>, SequenceError> {
    Ok(present(parse_boxes(text, path)?))
}

/// Reads the rows of a ground truth or result file as they stand: absent targets (NaN) and boxes without area among
/// them, for whoever has rules of their own for these.
///
/// # Errors
/// As [`read_ground_truth`].
pub fn read_boxes(path: &Path) -> Result<Vec<Rect>, SequenceError> {
    let bytes = std::fs::read(path).map_err(|source| SequenceError::Io { path: path.to_owned(), source })?;
    parse_boxes(&String::from_utf8_lossy(&bytes), path)
}

/// Parses the text of [`read_boxes`]; `path` only names it in errors.
///
/// # Errors
/// [`SequenceError::GroundTruth`], as [`read_ground_truth`].
pub fn parse_boxes(text: &str, path: &Path) -> Result<Vec<Rect>, SequenceError> {
    let rows = text.trim_start_matches('\u{feff}').trim_end();
    rows.lines()
        .enumerate()
        .map(|(index, line)| {
            row_in_file(line).map_err(|problem| SequenceError::GroundTruth {
                path: path.to_owned(),
                line: index + 1,
                text: line.to_owned(),
                problem,
            })
        })
        .collect()
}

fn present(rows: Vec<Rect>) -> Vec<Option<Rect>> {
    rows.into_iter().map(|row| row.is_proper().then_some(row)).collect()
}

fn row_in_file(line: &str) -> Result<Rect, RowProblem> {
    if line.is_ascii() { ascii_row(line) } else { ascii_row(&line.replace(char::is_whitespace, " ")) }
}

/// Goes over the bytes once: published results are millions of numbers.
fn ascii_row(line: &str) -> Result<Rect, RowProblem> {
    let bytes = line.as_bytes();
    let (mut numbers, mut count, mut at) = ([0.0; 4], 0, 0);
    let mut has_number_since_comma = false;
    while let Some(&byte) = bytes.get(at) {
        if is_space(byte) {
            at += 1;
        } else if byte == b',' {
            if !has_number_since_comma {
                return Err(RowProblem::NotANumber);
            }
            has_number_since_comma = false;
            at += 1;
        } else {
            let is_end = |byte: &u8| *byte == b',' || is_space(*byte);
            let end = bytes[at..].iter().position(is_end).map_or(bytes.len(), |length| at + length);
            let number: f64 = line[at..end].parse().map_err(|_| RowProblem::NotANumber)?;
            if number.is_infinite() {
                return Err(RowProblem::Infinite);
            }
            if let Some(place) = numbers.get_mut(count) {
                *place = number;
            }
            (count, at, has_number_since_comma) = (count + 1, end, true);
        }
    }
    let [x, y, w, h] = numbers;
    match count {
        0 => Err(RowProblem::Blank),
        4 => Ok(Rect::new(x, y, w, h)),
        _ => Err(RowProblem::Count(count)),
    }
}

/// Those of `char::is_whitespace` that are ASCII.
fn is_space(byte: u8) -> bool {
    matches!(byte, b'\t'..=b'\r' | b' ')
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn parsed(text: &str) -> Result<Vec<Option<Rect>>, SequenceError> {
        parse_ground_truth(text, Path::new("gt.txt"))
    }

    #[test]
    fn every_dialect_gives_the_same_box() {
        let expected = vec![Some(Rect::new(205.0, 151.5, 17.0, 50.0)); 2];
        for text in [
            "205,151.5,17,50\n205,151.5,17,50\n",
            "205\t151.5\t17\t50\r\n205\t151.5\t17\t50",
            "205 151.5  17 50\n 205 151.5 17 50 \n\n \r\n",
            "205, 151.5,\t17 50,\n+205,1.515e2\t17.0,50",
            "\u{feff}205,151.5,17,50\n205,151.5,17,50",
        ] {
            assert_eq!(parsed(text).unwrap(), expected, "{text:?}");
        }
    }

    #[test]
    fn nan_rows_and_boxes_without_area_are_absent_targets() {
        let text = "NaN,NaN,NaN,NaN\nnan nan nan nan\nNAN\t1\t2\t3\n1,2,0,5\n1,2,5,-1\n0,0,0,0\n-3,-4,1,1";
        let mut expected = vec![None; 6];
        expected.push(Some(Rect::new(-3.0, -4.0, 1.0, 1.0)));
        assert_eq!(parsed(text).unwrap(), expected);
    }

    #[test]
    fn an_empty_file_has_no_rows() {
        assert_eq!(parsed("").unwrap(), vec![]);
        assert_eq!(parsed("\r\n \n").unwrap(), vec![]);
    }

    #[test]
    fn what_is_no_box_is_named_with_its_line() {
        for (row, expected) in [
            ("1,2,three,4", RowProblem::NotANumber),
            ("x,y,w,h", RowProblem::NotANumber),
            ("1,,2,3,4", RowProblem::NotANumber),
            ("1,2,3", RowProblem::Count(3)),
            ("1 2 3 4 5", RowProblem::Count(5)),
            ("1,2,inf,4", RowProblem::Infinite),
            ("1,2,1e999,4", RowProblem::Infinite),
            ("", RowProblem::Blank),
        ] {
            let error = parsed(&format!("1,2,3,4\n{row}\n1,2,3,4\n")).unwrap_err();
            let SequenceError::GroundTruth { line: 2, text, problem, .. } = &error else {
                panic!("{error}");
            };
            assert_eq!((text.as_str(), *problem), (row, expected));
            assert!(error.to_string().starts_with(&format!("gt.txt, line 2: `{row}` ")), "{error}");
        }
    }

    /// The numbers of a line, a character set and a step at a time.
    fn naive(line: &str) -> Result<Rect, RowProblem> {
        let line = line.trim();
        if line.is_empty() {
            return Err(RowProblem::Blank);
        }
        let mut numbers = Vec::new();
        for between_commas in line.strip_suffix(',').unwrap_or(line).split(',') {
            if between_commas.trim().is_empty() {
                return Err(RowProblem::NotANumber);
            }
            for word in between_commas.split_whitespace() {
                let number: f64 = word.parse().map_err(|_| RowProblem::NotANumber)?;
                if number.is_infinite() {
                    return Err(RowProblem::Infinite);
                }
                numbers.push(number);
            }
        }
        let [x, y, w, h] = numbers[..] else { return Err(RowProblem::Count(numbers.len())) };
        Ok(Rect::new(x, y, w, h))
    }

    proptest! {
        #[test]
        fn any_line_is_read_as_word_by_word(
            words in prop::collection::vec(
                prop::sample::select(vec!["1", "-2.5", "3e2", "0", "inf", "x", "é", ".", ""]), 0..7),
            between in prop::collection::vec(
                prop::sample::select(vec![",", " ", "\t", ", ", " ,", ",,", "\u{b}", "\u{a0}", "\u{3000},"]), 7),
        ) {
            let line: String = words.iter().zip(&between).flat_map(|(word, space)| [*word, *space]).collect();
            prop_assert_eq!(row_in_file(&line), naive(&line), "{:?}", line);
        }
    }
}
