//! Drawing on an RGB picture: boxes, dots and text, anti-aliased by the share of each pixel they cover.

use image::{Rgb, RgbImage};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, RasterizedChar, get_raster, get_raster_width};

use crate::geometry::Rect;

/// A colour and how much of it is laid over what is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ink {
    /// Red, green, blue.
    pub colour: [u8; 3],
    /// Opacity in [0, 1].
    pub alpha: f64,
}

impl Ink {
    /// A colour that hides what is below.
    pub const fn solid(colour: [u8; 3]) -> Self {
        Self { colour, alpha: 1.0 }
    }

    /// The same colour with this opacity.
    pub const fn faded(self, alpha: f64) -> Self {
        Self { alpha, ..self }
    }
}

/// How the edges of a box are drawn.
#[derive(Debug, Clone, Copy)]
pub struct Stroke {
    /// Its colour.
    pub ink: Ink,
    /// Width of the line, pixels, centred on the edge.
    pub thickness: f64,
    /// Length of a dash and of a gap, pixels; `None` for a whole line.
    pub dash: Option<f64>,
}

/// Lays `ink` over pixel (`x`, `y`), of which it covers the share `coverage`. Outside the picture nothing happens.
fn blend(picture: &mut RgbImage, x: i64, y: i64, ink: Ink, coverage: f64) {
    let inside = |value: i64, size: u32| u32::try_from(value).ok().filter(|&v| v < size);
    let (Some(x), Some(y)) = (inside(x, picture.width()), inside(y, picture.height())) else { return };
    let share = (ink.alpha * coverage).clamp(0.0, 1.0);
    let Rgb(below) = picture.get_pixel_mut(x, y);
    for (sample, colour) in below.iter_mut().zip(ink.colour) {
        *sample = (f64::from(*sample) * (1.0 - share) + f64::from(colour) * share).round() as u8;
    }
}

/// Fills `area`.
pub fn fill_rect(picture: &mut RgbImage, area: Rect, ink: Ink) {
    for_pixels_of(picture, area, |picture, x, y| {
        blend(picture, x, y, ink, covered(area, x, y));
    });
}

/// Draws the edges of `area`.
pub fn stroke_rect(picture: &mut RgbImage, area: Rect, stroke: Stroke) {
    if !area.is_proper() {
        return;
    }
    let outer = grown(area, stroke.thickness / 2.0);
    let inner = grown(area, -stroke.thickness / 2.0);
    for side in sides(outer, stroke.thickness) {
        for_pixels_of(picture, side, |picture, x, y| {
            let hole = if inner.is_proper() { covered(inner, x, y) } else { 0.0 };
            // A pixel that two sides share is coloured with its part of either, so that corners are not drawn twice.
            let of_side = covered(side, x, y).min(covered(outer, x, y) - hole);
            if of_side > 0.0 && stroke.dash.is_none_or(|length| in_dash(outer, side, x, y, length)) {
                blend(picture, x, y, stroke.ink, of_side);
            }
        });
    }
}

/// The four bands of a frame whose outer edge is `outer`; left and right leave the corners to top and bottom.
fn sides(outer: Rect, thickness: f64) -> [Rect; 4] {
    let across = thickness.min(outer.w / 2.0);
    let down = thickness.min(outer.h / 2.0);
    let between = (outer.h - 2.0 * down).max(0.0);
    [
        Rect { h: down, ..outer },
        Rect { y: outer.bottom() - down, h: down, ..outer },
        Rect { y: outer.y + down, w: across, h: between, ..outer },
        Rect { x: outer.right() - across, y: outer.y + down, w: across, h: between },
    ]
}

/// Whether the middle of a pixel falls on a dash, counted along the side from the box's top left corner.
fn in_dash(outer: Rect, side: Rect, x: i64, y: i64, length: f64) -> bool {
    let along = if side.w > side.h { x as f64 + 0.5 - outer.x } else { y as f64 + 0.5 - outer.y };
    (along / length).floor().rem_euclid(2.0) == 0.0
}

/// Fills a disc.
pub fn fill_disc(picture: &mut RgbImage, centre: (f64, f64), radius: f64, ink: Ink) {
    let reach = radius + 1.0;
    let around = Rect::new(centre.0 - reach, centre.1 - reach, 2.0 * reach, 2.0 * reach);
    for_pixels_of(picture, around, |picture, x, y| {
        let distance = (x as f64 + 0.5 - centre.0).hypot(y as f64 + 0.5 - centre.1);
        blend(picture, x, y, ink, (radius + 0.5 - distance).clamp(0.0, 1.0));
    });
}

/// Height of a line of text at `scale` 1, pixels.
pub const LINE_HEIGHT: u32 = 16;

/// Width of `text` at `scale`, pixels.
pub fn text_width(text: &str, scale: u32) -> u32 {
    let letter = get_raster_width(FontWeight::Regular, RasterHeight::Size16) as u32;
    letter * scale * text.chars().count() as u32
}

/// Writes `text` with its top left corner at (`x`, `y`), letters `scale` times as large. Letters outside ASCII become `?`.
pub fn draw_text(picture: &mut RgbImage, text: &str, (x, y): (i64, i64), scale: u32, ink: Ink) {
    let letter_width = i64::from(text_width("x", scale));
    for (index, letter) in text.chars().enumerate() {
        let glyph = |letter| get_raster(letter, FontWeight::Regular, RasterHeight::Size16);
        let Some(raster) = glyph(letter).or_else(|| glyph('?')) else { continue };
        let left = x + letter_width * index as i64;
        for row in 0..i64::from(LINE_HEIGHT * scale) {
            for column in 0..letter_width {
                let coverage = smooth_sample(&raster, column, row, scale);
                blend(picture, left + column, y + row, ink, coverage);
            }
        }
    }
}

