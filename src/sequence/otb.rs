//! A folder as the Object Tracking Benchmark lays it out: `img/` and `groundtruth_rect*.txt`.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{
    OpenOptions, Sequence, SequenceError,
    ground_truth::parse_ground_truth,
    images::{ImageFiles, file_name, folder_name, images_in},
    natural::number_in_name,
    range::FrameRange,
};
use crate::geometry::{Origin, Rect};

/// Sequences whose ground truth covers only these frames, by the number in the file's name (the benchmark's own list).
const KNOWN_RANGES: [(&str, usize, usize); 8] = [
    ("David", 300, 770),
    ("BlurCar1", 247, 988),
    ("BlurCar3", 3, 359),
    ("BlurCar4", 18, 397),
    ("Football1", 1, 74),
    ("Freeman3", 1, 460),
    ("Freeman4", 1, 283),
    ("Diving", 1, 215),
];

/// An OTB folder: where its images are, and its ground truth files.
#[derive(Debug)]
pub(super) struct OtbFolder {
    path: PathBuf,
    name: String,
    annotations: Vec<Annotation>,
}

/// A target of an OTB folder.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct OtbTarget {
    /// The folder's name, with the target's number if the folder has several (`Jogging-1`).
    pub name: String,
    /// K of `groundtruth_rect.K.txt`; `None` for the plain `groundtruth_rect.txt`.
    pub number: Option<usize>,
    /// The ground truth file.
    pub ground_truth: PathBuf,
}

/// The targets of a folder, a ground truth file that has rows each; none if it is no OTB folder.
///
/// # Errors
/// [`SequenceError::Io`] if the folder or a ground truth in it cannot be read.
pub fn otb_targets(folder: &Path) -> Result<Vec<OtbTarget>, SequenceError> {
    let Some(folder) = OtbFolder::recognise(folder, &folder_name(folder))? else { return Ok(Vec::new()) };
    let target = |annotation: &Annotation| OtbTarget {
        name: folder.name_of(annotation),
        number: annotation.target,
        ground_truth: annotation.path.clone(),
    };
    Ok(folder.annotations.iter().map(target).collect())
}

/// The images of an OTB folder.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct OtbImages {
    /// All of them, in the order of their numbers.
    pub all: Vec<PathBuf>,
    /// Those that the rows of the ground truth belong to, from the first row on, as [`open`](super::open) delivers them;
    /// where nothing is known of the sequence, all.
    pub covered: Vec<PathBuf>,
}

/// The images of an OTB folder whose ground truth has that many rows; none if it has no images.
///
/// # Errors
/// [`SequenceError::Io`] if `img/` cannot be read.
pub fn otb_images(folder: &Path, rows: usize) -> Result<OtbImages, SequenceError> {
    let all = images_in(&folder.join("img"))?;
    Ok(OtbImages { covered: covered(all.clone(), rows, &folder_name(folder)), all })
}

/// A ground truth file that has rows.
#[derive(Debug)]
struct Annotation {
    /// K of `groundtruth_rect.K.txt`; `None` for the plain `groundtruth_rect.txt`.
    target: Option<usize>,
    path: PathBuf,
    text: String,
}

impl OtbFolder {
    /// The folder if it has `img/` and a ground truth that is not empty, else `None`.
    pub(super) fn recognise(path: &Path, name: &str) -> Result<Option<Self>, SequenceError> {
        if !path.join("img").is_dir() {
            return Ok(None);
        }
        let annotations = annotations_in(path)?;
        let folder = Self { path: path.to_owned(), name: name.to_owned(), annotations };
        Ok((!folder.annotations.is_empty()).then_some(folder))
    }

    /// Makes the frames that the ground truth covers, and the ground truth, ready.
    pub(super) fn open(&self, options: &OpenOptions) -> Result<Sequence, SequenceError> {
        let range = FrameRange::of(options)?;
        let annotation = self.chosen(options.target)?;
        let origin = options.origin.unwrap_or(Origin::One);
        let rows = parse_ground_truth(&annotation.text, &annotation.path)?;
        let images = covered(self.images()?, rows.len(), &self.name);
        let positions = range.positions(images.len(), &self.path.display().to_string())?;
        let ground_truth = rows.into_iter().take(positions.end).skip(positions.start);
        Ok(Sequence {
            name: self.name_of(annotation),
            ground_truth_row: Some((annotation.path.clone(), positions.start + 1)),
            ground_truth: ground_truth.map(|row| row.map(|in_file: Rect| origin.to_frame(in_file))).collect(),
            source: Box::new(ImageFiles::new(images[positions].to_vec(), range.start)),
            origin,
        })
    }

