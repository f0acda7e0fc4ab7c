//! The rows of a result file, in the forms that people have them in.
//!
//! `x,y,w,h` a line is read as it stands. Other forms are read where only one meaning is possible, and said:
//! 1. a header line whose every word is known tells what each column is,
//! 2. semicolons separate as commas do,
//! 3. a first column of 1, 2, 3, ... (or from 0 on) is the number of the frame, a last one within [0, 1] a score,
//! 4. eight numbers are the corners of a polygon, of which the upright box around them is taken,
//! 5. a first line of a lone 1 is VOT's word for the box given; any later code is of a run that was started again.
//!
//! Where two meanings are possible, or none, the file is refused.

use std::path::Path;

use infopart::{
    geometry::Rect,
    sequence::{SequenceError, parse_boxes},
};

use super::ResultsError;

/// Characters of a bad line that are shown.
const SHOWN: usize = 80;

/// Rows, and what had to be understood to read them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Rows {
    pub(super) rows: Vec<Rect>,
    /// The column of scores, if there is one.
    pub(super) scores: Option<Vec<f64>>,
    /// How the file was read, if not as plain `x,y,w,h`.
    pub(super) read_as: Option<String>,
    /// Whether the first row stands for the box that the tracker was given, whatever it is.
    pub(super) first_is_given: bool,
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Frame,
    X,
    Y,
    Width,
    Height,
    Score,
}

const BOX: [Column; 4] = [Column::X, Column::Y, Column::Width, Column::Height];

/// Why a file has no certain meaning: the line, counted from 1, and what is wrong there.
struct Refusal(usize, String);

pub(super) fn parse(text: &str, path: &Path) -> Result<Rows, ResultsError> {
    let plainly = match parse_boxes(text, path) {
        Ok(rows) => return Ok(Rows { rows, ..Rows::default() }),
        Err(error) => error,
    };
    let text = text.trim_start_matches('\u{feff}').trim_end();
    otherwise(text).map_err(|refusal| {
        let Refusal(line, problem) = refusal.unwrap_or_else(|| plain_refusal(&plainly));
        let shown: String = text.lines().nth(line - 1).unwrap_or_default().chars().take(SHOWN).collect();
        ResultsError::Row { path: path.to_owned(), line, text: shown, problem }
    })
}

fn plain_refusal(error: &SequenceError) -> Refusal {
    match error {
        SequenceError::GroundTruth { line, problem, .. } => Refusal(*line, problem.to_string()),
        _ => Refusal(1, "is no row of a result".to_owned()),
    }
}

/// Reads any of the other forms; `Err(None)` if it looks like none of them.
fn otherwise(text: &str) -> Result<Rows, Option<Refusal>> {
    let mut lines: Vec<&str> = text.lines().collect();
    let mut told = Vec::new();
    let header = lines.first().and_then(|line| header(line));
    if header.is_some() {
        lines.remove(0);
        told.push("a header line".to_owned());
    }
    if text.contains(';') {
        told.push("semicolons between the numbers".to_owned());
    }
    let mut table = Vec::with_capacity(lines.len());
    for line in lines {
        table.push(numbers(line).ok_or(None)?);
    }
    let first_is_given = vot_codes(&table, usize::from(header.is_some()))?;
    if first_is_given {
        table.remove(0);
        told.push("VOT's code 1 for the box given".to_owned());
    }
    let width = table.first().map(Vec::len).ok_or(None)?;
    if table.iter().any(|row| row.len() != width) {
        return Err(None);
    }
    let mut scores = None;
    let mut rows = if width == 8 && header.is_none() {
        told.push("the upright box around each polygon".to_owned());
        table.iter().map(|row| around(row)).collect()
    } else {
        let columns = match header {
            Some(columns) if columns.len() == width => columns,
            Some(_) => {
                return Err(Some(Refusal(2, "has not as many numbers as the header has words".to_owned())));
            }
            None => columns_of(&table, width)?,
        };
        for (column, name) in
            [(Column::Frame, "a column of frame numbers"), (Column::Score, "a column of scores")]
        {
            if columns.contains(&column) {
                told.push(format!("{name}, left out"));
            }
        }
        let place = columns.iter().position(|column| *column == Column::Score);
        scores = place.map(|place| table.iter().map(|row| row[place]).collect());
        boxes(&table, &columns).ok_or(None)?
    };
    if first_is_given {
        rows.insert(0, Rect::new(f64::NAN, f64::NAN, f64::NAN, f64::NAN));
        scores.iter_mut().for_each(|scores: &mut Vec<f64>| scores.insert(0, f64::NAN));
    }
    Ok(Rows { rows, scores, read_as: Some(told.join("; ")), first_is_given })
}

