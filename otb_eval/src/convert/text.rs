//! Layouts of text files.

use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

use super::{ConvertError, Layout, OutputFile, Track, in_the_benchmarks_spelling, name_with_seed};
use crate::{
    protocol::{Protocol, SHIFTS},
    results::{ResultFile, Results, ResultsError, SeedResults},
    runner::stem,
    store::Record,
};

/// The name of pytracking's parameters where nothing else is known.
const DEFAULT_PARAM: &str = "default";

pub(super) fn read(
    layout: Layout,
    path: &Path,
    problems: &mut Vec<ConvertError>,
) -> Result<Vec<Track>, ConvertError> {
    let mut tracks = Vec::new();
    match layout {
        Layout::Got10k => {
            let versions: Vec<PathBuf> =
                folders(path)?.into_iter().filter(|folder| name_of(folder).starts_with("OTB")).collect();
            let roots = if versions.is_empty() { vec![path.to_owned()] } else { versions };
            for root in roots {
                tracks.extend(of_protocol(&root, Protocol::Ope, problems)?);
            }
        }
        Layout::Pytracking => {
            for folder in folders(path)? {
                if folders(&folder)?.is_empty() {
                    return Err(ConvertError::Nothing { path: path.to_owned(), layout });
                }
                for mut track in of_protocol(&folder, Protocol::Ope, problems)? {
                    let (param, seed) = param_and_run(&track.tracker);
                    let tracker = name_of(&folder);
                    track.tracker =
                        if param == DEFAULT_PARAM { tracker } else { format!("{tracker}_{param}") };
                    track.seed = seed;
                    tracks.push(track);
                }
            }
        }
        Layout::Run | Layout::Flat | Layout::Pysot | Layout::Jwlim | Layout::Got10kSet => {
            for protocol in Results::protocols(path)? {
                tracks.extend(of_protocol(path, protocol, problems)?);
            }
        }
    }
    Ok(tracks)
}

/// `PARAM_RRR`: the parameters' name and the number of the run.
fn param_and_run(folder: &str) -> (&str, u64) {
    let run = |digits: &str| (digits.len() == 3).then(|| digits.parse().ok()).flatten();
    match folder.rsplit_once('_').and_then(|(param, digits)| Some((param, run(digits)?))) {
        Some((param, run)) => (param, run),
        None => (folder, 0),
    }
}

fn of_protocol(
    path: &Path,
    protocol: Protocol,
    problems: &mut Vec<ConvertError>,
) -> Result<Vec<Track>, ConvertError> {
    let mut tracks = Vec::new();
    for tracker in Results::open(path, protocol)?.trackers {
        for seed in &tracker.seeds {
            for file in seed.stems() {
                let (sequence, label) = split(file, protocol);
                let at = || path.join(&tracker.name).join(format!("{file}.txt"));
                match track_of(seed, &sequence, label.as_deref()) {
                    Ok((result, ..)) if result.first_is_given => problems.push(ConvertError::File {
                        path: at(),
                        problem: "its first line is VOT's code for the box given, which only the ground truth knows; write that box there"
                            .to_owned(),
                    }),
                    Ok((result, seconds, confidences)) => {
                        problems.extend(result.read_as.map(|how| ConvertError::Read { path: at(), how }));
                        tracks.push(Track {
                            tracker: tracker.name.clone(),
                            protocol,
                            seed: seed.seed,
                            sequence: in_the_benchmarks_spelling(&sequence),
                            label,
                            start: result.start.filter(|_| protocol == Protocol::Tre),
                            rows: result.rows,
                            seconds,
                            confidences,
                        });
                    }
                    Err(problem) => problems.push(problem.into()),
                }
            }
            problems.extend(seed.failures().map(|(stem, reason)| ConvertError::File {
                path: path.join(&tracker.name).join(stem),
                problem: format!("the job failed, so there is nothing to convert: {reason}"),
            }));
        }
    }
    Ok(tracks)
}

/// A result, its times, and how sure the tracker was, as a file beside it says, or else a column of it.
fn track_of(seed: &SeedResults, sequence: &str, label: Option<&str>) -> Result<Read, ResultsError> {
    let file = seed.read(sequence, label).transpose()?.unwrap_or_default();
    let confidences = seed.read_confidences(sequence, label).transpose()?.or_else(|| file.scores.clone());
    Ok((file, seed.read_seconds(sequence, label).transpose()?, confidences))
}

type Read = (ResultFile, Option<Vec<f64>>, Option<Vec<f64>>);

/// `SEQ_SEGMENT` into both.
fn split(stem: &str, protocol: Protocol) -> (String, Option<String>) {
    let number = |end: &str| end.len() == 2 && end.bytes().all(|byte| byte.is_ascii_digit());
    let found = match protocol {
        Protocol::Ope => None,
        Protocol::Tre => stem.rsplit_once('_').filter(|(_, end)| number(end)),
        Protocol::Sre => SHIFTS.iter().find_map(|shift| {
            let sequence = stem.strip_suffix(shift.name())?.strip_suffix('_')?;
            Some((sequence, shift.name()))
        }),
    };
    match found {
        Some((sequence, label)) => (sequence.to_owned(), Some(label.to_owned())),
        None => (stem.to_owned(), None),
    }
}