    fn images(&self) -> Result<Vec<PathBuf>, SequenceError> {
        let folder = self.path.join("img");
        let images = images_in(&folder)?;
        if images.is_empty() { Err(SequenceError::NoImages { path: folder }) } else { Ok(images) }
    }

    fn chosen(&self, target: Option<usize>) -> Result<&Annotation, SequenceError> {
        let targets: Vec<usize> = self.annotations.iter().filter_map(|one| one.target).collect();
        let path = self.path.clone();
        match target {
            Some(target) if targets.is_empty() => {
                Err(SequenceError::TargetWithoutChoice { input: path.display().to_string(), target })
            }
            Some(target) => self
                .annotations
                .iter()
                .find(|one| one.target == Some(target))
                .ok_or(SequenceError::NoSuchTarget { path, target, targets }),
            None => match &self.annotations[..] {
                [plain @ Annotation { target: None, .. }, ..] | [plain] => Ok(plain),
                _ => Err(SequenceError::SeveralTargets { path, targets }),
            },
        }
    }

    fn name_of(&self, annotation: &Annotation) -> String {
        match annotation.target {
            Some(target) if self.annotations.len() > 1 => format!("{}-{target}", self.name),
            _ => self.name.clone(),
        }
    }
}

/// The ground truth files that are not empty (Human4's first is), the plain one first, then by target.
fn annotations_in(folder: &Path) -> Result<Vec<Annotation>, SequenceError> {
    let io_error = |source| SequenceError::Io { path: folder.to_owned(), source };
    let mut annotations = Vec::new();
    for entry in fs::read_dir(folder).map_err(io_error)? {
        let path = entry.map_err(io_error)?.path();
        let Some(target) = target_of(&file_name(&path)) else {
            continue;
        };
        let bytes = fs::read(&path).map_err(|source| SequenceError::Io { path: path.clone(), source })?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        if !text.trim().is_empty() {
            annotations.push(Annotation { target, path, text });
        }
    }
    annotations.sort_by_key(|one| one.target);
    Ok(annotations)
}

/// Which target a ground truth file belongs to; the outer `None` if the file is no ground truth.
fn target_of(file_name: &str) -> Option<Option<usize>> {
    let between = file_name.strip_prefix("groundtruth_rect")?.strip_suffix(".txt")?;
    match between.strip_prefix('.') {
        Some(number) => number.parse().ok().map(Some),
        None => between.is_empty().then_some(None),
    }
}

