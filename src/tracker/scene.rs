//! What the scene looks like where the target is not: a box that shows what that place did when the target was elsewhere holds
//! scenery, or somebody who stands there, and not the target.
//!
//! Steps, each frame:
//! 1. the frame's outline, and whether the scene was cut: the frame shows less of what the one before did than frames do lately,
//! 2. (for each box asked about) where the camera is steady, it is carried into each view of the scene by the shift of the whole
//!    picture (`correlation/shift.rs`) and put right by a cell's width or two; a view in which it meets the target, or which does not
//!    show it, tells nothing,
//! 3. the correlation of the luminance in the box's middle, now and then; the highest over the views counts,
//! 4. a view is kept, with where the target was, if the tracker is sure and the target has left its place in the latest view.

use crate::{
    correlation::shift::{Outline, ShiftFinder},
    frame::FrameView,
    geometry::Rect,
};

/// Similarity to the frame before, over the running mean of it, below which the scene was cut.
const CUT: f64 = 0.7;
/// How fast that mean follows.
const SIMILARITY_RATE: f64 = 0.1;
/// Below this mean similarity the camera moves too quickly, or the light, for boxes to be carried along.
const STEADY: f64 = 0.9;
/// Views that are kept.
const VIEWS: usize = 5;
/// Pixels of a view at most; of larger frames some are left out.
const MOST_PIXELS: f64 = 1_048_576.0;
/// The target has left its place if it overlaps it by less than this.
const LEFT: f64 = 0.3;
/// How much wider and taller than its box the target is taken for.
const MARGIN: f64 = 1.2;
/// The middle of a box, in shares of its width and height.
const MIDDLE: (f64, f64) = (0.7, 0.9);
/// Cells of the middle that are compared, along its width and its height.
const CELLS: (usize, usize) = (10, 16);
/// Where a cell's luminance is read, in shares of its sides.
const SAMPLES: [(f64, f64); 4] = [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)];
/// Cells whose luminance has a standard deviation below this have no texture to compare.
const FLAT: f32 = 4.0;
/// Steps by which a carried box is put right, in widths of a cell, and how often each may be taken.
const STEPS: [f64; 2] = [1.0, 0.5];
const MOST_STEPS: usize = 3;

/// Luminance of a box's cells, of mean 0 and norm 1.
type Patch = [f32; CELLS.0 * CELLS.1];

/// The memory of a scene.
#[derive(Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Scene {
    #[cfg_attr(feature = "save", serde(skip))]
    finder: ShiftFinder,
    /// Of the last frame and of the one before.
    outlines: [Outline; 2],
    mean_similarity: f64,
    /// The latest last.
    views: Vec<View>,
    /// How far the last frame's picture is shifted against each view's, pixels, once that was asked for.
    shifts: Vec<Option<(f64, f64)>>,
}

/// A picture of the scene.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct View {
    /// Frame pixels from one kept pixel to the next.
    step: usize,
    width: usize,
    height: usize,
    luminance: Vec<u8>,
    outline: Outline,
    /// The target's whole box.
    full: Rect,
}

impl Scene {
    /// The memory of a first frame, in which the target has that whole box.
    pub fn new(frame: &FrameView<'_>, full: Rect) -> Self {
        let mut scene = Self {
            finder: ShiftFinder::default(),
            outlines: Default::default(),
            mean_similarity: 1.0,
            views: Vec::with_capacity(VIEWS),
            shifts: Vec::with_capacity(VIEWS),
        };
        scene.finder.outline(frame, &mut scene.outlines[0]);
        scene.remember(frame, full);
        scene
    }

    /// Looks at the next frame; true if the scene was cut before it (step 1).
    pub fn see(&mut self, frame: &FrameView<'_>) -> bool {
        let Self { finder, outlines: [now, before], .. } = self;
        std::mem::swap(now, before);
        finder.outline(frame, now);
        let similarity = finder.similarity(before, now);
        let is_cut = similarity < CUT * self.mean_similarity;
        self.mean_similarity += SIMILARITY_RATE * (similarity - self.mean_similarity);
        self.shifts.fill(None);
        is_cut
    }

    /// How much a part of the frame last seen looks like its place in the scene did when the target was elsewhere, in [0, 1]
    /// (steps 2 and 3).
    pub fn sameness(&mut self, frame: &FrameView<'_>, part: Rect, full: Rect) -> f64 {
        if self.mean_similarity < STEADY {
            return 0.0;
        }
        let middle = part.scaled_about_centre(MIDDLE);
        let Some(here) = patch(middle, |x, y| luminance_in(frame, x, y)) else { return 0.0 };
        let mut highest = 0.0f32;
        for number in 0..self.views.len() {
            let (dx, dy) = self.shift(number, frame);
            let view = &self.views[number];
            if !view.meets_target(&full.translated(-dx, -dy)) {
                highest = highest.max(view.best_correlation(&here, middle.translated(-dx, -dy)));
            }
        }
        f64::from(highest)
    }

