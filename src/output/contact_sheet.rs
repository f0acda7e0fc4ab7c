//! Many annotated frames on one picture, for a look at a whole sequence.

use std::path::Path;

use image::{RgbImage, imageops};

use super::{
    FrameEvent, Observer, OutputError, annotate,
    canvas::{self, Ink},
};

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

/// A picture and what is written below it.
#[derive(Debug, Clone)]
pub struct Tile {
    /// The picture.
    pub picture: RgbImage,
    /// One line of ASCII text; empty for none.
    pub caption: String,
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
            + self.sections.iter().map(|(_, tiles)| LINE + self.grid_height(tiles) + MARGIN).sum::<u32>();
        let mut sheet = RgbImage::from_pixel(width, height, image::Rgb(PAPER));
        let left = i64::from(MARGIN);
        let scale =
            if canvas::text_width(&self.title, TITLE_SCALE) + 2 * MARGIN <= width { TITLE_SCALE } else { 1 };
        canvas::draw_text(&mut sheet, &self.title, (left, left), scale, TITLE);
        let mut top = MARGIN + TITLE_LINE;
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
        tallest + if captioned { LINE } else { MARGIN }
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
                let below = top + i64::from(tile.picture.height()) + 2;
                canvas::draw_text(sheet, &tile.caption, (left, below), 1, CAPTION);
            }
            top += i64::from(Self::row_height(row));
        }
    }
}

/// Collects annotated frames at even distances over a sequence, for a [`ContactSheet`].
#[derive(Debug)]
pub struct SheetSampler {
    /// Counted from 0, ascending.
    wanted: Vec<usize>,
    seen: usize,
    tiles: Vec<Tile>,
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
        Self { wanted, seen: 0, tiles: Vec::new() }
    }

    /// The kept frames so far.
    pub fn into_tiles(self) -> Vec<Tile> {
        self.tiles
    }
}

impl Observer for SheetSampler {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        if self.wanted.get(self.tiles.len()) == Some(&self.seen) {
            self.tiles.push(Tile { picture: annotate(event), caption: String::new() });
        }
        self.seen += 1;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{geometry::Rect, output::testing::EventParts};

    fn tile(width: u32, height: u32, level: u8) -> Tile {
        Tile { picture: RgbImage::from_pixel(width, height, image::Rgb([level; 3])), caption: "one".into() }
    }

    #[test]
    fn tiles_stand_in_a_grid_at_their_size() {
        let mut sheet = ContactSheet::new("title", 2, 50);
        sheet.section("first", [tile(100, 60, 200), tile(50, 30, 100), tile(50, 30, 60)]);
        let picture = sheet.render();
        assert_eq!(picture.width(), 2 * (50 + MARGIN) + MARGIN);
        let top = MARGIN + TITLE_LINE + LINE;
        let level = |x: u32, y: u32| picture.get_pixel(x, y).0[0];
        assert_eq!(level(MARGIN, top), 200);
        assert_eq!(level(MARGIN + 49, top + 29), 200);
        assert_eq!(level(MARGIN + 50, top + 29), PAPER[0]);
        assert_eq!(level(2 * MARGIN + 50, top), 100);
        assert_eq!(level(MARGIN, top + 30 + LINE), 60);
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
    }
}
