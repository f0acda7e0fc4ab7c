//! Many annotated frames on one picture, for a look at a whole sequence.

use std::path::Path;

use image::{RgbImage, imageops};

use super::{
    FrameEvent, Observer, OutputError,
    annotate::{annotate_without_caption, status_ink},
    canvas::{self, Ink},
    legend,
};
use crate::{geometry::Rect, tracker::Status};

const PAPER: [u8; 3] = [24, 26, 31];
const TITLE: Ink = Ink::solid([245, 245, 245]);
const HEADING: Ink = Ink::solid([150, 190, 255]);
const CAPTION: Ink = Ink::solid([190, 194, 202]);
/// Space around and between tiles, pixels.
const MARGIN: u32 = 12;
/// Height of a line of text with the space below it, pixels.
const LINE: u32 = canvas::LINE_HEIGHT + 6;
/// Size of the title's letters, as a multiple of the others'.
const TITLE_SCALE: u32 = 2;
const TITLE_LINE: u32 = TITLE_SCALE * canvas::LINE_HEIGHT + 8;
/// Height of a caption with the space above and below it, pixels.
const CAPTION_LINE: u32 = LINE + 8;
const LEGEND_LINE: u32 = canvas::LINE_HEIGHT + 16;
/// Width of the status light with the space behind it, pixels.
const LIGHT: u32 = 18;

/// A picture and what is written below it.
#[derive(Debug, Clone)]
pub struct Tile {
    /// The picture.
    pub picture: RgbImage,
    /// One line of ASCII text below the picture; empty for none.
    pub caption: String,
    /// What the light before the caption shows; none without it.
    pub status: Option<Status>,
}

/// Tiles in a grid under headings, to be saved as one PNG.
#[derive(Debug, Clone)]
pub struct ContactSheet {
    title: String,
    columns: u32,
    tile_width: u32,
    sections: Vec<(String, Vec<Tile>)>,
}

impl ContactSheet {
    /// An empty sheet of `columns` tiles a row (at least 1), each scaled to `tile_width` pixels, under a line of ASCII text.
    pub fn new(title: impl Into<String>, columns: u32, tile_width: u32) -> Self {
        Self {
            title: title.into(),
            columns: columns.max(1),
            tile_width: tile_width.max(1),
            sections: Vec::new(),
        }
    }

    /// Adds tiles under a heading of their own, such as a tracker's name and scores.
    pub fn section(
        &mut self,
        heading: impl Into<String>,
        tiles: impl IntoIterator<Item = Tile>,
    ) -> &mut Self {
        let scaled = tiles.into_iter().map(|tile| self.scaled(tile)).collect();
        self.sections.push((heading.into(), scaled));
        self
    }

    fn scaled(&self, tile: Tile) -> Tile {
        let (width, height) = tile.picture.dimensions();
        let tile_height =
            (u64::from(height) * u64::from(self.tile_width) / u64::from(width.max(1))).max(1) as u32;
        let filter = imageops::FilterType::Lanczos3;
        let picture = if width == self.tile_width {
            tile.picture
        } else {
            imageops::resize(&tile.picture, self.tile_width, tile_height, filter)
        };
        Tile { picture, ..tile }
    }

    /// The sheet as a picture.
    pub fn render(&self) -> RgbImage {
        let width = self.columns * (self.tile_width + MARGIN) + MARGIN;
        let height = MARGIN
            + TITLE_LINE
            + LEGEND_LINE
            + self.sections.iter().map(|(_, tiles)| LINE + self.grid_height(tiles) + MARGIN).sum::<u32>();
        let mut sheet = RgbImage::from_pixel(width, height, image::Rgb(PAPER));
        let left = i64::from(MARGIN);
        let scale =
            if canvas::text_width(&self.title, TITLE_SCALE) + 2 * MARGIN <= width { TITLE_SCALE } else { 1 };
        canvas::draw_text(&mut sheet, &self.title, (left, left), scale, TITLE);
        legend::draw(&mut sheet, (MARGIN, MARGIN + TITLE_LINE), CAPTION);
        let mut top = MARGIN + TITLE_LINE + LEGEND_LINE;
        for (heading, tiles) in &self.sections {
            canvas::draw_text(&mut sheet, heading, (left, i64::from(top)), 1, HEADING);
            self.draw_grid(&mut sheet, tiles, top + LINE);
            top += LINE + self.grid_height(tiles) + MARGIN;
        }
        sheet
    }

