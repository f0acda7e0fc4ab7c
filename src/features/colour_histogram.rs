//! Colour and gradient histograms of boxes, from integral histograms of a search region.
//!
//! Steps, each frame:
//! 1. a cell is the pixel in the middle of its `step` x `step` pixels; cells outside the frame, and those that the caller
//!    leaves out (background, another target), count nothing,
//! 2. its red, green and blue levels, times the gain, each fall into one of 16 bins,
//! 3. if asked for, the magnitude of its luminance gradient falls into one of 16 unsigned orientation bins,
//! 4. one integral image a bin, interleaved (exact, u32),
//! 5. the histogram of a box is II(x'', y'') - II(x', y'') - II(x'', y') + II(x', y') in each bin.

use crate::{features::region::SearchRegion, frame::FrameView, geometry::Rect};

/// Bins of one cue: a colour channel, or gradient orientation.
pub const CUE_BINS: usize = 16;
/// Red, green, blue, gradient.
pub const CUES: usize = 4;
const COLOURS: usize = 3;

/// What is counted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistogramOptions {
    /// Whether gradients are counted besides colours.
    pub gradient: bool,
    /// Levels are multiplied by this before they are binned (brightness compensation).
    pub gain: f64,
}

/// Counts of a box: 16 bins of each of red, green, blue and gradient orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Histogram {
    bins: [[f32; CUE_BINS]; CUES],
}

/// How a histogram's cues are scaled before they are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Normalisation {
    /// Each cue has the Euclidean length 1: the inner product is a cosine.
    #[default]
    L2,
    /// Each cue sums to 1: inner products are small, and hardly differ.
    L1,
}

impl Histogram {
    /// A histogram that counts nothing.
    pub const EMPTY: Self = Self { bins: [[0.0; CUE_BINS]; CUES] };

    /// The bins of each cue: red, green, blue, gradient.
    pub fn bins(&self) -> &[[f32; CUE_BINS]; CUES] {
        &self.bins
    }

    /// Cells counted.
    pub fn cells(&self) -> f32 {
        self.bins[0].iter().sum()
    }

    /// <H, H'> in [0, 1]: the mean over the cues of the inner products of the normalised histograms. The gradient is a
    /// cue if `self` counts any. A cue without counts in either gives 0.
    pub fn inner_product(&self, other: &Self, normalisation: Normalisation) -> f64 {
        let cues = if self.bins[COLOURS].iter().any(|count| *count > 0.0) { CUES } else { COLOURS };
        let length = |cue: &[f32; CUE_BINS]| match normalisation {
            Normalisation::L2 => dot(cue, cue).sqrt(),
            Normalisation::L1 => cue.iter().map(|count| f64::from(*count)).sum(),
        };
        let products = self.bins[..cues].iter().zip(&other.bins).map(|(a, b)| {
            let lengths = length(a) * length(b);
            if lengths > 0.0 { (dot(a, b) / lengths).min(1.0) } else { 0.0 }
        });
        products.sum::<f64>() / cues as f64
    }

    /// Moves the shape of each cue by `rate` in [0, 1] towards that of `current`; a cue without counts in `current` stays.
    pub fn age_towards(&mut self, current: &Self, rate: f64) {
        for (cue, current) in self.bins.iter_mut().zip(&current.bins) {
            let total = |cue: &[f32; CUE_BINS]| cue.iter().sum::<f32>();
            let (mine, theirs) = (total(cue), total(current));
            if theirs > 0.0 && mine > 0.0 {
                let rate = rate as f32;
                for (count, current) in cue.iter_mut().zip(current) {
                    *count += rate * (current * mine / theirs - *count);
                }
            }
        }
    }
}

fn dot(a: &[f32; CUE_BINS], b: &[f32; CUE_BINS]) -> f64 {
    f64::from(a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>())
}

/// Integral histograms of a search region. Reused from frame to frame.
#[derive(Debug, Clone)]
pub struct HistogramIntegrals {
    region: SearchRegion,
    cues: usize,
    /// (width + 1) x (height + 1) entries of `cues` x 16 bins.
    sums: Vec<u32>,
}

impl Default for HistogramIntegrals {
    fn default() -> Self {
        let region = SearchRegion { x: 0, y: 0, width: 0, height: 0, step: 1 };
        Self { region, cues: COLOURS, sums: vec![0; COLOURS * CUE_BINS] }
    }
}

