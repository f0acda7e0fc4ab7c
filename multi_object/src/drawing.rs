//! Tracks drawn on frames: a box, the identity and the trail of each.

use std::collections::{HashMap, VecDeque};

use image::RgbImage;
use infopart::{
    frame::FrameView,
    geometry::Rect,
    output::{
        canvas::{Ink, LINE_HEIGHT, Stroke, draw_text, fill_disc, fill_rect, stroke_rect, text_width},
        rgb_from_view,
    },
};

use crate::tracking::TrackState;

/// Positions that a trail keeps.
const TRAIL: usize = 60;
/// Frames after which the trail of a track that is gone is forgotten.
const FORGOTTEN: u64 = 60;
/// Distinct, bright colours; a track has the one of its identity.
const COLOURS: [[u8; 3]; 10] = [
    [255, 214, 64],
    [64, 200, 255],
    [255, 96, 96],
    [96, 230, 110],
    [230, 120, 255],
    [255, 160, 60],
    [110, 140, 255],
    [70, 235, 205],
    [255, 130, 190],
    [190, 235, 80],
];

#[derive(Debug, Default)]
struct Trail {
    centres: VecDeque<(f64, f64)>,
    last_frame: u64,
}

/// Draws one frame after another; it remembers the trails.
#[derive(Debug, Default)]
pub struct TrackPainter {
    trails: HashMap<u64, Trail>,
    frames: u64,
}

impl TrackPainter {
    /// A copy of the frame with the established tracks: whole boxes where they were detected, dashed ones where they are
    /// only believed to be.
    pub fn paint(&mut self, frame: FrameView<'_>, states: &[TrackState]) -> RgbImage {
        self.frames += 1;
        let mut picture = rgb_from_view(frame);
        let established = || states.iter().filter(|state| state.is_established);
        for state in established() {
            let trail = self.trails.entry(state.identity).or_default();
            trail.last_frame = self.frames;
            trail.centres.push_back(state.box_in_frame.centre());
            if trail.centres.len() > TRAIL {
                trail.centres.pop_front();
            }
            draw_trail(&mut picture, &trail.centres, ink_of(state.identity));
        }
        for state in established() {
            draw_box(&mut picture, state);
        }
        let frames = self.frames;
        self.trails.retain(|_, trail| trail.last_frame + FORGOTTEN > frames);
        picture
    }
}

fn ink_of(identity: u64) -> Ink {
    Ink::solid(COLOURS[(identity % COLOURS.len() as u64) as usize])
}

fn draw_trail(picture: &mut RgbImage, centres: &VecDeque<(f64, f64)>, ink: Ink) {
    for (index, (from, to)) in centres.iter().zip(centres.iter().skip(1)).enumerate() {
        // Older parts are fainter.
        let ink = ink.faded(0.15 + 0.75 * index as f64 / centres.len() as f64);
        let steps = (to.0 - from.0).hypot(to.1 - from.1).ceil().clamp(1.0, 50.0);
        for step in 1..=steps as u32 {
            let share = f64::from(step) / steps;
            let at = (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
            fill_disc(picture, at, 1.0, ink);
        }
    }
}

fn draw_box(picture: &mut RgbImage, state: &TrackState) {
    let ink = ink_of(state.identity);
    let dash = state.detected_in_frame.is_none().then_some(5.0);
    let area = state.box_in_frame;
    stroke_rect(picture, area, Stroke { ink: Ink::solid([0, 0, 0]).faded(0.4), thickness: 4.0, dash: None });
    stroke_rect(picture, area, Stroke { ink, thickness: 2.0, dash });
    let label = state.identity.to_string();
    let (width, height) = (f64::from(text_width(&label, 1)) + 4.0, f64::from(LINE_HEIGHT));
    let top = if area.y >= height { area.y - height } else { area.y };
    fill_rect(picture, Rect::new(area.x, top, width, height), ink.faded(0.85));
    draw_text(picture, &label, (area.x.round() as i64 + 2, top.round() as i64), 1, Ink::solid([0, 0, 0]));
}

#[cfg(test)]
mod tests {
    use infopart::frame::PixelFormat;

    use super::*;

    #[test]
    fn only_established_tracks_are_drawn_each_in_its_colour_with_its_trail() {
        let pixels = vec![30; 100 * 80 * 3];
        let frame = FrameView::new(&pixels, 100, 80, 300, PixelFormat::Rgb).unwrap();
        let state = |x: f64, is_established| TrackState {
            identity: 2,
            predicted_in_frame: None,
            detected_in_frame: Some(Rect::new(x, 30.0, 20.0, 30.0)),
            box_in_frame: Rect::new(x, 30.0, 20.0, 30.0),
            is_established,
        };
        let mut painter = TrackPainter::default();
        assert_eq!(painter.paint(frame, &[state(10.0, false)]).into_raw(), pixels);
        painter.paint(frame, &[state(10.0, true)]);
        let picture = painter.paint(frame, &[state(50.0, true)]);
        assert_eq!(picture.get_pixel(50, 50).0, COLOURS[2]);
        // Between the two centres, on the trail.
        assert_ne!(picture.get_pixel(40, 45).0, [30; 3]);
        assert_eq!(picture.get_pixel(40, 70).0, [30; 3]);
    }
}
