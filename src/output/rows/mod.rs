//! One row a frame, in a format a reader of the field's tools knows.

use std::path::Path;

use serde::Serialize;

use super::{Destination, FrameEvent, Observer, OutputError};
use crate::{
    geometry::{Origin, Rect},
    tracker::{Evidence, Status},
};

mod csv;
mod jsonl;
mod otb;

/// How rows are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum RowFormat {
    /// `x,y,w,h` a frame, as the OTB toolkit reads results.
    #[default]
    Otb,
    /// Comma-separated with a header: boxes, confidence, status, effective sample size, time.
    Csv,
    /// One JSON object a line, with the same keys as the CSV.
    JsonLines,
}

impl RowFormat {
    /// The format that a file's extension stands for: `.csv`, `.jsonl`, and [`RowFormat::Otb`] for any other.
    pub fn from_path(path: &Path) -> Self {
        match path
            .extension()
            .and_then(|extension| extension.to_str())
            .map(str::to_ascii_lowercase)
            .as_deref()
        {
            Some("csv") => Self::Csv,
            Some("jsonl" | "ndjson") => Self::JsonLines,
            _ => Self::Otb,
        }
    }

    fn header(self, timing: bool) -> Option<String> {
        match self {
            Self::Csv => Some(csv::header(timing)),
            Self::Otb | Self::JsonLines => None,
        }
    }

    fn line(self, row: &Row) -> String {
        match self {
            Self::Otb => otb::line(row),
            Self::Csv => csv::line(row),
            Self::JsonLines => jsonl::line(row),
        }
    }
}

/// How a [`RowWriter`] writes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowOptions {
    /// The rows' format.
    pub format: RowFormat,
    /// The number of the first pixel in the rows' boxes.
    pub origin: Origin,
    /// The initial box as the user gave it (with `origin`), to be the first row to the last digit.
    pub initial_box_as_given: Option<Rect>,
    /// Whether CSV and JSON rows carry the milliseconds that each frame took.
    pub timing: bool,
}

/// Writes a row for each frame, at once, so that a run that is stopped keeps its rows.
#[derive(Debug)]
pub struct RowWriter<D> {
    destination: D,
    options: RowOptions,
    started: bool,
}

impl<D: Destination> RowWriter<D> {
    /// Rows to `destination`; nothing is written before the first frame.
    pub fn new(destination: D, options: RowOptions) -> Self {
        Self { destination, options, started: false }
    }

    /// Where the rows went.
    pub fn into_destination(self) -> D {
        self.destination
    }

    fn write(&mut self, mut line: String) -> Result<(), OutputError> {
        line.push('\n');
        let written = self.destination.write_all(line.as_bytes()).and_then(|()| self.destination.flush());
        written.map_err(|error| self.destination.name_error(error))
    }
}

impl<D: Destination> Observer for RowWriter<D> {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        let mut row = Row::of(event, &self.options);
        if !self.started {
            self.started = true;
            if let Some(header) = self.options.format.header(self.options.timing) {
                self.write(header)?;
            }
            row.set_full(self.options.initial_box_as_given.unwrap_or(row.full()));
        }
        self.write(self.options.format.line(&row))
    }

    fn finish(&mut self) -> Result<(), OutputError> {
        self.destination.complete()
    }

    fn flush(&mut self) -> Result<(), OutputError> {
        self.destination.flush().map_err(|error| self.destination.name_error(error))
    }
}

/// What a row says. The order of the fields is the order of the CSV's columns.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Row {
    frame: usize,
    x: f64,
    y: f64,
    w: f64,
    h: f64,
    part_x: f64,
    part_y: f64,
    part_w: f64,
    part_h: f64,
    confidence: f64,
    status: Status,
    effective_sample_size: f64,
    time_s: Option<f64>,
    #[serde(flatten)]
    evidence: Option<Evidence>,
    #[serde(skip_serializing_if = "Option::is_none")]
    update_ms: Option<f64>,
}

impl Row {
    fn of(event: &FrameEvent<'_>, options: &RowOptions) -> Self {
        let full = options.origin.from_frame(event.estimate.box_in_frame);
        let part = options.origin.from_frame(event.estimate.part_in_frame);
        Self {
            frame: event.number,
            x: full.x,
            y: full.y,
            w: full.w,
            h: full.h,
            part_x: part.x,
            part_y: part.y,
            part_w: part.w,
            part_h: part.h,
            confidence: event.estimate.confidence,
            status: event.estimate.status,
            effective_sample_size: event.estimate.effective_sample_size,
            time_s: event.time.map(|time| time.as_secs_f64()),
            evidence: event.estimate.evidence,
            update_ms: options.timing.then_some(event.tracking_time.as_secs_f64() * 1e3),
        }
    }

