//! How the camera moved from one frame to the next: a shift, a turn and a change of scale of the whole picture. For each frame:
//!
//! 1. Grey levels, averaged over squares so that at most `WIDEST` columns are left.
//! 2. Points of the frame before that can be found again: in each square of a grid the one whose patch changes most in every
//!    direction (Shi and Tomasi's smaller eigenvalue), if it is not in one of the boxes of objects, which move by themselves.
//! 3. Each is looked for: the patch of least squared difference, first in pictures of a quarter of the size, then ever nearer in
//!    finer ones, and at the end to a part of a pixel by the parabola through the neighbours' differences.
//! 4. Every point and its partner far off give a motion; the one that most points agree with is fitted to all of those by least
//!    squares, twice.
//! 5. Without agreement of `AGREEING` of the points nothing is said: the picture is blurred, black, or another scene.
//!
//! ```
//! use infopart::frame::{FrameView, PixelFormat};
//! use multi_object::camera_motion::CameraWatch;
//!
//! let picture = |shift: usize| -> Vec<u8> {
//!     let level = |x: usize, y: usize| ((x / 7 * 131 + y / 5 * 197) % 17 * 15) as u8;
//!     (0..160 * 120).map(|i| level(i % 160 + shift, i / 160)).collect()
//! };
//! let mut watch = CameraWatch::default();
//! assert!(watch.look(FrameView::new(&picture(0), 160, 120, 160, PixelFormat::Gray)?, &[]).is_none());
//! let motion = watch.look(FrameView::new(&picture(4), 160, 120, 160, PixelFormat::Gray)?, &[]);
//! assert!((motion.unwrap().of_point((80.0, 60.0)).0 - 76.0).abs() < 0.3);
//! # Ok::<(), infopart::frame::FrameError>(())
//! ```

use infopart::{frame::FrameView, geometry::Rect};

/// Columns of the picture that is looked at, at most.
const WIDEST: usize = 320;
/// Side of the grid's squares, in its pixels.
const GRID: usize = 16;
/// A patch reaches so far from its point.
const PATCH: usize = 4;
/// How far points are looked for in the smallest picture, whose pixels are four: 32 pixels.
const SEARCH: i64 = 8;
/// Times that the picture is halved.
const HALVINGS: usize = 2;
/// Smaller eigenvalue, over a patch's pixels, of the squared changes in grey levels from which a point is one.
const TEXTURE: f64 = 16.0;
/// Pixels up to which a point agrees with a motion.
const NEAR: f64 = 1.0;
/// Share of the points that must agree.
const AGREEING: f64 = 0.4;
/// Fewest points that a motion is taken from.
const FEWEST: usize = 8;

/// What the camera did to the picture: a point p goes to `linear` p + `shift`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraMotion {
    /// Two rows of a turn with a change of scale.
    pub linear: [[f64; 2]; 2],
    /// x and y, pixels.
    pub shift: [f64; 2],
}

impl CameraMotion {
    /// The camera stood still.
    pub const NONE: Self = Self { linear: [[1.0, 0.0], [0.0, 1.0]], shift: [0.0, 0.0] };

    /// Where a point goes.
    pub fn of_point(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (dx, dy) = self.of_vector((x, y));
        (dx + self.shift[0], dy + self.shift[1])
    }

    /// What becomes of a direction, of unit length.
    pub fn of_direction(&self, direction: (f64, f64)) -> (f64, f64) {
        let (x, y) = self.of_vector(direction);
        let length = x.hypot(y);
        if length > 0.0 { (x / length, y / length) } else { direction }
    }

    /// Where a box goes: its centre as a point, its sides with the scale. It stays upright.
    pub fn of_box(&self, area: &Rect) -> Rect {
        let ((x, y), scale) = (self.of_point(area.centre()), self.area_scale().sqrt());
        let (w, h) = (scale * area.w, scale * area.h);
        Rect::new(x - w / 2.0, y - h / 2.0, w, h)
    }

    /// What areas are multiplied by.
    pub fn area_scale(&self) -> f64 {
        let [[a, b], [c, d]] = self.linear;
        (a * d - b * c).abs()
    }

    /// The same where the first pixel is `first` instead of 0, as in MOTChallenge files.
    pub fn with_first_pixel(&self, first: f64) -> Self {
        let (x, y) = self.of_vector((first, first));
        Self { shift: [self.shift[0] + first - x, self.shift[1] + first - y], ..*self }
    }