/// The columns that a header names; `None` if a word is unknown, or a side of the box is missing.
fn header(line: &str) -> Option<Vec<Column>> {
    let words = line.split([',', ';', '\t', ' ']).filter(|word| !word.is_empty());
    let column = |word: &str| {
        Some(match word.trim_matches(['"', '\'', '#']).to_ascii_lowercase().as_str() {
            "frame" | "frame_id" | "frame_number" => Column::Frame,
            "x" | "left" => Column::X,
            "y" | "top" => Column::Y,
            "w" | "width" => Column::Width,
            "h" | "height" => Column::Height,
            "score" | "confidence" => Column::Score,
            _ => return None,
        })
    };
    let columns: Vec<Column> = words.map(column).collect::<Option<_>>()?;
    let once = |column: &Column| columns.iter().filter(|one| *one == column).count() == 1;
    BOX.iter().all(once).then_some(columns)
}

/// The numbers of a line; `None` if something else stands there, infinite numbers too.
fn numbers(line: &str) -> Option<Vec<f64>> {
    let line = line.trim();
    let mut numbers = Vec::with_capacity(8);
    for part in line.strip_suffix([',', ';']).unwrap_or(line).split([',', ';']) {
        let before = numbers.len();
        for word in part.split_whitespace() {
            numbers.push(word.parse::<f64>().ok().filter(|number| !number.is_infinite())?);
        }
        if numbers.len() == before {
            return None;
        }
    }
    Some(numbers)
}

/// Whether the first row is VOT's code for the box given; `before` lines stand before the rows.
fn vot_codes(table: &[Vec<f64>], before: usize) -> Result<bool, Option<Refusal>> {
    let is_code = |row: &Vec<f64>| matches!(row[..], [code] if code == 0.0 || code == 1.0 || code == 2.0);
    let Some(first) = table.first().filter(|_| table.len() > 1) else { return Ok(false) };
    if !is_code(first) || first[0] != 1.0 {
        return Ok(false);
    }
    match table.iter().skip(1).position(is_code) {
        None => Ok(true),
        Some(row) => Err(Some(Refusal(
            row + 2 + before,
            "is one of VOT's codes: the tracker failed and was started again on the true box, so this is no result of one pass"
                .to_owned(),
        ))),
    }
}

/// What the columns of a table without a header are.
fn columns_of(table: &[Vec<f64>], width: usize) -> Result<Vec<Column>, Option<Refusal>> {
    let column = |index: usize| table.iter().map(move |row| row[index]);
    let is_counter =
        |from: f64| table.len() > 1 && column(0).enumerate().all(|(i, value)| value == from + i as f64);
    let counts = is_counter(0.0) || is_counter(1.0);
    let is_score = column(width - 1).all(|value| (0.0..=1.0).contains(&value));
    let ends = |frame: &[Column], score: &[Column]| [frame, &BOX, score].concat();
    let unclear = |what: &str| {
        Err(Some(Refusal(
            1,
            format!("{what}; add a header line such as x,y,w,h,score, or leave only x,y,w,h"),
        )))
    };
    match (width, counts, is_score) {
        (4, _, _) => Ok(BOX.to_vec()),
        (5, true, false) => Ok(ends(&[Column::Frame], &[])),
        (5, false, true) => Ok(ends(&[], &[Column::Score])),
        (6, true, true) => Ok(ends(&[Column::Frame], &[Column::Score])),
        (5, true, true) => unclear(
            "begins with a count and ends with a number within [0, 1], so that either may be no side of a box",
        ),
        (5 | 6, _, _) => {
            let extra = if width == 5 { "the fifth" } else { "two" };
            unclear(&format!("has {width} numbers, and nothing tells what {extra} beside x,y,w,h are"))
        }
        _ => Err(None),
    }
}

fn boxes(table: &[Vec<f64>], columns: &[Column]) -> Option<Vec<Rect>> {
    let mut at = [0; 4];
    for (place, side) in at.iter_mut().zip(BOX) {
        *place = columns.iter().position(|column| *column == side)?;
    }
    Some(table.iter().map(|row| Rect::new(row[at[0]], row[at[1]], row[at[2]], row[at[3]])).collect())
}

