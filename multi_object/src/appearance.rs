//! What a box looks like, without trained weights: the colours of its upper and its lower half.

use infopart::{frame::FrameView, geometry::Rect};

/// Levels of each of red, green and blue.
const LEVELS: usize = 6;
const BINS: usize = LEVELS * LEVELS * LEVELS;
/// How much of a track's colours a new sight replaces.
const FOLLOWING: f32 = 0.1;

/// Colour histograms of the upper and the lower half of a box; all bins sum to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Appearance(Vec<f32>);

impl Appearance {
    /// The colours of `area` in `frame`; pixels near the box's upright middle line count more (Epanechnikov's kernel), as
    /// the sides are mostly background. Parts outside the frame are left out; a box wholly outside looks like nothing.
    pub fn of(frame: FrameView<'_>, area: &Rect) -> Self {
        let mut bins = vec![0.0f32; 2 * BINS];
        if let Some(inside) = area.clipped_to(frame.width(), frame.height()) {
            let (left, right) = (inside.x.floor() as usize, inside.right().ceil() as usize);
            let middle = area.centre().0;
            for y in inside.y.floor() as usize..inside.bottom().ceil() as usize {
                let half = usize::from(y as f64 + 0.5 > area.centre().1);
                let row = frame.row(y);
                for x in left..right {
                    let off = 2.0 * (x as f64 + 0.5 - middle) / area.w;
                    bins[half * BINS + bin(&frame, row, x)] += (1.0 - off * off).max(0.0) as f32;
                }
            }
        }
        let sum: f32 = bins.iter().sum();
        if sum > 0.0 {
            bins.iter_mut().for_each(|bin| *bin /= sum);
        }
        Self(bins)
    }

    /// Takes over a little of how the object looks now.
    pub fn follow(&mut self, seen: &Self) {
        for (known, seen) in self.0.iter_mut().zip(&seen.0) {
            *known += FOLLOWING * (seen - *known);
        }
    }
}

fn bin(frame: &FrameView<'_>, row: &[u8], x: usize) -> usize {
    let pixel = &row[x * frame.format().bytes_per_pixel()..];
    frame
        .format()
        .rgb_offsets()
        .iter()
        .fold(0, |bin, &channel| bin * LEVELS + usize::from(pixel[channel]) * LEVELS / 256)
}

/// Bhattacharyya's coefficient, in [0, 1]: 1 for the same colours, 0 for none in common.
pub fn similarity(a: &Appearance, b: &Appearance) -> f64 {
    a.0.iter().zip(&b.0).map(|(a, b)| f64::from((a * b).sqrt())).sum()
}

#[cfg(test)]
mod tests {
    use infopart::frame::PixelFormat;

    use super::*;

    /// 8 x 8: red above, blue below; the right half all green.
    fn picture() -> Vec<u8> {
        let colour = |x, y| match (x, y) {
            (4.., _) => [0, 255, 0],
            (_, 0..4) => [255, 0, 0],
            _ => [0, 0, 255],
        };
        (0..64).flat_map(|i| colour(i % 8, i / 8)).collect()
    }

    #[test]
    fn the_same_colours_the_other_way_up_are_another_look() {
        let pixels = picture();
        let frame = FrameView::new(&pixels, 8, 8, 24, PixelFormat::Rgb).unwrap();
        let upright = Appearance::of(frame, &Rect::new(0.0, 0.0, 4.0, 8.0));
        let green = Appearance::of(frame, &Rect::new(4.0, 0.0, 4.0, 8.0));
        let swapped: Vec<u8> = pixels.chunks(24).rev().flatten().copied().collect();
        let turned = FrameView::new(&swapped, 8, 8, 24, PixelFormat::Rgb).unwrap();
        let turned = Appearance::of(turned, &Rect::new(0.0, 0.0, 4.0, 8.0));
        assert!((similarity(&upright, &upright) - 1.0).abs() < 1e-6);
        assert_eq!((similarity(&upright, &green), similarity(&upright, &turned)), (0.0, 0.0));
    }

    #[test]
    fn a_box_outside_looks_like_nothing_and_a_look_follows_slowly() {
        let pixels = picture();
        let frame = FrameView::new(&pixels, 8, 8, 24, PixelFormat::Rgb).unwrap();
        let outside = Appearance::of(frame, &Rect::new(20.0, 0.0, 4.0, 8.0));
        let mut known = Appearance::of(frame, &Rect::new(0.0, -3.0, 4.0, 8.0));
        let green = Appearance::of(frame, &Rect::new(5.0, 0.0, 9.0, 8.0));
        assert_eq!(similarity(&outside, &known), 0.0);
        known.follow(&green);
        assert!((similarity(&known, &green) - f64::from(FOLLOWING).sqrt()).abs() < 1e-3);
    }
}
