//! Which result files there are.

use std::{
    collections::{BTreeMap, HashSet},
    fs, io,
    path::{Path, PathBuf},
};

use serde::Deserialize;

use super::{Listed, Results, ResultsError, SeedResults, TrackerResults};
use crate::{
    catalogue,
    protocol::Protocol,
    store::{Identity, Record},
};

/// Files beside results that are none.
const NOT_RESULTS: [&str; 3] = ["_time", "_object_presence_scores", "_confidence"];

/// What pytracking puts before the names of UAV123 and of Need for Speed.
const PREFIXES: [&str; 2] = ["uav_", "nfs_"];

/// How files of ground truth are called, which lie in folders as results do.
const TRUTH: &str = "groundtruth";

pub(super) fn protocols_in(path: &Path) -> Result<Vec<Protocol>, ResultsError> {
    if !path.is_dir() {
        return Err(ResultsError::Missing { path: path.to_owned() });
    }
    let own: Vec<Protocol> =
        Protocol::ALL.into_iter().filter(|protocol| path.join(protocol.name()).is_dir()).collect();
    Ok(match (own.is_empty(), one_protocol(path)) {
        (false, _) => own,
        (true, Some(protocol)) => vec![protocol],
        (true, None) => vec![Protocol::Ope],
    })
}

/// The protocol whose folder of `run` this is itself: one level too low, but clear.
fn one_protocol(path: &Path) -> Option<Protocol> {
    let protocol = path.file_name()?.to_str()?.parse().ok()?;
    let has_seeds = |(_, tracker): (String, PathBuf)| {
        folders_in(&tracker).is_ok_and(|seeds| seeds.iter().any(|(name, _)| name.starts_with("seed_")))
    };
    folders_in(path).ok()?.into_iter().any(has_seeds).then_some(protocol)
}

pub(super) fn results_in(path: &Path, protocol: Protocol) -> Result<Results, ResultsError> {
    let there = protocols_in(path)?;
    if !there.contains(&protocol) {
        let there = there.iter().map(|protocol| protocol.name()).collect::<Vec<_>>().join(", ");
        return Err(ResultsError::NoProtocol { path: path.to_owned(), protocol, there });
    }
    let own = path.join(protocol.name());
    let root = if own.is_dir() { own } else { path.to_owned() };
    let mut trackers = Vec::new();
    for (name, folder) in folders_in(&root)? {
        trackers.extend(tracker_in(name, &folder)?);
    }
    if trackers.is_empty() {
        // The folder of a single tracker.
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        trackers.extend(tracker_in(name, &root)?);
    }
    if trackers.is_empty() {
        return Err(ResultsError::Nothing { path: path.to_owned(), deeper: deeper(path) });
    }
    Ok(Results { trackers })
}

/// Folders in a folder that hold results, where it holds none itself: it is one level too high.
pub(super) fn deeper(path: &Path) -> Vec<PathBuf> {
    let holds = |folder: &PathBuf| {
        Protocol::ALL.iter().any(|protocol| folder.join(protocol.name()).is_dir())
            || folders_in(folder).is_ok_and(|trackers| trackers.into_iter().any(is_tracker))
    };
    let folders = folders_in(path).unwrap_or_default().into_iter().map(|(_, folder)| folder);
    folders.filter(holds).collect()
}

fn is_tracker((name, folder): (String, PathBuf)) -> bool {
    tracker_in(name, &folder).is_ok_and(|tracker| tracker.is_some())
}

/// Folders of flat results beside those of `run`.
pub(super) fn ignored_in(path: &Path) -> Result<Vec<String>, ResultsError> {
    let is_protocol = |name: &str| Protocol::ALL.iter().any(|protocol| protocol.name() == name);
    let (protocols, others): (Vec<_>, Vec<_>) =
        folders_in(path)?.into_iter().partition(|(name, _)| is_protocol(name));
    if protocols.is_empty() {
        return Ok(Vec::new());
    }
    Ok(others.into_iter().filter(|one| is_tracker(one.clone())).map(|(name, _)| name).collect())
}

/// A tracker's folder: seeds in it, or results themselves; `None` if neither is there.
fn tracker_in(name: String, folder: &Path) -> Result<Option<TrackerResults>, ResultsError> {
    let mut seeds = Vec::new();
    for (subfolder, path) in folders_in(folder)? {
        if let Some(seed) = subfolder.strip_prefix("seed_").and_then(|number| number.parse().ok()) {
            seeds.push(seed_in(seed, &path)?);
        }
    }
    if seeds.is_empty() {
        seeds = repetitions_in(folder)?;
    }
    if seeds.is_empty() {
        seeds.push(seed_in(0, folder)?);
    }
    seeds.retain(|seed| !seed.files.is_empty() || !seed.failures.is_empty());
    seeds.sort_by_key(|seed| seed.seed);
    if seeds.is_empty() {
        return Ok(None);
    }
    Ok(Some(TrackerResults { name, run: Identity::read(folder)?, seeds }))
}