pub(super) fn files(layout: Layout, tracks: &[Track]) -> Vec<OutputFile> {
    let mut files = Vec::new();
    if layout == Layout::Got10kSet {
        return repetitions(tracks);
    }
    for track in tracks {
        let tracker_folder = tracker_folder(layout, track, tracks);
        let folder = match layout {
            Layout::Run => tracker_folder.join(format!("seed_{}", track.seed)),
            _ => tracker_folder.clone(),
        };
        let stem = stem(&layout.spelled(&track.sequence), track.label.as_deref());
        let file = |path: PathBuf, text: String, has_boxes: bool| OutputFile {
            tracker_folder: tracker_folder.clone(),
            path,
            text,
            has_boxes,
        };
        if let Some(seconds) = track.seconds.as_ref().filter(|_| layout != Layout::Pysot) {
            let times = if layout == Layout::Got10k { folder.join("times") } else { folder.clone() };
            files.push(file(times.join(format!("{stem}_time.txt")), lines_of(seconds), false));
        }
        if let (Some(confidences), Some(ending)) = (&track.confidences, confidence_file(layout)) {
            let text = confidences.iter().map(|confidence| format!("{confidence}\n")).collect();
            files.push(file(folder.join(format!("{stem}{ending}")), text, false));
        }
        let separator = if layout == Layout::Pytracking { '\t' } else { ',' };
        let (path, text) = (folder.join(format!("{stem}.txt")), rows_of(track, separator));
        if layout == Layout::Run {
            let start = if track.protocol == Protocol::Tre { track.start } else { Some(0) };
            let record = Record::new(text.as_bytes(), track.rows.len(), start);
            files.push(file(Record::path(&path), record.text(), false));
        }
        files.push(file(path, text, true));
    }
    files
}

/// What a layout calls the file of confidences after the sequence; `None` where it has no place for it.
const fn confidence_file(layout: Layout) -> Option<&'static str> {
    match layout {
        Layout::Run | Layout::Flat => Some("_confidence.txt"),
        Layout::Pytracking => Some("_object_presence_scores.txt"),
        _ => None,
    }
}

fn tracker_folder(layout: Layout, track: &Track, tracks: &[Track]) -> PathBuf {
    let has_runs = name_with_seed(track, tracks) != track.tracker;
    match layout {
        Layout::Run => PathBuf::from(track.protocol.name()).join(&track.tracker),
        Layout::Got10k => PathBuf::from("OTB2015").join(name_with_seed(track, tracks)),
        Layout::Pytracking if has_runs => {
            PathBuf::from(&track.tracker).join(format!("{DEFAULT_PARAM}_{:03}", track.seed))
        }
        Layout::Pytracking => PathBuf::from(&track.tracker).join(DEFAULT_PARAM),
        Layout::Got10kSet => PathBuf::from(&track.tracker),
        Layout::Flat | Layout::Pysot | Layout::Jwlim => PathBuf::from(name_with_seed(track, tracks)),
    }
}

/// `TRACKER/SEQ/SEQ_00K.txt`, K counting the seeds, and the times of all of them as columns of one file.
fn repetitions(tracks: &[Track]) -> Vec<OutputFile> {
    let mut groups: Vec<Vec<&Track>> = Vec::new();
    for track in tracks {
        let is_same = |group: &&mut Vec<&Track>| {
            (&group[0].tracker, &group[0].sequence) == (&track.tracker, &track.sequence)
        };
        match groups.iter_mut().find(is_same) {
            Some(group) => group.push(track),
            None => groups.push(vec![track]),
        }
    }
    let mut files = Vec::new();
    for mut group in groups {
        group.sort_by_key(|track| track.seed);
        let (tracker_folder, sequence) = (PathBuf::from(&group[0].tracker), &group[0].sequence);
        let folder = tracker_folder.join(sequence);
        let file = |name: String, text: String, has_boxes: bool| OutputFile {
            tracker_folder: tracker_folder.clone(),
            path: folder.join(name),
            text,
            has_boxes,
        };
        for (place, track) in group.iter().enumerate() {
            files.push(file(format!("{sequence}_{:03}.txt", place + 1), rows_of(track, ','), true));
        }
        let columns: Option<Vec<&Vec<f64>>> = group.iter().map(|track| track.seconds.as_ref()).collect();
        if let Some(columns) =
            columns.filter(|columns| columns.iter().all(|one| one.len() == columns[0].len()))
        {
            let line = |frame: usize| {
                let seconds: Vec<String> = columns.iter().map(|one| format!("{:.8}", one[frame])).collect();
                seconds.join(",") + "\n"
            };
            files.push(file(
                format!("{sequence}_time.txt"),
                (0..columns[0].len()).map(line).collect(),
                false,
            ));
        }
    }
    files
}

fn rows_of(track: &Track, separator: char) -> String {
    let mut text = String::new();
    for row in &track.rows {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}{separator}{}{separator}{}{separator}{}", row.x, row.y, row.w, row.h);
    }
    text
}

fn lines_of(seconds: &[f64]) -> String {
    seconds.iter().map(|second| format!("{second:.8}\n")).collect()
}

/// Sorted, so that nothing depends on the file system's order.
fn folders(path: &Path) -> Result<Vec<PathBuf>, ConvertError> {
    let io_error = |source| ConvertError::Io { path: path.to_owned(), source };
    if !path.is_dir() {
        return Err(ResultsError::Missing { path: path.to_owned() }.into());
    }
    let mut folders = Vec::new();
    for entry in fs::read_dir(path).map_err(io_error)? {
        let entry = entry.map_err(io_error)?.path();
        if entry.is_dir() {
            folders.push(entry);
        }
    }
    folders.sort();
    Ok(folders)
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
