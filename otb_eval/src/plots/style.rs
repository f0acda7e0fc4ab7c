//! How a tracker looks: a colour and a pattern of dashes.
//!
//! The colours start from those of Okabe and Ito, which people who see colours differently tell apart, without
//! yellow, which white paper swallows, and go on with dark ones that differ from them in lightness. The pattern
//! alone tells twelve trackers apart where there is no colour.

/// What the texts of an SVG ask for. The font that the program carries is registered under the same name.
pub(super) const FONTS: &str = "Ubuntu, Segoe UI, Helvetica, Arial, sans-serif";

/// A colour as (red, green, blue).
pub(crate) type Rgb = (u8, u8, u8);

/// The curve that is to be seen first, where one is.
pub(super) const HIGHLIGHT: Rgb = (0xc8, 0x1e, 0x1e);

/// The others beside it, the best ranked darkest; their dashes tell them apart.
pub(super) fn grey(rank: usize, count: usize) -> Rgb {
    let share = rank as f64 / count.saturating_sub(1).max(1) as f64;
    let level = (70.0 + 100.0 * share).round() as u8;
    (level, level, level)
}

/// On white, and on a dark background.
const COLOURS: [(Rgb, Rgb); 12] = [
    ((0x00, 0x72, 0xb2), (0x4f, 0xa8, 0xe8)),
    ((0xd5, 0x5e, 0x00), (0xff, 0x84, 0x33)),
    ((0x00, 0x9e, 0x73), (0x22, 0xc7, 0x97)),
    ((0xcc, 0x79, 0xa7), (0xe8, 0x9c, 0xc6)),
    ((0x1a, 0x1a, 0x1a), (0xf2, 0xf2, 0xf2)),
    ((0xe6, 0x9f, 0x00), (0xff, 0xc2, 0x40)),
    ((0x56, 0xb4, 0xe9), (0x9a, 0xda, 0xff)),
    ((0x88, 0x22, 0x55), (0xd9, 0x5f, 0x98)),
    ((0x8a, 0x8a, 0x1f), (0xc8, 0xc8, 0x55)),
    ((0x33, 0x22, 0x88), (0x97, 0x88, 0xf5)),
    ((0x7d, 0x7d, 0x7d), (0xa6, 0xa6, 0xa6)),
    ((0x7a, 0x4b, 0x21), (0xc9, 0x98, 0x66)),
];

/// Lengths of dash, gap, dash, ... in units of a 720 x 500 plot; none for a solid line.
const DASHES: [&[f64]; 12] = [
    &[],
    &[12.0, 4.0],
    &[3.0, 3.0],
    &[12.0, 4.0, 3.0, 4.0],
    &[24.0, 5.0],
    &[6.0, 6.0],
    &[12.0, 4.0, 3.0, 4.0, 3.0, 4.0],
    &[2.0, 6.0],
    &[24.0, 5.0, 3.0, 5.0],
    &[12.0, 4.0, 12.0, 4.0, 3.0, 4.0],
    &[24.0, 4.0, 7.0, 4.0],
    &[6.0, 3.0, 2.0, 3.0],
];

/// Steps that a further dozen's dashes are ahead of its colours; prime to 12, so that 144 styles differ.
const SHIFT: usize = 5;

/// A tracker's colour and dashes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    light: Rgb,
    dark: Rgb,
    dashes: &'static [f64],
}

impl Style {
    /// The style of the tracker at `place` (0 is the first, a solid line). The first 144 all differ, and the first
    /// twelve differ in colour as well as in dashes.
    pub fn of(place: usize) -> Self {
        let (light, dark) = COLOURS[place % COLOURS.len()];
        let dashes = DASHES[(place + place / COLOURS.len() * SHIFT) % DASHES.len()];
        Self { light, dark, dashes }
    }

    /// Colour on white, (red, green, blue).
    pub fn on_light(&self) -> (u8, u8, u8) {
        self.light
    }

    /// Colour on a dark background, (red, green, blue).
    pub fn on_dark(&self) -> (u8, u8, u8) {
        self.dark
    }

    /// Lengths of dash, gap, dash, ... in units of the plot's size; empty for a solid line.
    pub fn dashes(&self) -> &'static [f64] {
        self.dashes
    }
}

/// The pieces of a broken line that a pattern of dashes leaves. An empty pattern leaves it whole.
pub(super) fn cut(points: &[(f64, f64)], dashes: &[f64]) -> Vec<Vec<(f64, f64)>> {
    if dashes.is_empty() || points.len() < 2 {
        return vec![points.to_vec()];
    }
    let (mut pieces, mut piece) = (Vec::new(), vec![points[0]]);
    let (mut at, mut left) = (0, dashes[0]);
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        let mut length = (to.0 - from.0).hypot(to.1 - from.1);
        while length > left {
            let share = left / length;
            from = (from.0 + (to.0 - from.0) * share, from.1 + (to.1 - from.1) * share);
            length -= left;
            if at % 2 == 0 {
                piece.push(from);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece.push(from);
            }
            at = (at + 1) % dashes.len();
            left = dashes[at];
        }
        left -= length;
        if at % 2 == 0 {
            piece.push(to);
        }
    }
    if piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}
