//! Boxes of many sequences in one JSON file, as pysot distributes them (`OTB100.json`).

use std::{collections::BTreeMap, fs, path::Path};

use infopart::geometry::Rect;
use serde::Deserialize;

use super::{Annotations, DatasetError, Target, folder::cut};
use crate::catalogue;

#[derive(Deserialize)]
struct Entry {
    gt_rect: Vec<[Option<f64>; 4]>,
}

/// The targets of the file, in the order of their names; a `null` coordinate is NaN.
pub(super) fn read(path: &Path) -> Result<Vec<Target>, DatasetError> {
    let bytes = fs::read(path).map_err(|source| DatasetError::Io { path: path.to_owned(), source })?;
    let entries: BTreeMap<String, Entry> = serde_json::from_slice(&bytes)
        .map_err(|error| DatasetError::Json { path: path.to_owned(), problem: error.to_string() })?;
    if entries.is_empty() {
        return Err(DatasetError::Json { path: path.to_owned(), problem: "no sequence in it".into() });
    }
    Ok(entries.into_iter().map(|(name, entry)| target(name, &entry)).collect())
}

fn target(name: String, entry: &Entry) -> Target {
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let rect = |[x, y, w, h]: [Option<f64>; 4]| Rect::new(number(x), number(y), number(w), number(h));
    let known = catalogue::find(&name);
    let mut truth: Vec<Rect> = entry.gt_rect.iter().copied().map(rect).collect();
    cut(known, &mut truth);
    Target {
        name: known.map_or(name, |known| known.name.to_owned()),
        truth,
        hidden: Vec::new(),
        frames: None,
        annotations: Annotations::default(),
    }
}