    fn of_vector(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let [[a, b], [c, d]] = self.linear;
        (a * x + b * y, c * x + d * y)
    }

    /// x' = a x - b y + u, y' = b x + a y + v.
    fn similarity([a, b, u, v]: [f64; 4]) -> Self {
        Self { linear: [[a, -b], [b, a]], shift: [u, v] }
    }
}

/// Looks at frames, one after another.
#[derive(Debug, Clone, Default)]
pub struct CameraWatch {
    before: Vec<Picture>,
}

/// Grey levels.
#[derive(Debug, Clone, Default, PartialEq)]
struct Picture {
    width: usize,
    height: usize,
    levels: Vec<f32>,
}

/// Where a point was and is, pixels of the picture that is looked at, from its middle.
type Pair = ((f64, f64), (f64, f64));

impl CameraWatch {
    /// The motion from the frame before to this one; `None` for the first, one of another size, or where it cannot be told.
    /// `objects_in_frame` are boxes, in the frame before, of what moves by itself.
    pub fn look(&mut self, frame: FrameView<'_>, objects_in_frame: &[Rect]) -> Option<CameraMotion> {
        let side = frame.width().div_ceil(WIDEST).max(1);
        let mut now = vec![averaged(frame, side)];
        for _ in 0..HALVINGS {
            now.extend(now.last().map(halved));
        }
        let before = std::mem::replace(&mut self.before, now);
        let now = &self.before;
        if before.first().map(|one| (one.width, one.height)) != Some((now[0].width, now[0].height)) {
            return None;
        }
        let is_free = |x: usize, y: usize| {
            let (x, y) = ((x as f64 + 0.5) * side as f64, (y as f64 + 0.5) * side as f64);
            !objects_in_frame.iter().any(|one| x > one.x && x < one.right() && y > one.y && y < one.bottom())
        };
        let middle = (now[0].width as f64 / 2.0, now[0].height as f64 / 2.0);
        let from_middle = |(x, y): (f64, f64)| (x + 0.5 - middle.0, y + 0.5 - middle.1);
        let pairs: Vec<Pair> = corners(&before[0], is_free)
            .into_iter()
            .filter_map(|(x, y)| {
                let found = found_again(&before, now, (x, y))?;
                Some((from_middle((x as f64, y as f64)), from_middle(found)))
            })
            .collect();
        let motion = agreed(&pairs)?;
        // From the middle of the small picture to the corner of the frame.
        let side = side as f64;
        let (x, y) = motion.of_vector(middle);
        let shift = [side * (motion.shift[0] + middle.0 - x), side * (motion.shift[1] + middle.1 - y)];
        Some(CameraMotion { shift, ..motion })
    }
}

/// Step 1.
fn averaged(frame: FrameView<'_>, side: usize) -> Picture {
    let (width, height) = (frame.width() / side, frame.height() / side);
    let (bytes, offsets) = (frame.format().bytes_per_pixel(), frame.format().rgb_offsets());
    let mut sums = vec![0u32; width];
    let mut levels = Vec::with_capacity(width * height);
    let scale = 1.0 / (3 * side * side) as f32;
    for row in 0..height {
        sums.fill(0);
        for y in row * side..(row + 1) * side {
            let line = &frame.row(y)[..width * side * bytes];
            for (sum, square) in sums.iter_mut().zip(line.chunks_exact(side * bytes)) {
                for pixel in square.chunks_exact(bytes) {
                    *sum += offsets.iter().map(|&channel| u32::from(pixel[channel])).sum::<u32>();
                }
            }
        }
        levels.extend(sums.iter().map(|&sum| sum as f32 * scale));
    }
    Picture { width, height, levels }
}

fn halved(picture: &Picture) -> Picture {
    let (width, height) = (picture.width / 2, picture.height / 2);
    let mut levels = Vec::with_capacity(width * height);
    for y in 0..height {
        let (above, below) = (picture.row(2 * y), picture.row(2 * y + 1));
        levels.extend(
            (0..width).map(|x| (above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1]) / 4.0),
        );
    }
    Picture { width, height, levels }
}

impl Picture {
    fn row(&self, y: usize) -> &[f32] {
        &self.levels[y * self.width..][..self.width]
    }

