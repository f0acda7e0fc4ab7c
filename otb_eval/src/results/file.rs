//! One result file, and the times beside it.

use std::{
    borrow::Cow,
    fs,
    path::{Path, PathBuf},
};

use infopart::geometry::Rect;

use super::{ResultsError, rows};
use crate::store::Record;

/// A tracker's boxes on a sequence.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ResultFile {
    /// A row a frame, as they stand in the file, odd ones among them.
    pub rows: Vec<Rect>,
    /// What stands between the numbers of a row.
    pub separators: Separators,
    /// The row of the truth, counted from 0, that the first row is of, if a record beside the file tells.
    pub start: Option<usize>,
    /// The column of scores, if the file has one.
    pub scores: Option<Vec<f64>>,
    /// How the file was read, if not as plain `x,y,w,h` rows.
    pub read_as: Option<String>,
    /// Whether the first row, which is NaN then, stands for the box that the tracker was given, whatever it is.
    pub first_is_given: bool,
}

/// What stands between the numbers of a file. Toolkits' readers take only some.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Separators {
    /// A comma somewhere.
    pub comma: bool,
    /// A tab somewhere.
    pub tab: bool,
    /// A space between numbers somewhere without a comma.
    pub space: bool,
    /// Something else than rows of `x,y,w,h`, or semicolons.
    pub other: bool,
}

impl ResultFile {
    /// Reads a file of `x,y,w,h` rows, separated by commas, tabs or spaces, or of another form with one meaning, and checks
    /// it by the record beside it, if there is one.
    ///
    /// # Errors
    /// [`ResultsError`], naming the file and line.
    pub fn read(path: &Path) -> Result<Self, ResultsError> {
        Self::with_record(path, Record::beside(path)?)
    }

    /// Reads a file and checks it by a record.
    pub(super) fn with_record(path: &Path, record: Option<Record>) -> Result<Self, ResultsError> {
        let bytes = fs::read(path).map_err(|source| ResultsError::Io { path: path.to_owned(), source })?;
        // What is all text, as nearly every file is, is told fastest so.
        let text = str::from_utf8(&bytes).map_or_else(|_| String::from_utf8_lossy(&bytes), Cow::Borrowed);
        let rows::Rows { rows, scores, read_as, first_is_given } = rows::parse(&text, path)?;
        if rows.is_empty() {
            return Err(ResultsError::Empty { path: path.to_owned() });
        }
        if record.as_ref().is_some_and(|record| !record.is_of(&bytes)) {
            return Err(ResultsError::Altered { path: path.to_owned(), record: Record::path(path) });
        }
        let start = record.and_then(|record| record.start());
        let separators = Separators { other: read_as.is_some(), ..Separators::of(&text) };
        Ok(Self { rows, separators, start, scores, read_as, first_is_given })
    }
}

impl Separators {
    /// The separators in a text of rows.
    pub fn of(text: &str) -> Self {
        let comma = text.contains(',');
        let is_spaced = |line: &str| line.trim().contains(' ') && !line.contains([',', '\t']);
        Self {
            comma,
            tab: text.contains('\t'),
            space: text.contains(' ') && text.lines().any(is_spaced),
            other: false,
        }
    }
}

/// The seconds beside a result, `SEQ_time.txt`; `None` if that is not there.
pub(super) fn seconds_beside(result: &Path) -> Result<Option<Vec<f64>>, ResultsError> {
    let stem = result.file_stem().unwrap_or_default().to_string_lossy();
    let path = result.with_file_name(format!("{stem}_time.txt"));
    if path.exists() { read_seconds(&path, 0).map(Some) } else { Ok(None) }
}

/// Reads a file of seconds, a frame a line; where a line has several, for repetitions, that of the repetition at `column`.
pub(super) fn read_seconds(path: &Path, column: usize) -> Result<Vec<f64>, ResultsError> {
    let text = fs::read(path).map_err(|source| ResultsError::Io { path: path.to_owned(), source })?;
    parse_seconds(&String::from_utf8_lossy(&text), path, column)
}

/// Reads a file of confidences, a frame a line. A blank line, as VOT has for the frame of the box given, is NaN.
pub(super) fn read_confidences(path: &Path) -> Result<Vec<f64>, ResultsError> {
    let bytes = fs::read(path).map_err(|source| ResultsError::Io { path: path.to_owned(), source })?;
    let text = String::from_utf8_lossy(&bytes);
    let number = |(index, line): (usize, &str)| {
        let word = line.trim();
        if word.is_empty() {
            return Ok(f64::NAN);
        }
        word.parse::<f64>().map_err(|_| ResultsError::Confidence {
            path: path.to_owned(),
            line: index + 1,
            text: line.to_owned(),
        })
    };
    text.trim_end().lines().enumerate().map(number).collect()
}

fn parse_seconds(text: &str, path: &Path, column: usize) -> Result<Vec<f64>, ResultsError> {
    let number =
        |(index, line): (usize, &str)| {
            let columns: Vec<&str> = line.trim().trim_end_matches(',').split(',').map(str::trim).collect();
            let seconds = columns.get(column).or(columns.first()).and_then(|word| word.parse::<f64>().ok());
            seconds.filter(|seconds| seconds.is_finite() && *seconds >= 0.0).ok_or_else(|| {
                ResultsError::Time { path: PathBuf::from(path), line: index + 1, text: line.to_owned() }
            })
        };
    text.trim_end().lines().enumerate().map(number).collect()
}