/// The coverage of a glyph enlarged `scale` times, between its samples linearly.
fn smooth_sample(glyph: &RasterizedChar, column: i64, row: i64, scale: u32) -> f64 {
    let at = |y: i64, x: i64| {
        let inside = usize::try_from(x).ok().zip(usize::try_from(y).ok());
        let sample = inside.and_then(|(x, y)| glyph.pixel(x, y));
        f64::from(sample.unwrap_or(0)) / 255.0
    };
    let place = |value: i64| (value as f64 + 0.5) / f64::from(scale) - 0.5;
    let (x, y) = (place(column), place(row));
    let (left, top) = (x.floor(), y.floor());
    let (fx, fy) = (x - left, y - top);
    let (i, j) = (left as i64, top as i64);
    let upper = at(j, i) * (1.0 - fx) + at(j, i + 1) * fx;
    let lower = at(j + 1, i) * (1.0 - fx) + at(j + 1, i + 1) * fx;
    upper * (1.0 - fy) + lower * fy
}

fn grown(area: Rect, by: f64) -> Rect {
    Rect::new(area.x - by, area.y - by, area.w + 2.0 * by, area.h + 2.0 * by)
}

/// The share of pixel (`x`, `y`) that lies in `area`.
fn covered(area: Rect, x: i64, y: i64) -> f64 {
    area.intersection_area(&Rect::new(x as f64, y as f64, 1.0, 1.0))
}

/// Visits the picture's pixels that touch `area`.
fn for_pixels_of(picture: &mut RgbImage, area: Rect, mut visit: impl FnMut(&mut RgbImage, i64, i64)) {
    if !area.is_proper() {
        return;
    }
    let Some(inside) = area.clipped_to(picture.width() as usize, picture.height() as usize) else { return };
    for y in inside.y.floor() as i64..inside.bottom().ceil() as i64 {
        for x in inside.x.floor() as i64..inside.right().ceil() as i64 {
            visit(picture, x, y);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Ink = Ink::solid([255, 255, 255]);

    fn reds(picture: &RgbImage) -> Vec<Vec<u8>> {
        picture.rows().map(|row| row.map(|pixel| pixel.0[0]).collect()).collect()
    }

    #[test]
    fn a_stroke_covers_each_pixel_by_its_share_and_once() {
        let mut picture = RgbImage::new(6, 5);
        let stroke = Stroke { ink: WHITE, thickness: 1.0, dash: None };
        stroke_rect(&mut picture, Rect::new(1.5, 1.5, 3.0, 2.0), stroke);
        assert_eq!(
            reds(&picture),
            [
                [0, 0, 0, 0, 0, 0],
                [0, 255, 255, 255, 255, 0],
                [0, 255, 0, 0, 255, 0],
                [0, 255, 255, 255, 255, 0],
                [0, 0, 0, 0, 0, 0],
            ]
        );
        let mut half_off = RgbImage::new(6, 5);
        stroke_rect(&mut half_off, Rect::new(1.0, 1.5, 3.0, 2.0), stroke);
        assert_eq!(reds(&half_off)[2], [128, 128, 0, 128, 128, 0]);
    }

    #[test]
    fn boxes_far_outside_or_improper_leave_the_picture_alone() {
        let mut picture = RgbImage::new(4, 4);
        let stroke = Stroke { ink: WHITE, thickness: 2.0, dash: Some(3.0) };
        for area in [
            Rect::new(1e12, 1e12, 5.0, 5.0),
            Rect::new(f64::NAN, 0.0, 2.0, 2.0),
            Rect::new(0.0, 0.0, 0.0, 2.0),
            Rect::new(-1e9, -1e9, 2e9, 2e9),
        ] {
            stroke_rect(&mut picture, area, stroke);
        }
        assert_eq!(picture, RgbImage::new(4, 4));
    }

    #[test]
    fn a_thin_box_is_filled_not_doubled() {
        let mut picture = RgbImage::new(5, 5);
        let ink = WHITE.faded(0.5);
        stroke_rect(&mut picture, Rect::new(2.0, 1.0, 0.5, 3.0), Stroke { ink, thickness: 2.0, dash: None });
        assert!(picture.pixels().all(|pixel| pixel.0[0] <= 128), "{:?}", reds(&picture));
        assert!(picture.get_pixel(2, 2).0[0] > 110, "{:?}", reds(&picture));
    }

    #[test]
    fn dashes_alternate_along_the_edge() {
        let mut picture = RgbImage::new(8, 3);
        let stroke = Stroke { ink: WHITE, thickness: 1.0, dash: Some(2.0) };
        stroke_rect(&mut picture, Rect::new(0.5, 0.5, 7.0, 2.0), stroke);
        assert_eq!(reds(&picture)[0], [255, 255, 0, 0, 255, 255, 0, 0]);
    }

    #[test]
    fn letters_differ_and_grow() {
        let written = |text: &str, scale| {
            let mut picture = RgbImage::new(40, 40);
            draw_text(&mut picture, text, (1, 1), scale, WHITE);
            picture
        };
        let ink = |picture: &RgbImage| picture.pixels().map(|pixel| u32::from(pixel.0[0])).sum::<u32>();
        assert_ne!(written("A", 1), written("B", 1));
        let ratio = f64::from(ink(&written("A", 2))) / f64::from(ink(&written("A", 1)));
        assert!((ratio - 4.0).abs() < 0.2, "{ratio}");
        assert_eq!(written("\u{e9}", 1), written("?", 1));
    }
}
