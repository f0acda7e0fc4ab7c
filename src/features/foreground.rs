//! Which pixels around a box are likely its own, by their colours (after Possegger, Mauthner, Bischof 2015 and Bertinetto,
//! Valmadre, Golodetz, Miksik, Torr 2016).
//!
//! Steps:
//! 1. learning: the colours of 16 x 16 x 16 bins are counted in the middle of the box and in its surroundings, and each of the
//!    two histograms, which sum to 1, moves towards its count,
//! 2. a colour's foreground probability: its share of the box's histogram / its shares of both,
//! 3. looking, each frame: the probability at each place of a lattice over a window, and its integral image,
//! 4. a box's contrast: the mean probability inside less that in a ring around it.

use crate::{frame::FrameView, geometry::Rect};

const LEVELS: usize = 16;
const BINS: usize = LEVELS * LEVELS * LEVELS;
/// Added to a colour's two shares, so that one never seen is as likely foreground as background.
const UNSEEN: f32 = 1e-4;
/// Places along a side of the lattices at most.
const PLACES: f64 = 96.0;
/// Width and height of what counts as inside, in shares of the box's.
const INSIDE: (f64, f64) = (0.7, 0.9);
/// Width and height from which on a place counts as outside.
const OUTSIDE: f64 = 1.1;
/// Side of the surroundings, in square roots of the box's area.
const SURROUNDINGS: f64 = 2.5;
/// Width and height of a box with its ring.
const RING: (f64, f64) = (1.5, 1.25);

/// The colours of a target and of what surrounds it.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ForegroundModel {
    rate: f32,
    learnt: bool,
    inside: Vec<f32>,
    outside: Vec<f32>,
    probability: Vec<f32>,
    /// Scratch: counts inside and outside.
    counts: [Vec<f32>; 2],
}

impl ForegroundModel {
    /// A model that takes every colour for either, until it learns; later lessons move it by `rate` in (0, 1].
    pub fn new(rate: f32) -> Self {
        let zeros = || vec![0.0; BINS];
        Self {
            rate,
            learnt: false,
            inside: zeros(),
            outside: zeros(),
            probability: vec![0.5; BINS],
            counts: [zeros(), zeros()],
        }
    }

    /// Learns the colours of a box of the frame and of its surroundings (steps 1 and 2).
    pub fn learn(&mut self, frame: &FrameView<'_>, target: Rect) {
        let rate = if self.learnt { self.rate } else { 1.0 };
        self.learnt = true;
        self.count(frame, target);
        for (histogram, counts) in [&mut self.inside, &mut self.outside].into_iter().zip(&self.counts) {
            let total: f32 = counts.iter().sum();
            if total > 0.0 {
                let shares = counts.iter().map(|count| count / total);
                histogram.iter_mut().zip(shares).for_each(|(mean, share)| *mean += rate * (share - *mean));
            }
        }
        for ((probability, inside), outside) in
            self.probability.iter_mut().zip(&self.inside).zip(&self.outside)
        {
            *probability = (inside + UNSEEN) / (inside + outside + 2.0 * UNSEEN);
        }
    }

    /// How well the colours tell the two apart: the mean probability inside less that outside, in [-1, 1].
    pub fn separation(&self) -> f32 {
        let mean = |histogram: &[f32]| -> f32 {
            histogram.iter().zip(&self.probability).map(|(share, probability)| share * probability).sum()
        };
        mean(&self.inside) - mean(&self.outside)
    }

    fn count(&mut self, frame: &FrameView<'_>, target: Rect) {
        self.counts.iter_mut().for_each(|counts| counts.fill(0.0));
        let (x, y) = target.centre();
        let within = |at: (f64, f64), scale: (f64, f64)| {
            (at.0 - x).abs() < scale.0 * target.w / 2.0 && (at.1 - y).abs() < scale.1 * target.h / 2.0
        };
        let side = SURROUNDINGS * target.area().sqrt();
        let lattice = PixelLattice::over(Rect::new(x - side / 2.0, y - side / 2.0, side, side));
        let [inside, outside] = &mut self.counts;
        lattice.for_each_pixel(frame, |_, at, bin| {
            if within(at, INSIDE) {
                inside[bin] += 1.0;
            } else if !within(at, (OUTSIDE, OUTSIDE)) {
                outside[bin] += 1.0;
            }
        });
    }
}

/// Foreground probabilities over a window of a frame. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ForegroundMap {
    lattice: PixelLattice,
    /// Sums of the probabilities, and of the places that lie in the frame, above and left of each line of the lattice.
    sums: Vec<[f32; 2]>,
}