    /// Whether the patch around a point is inside.
    fn holds(&self, x: i64, y: i64) -> bool {
        let reach = PATCH as i64;
        x >= reach && y >= reach && x + reach < self.width as i64 && y + reach < self.height as i64
    }
}

/// Step 2.
fn corners(picture: &Picture, is_free: impl Fn(usize, usize) -> bool) -> Vec<(usize, usize)> {
    let margin = PATCH + 1;
    let mut found = Vec::new();
    if picture.width <= 2 * margin || picture.height <= 2 * margin {
        return found;
    }
    for top in (margin..picture.height - margin).step_by(GRID) {
        for left in (margin..picture.width - margin).step_by(GRID) {
            let rows = top..(top + GRID).min(picture.height - margin);
            let columns = left..(left + GRID).min(picture.width - margin);
            // Every other pixel: patches are wider than that.
            let points = rows.step_by(2).flat_map(|y| columns.clone().step_by(2).map(move |x| (x, y)));
            let textured = points
                .filter(|&(x, y)| is_free(x, y))
                .map(|(x, y)| ((x, y), texture(picture, x, y)))
                .filter(|one| one.1 >= TEXTURE);
            found.extend(textured.max_by(|a, b| a.1.total_cmp(&b.1)).map(|one| one.0));
        }
    }
    found
}

/// The smaller eigenvalue of the mean of the squared changes over a patch.
fn texture(picture: &Picture, x: usize, y: usize) -> f64 {
    let (mut xx, mut xy, mut yy) = (0.0f32, 0.0f32, 0.0f32);
    for row in y - PATCH..=y + PATCH {
        let (above, here, below) = (picture.row(row - 1), picture.row(row), picture.row(row + 1));
        for column in x - PATCH..=x + PATCH {
            let across = (here[column + 1] - here[column - 1]) / 2.0;
            let down = (below[column] - above[column]) / 2.0;
            xx += across * across;
            xy += across * down;
            yy += down * down;
        }
    }
    let pixels = ((2 * PATCH + 1) * (2 * PATCH + 1)) as f64;
    let (xx, xy, yy) = (f64::from(xx) / pixels, f64::from(xy) / pixels, f64::from(yy) / pixels);
    (xx + yy) / 2.0 - ((xx - yy) / 2.0).hypot(xy)
}

/// Step 3; `None` if it is beyond the border or beyond reach.
fn found_again(before: &[Picture], now: &[Picture], (x, y): (usize, usize)) -> Option<(f64, f64)> {
    let (mut dx, mut dy) = (0i64, 0i64);
    for level in (0..before.len()).rev() {
        let (px, py) = ((x >> level) as i64, (y >> level) as i64);
        if !before[level].holds(px, py) {
            // In a small picture only: it is then looked for nearby.
            continue;
        }
        let reach = if level + 1 == before.len() { SEARCH } else { 2 };
        (dx, dy) = (2 * dx, 2 * dy);
        if level + 1 == before.len() {
            (dx, dy) = (0, 0);
        }
        let mut best = (f32::INFINITY, 0, 0);
        for oy in dy - reach..=dy + reach {
            for ox in dx - reach..=dx + reach {
                let off = difference(&before[level], &now[level], (px, py), (px + ox, py + oy), best.0);
                if off < best.0 {
                    best = (off, ox, oy);
                }
            }
        }
        if best.0 == f32::INFINITY {
            return None;
        }
        (dx, dy) = (best.1, best.2);
    }
    let (px, py) = (x as i64, y as i64);
    let at = |ox: i64, oy: i64| {
        let place = (px + dx + ox, py + dy + oy);
        f64::from(difference(&before[0], &now[0], (px, py), place, f32::INFINITY))
    };
    let here = at(0, 0);
    let part = |low: f64, high: f64| {
        let bend = low + high - 2.0 * here;
        if bend.is_finite() && bend > 0.0 { ((low - high) / (2.0 * bend)).clamp(-0.5, 0.5) } else { 0.0 }
    };
    here.is_finite()
        .then(|| ((px + dx) as f64 + part(at(-1, 0), at(1, 0)), (py + dy) as f64 + part(at(0, -1), at(0, 1))))
}