    /// Keeps a view of the frame last seen, in which the target surely has that whole box, if it tells something new (step 4).
    pub fn remember(&mut self, frame: &FrameView<'_>, full: Rect) {
        if let Some(latest) = self.views.len().checked_sub(1) {
            let (dx, dy) = self.shift(latest, frame);
            if full.translated(-dx, -dy).overlap(&self.views[latest].full) >= LEFT {
                return;
            }
        }
        let oldest = if self.views.len() < VIEWS { View::empty() } else { self.views.remove(0) };
        self.views.push(oldest.taken(frame, &self.outlines[0], full));
        self.shifts.clear();
        self.shifts.resize(self.views.len(), None);
    }

    fn shift(&mut self, view: usize, frame: &FrameView<'_>) -> (f64, f64) {
        let Self { views, finder, outlines: [now, _], shifts, .. } = self;
        *shifts[view].get_or_insert_with(|| {
            let (across, down) = finder.between(&views[view].outline, now);
            (across * frame.width() as f64, down * frame.height() as f64)
        })
    }
}

impl View {
    fn empty() -> Self {
        let full = Rect::new(0.0, 0.0, 1.0, 1.0);
        Self { step: 1, width: 0, height: 0, luminance: Vec::new(), outline: Outline::default(), full }
    }

    /// The view with another frame in the place of its own.
    fn taken(mut self, frame: &FrameView<'_>, outline: &Outline, full: Rect) -> Self {
        let pixels = frame.width() as f64 * frame.height() as f64;
        self.step = (pixels / MOST_PIXELS).sqrt().ceil().max(1.0) as usize;
        (self.width, self.height) = (frame.width().div_ceil(self.step), frame.height().div_ceil(self.step));
        self.luminance.clear();
        let (bytes, offsets) = (frame.format().bytes_per_pixel(), frame.format().rgb_offsets());
        for y in (0..frame.height()).step_by(self.step) {
            let row = frame.row(y).chunks_exact(bytes).step_by(self.step);
            self.luminance.extend(row.map(|pixel| luminance_of(pixel, offsets)));
        }
        self.outline.clone_from(outline);
        Self { full, ..self }
    }

    fn meets_target(&self, full: &Rect) -> bool {
        self.full.scaled_about_centre((MARGIN, MARGIN)).overlap(full) > 0.0
    }

    /// The highest correlation with what is at a place of the view, which is put right by a few steps (steps 2 and 3).
    fn best_correlation(&self, here: &Patch, place: Rect) -> f32 {
        let correlation =
            |place: Rect| patch(place, |x, y| self.luminance(x, y)).map_or(0.0, |then| dot(here, &then));
        let cell = (place.w / CELLS.0 as f64).max(self.step as f64);
        let (mut best, mut highest) = (place, correlation(place));
        for step in STEPS {
            for _ in 0..MOST_STEPS {
                let from = best;
                for (dx, dy) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
                    let next = from.translated(dx * step * cell, dy * step * cell);
                    let there = correlation(next);
                    if there > highest {
                        (best, highest) = (next, there);
                    }
                }
                if best == from {
                    break;
                }
            }
        }
        highest
    }

    fn luminance(&self, x: f64, y: f64) -> Option<u8> {
        let (column, row) = (x / self.step as f64, y / self.step as f64);
        let inside = column >= 0.0 && row >= 0.0 && column < self.width as f64 && row < self.height as f64;
        inside.then(|| self.luminance[row as usize * self.width + column as usize])
    }
}

fn luminance_in(frame: &FrameView<'_>, x: f64, y: f64) -> Option<u8> {
    let inside = x >= 0.0 && y >= 0.0 && x < frame.width() as f64 && y < frame.height() as f64;
    let format = frame.format();
    inside.then(|| {
        luminance_of(&frame.row(y as usize)[x as usize * format.bytes_per_pixel()..], format.rgb_offsets())
    })
}

fn luminance_of(pixel: &[u8], [r, g, b]: [usize; 3]) -> u8 {
    ((u16::from(pixel[r]) + 2 * u16::from(pixel[g]) + u16::from(pixel[b])) / 4) as u8
}

/// The cells of a box; `None` if it leaves the picture or has no texture.
fn patch(target: Rect, luminance: impl Fn(f64, f64) -> Option<u8>) -> Option<Patch> {
    let (columns, rows) = CELLS;
    let (w, h) = (target.w / columns as f64, target.h / rows as f64);
    let mut patch = [0.0; CELLS.0 * CELLS.1];
    for (i, value) in patch.iter_mut().enumerate() {
        let (x, y) = (target.x + (i % columns) as f64 * w, target.y + (i / columns) as f64 * h);
        for (u, v) in SAMPLES {
            *value += f32::from(luminance(x + u * w, y + v * h)?);
        }
    }
    let cells = patch.len() as f32;
    let mean = patch.iter().sum::<f32>() / cells;
    patch.iter_mut().for_each(|value| *value = (*value - mean) / SAMPLES.len() as f32);
    let norm = dot(&patch, &patch).sqrt();
    if norm < FLAT * cells.sqrt() {
        return None;
    }
    patch.iter_mut().for_each(|value| *value /= norm);
    Some(patch)
}