impl ForegroundMap {
    /// Computes the map of a window (step 3).
    pub fn compute(&mut self, model: &ForegroundModel, frame: &FrameView<'_>, window: Rect) {
        self.lattice = PixelLattice::over(window);
        let (columns, rows) = (self.lattice.columns, self.lattice.rows);
        let stride = columns + 1;
        self.sums.clear();
        self.sums.resize(stride * (rows + 1), [0.0; 2]);
        let sums = &mut self.sums;
        self.lattice.for_each_pixel(frame, |(column, row), _, bin| {
            sums[(row + 1) * stride + column + 1] = [model.probability[bin], 1.0];
        });
        for row in 1..=rows {
            let mut along = [0.0; 2];
            for column in 1..=columns {
                let (here, above) = (row * stride + column, (row - 1) * stride + column);
                for k in 0..2 {
                    along[k] += sums[here][k];
                    sums[here][k] = along[k] + sums[above][k];
                }
            }
        }
    }

    /// The mean probability in a box of the frame; `None` where nothing of it was looked at.
    pub fn mean(&self, target: Rect) -> Option<f32> {
        let [sum, places] = self.sum(target);
        (places >= 1.0).then(|| sum / places)
    }

    /// How much more the colours in a box are the target's than those in the ring around it, in [-1, 1] (step 4); -1 where
    /// nothing of the box was looked at.
    pub fn contrast(&self, target: Rect) -> f32 {
        let [inside, places] = self.sum(target);
        if places < 1.0 {
            return -1.0;
        }
        let [all, all_places] = self.sum(target.scaled_about_centre(RING));
        let ring_places = all_places - places;
        let ring = if ring_places > 1.0 { (all - inside) / ring_places } else { 0.0 };
        inside / places - ring
    }

    fn sum(&self, target: Rect) -> [f32; 2] {
        let PixelLattice { x, y, step, columns, rows } = self.lattice;
        let line =
            |at: f64, from: f64, lines: usize| ((at - from) / step).round().clamp(0.0, lines as f64) as usize;
        let (left, right) = (line(target.x, x, columns), line(target.right(), x, columns));
        let (top, bottom) = (line(target.y, y, rows), line(target.bottom(), y, rows));
        let at = |column: usize, row: usize| {
            self.sums.get(row * (columns + 1) + column).copied().unwrap_or_default()
        };
        let corners = [at(right, bottom), at(right, top), at(left, bottom), at(left, top)];
        std::array::from_fn(|k| corners[0][k] - corners[1][k] - corners[2][k] + corners[3][k])
    }
}

/// Places at which pixels are looked at: the middles of squares of `step` pixels, at least 1.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct PixelLattice {
    x: f64,
    y: f64,
    step: f64,
    columns: usize,
    rows: usize,
}

impl Default for PixelLattice {
    fn default() -> Self {
        Self { x: 0.0, y: 0.0, step: 1.0, columns: 0, rows: 0 }
    }
}

impl PixelLattice {
    fn over(window: Rect) -> Self {
        let step = (window.w.max(window.h) / PLACES).max(1.0);
        let places = |length: f64| (length / step).ceil() as usize;
        Self { x: window.x, y: window.y, step, columns: places(window.w), rows: places(window.h) }
    }