/// The images that `rows` rows belong to. Copies of the benchmark differ in what they were trimmed to, so the count
/// decides and the name only where it must.
fn covered(images: Vec<PathBuf>, rows: usize, name: &str) -> Vec<PathBuf> {
    let known = KNOWN_RANGES.iter().find(|(known, ..)| known.eq_ignore_ascii_case(name));
    let Some(&(_, first, last)) = known.filter(|_| images.len() > rows) else {
        return images;
    };
    let in_range = |path: &&PathBuf| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        number_in_name(&stem).is_some_and(|number| (first..=last).contains(&number))
    };
    let named: Vec<PathBuf> = images.iter().filter(in_range).cloned().collect();
    if named.len() == rows { named } else { images }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder_with(files: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("img")).unwrap();
        for number in 1..=3 {
            image::GrayImage::new(8, 6).save(folder.path().join(format!("img/{number:04}.png"))).unwrap();
        }
        for (name, text) in files {
            fs::write(folder.path().join(name), text).unwrap();
        }
        folder
    }

    fn opened(folder: &tempfile::TempDir, options: OpenOptions) -> Result<Sequence, SequenceError> {
        OtbFolder::recognise(folder.path(), "Seq").unwrap().unwrap().open(&options)
    }

    fn numbered(numbers: std::ops::RangeInclusive<usize>) -> Vec<PathBuf> {
        numbers.map(|number| PathBuf::from(format!("img/{number:04}.jpg"))).collect()
    }

    const ROWS: &str = "1,1,2,2\nNaN,NaN,NaN,NaN\n3,3,2,2\n";

    #[test]
    fn boxes_come_in_frame_coordinates_and_cut_to_the_range() {
        let folder = folder_with(&[("groundtruth_rect.txt", ROWS)]);
        let all = opened(&folder, OpenOptions::default()).unwrap();
        assert_eq!((all.name.as_str(), all.origin, all.source.remaining()), ("Seq", Origin::One, Some(3)));
        let (first, third) = (Rect::new(0.0, 0.0, 2.0, 2.0), Rect::new(2.0, 2.0, 2.0, 2.0));
        assert_eq!(all.ground_truth, [Some(first), None, Some(third)]);
        let options = OpenOptions { start: Some(2), origin: Some(Origin::Zero), ..OpenOptions::default() };
        let mut tail = opened(&folder, options).unwrap();
        assert_eq!(tail.ground_truth, [None, Some(Rect::new(3.0, 3.0, 2.0, 2.0))]);
        let frame = tail.source.next_frame().unwrap().unwrap();
        assert_eq!((frame.number, frame.label.as_str()), (2, "0002.png"));
    }

    #[test]
    fn fewer_rows_belong_to_the_first_images_and_extra_rows_to_none() {
        let folder = folder_with(&[("groundtruth_rect.txt", "1,1,2,2\n")]);
        let few = opened(&folder, OpenOptions::default()).unwrap();
        assert_eq!((few.source.remaining(), few.ground_truth.len()), (Some(3), 1));
        let folder = folder_with(&[("groundtruth_rect.txt", &ROWS.repeat(2))]);
        let many = opened(&folder, OpenOptions { end: Some(9), ..OpenOptions::default() }).unwrap();
        assert_eq!((many.source.remaining(), many.ground_truth.len()), (Some(3), 3));
    }

    #[test]
    fn several_targets_must_be_chosen_from() {
        let folder = folder_with(&[("groundtruth_rect.1.txt", ROWS), ("groundtruth_rect.2.txt", "9 9 1 1")]);
        let message = opened(&folder, OpenOptions::default()).map(|_| ()).unwrap_err().to_string();
        assert!(message.contains("has 2 targets: 1, 2; choose one with --target K"), "{message}");
        let second = opened(&folder, OpenOptions { target: Some(2), ..OpenOptions::default() }).unwrap();
        assert_eq!((second.name.as_str(), second.ground_truth.len()), ("Seq-2", 1));
        let third = opened(&folder, OpenOptions { target: Some(3), ..OpenOptions::default() });
        let message = third.map(|_| ()).unwrap_err().to_string();
        assert!(message.contains("has no target 3; give --target one of: 1, 2"), "{message}");
    }

    #[test]
    fn targets_are_listed_with_their_files() {
        let folder = folder_with(&[("groundtruth_rect.1.txt", ROWS), ("groundtruth_rect.2.txt", ROWS)]);
        let targets = otb_targets(folder.path()).unwrap();
        let name = folder_name(folder.path());
        assert_eq!(targets.len(), 2);
        assert_eq!((targets[1].name.clone(), targets[1].number), (format!("{name}-2"), Some(2)));
        assert!(targets[1].ground_truth.ends_with("groundtruth_rect.2.txt"));
        assert!(otb_targets(&folder.path().join("img")).unwrap().is_empty());
    }

    #[test]
    fn an_empty_annotation_is_none() {
        let folder = folder_with(&[("groundtruth_rect.1.txt", ""), ("groundtruth_rect.2.txt", ROWS)]);
        let only = opened(&folder, OpenOptions::default()).unwrap();
        assert_eq!((only.name.as_str(), only.ground_truth.len()), ("Seq", 3));
        let folder = folder_with(&[("groundtruth_rect.txt", "\n"), ("groundtruth_rectx.txt", ROWS)]);
        assert!(OtbFolder::recognise(folder.path(), "Seq").unwrap().is_none());
    }

    #[test]
    fn a_target_of_a_plain_folder_names_the_flag() {
        let folder = folder_with(&[("groundtruth_rect.txt", ROWS)]);
        let result = opened(&folder, OpenOptions { target: Some(1), ..OpenOptions::default() });
        assert!(result.map(|_| ()).unwrap_err().to_string().contains("--target 1 has no meaning here"));
    }

    #[test]
    fn a_known_range_is_used_only_where_it_fits_the_count() {
        assert_eq!(covered(numbered(1..=770), 471, "David"), numbered(300..=770));
        assert_eq!(covered(numbered(300..=770), 471, "David"), numbered(300..=770));
        assert_eq!(covered(numbered(1..=81), 74, "Football1"), numbered(1..=74));
        assert_eq!(covered(numbered(1..=81), 70, "Football1"), numbered(1..=81));
        assert_eq!(covered(numbered(1..=81), 74, "Other"), numbered(1..=81));
    }
}
