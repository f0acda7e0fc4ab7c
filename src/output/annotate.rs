//! What the tracker says, drawn on a copy of the frame.

use image::{RgbImage, imageops};

use super::{
    FrameEvent,
    canvas::{self, Ink, Stroke},
};
use crate::{frame::FrameView, geometry::Rect, tracker::Status};

const BLACK: Ink = Ink::solid([0, 0, 0]);
pub(super) const WHITE: Ink = Ink::solid([255, 255, 255]);
pub(super) const COMPETITOR: Ink = Ink::solid([224, 96, 255]);
pub(super) const SEARCHED: Ink = Ink::solid([96, 192, 255]);
pub(super) const PARTICLE: Ink = Ink::solid([255, 224, 64]);
/// Longer side, in pixels, below which a frame is enlarged so that lines and letters stay legible.
const LEGIBLE_SIDE: u32 = 600;
const LARGEST_ZOOM: u32 = 4;
/// Longer side, in pixels, per size of letters.
const SIDE_PER_SCALE: u32 = 1200;
/// Longer side, in pixels, up to which lines have their usual thickness; beyond, they grow with it.
const SIDE_PER_UNIT: f64 = 900.0;

/// A copy of the event's frame with the full box in the colour of the status (green: tracking, orange: uncertain,
/// red: lost), the tracked part as a thinner box, the particles as dots at their boxes' centres, the ground truth as
/// a dashed white box, places that look like the target in violet, windows in which a lost target is looked for dashed in
/// blue with who may be it, and a caption. Frames shorter than 600 pixels on their longer side are enlarged by a whole
/// number.
pub fn annotate(event: &FrameEvent<'_>) -> RgbImage {
    let mut page = Page::with_boxes(event);
    page.draw_caption(event);
    page.picture
}

/// As [`annotate`], but for the caption, which a contact sheet has below its tiles.
pub(super) fn annotate_without_caption(event: &FrameEvent<'_>) -> RgbImage {
    Page::with_boxes(event).picture
}

/// Green for tracking, orange for uncertain, red for lost.
pub(super) fn status_ink(status: Status) -> Ink {
    Ink::solid(match status {
        Status::Tracking => [64, 224, 96],
        Status::Uncertain => [255, 160, 32],
        Status::Lost => [255, 64, 64],
    })
}

/// A view's pixels as an RGB picture of the same size.
pub fn rgb_from_view(view: FrameView<'_>) -> RgbImage {
    let step = view.format().bytes_per_pixel();
    let [red, green, blue] = view.format().rgb_offsets();
    let mut picture = RgbImage::new(view.width() as u32, view.height() as u32);
    for (y, row) in picture.rows_mut().enumerate() {
        for (to, from) in row.zip(view.row(y).chunks_exact(step)) {
            to.0 = [from[red], from[green], from[blue]];
        }
    }
    picture
}

/// A picture being annotated.
struct Page {
    picture: RgbImage,
    /// Picture pixels a frame pixel.
    zoom: u32,
    /// Size of letters, as a multiple of the smallest.
    scale: u32,
    /// Half the thickness of the full box's line, pixels.
    unit: f64,
}

impl Page {
    fn with_boxes(event: &FrameEvent<'_>) -> Self {
        let mut page = Self::of(event.frame);
        page.draw_elsewhere(event);
        page.draw_particles(event);
        page.draw_ground_truth(event.ground_truth);
        page.draw_boxes(event);
        page
    }

    fn of(frame: FrameView<'_>) -> Self {
        let original = rgb_from_view(frame);
        let (width, height) = original.dimensions();
        let zoom = LEGIBLE_SIDE.div_ceil(width.max(height)).clamp(1, LARGEST_ZOOM);
        let picture = match zoom {
            1 => original,
            _ => imageops::resize(&original, width * zoom, height * zoom, imageops::FilterType::CatmullRom),
        };
        let side = picture.width().max(picture.height());
        let scale = side.div_ceil(SIDE_PER_SCALE);
        let unit = (f64::from(side) / SIDE_PER_UNIT).max(1.0);
        Self { picture, zoom, scale, unit }
    }

    fn zoomed(&self, in_frame: Rect) -> Rect {
        let zoom = f64::from(self.zoom);
        Rect::new(in_frame.x * zoom, in_frame.y * zoom, in_frame.w * zoom, in_frame.h * zoom)
    }

    /// A line over a darker, wider one, so that it shows on any background.
    fn outline(&mut self, area: Rect, stroke: Stroke) {
        let halo =
            Stroke { ink: BLACK.faded(0.4), thickness: stroke.thickness + 2.0 * self.unit, dash: None };
        canvas::stroke_rect(&mut self.picture, area, halo);
        canvas::stroke_rect(&mut self.picture, area, stroke);
    }