fn seed_in(seed: u64, folder: &Path) -> Result<SeedResults, ResultsError> {
    let (mut files, mut failures) = (BTreeMap::new(), BTreeMap::new());
    let paths = entries(folder)?;
    // As got10k keeps times.
    let in_times = entries(&folder.join("times")).unwrap_or_default();
    let there: HashSet<&Path> = paths.iter().chain(&in_times).map(PathBuf::as_path).collect();
    for path in &paths {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if let Some(stem) = name.strip_suffix(".failed.json") {
            failures.insert(stem.to_owned(), reason_in(path)?);
        } else if let Some(stem) = name.strip_suffix(".txt")
            && !NOT_RESULTS.iter().any(|other| stem.ends_with(other))
            && !stem.starts_with('.')
            && !stem.starts_with(TRUTH)
        {
            let name = format!("{stem}_time.txt");
            let times = [folder.join(&name), folder.join("times").join(&name)];
            let confidences = ["_confidence.txt", "_object_presence_scores.txt", "_confidence.value"]
                .map(|end| folder.join(format!("{stem}{end}")));
            let listed = Listed {
                path: path.clone(),
                has_record: there.contains(Record::path(path).as_path()),
                times: times.into_iter().find(|path| there.contains(path.as_path())).map(|path| (path, 0)),
                confidences: confidences.into_iter().find(|path| there.contains(path.as_path())),
            };
            files.insert(listed_as(stem), listed);
        }
    }
    Ok(SeedResults { seed, files, failures })
}

/// `TRACKER/SEQ/SEQ_001.txt`, as the GOT-10k toolkit and VOT have it: repetition K is seed K. Nothing if it is not laid out so.
fn repetitions_in(folder: &Path) -> Result<Vec<SeedResults>, ResultsError> {
    let mut seeds: BTreeMap<u64, SeedResults> = BTreeMap::new();
    for (sequence, subfolder) in folders_in(folder)? {
        let paths = entries(&subfolder)?;
        let is_there =
            |name: &str| paths.iter().find(|path| path.file_name().is_some_and(|one| one == name)).cloned();
        let number_of = |path: &PathBuf| {
            let name = path.file_name()?.to_str()?;
            let digits = name.strip_prefix(&sequence)?.strip_prefix('_')?.strip_suffix(".txt")?;
            if digits.len() == 3 { digits.parse::<u64>().ok() } else { None }
        };
        for (path, number) in paths.iter().filter_map(|path| Some((path, number_of(path)?))) {
            let all_times = is_there(&format!("{sequence}_time.txt"));
            let times = all_times.map(|path| (path, number.saturating_sub(1) as usize));
            let own_times = is_there(&format!("{sequence}_{number:03}_time.value")).map(|path| (path, 0));
            let listed = Listed {
                path: path.clone(),
                has_record: false,
                times: times.or(own_times),
                confidences: is_there(&format!("{sequence}_{number:03}_confidence.value")),
            };
            let empty = || SeedResults { seed: number, files: BTreeMap::new(), failures: BTreeMap::new() };
            seeds.entry(number).or_insert_with(empty).files.insert(listed_as(&sequence), listed);
        }
    }
    Ok(seeds.into_values().collect())
}

/// How a result is known whatever its toolkit calls the sequence: `Jogging_1` is Jogging-1 to some, `uav_person1` is person1 to
/// pytracking; `Couple_left` is Couple's segment.
pub(crate) fn listed_as(stem: &str) -> String {
    let plain = PREFIXES.iter().find_map(|prefix| stem.strip_prefix(prefix)).unwrap_or(stem);
    catalogue::find(plain).map_or_else(|| plain.to_owned(), |known| known.name.to_owned())
}

#[derive(Deserialize)]
struct Failure {
    reason: String,
}

fn reason_in(path: &Path) -> Result<String, ResultsError> {
    let text =
        fs::read_to_string(path).map_err(|source| ResultsError::Io { path: path.to_owned(), source })?;
    let failure = serde_json::from_str::<Failure>(&text);
    Ok(failure.map_or_else(|_| text.trim().to_owned(), |failure| failure.reason))
}

fn folders_in(folder: &Path) -> Result<Vec<(String, PathBuf)>, ResultsError> {
    let folders = entries(folder)?.into_iter().filter(|path| path.is_dir());
    Ok(folders
        .map(|path| (path.file_name().unwrap_or_default().to_string_lossy().into_owned(), path))
        .collect())
}

/// Sorted, so that nothing depends on the file system's order.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, ResultsError> {
    let io_error = |source| ResultsError::Io { path: folder.to_owned(), source };
    let entries = fs::read_dir(folder).map_err(io_error)?;
    let mut paths: Vec<PathBuf> =
        entries.map(|entry| entry.map(|entry| entry.path())).collect::<io::Result<_>>().map_err(io_error)?;
    paths.sort();
    Ok(paths)
}
