//! Which cells of the foreground belong to which track, and what is left.
//!
//! Steps:
//! 1. Cut the foreground into connected regions.
//! 2. Give each cell to the nearest track, by max(|dx| / half width, |dy| / half height) from the centre of its predicted box, if
//!    that is within [`REACH`]; established tracks come before others.
//! 3. A region in which several tracks have a share of their usual cells is shared by them. (That of an established track is not
//!    shared by one that is none yet.)
//! 4. A region that one track has alone is wholly that track's, if it takes all.
//! 5. Join the cells that are left into pieces.
//! 6. A small piece near a track is a part of it: the track gets it, unless it would grow too much at once; then nobody does.

use image::GrayImage;
use infopart::{
    background::{FOREGROUND, Run, runs},
    geometry::Rect,
};

use super::extent::{Segment, count, extent};

/// How far beyond its predicted box a track claims cells, in halves of the box.
const REACH: f64 = 1.3;
/// Share of a track's usual cells that it must have in a region to share it.
const SHARE: f64 = 0.15;
/// Share of a track's usual cells up to which a piece near it is small.
const SMALL: f64 = 0.5;
/// Distance from a track's box up to which a piece is near, in sides of the box.
const NEAR: f64 = 0.25;
/// How much wider or higher than expected a track may get by a piece.
const GROWTH: f64 = 1.4;
/// Share of the cells at each side of an object that may be a stray limb or speck.
pub(super) const STRAY: f64 = 0.01;

/// What a track has of the foreground.
#[derive(Debug, Clone, Default)]
pub(super) struct Claim {
    pub segments: Vec<Segment>,
    /// Cells of the regions in which it is the only established track.
    pub region_cells: usize,
    /// Whether another track has cells of one of its regions.
    pub is_shared: bool,
}

/// Foreground that no track claims.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub segments: Vec<Segment>,
    pub cells: usize,
    /// The smallest box that holds it.
    pub box_in_cells: Rect,
}

/// One track, for claiming.
#[derive(Debug, Clone, Copy)]
pub(super) struct Claimer {
    /// Where it is expected.
    pub box_in_cells: Rect,
    /// Cells that it usually has.
    pub usual_cells: f64,
    /// Whether it comes before those that are not.
    pub is_established: bool,
    /// Whether a region that it has alone is its own, however far it goes.
    pub takes_all: bool,
}

/// How many cells a track has in a region.
#[derive(Debug, Clone, Copy)]
struct Part {
    region: usize,
    track: usize,
    cells: usize,
}

/// Steps 1 to 6.
pub(super) fn claim(mask: &GrayImage, claimers: &[Claimer]) -> (Vec<Claim>, Vec<Piece>) {
    let regions = runs(mask, FOREGROUND, true);
    let mut claims = vec![Claim::default(); claimers.len()];
    let mut parts: Vec<Part> = Vec::new();
    let mut left: Vec<Segment> = Vec::new();
    for run in &regions {
        for (owner, segment) in by_owner(run, claimers) {
            let Some(track) = owner else {
                left.push(segment);
                continue;
            };
            claims[track].segments.push(segment);
            match parts.iter_mut().find(|part| (part.region, part.track) == (run.region, track)) {
                Some(part) => part.cells += segment.cells(),
                None => parts.push(Part { region: run.region, track, cells: segment.cells() }),
            }
        }
    }
    parts.retain(|part| part.cells as f64 >= SHARE * claimers[part.track].usual_cells);
    share(&mut claims, &parts, claimers);
    take_all(&mut claims, &parts, claimers, &mut left);
    for run in &regions {
        if let Some(track) = only(parts.iter().filter(|part| claimers[part.track].is_established), run.region)
        {
            claims[track].region_cells += (run.end - run.start) as usize;
        }
    }
    let mut pieces = pieces(&left, mask);
    pieces.retain(|piece| !give_near(piece, &mut claims, &parts, claimers));
    (claims, pieces)
}

/// The foreground as pieces, whoever claims it.
pub(super) fn all_pieces(mask: &GrayImage) -> Vec<Piece> {
    claim(mask, &[]).1
}