    fn draw_particles(&mut self, event: &FrameEvent<'_>) {
        let hypotheses = event.tracker.hypotheses();
        let largest = hypotheses.iter().map(|hypothesis| hypothesis.weight).fold(0.0, f64::max);
        for hypothesis in &hypotheses {
            let centre = self.zoomed(hypothesis.box_in_frame).centre();
            // The square root keeps light particles visible beside the heaviest.
            let relative = if largest > 0.0 { (hypothesis.weight / largest).sqrt() } else { 1.0 };
            let ink = PARTICLE.faded(0.12 + 0.6 * relative);
            canvas::fill_disc(&mut self.picture, centre, 1.2 * self.unit, ink);
        }
    }

    fn draw_elsewhere(&mut self, event: &FrameEvent<'_>) {
        let unit = self.unit;
        let elsewhere = event.tracker.elsewhere();
        let boxes =
            [(elsewhere.searched, SEARCHED, Some(6.0 * unit)), (elsewhere.competitors, COMPETITOR, None)];
        for (places, ink, dash) in boxes {
            for place in places {
                let stroke = Stroke { ink: ink.faded(0.85), thickness: 1.2 * unit, dash };
                let place = self.zoomed(place);
                canvas::stroke_rect(&mut self.picture, place, stroke);
            }
        }
        if let Some(suspect) = elsewhere.suspect {
            let stroke = Stroke { ink: SEARCHED, thickness: 2.0 * unit, dash: None };
            self.outline(self.zoomed(suspect), stroke);
        }
    }

    fn draw_ground_truth(&mut self, ground_truth: Option<Rect>) {
        let Some(truth) = ground_truth else { return };
        let unit = self.unit;
        let stroke = Stroke { ink: WHITE.faded(0.9), thickness: 1.2 * unit, dash: Some(5.0 * unit) };
        self.outline(self.zoomed(truth), stroke);
    }

    fn draw_boxes(&mut self, event: &FrameEvent<'_>) {
        let unit = self.unit;
        let ink = status_ink(event.estimate.status);
        let (full, part) = (event.estimate.box_in_frame, event.estimate.part_in_frame);
        if part != full {
            let stroke = Stroke { ink: ink.faded(0.85), thickness: unit, dash: None };
            let part = self.zoomed(part);
            canvas::stroke_rect(&mut self.picture, part, stroke);
        }
        self.outline(self.zoomed(full), Stroke { ink, thickness: 2.0 * unit, dash: None });
    }

    fn draw_caption(&mut self, event: &FrameEvent<'_>) {
        let pad = 4 * self.scale;
        let height = canvas::LINE_HEIGHT * self.scale + pad;
        let indent = canvas::LINE_HEIGHT * self.scale + pad;
        let room = self.picture.width().saturating_sub(indent + pad);
        let fits = |text: &String| canvas::text_width(text, self.scale) <= room;
        let Some(text) = captions(event).into_iter().find(fits) else { return };
        if self.picture.height() < 3 * height {
            return;
        }
        let strip = Rect::new(0.0, 0.0, f64::from(self.picture.width()), f64::from(height));
        canvas::fill_rect(&mut self.picture, strip, BLACK.faded(0.6));
        let middle = f64::from(height) / 2.0;
        let light = status_ink(event.estimate.status);
        canvas::fill_disc(
            &mut self.picture,
            (f64::from(indent) / 2.0, middle),
            4.5 * f64::from(self.scale),
            light,
        );
        let corner = (i64::from(indent), i64::from(pad / 2));
        canvas::draw_text(&mut self.picture, &text, corner, self.scale, WHITE);
    }
}

