//! Naive versions that the fast features are tested against.

use super::{
    haar::{HaarFeature, HaarMask},
    hog::{BINS, CELLS},
    region::SearchRegion,
};
use crate::{
    frame::{Frame, FrameView, PixelFormat},
    geometry::Rect,
};

/// A smooth texture with edges at several sizes.
pub(crate) fn textured_frame(width: usize, height: usize, format: PixelFormat) -> Frame {
    let mut data = Vec::with_capacity(width * height * format.bytes_per_pixel());
    for y in 0..height {
        for x in 0..width {
            for c in 0..format.bytes_per_pixel() {
                let (fx, fy, fc) = (x as f64, y as f64, c as f64);
                let waves = (fx * 0.21 + fc).sin() + (fy * 0.17 - fc).cos() + ((fx + fy) * 0.11).sin();
                let blocks = if (x / 11 + y / 13 + c) % 3 == 0 { 40.0 } else { 0.0 };
                data.push((110.0 + 30.0 * waves + blocks).clamp(0.0, 255.0) as u8);
            }
        }
    }
    Frame::new(data, width, height, format).unwrap()
}

/// The RGB pixel nearest to (x, y) in the frame.
pub(crate) fn sample(frame: &FrameView<'_>, x: i64, y: i64) -> [u8; 3] {
    let x = x.clamp(0, frame.width() as i64 - 1) as usize;
    let y = y.clamp(0, frame.height() as i64 - 1) as usize;
    let at = x * frame.format().bytes_per_pixel();
    frame.format().rgb_offsets().map(|offset| frame.row(y)[at + offset])
}

fn mean(frame: &FrameView<'_>, channel: usize, x: [f64; 2], y: [f64; 2]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for j in y[0].round() as i64..y[1].round() as i64 {
        for i in x[0].round() as i64..x[1].round() as i64 {
            sum += f64::from(sample(frame, i, j)[channel]);
            count += 1.0;
        }
    }
    sum / count
}

/// A Haar-like feature by summing pixels.
pub(crate) fn haar(frame: &FrameView<'_>, target: Rect, feature: &HaarFeature) -> f64 {
    let (columns, rows) = feature.mask.parts();
    let left = target.x + f64::from(feature.x) * target.w;
    let top = target.y + f64::from(feature.y) * target.h;
    let (w, h) =
        (f64::from(feature.w) * target.w / columns as f64, f64::from(feature.h) * target.h / rows as f64);
    let part = |column: usize, row: usize| {
        let (x, y) = (left + w * column as f64, top + h * row as f64);
        mean(frame, feature.channel, [x, x + w], [y, y + h])
    };
    match feature.mask {
        HaarMask::LeftRight => part(0, 0) - part(1, 0),
        HaarMask::TopBottom => part(0, 0) - part(0, 1),
        HaarMask::ThreeColumns => (part(0, 0) + part(2, 0)) / 2.0 - part(1, 0),
        HaarMask::ThreeRows => (part(0, 0) + part(0, 2)) / 2.0 - part(0, 1),
        HaarMask::Checker => (part(0, 0) + part(1, 1)) / 2.0 - (part(1, 0) + part(0, 1)) / 2.0,
    }
}

/// Gradient magnitude in each orientation bin of each pixel of a region of step 1.
pub(crate) fn gradient_bins(frame: &FrameView<'_>, region: SearchRegion) -> Vec<Vec<[f32; BINS]>> {
    let luminance = |i: usize, j: usize| {
        let x = region.x + i.min(region.width - 1) as i64;
        let y = region.y + j.min(region.height - 1) as i64;
        let [r, g, b] = sample(frame, x, y).map(f32::from);
        r + 2.0 * g + b
    };
    (0..region.height)
        .map(|j| {
            (0..region.width)
                .map(|i| {
                    let dx = luminance(i + 1, j) - luminance(i.saturating_sub(1), j);
                    let dy = luminance(i, j + 1) - luminance(i, j.saturating_sub(1));
                    let half_turns = (dy.atan2(dx) / std::f32::consts::PI).rem_euclid(1.0);
                    let position = half_turns * BINS as f32 - 0.5;
                    let lower = position.floor();
                    let share = position - lower;
                    let bin = (lower as i32).rem_euclid(BINS as i32) as usize;
                    let mut bins = [0.0; BINS];
                    bins[bin] += dx.hypot(dy) * (1.0 - share);
                    bins[(bin + 1) % BINS] += dx.hypot(dy) * share;
                    bins
                })
                .collect()
        })
        .collect()
}

/// The HOG descriptor by summing the gradients of pixels.
pub(crate) fn hog(frame: &FrameView<'_>, target: Rect) -> Vec<f64> {
    let region = SearchRegion::around(target, 1);
    let bins = gradient_bins(frame, region);
    let line =
        |start: f64, length: f64, i: usize| (start + length * i as f64 / CELLS as f64).round() as usize;
    let mut values = Vec::new();
    for cell_row in 0..CELLS {
        for cell in 0..CELLS {
            let rows = line(target.y - region.y as f64, target.h, cell_row)
                ..line(target.y - region.y as f64, target.h, cell_row + 1);
            let columns = line(target.x - region.x as f64, target.w, cell)
                ..line(target.x - region.x as f64, target.w, cell + 1);
            let area = (rows.len() * columns.len()) as f64;
            for bin in 0..BINS {
                let sum: f64 = rows
                    .clone()
                    .flat_map(|r| columns.clone().map(move |c| (r, c)))
                    .map(|(r, c)| f64::from(bins[r][c][bin]))
                    .sum();
                values.push(sum / area);
            }
        }
    }
    let normalise = |values: &mut Vec<f64>| {
        let norm = values.iter().map(|v| v * v).sum::<f64>().sqrt();
        values.iter_mut().for_each(|v| *v /= norm);
    };
    normalise(&mut values);
    values.iter_mut().for_each(|v| *v = v.min(0.2));
    normalise(&mut values);
    values
}

/// A box of the frame, cut out and resized: each output pixel is the mean of 8 x 8 bilinear samples.
pub(crate) fn crop_and_resize(frame: &FrameView<'_>, target: Rect, width: usize, height: usize) -> Frame {
    const SAMPLES: usize = 8;
    let bilinear = |x: f64, y: f64| {
        let (fx, fy) = (x - 0.5, y - 0.5);
        let (i, j) = (fx.floor(), fy.floor());
        let (a, b) = (fx - i, fy - j);
        let at = |dx: i64, dy: i64| sample(frame, i as i64 + dx, j as i64 + dy).map(f64::from);
        let (p, q, r, s) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
        [0, 1, 2].map(|c| (p[c] * (1.0 - a) + q[c] * a) * (1.0 - b) + (r[c] * (1.0 - a) + s[c] * a) * b)
    };
    let mut data = Vec::with_capacity(width * height * 3);
    for j in 0..height {
        for i in 0..width {
            let mut sums = [0.0; 3];
            for v in 0..SAMPLES {
                for u in 0..SAMPLES {
                    let x =
                        target.x + target.w * (i as f64 + (u as f64 + 0.5) / SAMPLES as f64) / width as f64;
                    let y =
                        target.y + target.h * (j as f64 + (v as f64 + 0.5) / SAMPLES as f64) / height as f64;
                    bilinear(x, y).iter().zip(&mut sums).for_each(|(value, sum)| *sum += value);
                }
            }
            data.extend(sums.map(|sum| (sum / (SAMPLES * SAMPLES) as f64).round() as u8));
        }
    }
    Frame::new(data, width, height, PixelFormat::Rgb).unwrap()
}