    /// Writes the sheet as a PNG, whatever the extension of `path`.
    ///
    /// # Errors
    /// [`OutputError`] if it cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), OutputError> {
        self.render()
            .save_with_format(path, image::ImageFormat::Png)
            .map_err(|source| OutputError::Picture { path: path.to_owned(), source })
    }

    fn row_height(row: &[Tile]) -> u32 {
        let tallest = row.iter().map(|tile| tile.picture.height()).max().unwrap_or(0);
        let captioned = row.iter().any(|tile| !tile.caption.is_empty());
        tallest + if captioned { CAPTION_LINE } else { MARGIN }
    }

    fn grid_height(&self, tiles: &[Tile]) -> u32 {
        tiles.chunks(self.columns as usize).map(Self::row_height).sum()
    }

    fn draw_grid(&self, sheet: &mut RgbImage, tiles: &[Tile], top: u32) {
        let mut top = i64::from(top);
        for row in tiles.chunks(self.columns as usize) {
            for (column, tile) in row.iter().enumerate() {
                let left = i64::from(MARGIN) + column as i64 * i64::from(self.tile_width + MARGIN);
                imageops::replace(sheet, &tile.picture, left, top);
                let below = top + i64::from(tile.picture.height()) + 3;
                draw_caption(sheet, tile, (left, below));
            }
            top += i64::from(Self::row_height(row));
        }
    }
}

fn draw_caption(sheet: &mut RgbImage, tile: &Tile, (left, top): (i64, i64)) {
    let Some(status) = tile.status else {
        return canvas::draw_text(sheet, &tile.caption, (left, top), 1, CAPTION);
    };
    let centre = (left as f64 + 6.0, top as f64 + f64::from(canvas::LINE_HEIGHT) / 2.0);
    canvas::fill_disc(sheet, centre, 4.5, status_ink(status));
    canvas::draw_text(sheet, &tile.caption, (left + i64::from(LIGHT), top), 1, CAPTION);
}

/// Collects some annotated frames of a sequence, for a [`ContactSheet`].
#[derive(Debug)]
pub struct SheetSampler {
    /// Counted from 0, ascending.
    wanted: Vec<usize>,
    seen: usize,
    tiles: Vec<Tile>,
    /// The share of the frame's width and height that is shown, in (0, 1].
    shown: f64,
}

impl SheetSampler {
    /// Keeps `count` of `total` frames, the first and the last among them (all of them if there are fewer).
    pub fn new(total: usize, count: usize) -> Self {
        let count = count.min(total);
        let wanted = match count {
            0 => Vec::new(),
            1 => vec![total - 1],
            _ => (0..count).map(|i| (i * (total - 1) + (count - 1) / 2) / (count - 1)).collect(),
        };
        Self { wanted, seen: 0, tiles: Vec::new(), shown: 1.0 }
    }

    /// Keeps the frames at these places in the sequence, counted from 1.
    pub fn at(places: &[usize]) -> Self {
        let mut wanted: Vec<usize> = places.iter().filter_map(|place| place.checked_sub(1)).collect();
        wanted.sort_unstable();
        wanted.dedup();
        Self { wanted, seen: 0, tiles: Vec::new(), shown: 1.0 }
    }

    /// Shows only this share of the frame's width and height around the target, but the whole frame where the
    /// estimate and the truth do not both fit.
    pub fn close_up(self, share: f64) -> Self {
        Self { shown: share.clamp(0.1, 1.0), ..self }
    }

    /// The kept frames so far.
    pub fn into_tiles(self) -> Vec<Tile> {
        self.tiles
    }
}

impl Observer for SheetSampler {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        if self.wanted.get(self.tiles.len()) == Some(&self.seen) {
            self.tiles.push(tile_of(event, self.shown));
        }
        self.seen += 1;
        Ok(())
    }
}

fn tile_of(event: &FrameEvent<'_>, shown: f64) -> Tile {
    let estimate = event.estimate;
    let mut caption = format!("{:<3} {} {:.2}", event.number, estimate.status, estimate.confidence);
    if let Some(truth) = event.ground_truth {
        caption += &format!("  overlap {:.2}", estimate.box_in_frame.overlap(&truth));
    }
    let picture = close_up(annotate_without_caption(event), event, shown);
    Tile { picture, caption, status: Some(estimate.status) }
}