/// Step 2: a run cut where its nearest track changes.
fn by_owner(run: &Run, claimers: &[Claimer]) -> Vec<(Option<usize>, Segment)> {
    let whole = Segment { row: run.row, start: run.start, end: run.end, region: run.region };
    let y = f64::from(run.row) + 0.5;
    // Track, centre, half width and vertical distance of those that reach this row.
    let near: Vec<(usize, f64, f64, f64)> = (claimers.iter().enumerate())
        .filter_map(|(index, claimer)| {
            let Rect { w, h, .. } = claimer.box_in_cells;
            let (cx, cy) = claimer.box_in_cells.centre();
            let down = (y - cy).abs() / (h / 2.0);
            let reach = REACH * w / 2.0;
            let meets = f64::from(run.end) > cx - reach && f64::from(run.start) < cx + reach;
            (down <= REACH && meets).then_some((index, cx, w / 2.0, down))
        })
        .collect();
    if near.is_empty() {
        return vec![(None, whole)];
    }
    let mut cut: Vec<(Option<usize>, Segment)> = Vec::new();
    for cell in run.start..run.end {
        let x = f64::from(cell) + 0.5;
        let owner = (near.iter())
            .map(|&(index, cx, half, down)| (index, ((x - cx).abs() / half).max(down)))
            .filter(|&(_, distance)| distance <= REACH)
            .min_by(|a, b| {
                let rank = |index: usize| !claimers[index].is_established;
                rank(a.0).cmp(&rank(b.0)).then(a.1.total_cmp(&b.1))
            })
            .map(|(index, _)| index);
        match cut.last_mut() {
            Some((last, segment)) if *last == owner => segment.end = cell + 1,
            _ => cut.push((owner, Segment { start: cell, end: cell + 1, ..whole })),
        }
    }
    cut
}

/// Step 3.
fn share(claims: &mut [Claim], parts: &[Part], claimers: &[Claimer]) {
    for part in parts {
        claims[part.track].is_shared |= parts.iter().any(|other| {
            let counts = claimers[other.track].is_established || !claimers[part.track].is_established;
            other.region == part.region && other.track != part.track && counts
        });
    }
}

/// The track of the only part in `region`.
fn only<'a>(parts: impl Iterator<Item = &'a Part>, region: usize) -> Option<usize> {
    let mut of_region = parts.filter(|part| part.region == region);
    let first = of_region.next()?;
    of_region.next().is_none().then_some(first.track)
}

/// Step 4.
fn take_all(claims: &mut [Claim], parts: &[Part], claimers: &[Claimer], left: &mut Vec<Segment>) {
    let taker = |region: usize| {
        let mut established = parts.iter().filter(|part| claimers[part.track].is_established).peekable();
        let has_established = established.clone().any(|part| part.region == region);
        let found =
            if has_established { only(established.by_ref(), region) } else { only(parts.iter(), region) };
        found.filter(|&track| claimers[track].takes_all)
    };
    for (track, claim) in claims.iter_mut().enumerate() {
        let is_taken = |segment: &Segment| taker(segment.region).is_some_and(|one| one != track);
        let segments = std::mem::take(&mut claim.segments);
        let (taken, kept): (Vec<Segment>, Vec<Segment>) = segments.into_iter().partition(is_taken);
        claim.segments = kept;
        left.extend(taken);
    }
    left.retain(|segment| match taker(segment.region) {
        Some(track) => {
            claims[track].segments.push(*segment);
            false
        }
        None => true,
    });
}

/// Step 5. A piece keeps the region that it was cut from.
fn pieces(left: &[Segment], mask: &GrayImage) -> Vec<Piece> {
    let mut picture = GrayImage::new(mask.width(), mask.height());
    for segment in left {
        (*picture)[segment.range(mask.width())].fill(FOREGROUND);
    }
    let mut ordered = left.to_vec();
    ordered.sort_unstable_by_key(|segment| (segment.row, segment.start));
    let region_at = |row: u32, x: u32| {
        let place = ordered.partition_point(|segment| (segment.row, segment.end) <= (row, x));
        ordered.get(place).map_or(usize::MAX, |segment| segment.region)
    };
    let runs = runs(&picture, FOREGROUND, true);
    let mut place_of = vec![usize::MAX; runs.len()];
    let mut pieces: Vec<Vec<Segment>> = Vec::new();
    for run in &runs {
        if place_of[run.region] == usize::MAX {
            place_of[run.region] = pieces.len();
            pieces.push(Vec::new());
        }
        let region = region_at(run.row, run.start);
        pieces[place_of[run.region]].push(Segment { row: run.row, start: run.start, end: run.end, region });
    }
    let piece = |segments: Vec<Segment>| {
        let box_in_cells = extent(&segments, 0.0)?;
        Some(Piece { cells: count(&segments), segments, box_in_cells })
    };
    pieces.into_iter().filter_map(piece).collect()
}

