//! The values that flags take. clap puts the flag's name before each message.

use std::num::NonZeroUsize;

use clap::ValueEnum;
use infopart::{
    geometry::{Origin, Rect},
    output::RowFormat,
};

/// `X,Y,W,H`.
pub fn parse_box(text: &str) -> Result<Rect, String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|number| {
            number
                .trim()
                .parse()
                .map_err(|_| format!("`{number}` is not a number; give X,Y,W,H, such as 120,80,40,110"))
        })
        .collect::<Result<_, _>>()?;
    let &[x, y, w, h] = numbers.as_slice() else {
        return Err(format!("{} numbers; give four, X,Y,W,H, such as 120,80,40,110", numbers.len()));
    };
    let given = Rect::new(x, y, w, h);
    if !numbers.iter().all(|number| number.is_finite()) {
        return Err("a number is not finite; give four finite numbers X,Y,W,H".to_owned());
    }
    if !given.is_proper() {
        return Err(format!("the size {w} x {h} is not positive; give a width and a height above 0"));
    }
    Ok(given)
}

/// Where the first box comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Init {
    /// It is given.
    Box(Rect),
    /// It is that of what moves first.
    Auto,
}

/// `X,Y,W,H` or `auto`.
pub fn parse_init(text: &str) -> Result<Init, String> {
    match text.trim() {
        "auto" => Ok(Init::Auto),
        given => parse_box(given).map(Init::Box),
    }
}

/// `0` or `1`.
pub fn parse_origin(text: &str) -> Result<Origin, String> {
    match text {
        "0" => Ok(Origin::Zero),
        "1" => Ok(Origin::One),
        _ => {
            Err("give 0 if boxes number the first pixel 0, or 1 if they number it 1 (MATLAB, OTB)".to_owned())
        }
    }
}

/// A count from 1 on.
pub fn parse_count(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if count > 0 => Ok(count),
        _ => Err("give a whole number from 1 on".to_owned()),
    }
}

/// More threads than any machine for this has, and than would start in reasonable time.
const MOST_THREADS: usize = 512;

/// A number of threads.
pub fn parse_threads(text: &str) -> Result<usize, String> {
    match parse_count(text)? {
        threads if threads <= MOST_THREADS => Ok(threads),
        _ => Err(format!("give at most {MOST_THREADS}; more than there are cores make nothing faster")),
    }
}

/// The trackers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TrackerName {
    /// The part that changes least, by boosted Haar-like features and HOG
    Infopart,
    /// The colour-histogram particle filter
    Colour,
}

/// A count from 1 on, as the type that has no 0.
pub fn parse_stride(text: &str) -> Result<NonZeroUsize, String> {
    parse_count(text).and_then(|count| NonZeroUsize::new(count).ok_or_else(|| "give 1 or more".to_owned()))
}

/// A finite number above 0.
pub fn parse_positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("give a finite number above 0, such as 0.5 or 1e-3".to_owned()),
    }
}

/// The formats of rows.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Format {
    /// x,y,w,h a frame
    Otb,
    /// With a header: boxes, confidence, status, effective sample size, time
    Csv,
    /// One JSON object a frame, with the keys of csv
    Jsonl,
}

impl From<Format> for RowFormat {
    fn from(format: Format) -> Self {
        match format {
            Format::Otb => Self::Otb,
            Format::Csv => Self::Csv,
            Format::Jsonl => Self::JsonLines,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_parse_with_signs_spaces_and_fractions() {
        assert_eq!(parse_box("-3, 4.5,1e1,20"), Ok(Rect::new(-3.0, 4.5, 10.0, 20.0)));
    }

    #[test]
    fn threads_have_an_end() {
        assert_eq!(parse_threads("512"), Ok(512));
        assert!(parse_threads("100000").unwrap_err().contains("at most 512") && parse_threads("0").is_err());
    }

    #[test]
    fn bad_boxes_are_told_apart() {
        for (text, reason) in [
            ("1,2,3", "3 numbers"),
            ("1,2,3,4,5", "5 numbers"),
            ("1,2,x,4", "`x` is not a number"),
            ("", "`` is not a number"),
            ("1,2,0,4", "not positive"),
            ("1,2,3,-4", "not positive"),
            ("nan,2,3,4", "not finite"),
            ("1,2,inf,4", "not finite"),
        ] {
            let message = parse_box(text).unwrap_err();
            assert!(message.contains(reason), "{text}: {message}");
        }
    }
}
