//! The ground truth of a sequence, with what the benchmark says of each frame beside it.

use std::{fs, path::Path};

use super::{
    super::{RowProblem, SequenceError},
    Benchmark, BenchmarkSequence, BenchmarkTruth, PolygonBox, recognise,
    rows::{self, ABSENT, RowForm},
};

/// Need for Speed's files at 240 frames a second have a row of which every eighth belongs to a frame at 30.
const SLOWER: usize = 8;

pub(super) fn read(
    sequence: &BenchmarkSequence,
    polygons: PolygonBox,
) -> Result<BenchmarkTruth, SequenceError> {
    let path = &sequence.ground_truth;
    let text = text_of(path)?;
    let form = match sequence.benchmark {
        Benchmark::Vot => RowForm::Region(polygons),
        Benchmark::Tld => RowForm::Corners,
        Benchmark::NeedForSpeed if recognise::has_track_rows(path) => RowForm::Track,
        _ => RowForm::Box,
    };
    let mut parsed = rows::parse(&text, path, form)?;
    let images = sequence.images()?.len();
    if form == RowForm::Track && images > 0 && parsed.len() > images {
        let every = (parsed.len() as f64 / images as f64).round() as usize;
        if every == SLOWER {
            parsed = parsed.into_iter().step_by(SLOWER).take(images).collect();
        }
    }
    let (rows, lost): (Vec<_>, Vec<bool>) = parsed.into_iter().unzip();
    let mut truth = BenchmarkTruth { rows, ..BenchmarkTruth::default() };
    if lost.contains(&true) {
        truth.absent = lost;
    }
    match sequence.benchmark {
        Benchmark::Lasot => truth.absent = out_of_sight(path, truth.rows.len())?,
        Benchmark::Got10k => got10k(path, &mut truth)?,
        _ => {}
    }
    let withheld = matches!(sequence.benchmark, Benchmark::Got10k | Benchmark::TrackingNet);
    if withheld && truth.rows.len() == 1 && images > 1 {
        truth.rows.resize(images, ABSENT);
        truth.first_only = true;
    }
    if truth.rows.is_empty() {
        let (line, text, problem) = (1, String::new(), RowProblem::Blank);
        return Err(SequenceError::GroundTruth { path: path.clone(), line, text, problem });
    }
    Ok(truth)
}

fn text_of(path: &Path) -> Result<String, SequenceError> {
    let bytes = fs::read(path).map_err(|source| SequenceError::Io { path: path.to_owned(), source })?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// LaSOT's two files of zeros and ones, in one line or a line a frame. A frame in which either has a one has no target in sight.
fn out_of_sight(truth: &Path, rows: usize) -> Result<Vec<bool>, SequenceError> {
    let mut absent = Vec::new();
    for name in ["full_occlusion.txt", "out_of_view.txt"] {
        let path = truth.with_file_name(name);
        if !path.is_file() {
            continue;
        }
        let flags = flags(&path, 1)?;
        if flags.len() != rows {
            let problem = RowProblem::Flags { flags: flags.len(), rows };
            return Err(SequenceError::GroundTruth { path, line: 1, text: String::new(), problem });
        }
        absent.resize(rows, false);
        absent.iter_mut().zip(flags).for_each(|(absent, flag)| *absent |= flag > 0);
    }
    Ok(absent)
}

/// Numbers from 0 to `most`, separated by commas, blanks or ends of lines.
fn flags(path: &Path, most: u8) -> Result<Vec<u8>, SequenceError> {
    let text = text_of(path)?;
    let mut flags = Vec::new();
    for (index, line) in text.lines().enumerate() {
        for word in line.split([',', ' ', '\t']).filter(|word| !word.is_empty()) {
            let number = word.parse::<f64>().ok().filter(|number| number.fract() == 0.0);
            match number.filter(|number| (0.0..=f64::from(most)).contains(number)) {
                Some(number) => flags.push(number as u8),
                None => {
                    return Err(SequenceError::GroundTruth {
                        path: path.to_owned(),
                        line: index + 1,
                        text: word.chars().take(40).collect(),
                        problem: RowProblem::NoFlag { most },
                    });
                }
            }
        }
    }
    Ok(flags)
}

/// Labels a line a frame, and the size of the frames.
fn got10k(path: &Path, truth: &mut BenchmarkTruth) -> Result<(), SequenceError> {
    let rows = truth.rows.len();
    let beside = |name: &str, most: u8| {
        let path = path.with_file_name(name);
        if !path.is_file() {
            return Ok(Vec::new());
        }
        let flags = flags(&path, most)?;
        if flags.len() == rows || rows == 1 {
            return Ok(flags);
        }
        let problem = RowProblem::Flags { flags: flags.len(), rows };
        Err(SequenceError::GroundTruth { path, line: 1, text: String::new(), problem })
    };
    truth.absent = beside("absence.label", 1)?.into_iter().map(|flag| flag > 0).collect();
    truth.cover = beside("cover.label", 8)?;
    truth.resolution =
        fs::read_to_string(path.with_file_name("meta_info.ini")).ok().and_then(|text| resolution(&text));
    Ok(())
}

/// `resolution: (1920, 1080)`.
fn resolution(text: &str) -> Option<(usize, usize)> {
    let line = text.lines().find_map(|line| line.trim().strip_prefix("resolution"))?;
    let mut numbers =
        line.split(|letter: char| !letter.is_ascii_digit()).filter_map(|number| number.parse().ok());
    Some((numbers.next()?, numbers.next()?))
}