    /// Hands out each place that lies in the frame: its column and row, where it is, and its colour's bin.
    fn for_each_pixel(&self, frame: &FrameView<'_>, mut take: impl FnMut((usize, usize), (f64, f64), usize)) {
        let (offsets, bytes) = (frame.format().rgb_offsets(), frame.format().bytes_per_pixel());
        let middle = |from: f64, i: usize| from + (i as f64 + 0.5) * self.step;
        for row in 0..self.rows {
            let y = middle(self.y, row);
            if y < 0.0 || y >= frame.height() as f64 {
                continue;
            }
            let pixels = frame.row(y as usize);
            for column in 0..self.columns {
                let x = middle(self.x, column);
                if x < 0.0 || x >= frame.width() as f64 {
                    continue;
                }
                let pixel = &pixels[x as usize * bytes..];
                let bin =
                    offsets.iter().fold(0, |bin, &offset| bin * LEVELS + usize::from(pixel[offset] >> 4));
                take((column, row), (x, y), bin);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Frame, PixelFormat};

    /// Blue all over but for a red box.
    fn red_box(width: usize, height: usize, red: Rect, format: PixelFormat) -> Frame {
        let offsets = format.rgb_offsets();
        let bytes = format.bytes_per_pixel();
        let mut data = vec![0; width * height * bytes];
        for y in 0..height {
            for x in 0..width {
                let (u, v) = (x as f64 + 0.5, y as f64 + 0.5);
                let is_red = u > red.x && u < red.right() && v > red.y && v < red.bottom();
                data[(y * width + x) * bytes + offsets[if is_red { 0 } else { 2 }]] = 200;
            }
        }
        Frame::new(data, width, height, format).unwrap()
    }

    fn learnt(target: Rect, format: PixelFormat) -> ForegroundModel {
        let mut model = ForegroundModel::new(0.1);
        model.learn(&red_box(100, 100, target, format).view(), target);
        model
    }

    #[test]
    fn colours_of_the_box_are_foreground_and_the_contrast_peaks_where_the_box_went() {
        for format in [PixelFormat::Rgb, PixelFormat::Bgra] {
            let model = learnt(Rect::new(40.0, 30.0, 20.0, 40.0), format);
            let moved = Rect::new(52.0, 36.0, 20.0, 40.0);
            let frame = red_box(100, 100, moved, format);
            let mut map = ForegroundMap::default();
            map.compute(&model, &frame.view(), Rect::new(0.0, 0.0, 90.0, 90.0));
            assert!(map.mean(moved).unwrap() > 0.99);
            assert!(map.mean(Rect::new(5.0, 5.0, 20.0, 20.0)).unwrap() < 0.01);
            assert!(map.contrast(moved) > 0.98);
            for (dx, dy) in [(4.0, 0.0), (-4.0, 0.0), (0.0, 6.0), (-12.0, -6.0)] {
                assert!(map.contrast(moved.translated(dx, dy)) < 0.9);
            }
            let (larger, smaller) = (Rect::new(47.0, 26.0, 30.0, 60.0), Rect::new(57.0, 46.0, 10.0, 20.0));
            assert!(map.contrast(larger) < 0.8 && map.contrast(smaller) < 0.6);
        }
    }

    #[test]
    fn sums_are_those_of_the_pixels_one_by_one_even_beyond_the_frame() {
        let target = Rect::new(3.0, 4.0, 8.0, 12.0);
        let model = learnt(target, PixelFormat::Rgb);
        let frame = red_box(30, 30, target, PixelFormat::Rgb);
        let mut map = ForegroundMap::default();
        map.compute(&model, &frame.view(), Rect::new(-10.0, -10.0, 34.0, 34.0));
        for wanted in [Rect::new(-6.0, 2.0, 12.0, 9.0), Rect::new(2.0, 3.0, 5.0, 20.0)] {
            let (mut sum, mut count) = (0.0, 0.0);
            for y in wanted.y as i64..wanted.bottom() as i64 {
                for x in wanted.x as i64..wanted.right() as i64 {
                    if (0..24).contains(&x) && (0..24).contains(&y) {
                        let red = (3..11).contains(&x) && (4..16).contains(&y);
                        sum += if red { 1.0 } else { 0.0 };
                        count += 1.0;
                    }
                }
            }
            let mean = map.mean(wanted).unwrap();
            assert!((mean - sum / count).abs() < 0.01, "{mean} {}", sum / count);
        }
        assert_eq!(map.mean(Rect::new(-9.0, -9.0, 5.0, 5.0)), None);
        assert_eq!(map.contrast(Rect::new(-9.0, -9.0, 5.0, 5.0)), -1.0);
    }

    #[test]
    fn a_model_moves_towards_new_colours_by_its_rate() {
        let target = Rect::new(40.0, 30.0, 20.0, 40.0);
        let mut model = learnt(target, PixelFormat::Rgb);
        // The same colours, changed round: red outside, blue inside.
        let mut data = vec![0; 100 * 100 * 3];
        for (i, pixel) in data.chunks_exact_mut(3).enumerate() {
            let (x, y) = ((i % 100) as f64 + 0.5, (i / 100) as f64 + 0.5);
            let inside = x > target.x && x < target.right() && y > target.y && y < target.bottom();
            pixel[if inside { 2 } else { 0 }] = 200;
        }
        let changed = Frame::new(data, 100, 100, PixelFormat::Rgb).unwrap();
        let red = (200 >> 4) * LEVELS * LEVELS;
        for (lessons, expected) in [(1, 0.9), (1, 0.81), (40, 0.012)] {
            (0..lessons).for_each(|_| model.learn(&changed.view(), target));
            assert!((model.probability[red] - expected).abs() < 0.002, "{}", model.probability[red]);
        }
    }
}