    fn full(&self) -> Rect {
        Rect::new(self.x, self.y, self.w, self.h)
    }

    fn set_full(&mut self, full: Rect) {
        (self.x, self.y, self.w, self.h) = (full.x, full.y, full.w, full.h);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::output::testing::EventParts;

    fn rows(options: RowOptions, frames: &[EventParts]) -> String {
        let mut writer = RowWriter::new(Vec::new(), options);
        for frame in frames {
            writer.on_frame(&frame.event()).unwrap();
        }
        writer.finish().unwrap();
        String::from_utf8(writer.into_destination()).unwrap()
    }

    fn options(format: RowFormat) -> RowOptions {
        RowOptions { format, origin: Origin::One, initial_box_as_given: None, timing: false }
    }

    fn two_frames() -> [EventParts; 2] {
        let mut first = EventParts::new(Rect::new(4.0, 5.5, 10.0, 16.0));
        first.time = Some(Duration::from_millis(40));
        let mut second = EventParts::new(Rect::new(1.0 / 3.0, -7.0, 10.25, 16.0));
        second.number = 2;
        second.estimate.confidence = 0.5;
        second.estimate.status = Status::Lost;
        [first, second]
    }

    #[test]
    fn otb_rows_hold_every_digit_and_the_origin() {
        assert_eq!(
            rows(options(RowFormat::Otb), &two_frames()),
            "5,6.5,10,16\n1.3333333333333333,-6,10.25,16\n"
        );
    }

    #[test]
    fn csv_rows_have_a_header_and_an_empty_cell_where_time_is_unknown() {
        let text = rows(options(RowFormat::Csv), &two_frames());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[0],
            "frame,x,y,w,h,part_x,part_y,part_w,part_h,confidence,status,effective_sample_size,time_s"
        );
        assert_eq!(lines[1], "1,5,6.5,10,16,5,6.5,10,10,1,tracking,0,0.04");
        assert_eq!(lines[2], "2,1.3333333333333333,-6,10.25,16,1.3333333333333333,-6,10.25,10,0.5,lost,0,");
        let timed = rows(RowOptions { timing: true, ..options(RowFormat::Csv) }, &two_frames());
        assert!(timed.lines().next().unwrap().ends_with(",time_s,update_ms"));
        assert!(timed.lines().nth(2).unwrap().ends_with(",0,,2.5"));
    }

    #[test]
    fn json_lines_parse_and_have_the_header_as_keys() {
        let text = rows(options(RowFormat::JsonLines), &two_frames());
        let second: serde_json::Value = serde_json::from_str(text.lines().nth(1).unwrap()).unwrap();
        assert_eq!(second["x"], 1.0 + 1.0 / 3.0);
        assert_eq!(second["status"], "lost");
        assert!(second["time_s"].is_null());
        for key in csv::header(false).split(',') {
            assert!(second.get(key).is_some(), "{key}");
        }
    }

    #[test]
    fn the_first_row_is_the_initial_box_to_the_last_digit() {
        let given = Rect::new(0.1, 0.7, 10.3, 16.0);
        let mut frame = EventParts::new(Origin::One.to_frame(given));
        assert_ne!(Origin::One.from_frame(frame.estimate.box_in_frame), given, "the round trip is not exact");
        let with_given = RowOptions { initial_box_as_given: Some(given), ..options(RowFormat::Otb) };
        frame.number = 1;
        assert_eq!(rows(with_given, &[frame]), "0.1,0.7,10.3,16\n");
    }

    #[test]
    fn a_row_is_out_before_the_next_frame_comes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.txt");
        let file = crate::output::PartialFile::create(&path).unwrap();
        let mut writer = RowWriter::new(file, options(RowFormat::Otb));
        writer.on_frame(&two_frames()[0].event()).unwrap();
        assert_eq!(std::fs::read_to_string(folder.path().join("rows.txt.partial")).unwrap(), "5,6.5,10,16\n");
    }

    #[test]
    fn the_extension_tells_the_format() {
        for (path, format) in [
            ("a.CSV", RowFormat::Csv),
            ("a.jsonl", RowFormat::JsonLines),
            ("a.txt", RowFormat::Otb),
            ("a", RowFormat::Otb),
        ] {
            assert_eq!(RowFormat::from_path(Path::new(path)), format);
        }
    }
}