fn dot(a: &Patch, b: &Patch) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Frame, PixelFormat};

    const FULL: Rect = Rect { x: 40.0, y: 40.0, w: 24.0, h: 48.0 };

    /// A textured wall, moved by `pan` pixels to the left, before it a target of another texture in `full`.
    fn frame(pan: usize, full: Rect, format: PixelFormat) -> Frame {
        let level = |x: usize, y: usize| {
            let (u, v) = (x as f64 + 0.5 - full.x, y as f64 + 0.5 - full.y);
            let inside = (0.0..full.w).contains(&u) && (0.0..full.h).contains(&v);
            let (a, b, seed) =
                if inside { ((u / 4.0) as usize, (v / 4.0) as usize, 77) } else { ((x + pan) / 6, y / 6, 5) };
            ((a * 7919 + b * 104_729 + a * b * seed) * 2_654_435_761 % 1_000_003 % 200) as u8 + 20
        };
        let bytes = format.bytes_per_pixel();
        let pixels = (0..240 * 160 * bytes).map(|i| level(i / bytes % 240, i / bytes / 240)).collect();
        Frame::new(pixels, 240, 160, format).unwrap()
    }

    #[test]
    fn a_place_that_shows_what_it_did_without_the_target_is_scenery_and_the_target_is_not() {
        for format in [PixelFormat::Gray, PixelFormat::Bgra] {
            for pan in [0, 11] {
                let mut scene = Scene::new(&frame(0, FULL, format).view(), FULL);
                let moved = FULL.translated(90.0, 20.0);
                let now = frame(pan, moved, format);
                assert!(!scene.see(&now.view()));
                assert!(scene.sameness(&now.view(), moved, moved) < 0.5);
                let wall = FULL.translated(120.0, -20.0);
                let sameness = scene.sameness(&now.view(), wall, wall);
                assert!(sameness > 0.9, "{format:?} {pan}: {sameness}");
            }
        }
    }

    #[test]
    fn where_the_target_was_the_scene_tells_nothing_until_a_view_shows_it() {
        let mut scene = Scene::new(&frame(0, FULL, PixelFormat::Gray).view(), FULL);
        let moved = FULL.translated(90.0, 20.0);
        let now = frame(0, moved, PixelFormat::Gray);
        scene.see(&now.view());
        assert_eq!(scene.sameness(&now.view(), FULL, FULL), 0.0);
        scene.remember(&now.view(), moved);
        assert!(scene.sameness(&now.view(), FULL, FULL) > 0.99);
        let views = scene.views.len();
        scene.remember(&now.view(), moved.translated(2.0, 0.0));
        assert_eq!(scene.views.len(), views, "the target has not left its place");
    }

    #[test]
    fn the_oldest_view_is_given_up_and_large_frames_are_thinned_out() {
        let mut scene = Scene::new(&frame(0, FULL, PixelFormat::Gray).view(), FULL);
        for number in 1..VIEWS + 3 {
            let full = FULL.translated(number as f64 * 20.0, 0.0);
            let now = frame(0, full, PixelFormat::Gray);
            scene.see(&now.view());
            scene.remember(&now.view(), full);
        }
        let left: Vec<f64> = scene.views.iter().map(|view| view.full.x).collect();
        assert_eq!(left, [100.0, 120.0, 140.0, 160.0, 180.0]);
        let large = Frame::new(vec![7; 3000 * 1000], 3000, 1000, PixelFormat::Gray).unwrap();
        let view = View::empty().taken(&large.view(), &Outline::default(), FULL);
        assert_eq!((view.step, view.width, view.height, view.luminance.len()), (2, 1500, 500, 750_000));
        assert_eq!((view.luminance(2999.0, 999.0), view.luminance(3000.0, 0.0)), (Some(7), None));
    }

    #[test]
    fn another_scene_is_a_cut_and_a_flat_box_tells_nothing() {
        let mut scene = Scene::new(&frame(0, FULL, PixelFormat::Gray).view(), FULL);
        assert!(!scene.see(&frame(3, FULL, PixelFormat::Gray).view()));
        let pixels = (0..240 * 160).map(|i| ((i % 240) * 255 / 240) as u8).collect();
        let other = Frame::new(pixels, 240, 160, PixelFormat::Gray).unwrap();
        assert!(scene.see(&other.view()));
        assert!(!scene.see(&other.view()));
        let black = Frame::new(vec![0; 240 * 160], 240, 160, PixelFormat::Gray).unwrap();
        assert!(scene.see(&black.view()));
        assert_eq!(scene.sameness(&black.view(), FULL, FULL), 0.0);
    }
}