/// The window of an annotated frame that [`SheetSampler::close_up`] speaks of.
fn close_up(picture: RgbImage, event: &FrameEvent<'_>, share: f64) -> RgbImage {
    let (width, height) = (event.frame.width() as f64, event.frame.height() as f64);
    let seen = event.estimate.box_in_frame;
    let truth = event.ground_truth.unwrap_or(seen);
    let (w, h) = (share * width, share * height);
    let (x, y) = truth.centre();
    let window = Rect::new((x - w / 2.0).clamp(0.0, width - w), (y - h / 2.0).clamp(0.0, height - h), w, h);
    let fits = |inside: Rect| {
        inside.x >= window.x
            && inside.y >= window.y
            && inside.right() <= window.right()
            && inside.bottom() <= window.bottom()
    };
    if !(fits(seen) && fits(truth)) {
        return picture;
    }
    let zoom = f64::from(picture.width()) / width;
    let [x, y, w, h] = [window.x, window.y, w, h].map(|length| (length * zoom) as u32);
    imageops::crop_imm(&picture, x, y, w.max(1), h.max(1)).to_image()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::testing::EventParts;

    fn tile(width: u32, height: u32, level: u8) -> Tile {
        let picture = RgbImage::from_pixel(width, height, image::Rgb([level; 3]));
        Tile { picture, caption: "one".into(), status: None }
    }

    #[test]
    fn tiles_stand_in_a_grid_at_their_size() {
        let mut sheet = ContactSheet::new("title", 2, 50);
        sheet.section("first", [tile(100, 60, 200), tile(50, 30, 100), tile(50, 30, 60)]);
        let picture = sheet.render();
        assert_eq!(picture.width(), 2 * (50 + MARGIN) + MARGIN);
        let top = MARGIN + TITLE_LINE + LEGEND_LINE + LINE;
        let level = |x: u32, y: u32| picture.get_pixel(x, y).0[0];
        assert_eq!(level(MARGIN, top), 200);
        assert_eq!(level(MARGIN + 49, top + 29), 200);
        assert_eq!(level(MARGIN + 50, top + 29), PAPER[0]);
        assert_eq!(level(2 * MARGIN + 50, top), 100);
        assert_eq!(level(MARGIN, top + 30 + CAPTION_LINE), 60);
    }

    #[test]
    fn sampled_frames_are_even_and_reach_from_first_to_last() {
        assert_eq!(SheetSampler::new(100, 4).wanted, [0, 33, 66, 99]);
        assert_eq!(SheetSampler::new(3, 12).wanted, [0, 1, 2]);
        assert_eq!(SheetSampler::new(0, 12).wanted, [0; 0]);
        let mut sampler = SheetSampler::new(5, 3);
        for _ in 0..5 {
            sampler.on_frame(&EventParts::new(Rect::new(10.0, 12.0, 8.0, 20.0)).event()).unwrap();
        }
        assert_eq!(sampler.into_tiles().len(), 3);
        assert_eq!(SheetSampler::at(&[9, 1, 0, 9]).wanted, [0, 8]);
    }

    #[test]
    fn a_close_up_shows_both_boxes_or_the_whole_frame() {
        let mut parts = EventParts::new(Rect::new(40.0, 12.0, 8.0, 20.0));
        let size = |parts: &EventParts| {
            let mut sampler = SheetSampler::at(&[1]).close_up(0.5);
            sampler.on_frame(&parts.event()).unwrap();
            sampler.into_tiles().remove(0).picture.dimensions()
        };
        assert_eq!(size(&parts), (128, 96), "half of 64 x 48, four times enlarged");
        parts.ground_truth = Some(Rect::new(2.0, 12.0, 8.0, 20.0));
        assert_eq!(size(&parts), (256, 192));
    }

    #[test]
    fn a_sampled_frame_has_its_status_as_light_and_caption() {
        let mut parts = EventParts::new(Rect::new(10.0, 12.0, 8.0, 20.0));
        parts.estimate.status = Status::Lost;
        parts.ground_truth = Some(parts.estimate.box_in_frame);
        let mut sampler = SheetSampler::at(&[1]);
        sampler.on_frame(&parts.event()).unwrap();
        let tile = sampler.into_tiles().remove(0);
        assert_eq!((tile.status, tile.caption.as_str()), (Some(Status::Lost), "1   lost 1.00  overlap 1.00"));
        let mut sheet = ContactSheet::new("", 1, 256);
        let height = tile.picture.height();
        sheet.section("", [tile]);
        let (x, y) = (MARGIN + 6, MARGIN + TITLE_LINE + LEGEND_LINE + LINE + height + 3 + 8);
        assert_eq!(sheet.render().get_pixel(x, y).0, status_ink(Status::Lost).colour);
    }
}