/// What is said of a frame, at length and ever shorter.
fn captions(event: &FrameEvent<'_>) -> [String; 3] {
    let status = event.estimate.status;
    let brief = format!("{}  {status} {:.2}", event.number, event.estimate.confidence);
    let mut long = format!("frame {}  {status}  confidence {:.2}", event.number, event.estimate.confidence);
    if let Some(truth) = event.ground_truth {
        long += &format!("  overlap {:.2}", event.estimate.box_in_frame.overlap(&truth));
    }
    [long, brief, event.number.to_string()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        frame::{Frame, PixelFormat},
        output::testing::EventParts,
        tracker::WeightedBox,
    };

    fn grey(width: usize, height: usize, level: u8) -> Frame {
        Frame::new(vec![level; width * height], width, height, PixelFormat::Gray).unwrap()
    }

    /// The pixel of the annotated picture under a place of a 640 x 480 frame, which is not enlarged.
    fn at(picture: &RgbImage, x: u32, y: u32) -> [u8; 3] {
        picture.get_pixel(x, y).0
    }

    #[test]
    fn the_full_box_has_the_colour_of_the_status() {
        let mut parts = EventParts::on(grey(640, 480, 90), Rect::new(100.0, 100.0, 60.0, 160.0));
        for status in [Status::Tracking, Status::Uncertain, Status::Lost] {
            parts.estimate.status = status;
            let picture = annotate(&parts.event());
            let colour = status_ink(status).colour;
            assert_eq!(at(&picture, 130, 99), colour);
            assert_eq!(at(&picture, 130, 260), colour);
            assert_eq!(at(&picture, 160, 180), colour);
        }
    }

    #[test]
    fn the_parts_lower_edge_is_drawn_inside_and_nothing_below_it() {
        let parts = EventParts::on(grey(640, 480, 90), Rect::new(100.0, 100.0, 60.0, 160.0));
        let picture = annotate(&parts.event());
        assert_ne!(at(&picture, 130, 200), [90; 3], "the part ends at 5/8 of the height");
        assert_eq!(at(&picture, 130, 230), [90; 3]);
        assert_eq!(at(&picture, 300, 300), [90; 3], "far from the boxes the frame is untouched");
    }

    #[test]
    fn heavy_particles_are_brighter_than_light_ones() {
        let mut parts = EventParts::on(grey(640, 480, 0), Rect::new(100.0, 100.0, 60.0, 160.0));
        let hypothesis =
            |x: f64, weight| WeightedBox { box_in_frame: Rect::new(x, 295.5, 10.0, 10.0), weight };
        parts.tracker.hypotheses = vec![hypothesis(295.5, 0.9), hypothesis(395.5, 0.1)];
        let picture = annotate(&parts.event());
        let (heavy, light) = (at(&picture, 300, 300)[0], at(&picture, 400, 300)[0]);
        assert!(heavy > light && light > 30, "{heavy} {light}");
    }

    #[test]
    fn ground_truth_is_dashed_and_only_drawn_where_known() {
        let mut parts = EventParts::on(grey(640, 480, 0), Rect::new(100.0, 100.0, 60.0, 160.0));
        let row = |parts: &EventParts| {
            let picture = annotate(&parts.event());
            (300..400).map(|x| at(&picture, x, 300)[0] > 150).collect::<Vec<bool>>()
        };
        assert!(row(&parts).iter().all(|&lit| !lit));
        parts.ground_truth = Some(Rect::new(300.0, 300.5, 100.0, 50.0));
        let lit = row(&parts).iter().filter(|&&lit| lit).count();
        assert!((40..=60).contains(&lit), "half of a dashed line: {lit}");
    }

    #[test]
    fn competitors_and_a_search_have_colours_of_their_own() {
        let mut parts = EventParts::on(grey(640, 480, 0), Rect::new(100.0, 100.0, 60.0, 160.0));
        let place = |x: f64| Rect::new(x, 300.0, 40.0, 80.0);
        parts.tracker.elsewhere.competitors = vec![place(300.0)];
        parts.tracker.elsewhere.suspect = Some(place(400.0));
        parts.tracker.elsewhere.searched = vec![place(500.0)];
        let picture = annotate(&parts.event());
        let colour = |x: u32| at(&picture, x, 340);
        let [red, green, blue] = colour(300);
        assert!(red > green && blue > green, "violet: {:?}", colour(300));
        assert_eq!(colour(400), SEARCHED.colour);
        let lit = (300..380).filter(|&y| at(&picture, 500, y)[2] > 90).count();
        assert!((25..=55).contains(&lit), "dashed: {lit}");
    }

    #[test]
    fn small_frames_are_enlarged_and_boxes_with_them() {
        let parts = EventParts::on(grey(200, 150, 90), Rect::new(50.0, 50.0, 20.0, 40.0));
        let picture = annotate(&parts.event());
        assert_eq!(picture.dimensions(), (600, 450));
        assert_eq!(at(&picture, 180, 150), status_ink(Status::Tracking).colour);
    }

    #[test]
    fn any_size_of_frame_and_box_is_drawn_without_a_panic() {
        for (width, height) in [(1, 1), (3, 200), (200, 3), (1300, 20)] {
            for area in [Rect::new(0.0, 0.0, 1.0, 1.0), Rect::new(-1e7, -5.0, 2e7, 1e7)] {
                let mut parts = EventParts::on(grey(width, height, 9), area);
                parts.ground_truth = Some(area);
                annotate(&parts.event());
            }
        }
    }

    #[test]
    fn channels_keep_their_places() {
        let frame = Frame::new(vec![1, 2, 3, 9], 1, 1, PixelFormat::Bgra).unwrap();
        assert_eq!(rgb_from_view(frame.view()).get_pixel(0, 0).0, [3, 2, 1]);
    }
}
