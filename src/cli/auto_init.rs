//! `--init auto`: the first box from what moves before a static camera.
//!
//! 1. Detect what moves: background model, clean-up, blobs.
//! 2. Link each object to the blob, not yet taken, that overlaps its last one most, the oldest object first; one that finds no
//!    blob is forgotten, and a blob that no object takes is a new one.
//! 3. An object linked through 15 frames is a lasting one. The K-th that becomes so is the target, from that frame on.

use anyhow::Result;
use infopart::{
    background::{BackgroundModel, BackgroundParameters, CleanUp, MaskCleaner},
    geometry::Rect,
    program::BadInput,
    sequence::{self, OpenOptions},
};

/// Frames that an object must be seen in, one after another.
const LASTING: usize = 15;
/// Least overlap of an object's blobs in neighbouring frames.
const LEAST_OVERLAP: f64 = 0.3;
/// Smallest object as a share of the frame's pixels, unless that is more than the clean-up's default.
const SMALLEST_SHARE: f64 = 0.002;

/// An object that has been seen for long enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LastingObject {
    /// The frame, counted from 1, in which it was first seen.
    pub first_seen: usize,
    /// The frame in which it had been seen for long enough.
    pub frame: usize,
    /// Its box there.
    pub box_in_frame: Rect,
}

/// Objects that are being linked, the oldest first.
#[derive(Debug, Default)]
struct Linker {
    objects: Vec<LastingObject>,
    lasting: usize,
}

impl Linker {
    /// Steps 2 and 3; gives the objects that became lasting in this frame.
    fn add(&mut self, frame: usize, blobs: &[Rect]) -> Vec<LastingObject> {
        let mut left = blobs.to_vec();
        self.objects.retain_mut(|object| {
            let overlap = |index: &usize| left[*index].overlap(&object.box_in_frame);
            let nearest = (0..left.len()).max_by(|a, b| overlap(a).total_cmp(&overlap(b)));
            let Some(index) = nearest.filter(|index| overlap(index) >= LEAST_OVERLAP) else { return false };
            object.frame = frame;
            object.box_in_frame = left.swap_remove(index);
            true
        });
        let news =
            left.into_iter().map(|box_in_frame| LastingObject { first_seen: frame, frame, box_in_frame });
        self.objects.extend(news);
        let due = |object: &&LastingObject| object.frame + 1 == object.first_seen + LASTING;
        let lasting: Vec<LastingObject> = self.objects.iter().filter(due).copied().collect();
        self.lasting += lasting.len();
        lasting
    }
}

/// The `number`-th lasting object, counted from 1, of the input from `options.start` on.
///
/// # Errors
/// [`BadInput`] if there are fewer, and what opening and reading the input gives.
pub fn find(input: &str, options: &OpenOptions, number: usize) -> Result<LastingObject> {
    let mut source = sequence::open(input, options)?.source;
    let mut model = BackgroundModel::new(BackgroundParameters::default().check()?);
    let mut cleaner = None;
    let mut linker = Linker::default();
    while let Some(frame) = source.next_frame()? {
        let view = frame.frame.view();
        let raw = model.apply(view).map_err(|error| BadInput(format!("{}: {error}", frame.label)))?;
        if cleaner.is_none() {
            let share = (SMALLEST_SHARE * (view.width() * view.height()) as f64) as usize;
            let clean_up = CleanUp::default();
            let min_area = clean_up.min_area.min(share.max(1));
            cleaner = Some(MaskCleaner::new(CleanUp { min_area, ..clean_up }.check()?));
        }
        let Some(cleaner) = &cleaner else { continue };
        let blobs: Vec<Rect> =
            cleaner.blobs(&cleaner.clean(raw)).iter().map(|blob| blob.box_in_frame).collect();
        let before = linker.lasting;
        let lasting = linker.add(frame.number, &blobs);
        if let Some(found) = lasting.get((number - 1).saturating_sub(before)) {
            return Ok(*found);
        }
    }
    let seen = match linker.lasting {
        0 => "nothing moves".to_owned(),
        1 => "only one object moves".to_owned(),
        several => format!("only {several} objects move"),
    };
    Err(BadInput(format!(
        "--init auto: {input}: {seen} for {LASTING} frames in a row before a static camera; give the target's box with \
         --init X,Y,W,H{}",
        if linker.lasting > 0 { ", or a smaller --target" } else { "" }
    ))
    .into())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Rect = Rect::new(10.0, 10.0, 20.0, 40.0);

    #[test]
    fn an_object_lasts_after_fifteen_frames_in_a_row_and_a_gap_starts_it_again() {
        let mut linker = Linker::default();
        let mut found = Vec::new();
        for frame in 1..=40 {
            let blobs = if frame == 10 { vec![] } else { vec![HERE.translated(frame as f64, 0.0)] };
            found.extend(linker.add(frame, &blobs));
        }
        let expected = LastingObject { first_seen: 11, frame: 25, box_in_frame: HERE.translated(25.0, 0.0) };
        assert_eq!(found, [expected]);
    }

    #[test]
    fn objects_are_numbered_by_when_they_last_and_keep_apart() {
        let mut linker = Linker::default();
        let far = HERE.translated(200.0, 0.0);
        let mut found = Vec::new();
        for frame in 1..=30 {
            let blobs = if frame < 5 { vec![HERE] } else { vec![far, HERE] };
            found.extend(linker.add(frame, &blobs));
        }
        assert_eq!(
            found.iter().map(|object| (object.frame, object.box_in_frame)).collect::<Vec<_>>(),
            [(15, HERE), (19, far)]
        );
    }
}