/// Sum of squared differences of two patches; infinite beyond the border, or as soon as it is above `most`.
fn difference(a: &Picture, b: &Picture, from: (i64, i64), to: (i64, i64), most: f32) -> f32 {
    if !b.holds(to.0, to.1) {
        return f32::INFINITY;
    }
    let mut sum = 0.0;
    for row in 0..=2 * PATCH as i64 {
        let reach = PATCH as i64;
        let of = |picture: &Picture, (x, y): (i64, i64)| {
            (y + row - reach) as usize * picture.width + (x - reach) as usize
        };
        let (one, other) = (&a.levels[of(a, from)..], &b.levels[of(b, to)..]);
        sum += (one[..2 * PATCH + 1].iter().zip(&other[..2 * PATCH + 1]))
            .map(|(one, other)| (one - other) * (one - other))
            .sum::<f32>();
        if sum > most {
            return f32::INFINITY;
        }
    }
    sum
}

/// Steps 4 and 5.
fn agreed(pairs: &[Pair]) -> Option<CameraMotion> {
    if pairs.len() < FEWEST {
        return None;
    }
    let agreeing = |motion: &CameraMotion| -> Vec<Pair> {
        let is_near = |(from, to): &&Pair| {
            let (x, y) = motion.of_point(*from);
            (x - to.0).hypot(y - to.1) <= NEAR
        };
        pairs.iter().filter(is_near).copied().collect()
    };
    let guesses = (0..pairs.len()).flat_map(|one| {
        // Partners a half and a third of all points on, which are far off, as points come row by row.
        [pairs.len() / 2, pairs.len() / 3].map(|on| fitted(&[pairs[one], pairs[(one + on) % pairs.len()]]))
    });
    let best = guesses.flatten().map(|motion| agreeing(&motion)).max_by_key(Vec::len)?;
    let motion = fitted(&best)?;
    let agree = agreeing(&motion);
    let is_enough = agree.len() >= FEWEST && agree.len() as f64 >= AGREEING * pairs.len() as f64;
    fitted(&agree).filter(|_| is_enough)
}

/// The turn, scale and shift of least squared error; `None` where all points are one.
fn fitted(pairs: &[Pair]) -> Option<CameraMotion> {
    let count = pairs.len() as f64;
    let mean = |of: &dyn Fn(&Pair) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&|pair| pair.0.0), mean(&|pair| pair.0.1));
    let (to_x, to_y) = (mean(&|pair| pair.1.0), mean(&|pair| pair.1.1));
    let (mut along, mut across, mut spread) = (0.0, 0.0, 0.0);
    for &((px, py), (qx, qy)) in pairs {
        let ((px, py), (qx, qy)) = ((px - x, py - y), (qx - to_x, qy - to_y));
        along += px * qx + py * qy;
        across += px * qy - py * qx;
        spread += px * px + py * py;
    }
    if spread.is_nan() || spread <= 1.0 {
        return None;
    }
    let (a, b) = (along / spread, across / spread);
    Some(CameraMotion::similarity([a, b, to_x - a * x + b * y, to_y - b * x - a * y]))
}

#[cfg(test)]
mod tests {
    use infopart::frame::PixelFormat;

    use super::*;

