//! What the marks on an annotated picture mean, drawn as they are drawn there.

use image::RgbImage;

use super::{
    annotate::{COMPETITOR, PARTICLE, WHITE, status_ink},
    canvas::{self, Ink, Stroke},
};
use crate::{geometry::Rect, tracker::Status};

/// Size of a sample, pixels.
const SAMPLE: (u32, u32) = (22, 14);
/// Space between a sample and its text, pixels.
const GAP: u32 = 6;
/// Space between an entry and the next, pixels.
const SPACE: u32 = 20;

enum Mark {
    Box(Stroke),
    Dots,
}

fn entries() -> [(Mark, &'static str); 7] {
    let line = |ink: Ink, thickness, dash| Mark::Box(Stroke { ink, thickness, dash });
    let full = |status| line(status_ink(status), 2.0, None);
    [
        (full(Status::Tracking), "box: tracking"),
        (full(Status::Uncertain), "uncertain"),
        (full(Status::Lost), "lost"),
        (line(status_ink(Status::Tracking).faded(0.85), 1.0, None), "tracked part"),
        (line(COMPETITOR.faded(0.85), 1.2, None), "looks like it"),
        (Mark::Dots, "particles"),
        (line(WHITE.faded(0.9), 1.2, Some(4.0)), "ground truth"),
    ]
}

/// Draws the legend as one line from (`left`, `top`) on.
pub(super) fn draw(picture: &mut RgbImage, (left, top): (u32, u32), ink: Ink) {
    let mut left = left;
    for (mark, text) in entries() {
        draw_mark(picture, &mark, (left, top + 1));
        left += SAMPLE.0 + GAP;
        canvas::draw_text(picture, text, (i64::from(left), i64::from(top)), 1, ink);
        left += canvas::text_width(text, 1) + SPACE;
    }
}

fn draw_mark(picture: &mut RgbImage, mark: &Mark, (left, top): (u32, u32)) {
    let (left, top) = (f64::from(left), f64::from(top));
    let (width, height) = (f64::from(SAMPLE.0), f64::from(SAMPLE.1));
    match mark {
        Mark::Box(stroke) => {
            let inside = Rect::new(left + 1.0, top + 1.0, width - 2.0, height - 2.0);
            canvas::stroke_rect(picture, inside, *stroke);
        }
        Mark::Dots => {
            for (x, y, alpha) in
                [(0.2, 0.6, 0.3), (0.38, 0.3, 0.5), (0.5, 0.6, 0.8), (0.65, 0.35, 0.6), (0.82, 0.7, 0.3)]
            {
                canvas::fill_disc(picture, (left + x * width, top + y * height), 1.6, PARTICLE.faded(alpha));
            }
        }
    }
}