impl HistogramIntegrals {
    /// Steps 1 to 4 over `region`; only cells whose pixel (x, y) of the frame `counts` are counted.
    pub fn compute(
        &mut self,
        frame: &FrameView<'_>,
        region: SearchRegion,
        options: HistogramOptions,
        counts: impl Fn(usize, usize) -> bool,
    ) {
        self.region = region;
        self.cues = if options.gradient { CUES } else { COLOURS };
        let bins = self.cues * CUE_BINS;
        let stride = (region.width + 1) * bins;
        self.sums.resize(stride * (region.height + 1), 0);
        self.sums[..stride].fill(0);
        let bin_of = level_bins(options.gain);
        let mut running = [0u32; CUES * CUE_BINS];
        for row in 0..region.height {
            running.fill(0);
            let (above, below) = self.sums[row * stride..].split_at_mut(stride);
            let below = &mut below[..stride];
            below[..bins].fill(0);
            let y = inside(region.y + (row * region.step + region.step / 2) as i64, frame.height());
            let entries = above.chunks_exact(bins).zip(below.chunks_exact_mut(bins)).skip(1);
            for (column, (above, below)) in entries.enumerate() {
                let x = inside(region.x + (column * region.step + region.step / 2) as i64, frame.width());
                if let (Some(x), Some(y)) = (x, y)
                    && counts(x, y)
                {
                    for (channel, level) in rgb(frame, x, y).into_iter().enumerate() {
                        running[channel * CUE_BINS + bin_of[usize::from(level)]] += 1;
                    }
                    if options.gradient {
                        let (magnitude, bin) = gradient(frame, x, y, region.step);
                        running[COLOURS * CUE_BINS + bin] += magnitude;
                    }
                }
                for ((below, above), running) in below.iter_mut().zip(above).zip(&running) {
                    *below = above + running;
                }
            }
        }
    }

    /// Step 5: the histogram of a box, its borders at the nearest cells'. What is outside the region counts nothing.
    pub fn histogram(&self, box_in_frame: &Rect) -> Histogram {
        let SearchRegion { x, y, width, height, step } = self.region;
        let line = |at: f64, from: i64, lines: usize| {
            (((at - from as f64) / step as f64).round().max(0.0) as usize).min(lines)
        };
        let (left, right) = (line(box_in_frame.x, x, width), line(box_in_frame.right(), x, width));
        let (top, bottom) = (line(box_in_frame.y, y, height), line(box_in_frame.bottom(), y, height));
        let bins = self.cues * CUE_BINS;
        let corner = |column: usize, row: usize| &self.sums[(row * (width + 1) + column) * bins..][..bins];
        let (a, b, c, d) =
            (corner(right, bottom), corner(left, bottom), corner(right, top), corner(left, top));
        let mut histogram = Histogram::EMPTY;
        let flat = histogram.bins.as_flattened_mut();
        for (i, bin) in flat[..bins].iter_mut().enumerate() {
            *bin = (a[i] + d[i] - b[i] - c[i]) as f32;
        }
        histogram
    }
}

fn inside(at: i64, size: usize) -> Option<usize> {
    usize::try_from(at).ok().filter(|at| *at < size)
}

/// The bin of each level.
fn level_bins(gain: f64) -> [usize; 256] {
    let levels_a_bin = 256 / CUE_BINS;
    std::array::from_fn(|level| (level as f64 * gain).clamp(0.0, 255.0) as usize / levels_a_bin)
}

fn rgb(frame: &FrameView<'_>, x: usize, y: usize) -> [u8; 3] {
    let pixel = &frame.row(y)[x * frame.format().bytes_per_pixel()..];
    frame.format().rgb_offsets().map(|offset| pixel[offset])
}