/// The upright box around the corners x1,y1,...,x4,y4; NaN if one of them is.
fn around(corners: &[f64]) -> Rect {
    if corners.iter().any(|number| number.is_nan()) {
        return Rect::new(f64::NAN, f64::NAN, f64::NAN, f64::NAN);
    }
    let ends = |first: usize| {
        let along = corners.iter().skip(first).step_by(2).copied();
        (along.clone().fold(f64::INFINITY, f64::min), along.fold(f64::NEG_INFINITY, f64::max))
    };
    let ((left, right), (top, bottom)) = (ends(0), ends(1));
    Rect::new(left, top, right - left, bottom - top)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(Vec<[f64; 4]>, String), String> {
        let rows = parse(text, Path::new("A.txt")).map_err(|error| error.to_string())?;
        let numbers = rows.rows.iter().map(|row| [row.x, row.y, row.w, row.h]).collect();
        Ok((numbers, rows.read_as.unwrap_or_default()))
    }

    #[test]
    fn forms_of_one_meaning_are_read_and_said() {
        let expected = vec![[10.0, 20.0, 30.0, 40.0], [10.5, 20.0, 30.0, 41.0]];
        for (text, told) in [
            ("10,20,30,40\n10.5 20\t30,41\n", ""),
            ("x,y,w,h\r\n10,20,30,40\r\n10.5,20,30,41\r\n", "a header line"),
            (
                "\"frame\";\"left\";\"top\";\"height\";\"width\"\n7;10;20;40;30\n9;10.5;20;41;30\n",
                "frame numbers",
            ),
            ("10;20;30;40\n10.5; 20; 30; 41;\n", "semicolons"),
            ("10,20,30,40,0.93\n10.5,20,30,41,1\n", "a column of scores, left out"),
            ("1 10 20 30 40\n2 10.5 20 30 41\n", "a column of frame numbers, left out"),
            ("0\t10\t20\t30\t40\n1\t10.5\t20\t30\t41\n", "a column of frame numbers, left out"),
            ("1,10,20,30,40,0.5\n2,10.5,20,30,41,0.25\n", "frame numbers, left out; a column of scores"),
            ("40,20,40,60,10,60,10,20\n10.5,20,40.5,20,40.5,61,10.5,61\n", "upright box around each polygon"),
        ] {
            let (rows, said) = read(text).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_eq!(rows, expected, "{text}");
            assert!(said.contains(told) && said.is_empty() == told.is_empty(), "{text}: {said}");
        }
    }

    #[test]
    fn a_vot_result_of_one_pass_is_read_and_one_that_was_started_again_refused() {
        let rows = parse("1\n10,20,30,40\n11,20,30,40\n", Path::new("A.txt")).unwrap();
        assert!(
            rows.first_is_given && rows.rows.len() == 3 && rows.rows[0].x.is_nan() && rows.rows[2].x == 11.0
        );
        for text in ["1\n10,20,30,40\n2\n0\n", "1\n10,20,30,40\n1\n", "1\n5,5,5,5\n0\n"] {
            let told = read(text).unwrap_err();
            assert!(told.contains("A.txt, line 3") && told.contains("VOT's codes"), "{told}");
        }
    }

    #[test]
    fn forms_of_several_meanings_or_none_are_refused_with_their_line() {
        for (text, needle) in [
            ("10,20,30,40,50\n11,20,30,40,50\n", "line 1: `10,20,30,40,50` has 5 numbers"),
            ("1,20,30,40,0.5\n2,20,30,40,0.5\n", "begins with a count and ends with a number within [0, 1]"),
            ("10,20,30,40,0.5,3\n10,20,30,40,0.5,3\n", "has 6 numbers"),
            ("10,20,30,40\n10,b,30,40\n", "line 2: `10,b,30,40`"),
            ("10,20,30,40\n10,20,30\n", "line 2"),
            ("10,20,30,40\n10,20,30,40,0.5\n", "line 2"),
            ("x,y,w,h\n1,2,3\n", "line 2: `1,2,3` has not as many numbers as the header"),
            ("xmin,ymin,xmax,ymax\n1,2,3,4\n", "line 1: `xmin,ymin,xmax,ymax`"),
            ("1,2,,4\n", "line 1"),
            ("1;2;inf;4\n", "line 1"),
            ("\u{1b}[31m,2,3,4\n", "line 1: `\\u{1b}[31m,2,3,4`"),
            ("1\n", "line 1"),
            ("2\n1,2,3,4\n", "line 1"),
        ] {
            let told = read(text).unwrap_err();
            assert!(told.contains(needle) && !told.contains('\u{1b}'), "{text}: {told}");
        }
        let long = read(&"9,".repeat(5000)).unwrap_err();
        assert!(long.len() < 400, "{long}");
    }
}