    /// Random levels on a lattice of that side, smooth between its points, so that it can be moved by parts of a pixel.
    fn noise(x: f64, y: f64, side: f64) -> f64 {
        let (x, y) = (x / side + 100.0, y / side + 100.0);
        let level = |i: f64, j: f64| {
            let mixed = ((i as u64) << 32 | j as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            ((mixed ^ mixed >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40) as f64 / (1u64 << 24) as f64
        };
        let ease = |t: f64| t * t * (3.0 - 2.0 * t);
        let ((i, j), (u, v)) = ((x.floor(), y.floor()), (ease(x.fract()), ease(y.fract())));
        let above = (1.0 - u) * level(i, j) + u * level(i + 1.0, j);
        let below = (1.0 - u) * level(i, j + 1.0) + u * level(i + 1.0, j + 1.0);
        (1.0 - v) * above + v * below
    }

    fn texture_at(x: f64, y: f64) -> f64 {
        120.0 * noise(x, y, 6.0) + 135.0 * noise(x + 7.0, y + 3.0, 23.0)
    }

    /// What a camera shows that has moved so.
    fn picture(motion: &CameraMotion, object: Option<Rect>) -> Vec<u8> {
        let scale = motion.area_scale();
        let [[a, b], [c, d]] = motion.linear;
        (0..240 * 180)
            .map(|i| {
                let (x, y) = ((i % 240) as f64 + 0.5, (i / 240) as f64 + 0.5);
                if object.is_some_and(|one| x > one.x && x < one.right() && y > one.y && y < one.bottom()) {
                    return texture_at(3.0 * x - 1.7 * y, y) as u8;
                }
                let (x, y) = (x - motion.shift[0], y - motion.shift[1]);
                texture_at((d * x - b * y) / scale, (a * y - c * x) / scale).round() as u8
            })
            .collect()
    }

    fn view(pixels: &[u8]) -> FrameView<'_> {
        FrameView::new(pixels, 240, 180, 240, PixelFormat::Gray).unwrap()
    }

    fn seen(
        motion: &CameraMotion,
        object: Option<Rect>,
        moved: Option<Rect>,
        known: &[Rect],
    ) -> CameraMotion {
        let mut watch = CameraWatch::default();
        assert_eq!(watch.look(view(&picture(&CameraMotion::NONE, object)), &[]), None);
        watch.look(view(&picture(motion, moved)), known).unwrap()
    }

    fn assert_alike(found: &CameraMotion, true_motion: &CameraMotion) {
        for corner in [(0.0, 0.0), (240.0, 0.0), (0.0, 180.0), (240.0, 180.0)] {
            let ((x, y), (to_x, to_y)) = (found.of_point(corner), true_motion.of_point(corner));
            assert!((x - to_x).hypot(y - to_y) < 0.3, "{corner:?}: {found:?} instead of {true_motion:?}");
        }
    }

    #[test]
    fn a_pan_a_turn_and_a_zoom_are_told_to_a_third_of_a_pixel() {
        let turn = |angle: f64, scale: f64, shift| {
            let (sine, cosine) = angle.sin_cos();
            CameraMotion { linear: [[scale * cosine, -scale * sine], [scale * sine, scale * cosine]], shift }
        };
        for motion in [
            CameraMotion::NONE,
            turn(0.0, 1.0, [9.3, -4.6]),
            turn(0.0, 1.0, [-25.0, 14.0]),
            turn(0.03, 1.0, [4.0, -2.0]),
            turn(-0.01, 1.04, [-6.0, -5.0]),
        ] {
            assert_alike(&seen(&motion, None, None, &[]), &motion);
        }
    }

    #[test]
    fn a_large_object_that_goes_its_own_way_is_no_camera() {
        let motion = CameraMotion { shift: [3.0, 1.0], ..CameraMotion::NONE };
        let object = Rect::new(40.0, 20.0, 90.0, 140.0);
        let moved = object.translated(-12.0, 0.0);
        assert_alike(&seen(&motion, Some(object), Some(moved), &[]), &motion);
        assert_alike(&seen(&motion, Some(object), Some(moved), &[object]), &motion);
    }

    #[test]
    fn nothing_is_said_of_blank_pictures_other_scenes_and_other_sizes() {
        let blank = vec![90u8; 240 * 180];
        let mut watch = CameraWatch::default();
        assert_eq!(watch.look(view(&blank), &[]), None);
        assert_eq!(watch.look(view(&blank), &[]), None);
        let noise: Vec<u8> = (0..240 * 180u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        assert_eq!(watch.look(view(&picture(&CameraMotion::NONE, None)), &[]), None);
        assert_eq!(watch.look(view(&noise), &[]), None);
        let small = FrameView::new(&blank, 5, 4, 5, PixelFormat::Gray).unwrap();
        assert_eq!(watch.look(small, &[]), None);
        assert_eq!(watch.look(small, &[]), None);
    }

    #[test]
    fn boxes_directions_and_files_follow() {
        let quarter = CameraMotion { linear: [[0.0, -2.0], [2.0, 0.0]], shift: [10.0, 0.0] };
        assert_eq!(quarter.of_point((3.0, 1.0)), (8.0, 6.0));
        assert_eq!(quarter.of_direction((1.0, 0.0)), (0.0, 1.0));
        assert_eq!(quarter.of_box(&Rect::new(2.0, 0.0, 2.0, 2.0)), Rect::new(6.0, 4.0, 4.0, 4.0));
        // The point (3, 1) is (4, 2) in a file.
        assert_eq!(quarter.with_first_pixel(1.0).of_point((4.0, 2.0)), (9.0, 7.0));
    }
}