/// Magnitude and orientation bin of the luminance gradient, by central differences `step` pixels apart.
fn gradient(frame: &FrameView<'_>, x: usize, y: usize, step: usize) -> (u32, usize) {
    let luminance = |x: usize, y: usize| {
        let [red, green, blue] = rgb(frame, x, y).map(f32::from);
        (red + 2.0 * green + blue) / 4.0
    };
    let (right, bottom) = (frame.width() - 1, frame.height() - 1);
    let dx = luminance((x + step).min(right), y) - luminance(x.saturating_sub(step), y);
    let dy = luminance(x, (y + step).min(bottom)) - luminance(x, y.saturating_sub(step));
    let half_turns = (dy.atan2(dx) / std::f32::consts::PI).rem_euclid(1.0);
    let bin = ((half_turns * CUE_BINS as f32) as usize).min(CUE_BINS - 1);
    (dx.hypot(dy).round() as u32, bin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{features::reference::textured_frame, frame::PixelFormat};
    use proptest::prelude::*;

    const COLOUR: HistogramOptions = HistogramOptions { gradient: false, gain: 1.0 };

    /// Counts pixel by pixel.
    fn naive(
        frame: &FrameView<'_>,
        area: (usize, usize, usize, usize),
        counts: impl Fn(usize, usize) -> bool,
    ) -> Histogram {
        let (left, top, right, bottom) = area;
        let mut histogram = Histogram::EMPTY;
        for y in top..bottom.min(frame.height()) {
            for x in (left..right.min(frame.width())).filter(|x| counts(*x, y)) {
                for (channel, level) in rgb(frame, x, y).into_iter().enumerate() {
                    histogram.bins[channel][usize::from(level) / 16] += 1.0;
                }
                let (magnitude, bin) = gradient(frame, x, y, 1);
                histogram.bins[3][bin] += magnitude as f32;
            }
        }
        histogram
    }

    proptest! {
        #[test]
        fn a_box_has_the_histogram_of_its_pixels(
            left in 0usize..20, top in 0usize..14, w in 1usize..12, h in 1usize..12, hole in 0usize..9
        ) {
            let frame = textured_frame(23, 17, PixelFormat::Bgr);
            let counts = |x: usize, y: usize| (x + y) % 9 != hole;
            let mut integrals = HistogramIntegrals::default();
            let region = SearchRegion { x: -3, y: -2, width: 40, height: 32, step: 1 };
            integrals.compute(&frame.view(), region, HistogramOptions { gradient: true, gain: 1.0 }, counts);
            let found = integrals.histogram(&Rect::new(left as f64, top as f64, w as f64, h as f64));
            prop_assert_eq!(found, naive(&frame.view(), (left, top, left + w, top + h), counts));
        }
    }

    #[test]
    fn what_is_outside_frame_or_region_counts_nothing() {
        let frame = textured_frame(10, 8, PixelFormat::Rgb);
        let mut integrals = HistogramIntegrals::default();
        integrals.compute(
            &frame.view(),
            SearchRegion { x: -4, y: -4, width: 10, height: 20, step: 1 },
            COLOUR,
            |_, _| true,
        );
        let cells = |x, y, w, h| integrals.histogram(&Rect::new(x, y, w, h)).cells();
        assert_eq!(cells(-4.0, -4.0, 4.0, 20.0), 0.0);
        assert_eq!(cells(-4.0, -4.0, 100.0, 100.0), 6.0 * 8.0);
        assert_eq!(cells(50.0, 50.0, 5.0, 5.0), 0.0);
        assert_eq!(HistogramIntegrals::default().histogram(&Rect::new(0.0, 0.0, 3.0, 3.0)), Histogram::EMPTY);
    }

    #[test]
    fn a_cell_is_the_pixel_in_its_middle_and_the_gain_moves_its_bin() {
        let data: Vec<u8> = (0..16).map(|i| i * 16).collect();
        let frame = FrameView::new(&data, 4, 4, 4, PixelFormat::Gray).unwrap();
        let region = SearchRegion { x: 0, y: 0, width: 2, height: 2, step: 2 };
        let mut integrals = HistogramIntegrals::default();
        let bins = |integrals: &HistogramIntegrals| {
            let histogram = integrals.histogram(&Rect::new(0.0, 0.0, 4.0, 4.0));
            (0..16).filter(|bin| histogram.bins()[0][*bin] == 1.0).collect::<Vec<_>>()
        };
        integrals.compute(&frame, region, COLOUR, |_, _| true);
        assert_eq!(bins(&integrals), [5, 7, 13, 15]);
        integrals.compute(&frame, region, HistogramOptions { gain: 0.5, ..COLOUR }, |_, _| true);
        assert_eq!(bins(&integrals), [2, 3, 6, 7]);
    }

    #[test]
    fn the_inner_product_is_a_cosine_under_l2_and_tiny_under_l1() {
        let of = |counts: &[(usize, f32)]| {
            let mut histogram = Histogram::EMPTY;
            for cue in &mut histogram.bins[..3] {
                counts.iter().for_each(|(bin, count)| cue[*bin] = *count);
            }
            histogram
        };
        let (a, b) = (of(&[(0, 3.0), (1, 4.0)]), of(&[(1, 10.0)]));
        assert!((a.inner_product(&b, Normalisation::L2) - 0.8).abs() < 1e-7);
        assert!((a.inner_product(&a, Normalisation::L2) - 1.0).abs() < 1e-7);
        assert!((a.inner_product(&a, Normalisation::L1) - 25.0 / 49.0).abs() < 1e-7);
        assert_eq!(a.inner_product(&Histogram::EMPTY, Normalisation::L2), 0.0);
        let mut aged = a;
        aged.age_towards(&b, 0.5);
        assert_eq!(&aged.bins[0][..2], &[1.5, 5.5]);
    }
}
