//! Tables of scores as a terminal, a spreadsheet or a paper takes them.
//!
//! 1. A [`ScoreTable`] says what stands in each cell: a name, a count, or a score with what is known of its certainty.
//! 2. The best and the second best score of a column, or of a row where the trackers are columns, are found by the digits that
//!    are shown, so that two equal ones are marked alike.
//! 3. A [`TableFormat`] writes it.

mod build;
mod write;

use std::str::FromStr;

use thiserror::Error;

use crate::statistics::Interval;
pub use build::{OverallOptions, by_attribute, by_sequence, long_term, long_term_by_sequence, overall};

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableFormat {
    /// Columns of text; the best score is marked `*`, the second `+`.
    Text,
    /// Comma-separated (RFC 4180, lines end in LF), every digit, a column for each number, no marks.
    Csv,
    /// A Markdown table; the best score is bold, the second italic.
    Markdown,
    /// A LaTeX `tabular` with booktabs' rules; the best score is bold, the second underlined.
    Latex,
}

impl TableFormat {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Text, Self::Csv, Self::Markdown, Self::Latex];

    /// The name in flags.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Csv => "csv",
            Self::Markdown => "markdown",
            Self::Latex => "latex",
        }
    }
}

/// A format that does not exist.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no format `{word}`; choose one of: {}", TableFormat::ALL.map(TableFormat::name).join(", "))]
pub struct UnknownFormat {
    /// The name as given.
    pub word: String,
}

impl FromStr for TableFormat {
    type Err = UnknownFormat;

    fn from_str(word: &str) -> Result<Self, UnknownFormat> {
        Self::ALL
            .into_iter()
            .find(|format| format.name().eq_ignore_ascii_case(word))
            .ok_or_else(|| UnknownFormat { word: word.to_owned() })
    }
}

/// How scores are shown; in CSV they have every digit whatever this says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Digits {
    /// Digits after the point.
    pub decimals: usize,
    /// Whether scores are shown as percentages.
    pub percent: bool,
}

impl Default for Digits {
    fn default() -> Self {
        Self { decimals: 4, percent: false }
    }
}

impl Digits {
    fn shown(self, value: f64) -> String {
        let factor = if self.percent { 100.0 } else { 1.0 };
        let shown = format!("{:.*}", self.decimals, value * factor);
        // What rounds to zero has no sign.
        let is_zero = shown.trim_start_matches('-').bytes().all(|byte| matches!(byte, b'0' | b'.'));
        if is_zero { shown.trim_start_matches('-').to_owned() } else { shown }
    }

    fn signed(self, value: f64) -> String {
        let shown = self.shown(value);
        if shown.starts_with('-') { shown } else { format!("+{shown}") }
    }
}

/// What stands in a cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// A name.
    Text(String),
    /// A count of something; `None` where there is none.
    Count(Option<usize>),
    /// A score in [0, 1].
    Score(Option<Scored>),
    /// A difference of scores.
    Difference(Option<Scored>),
    /// A probability.
    Probability(Option<f64>),
    /// Frames per second.
    Speed(Option<f64>),
}

/// A number and what is known of its certainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scored {
    /// The number.
    pub value: f64,
    /// Standard deviation over seeds.
    pub deviation: Option<f64>,
    /// 95 % interval over sequences.
    pub interval: Option<Interval>,
}

/// A column's heading.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// As it is shown.
    pub title: String,
    /// Its name in CSV.
    pub key: String,
}

/// Among which scores the best is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ranked {
    /// Those of a column: the trackers are rows.
    Columns,
    /// Those of a row: the trackers are columns.
    Rows,
}

/// A table of scores.
#[derive(Debug, Clone, PartialEq)]
pub struct ScoreTable {
    /// What it shows.
    pub title: String,
    /// The columns.
    pub columns: Vec<Column>,
    /// The rows, a cell for each column.
    pub rows: Vec<Vec<Cell>>,
    /// Among which scores the best is looked for.
    pub ranked: Ranked,
}

/// How good a score is among those it is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rank {
    Best,
    Second,
    Other,
}

impl ScoreTable {
    /// The table as text of a format.
    pub fn written(&self, format: TableFormat, digits: Digits) -> String {
        match format {
            TableFormat::Text => write::text(self, digits),
            TableFormat::Csv => write::csv(self),
            TableFormat::Markdown => write::markdown(self, digits),
            TableFormat::Latex => write::latex(self, digits),
        }
    }

    /// Step 2.
    fn ranks(&self, digits: Digits) -> Vec<Vec<Rank>> {
        let shown = |row: usize, column: usize| match &self.rows[row][column] {
            Cell::Score(Some(scored)) => digits.shown(scored.value).parse::<f64>().ok(),
            _ => None,
        };
        let (rows, columns) = (self.rows.len(), self.columns.len());
        let mut ranks = vec![vec![Rank::Other; columns]; rows];
        let lines: Vec<Vec<(usize, usize)>> = match self.ranked {
            Ranked::Columns => {
                (0..columns).map(|column| (0..rows).map(|row| (row, column)).collect()).collect()
            }
            Ranked::Rows => (0..rows).map(|row| (0..columns).map(|column| (row, column)).collect()).collect(),
        };
        for line in lines {
            let mut values: Vec<f64> = line.iter().filter_map(|&(row, column)| shown(row, column)).collect();
            if values.len() < 2 {
                continue;
            }
            values.sort_by(|a, b| b.total_cmp(a));
            values.dedup();
            for (row, column) in line {
                let value = shown(row, column);
                ranks[row][column] = match value {
                    Some(value) if value == values[0] => Rank::Best,
                    Some(value) if values.get(1) == Some(&value) => Rank::Second,
                    _ => Rank::Other,
                };
            }
        }
        ranks
    }
}

#[cfg(test)]
mod tests;