/// Step 6; whether the piece was a part of a track.
fn give_near(piece: &Piece, claims: &mut [Claim], parts: &[Part], claimers: &[Claimer]) -> bool {
    let region = piece.segments[0].region;
    let may_have = |track: usize| {
        let touches = || parts.iter().any(|part| (part.region, part.track) == (region, track));
        !claims[track].segments.is_empty()
            && (claimers[track].is_established || touches())
            && piece.cells as f64 <= SMALL * claimers[track].usual_cells
    };
    let nearest = (0..claimers.len())
        .filter(|&track| may_have(track))
        .map(|track| {
            let area = claimers[track].box_in_cells;
            (track, gap(&piece.box_in_cells, &area) / area.area().sqrt())
        })
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((track, _)) = nearest.filter(|&(_, distance)| distance <= NEAR) else { return false };
    let expected = claimers[track].box_in_cells;
    let grown = extent(&claims[track].segments, STRAY)
        .map_or(piece.box_in_cells, |known| known.union(&piece.box_in_cells));
    let fits = grown.w <= GROWTH * expected.w && grown.h <= GROWTH * expected.h;
    if fits && !claims[track].is_shared {
        // No part of the track's other regions: names of runs are smaller.
        let own = usize::MAX - piece.segments[0].range(1 << 16).start;
        claims[track].segments.extend(piece.segments.iter().map(|one| Segment { region: own, ..*one }));
    }
    true
}

/// The larger of the gaps between two boxes across and down; 0 if they meet.
pub(super) fn gap(a: &Rect, b: &Rect) -> f64 {
    let across = a.x.max(b.x) - a.right().min(b.right());
    let down = a.y.max(b.y) - a.bottom().min(b.bottom());
    across.max(down).max(0.0)
}

#[cfg(test)]
mod tests {
    use image::Luma;

    use super::*;

    fn mask(boxes: &[Rect]) -> GrayImage {
        GrayImage::from_fn(60, 40, |x, y| {
            let inside = |b: &&Rect| {
                (b.x..b.right()).contains(&f64::from(x)) && (b.y..b.bottom()).contains(&f64::from(y))
            };
            Luma([if boxes.iter().find(inside).is_some() { FOREGROUND } else { 0 }])
        })
    }

    fn claimer(box_in_cells: Rect) -> Claimer {
        let usual_cells = box_in_cells.area();
        Claimer { box_in_cells, usual_cells, is_established: true, takes_all: false }
    }

    const A: Rect = Rect::new(10.0, 10.0, 8.0, 20.0);
    const B: Rect = Rect::new(18.0, 10.0, 8.0, 20.0);

    #[test]
    fn each_of_two_who_touch_gets_its_own_cells_and_the_region_is_shared() {
        let (claims, pieces) = claim(&mask(&[A, B]), &[claimer(A), claimer(B)]);
        for (claim, own) in claims.iter().zip([A, B]) {
            assert_eq!(extent(&claim.segments, 0.0), Some(own));
            assert!(claim.is_shared);
        }
        assert!(pieces.is_empty());
        let (claims, _) = claim(&mask(&[A]), &[claimer(A), claimer(B)]);
        assert!(!claims[0].is_shared && claims[0].region_cells == 160);
    }

    #[test]
    fn a_newcomer_beyond_reach_is_a_piece_and_a_hand_is_not() {
        let far = Rect::new(40.0, 10.0, 8.0, 20.0);
        let (claims, pieces) = claim(&mask(&[A, far]), &[claimer(A)]);
        assert_eq!((pieces.len(), pieces[0].cells, pieces[0].box_in_cells), (1, 160, far));
        assert_eq!(count(&claims[0].segments), 160);
        // A hand held out, near and small: the track's, as it does not make it much wider.
        let hand = Rect::new(20.0, 14.0, 1.0, 4.0);
        let (claims, pieces) = claim(&mask(&[A, hand]), &[claimer(A)]);
        assert!(pieces.is_empty());
        assert_eq!(count(&claims[0].segments), 164);
    }

    #[test]
    fn alone_in_its_region_a_track_may_take_all_of_it_but_not_from_an_established_one() {
        let long = Rect::new(10.0, 10.0, 40.0, 20.0);
        let all = Claimer { takes_all: true, ..claimer(A) };
        assert_eq!(count(&claim(&mask(&[long]), &[all]).0[0].segments), 800);
        let (claims, pieces) = claim(&mask(&[long]), &[claimer(A)]);
        assert!(count(&claims[0].segments) < 200 && pieces.len() == 1);
        // One that is not established yet loses its cells to the one that is.
        let new = Claimer { is_established: false, ..claimer(Rect::new(35.0, 10.0, 8.0, 20.0)) };
        let (claims, _) = claim(&mask(&[long]), &[all, new]);
        assert_eq!((count(&claims[0].segments), count(&claims[1].segments)), (800, 0));
        assert!(claims[1].is_shared && !claims[0].is_shared);
    }
}
