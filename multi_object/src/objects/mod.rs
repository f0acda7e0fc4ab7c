//! Tracks of whatever moves before a static camera: by place, size and colour, in foreground that two may share. In each frame:
//!
//! 1. Foreground, as cells (`foreground`). Where an established object stands the background is not learnt, so that one who
//!    stops is not swallowed; what rests and never moved, as the ghost of someone who went away, is taken over at once.
//! 2. Predict every track.
//! 3. Cells go to the tracks whose predicted boxes they are near (`claims`); a track parts with what is another object (`track`).
//! 4. A track that has its region alone is where its cells are, and its size follows theirs slowly. One that shares it, or
//!    seems to have another size for once, or whose region goes on beyond its reach, as where others whom no track has come near,
//!    keeps its size and is where it fits best (`fit`).
//! 5. Pieces that are left, near each other, are objects. A track that was not seen takes the one that costs least, by place,
//!    size and colours, within a gate in sides of its box.
//! 6. Delete tracks that were not seen for `max_age` frames (those never established: a few), that left the picture, or that
//!    coincide with an older one. Start a track from each object that is left.
//! 7. A track is established once it was seen alone `min_hits` times and has moved. One that leaps is another from then on.
//!
//! ```
//! use infopart::frame::{FrameView, PixelFormat};
//! use multi_object::{motion::ConstantVelocity, objects::{ObjectParameters, ObjectTracker}};
//!
//! let mut tracker = ObjectTracker::<ConstantVelocity, 4>::new(ObjectParameters::default().check()?);
//! let picture = |left: usize| -> Vec<u8> {
//!     let inside = |i: usize| (left..left + 24).contains(&(i % 160)) && (40..80).contains(&(i / 160));
//!     (0..160 * 120).map(|i| if inside(i) { 220 } else { 60 }).collect()
//! };
//! for _ in 0..20 {
//!     tracker.learn(FrameView::new(&picture(160), 160, 120, 160, PixelFormat::Gray)?)?;
//! }
//! let mut established = 0;
//! for frame in 0..20 {
//!     let pixels = picture(10 + 4 * frame);
//!     let states = tracker.update(FrameView::new(&pixels, 160, 120, 160, PixelFormat::Gray)?)?;
//!     established = states.iter().filter(|state| state.is_established).count();
//! }
//! assert_eq!(established, 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::time::Duration;

use image::GrayImage;
use infopart::{background::Learning, frame::FrameView, geometry::Rect};

use crate::{
    appearance::{Appearance, similarity},
    assignment::Assigner,
    grid::Grid,
    motion::CentreModel,
    tracking::{PredictionClock, SceneWarning, TrackState, WarningWatch},
};

mod claims;
mod extent;
mod fit;
mod foreground;
mod parameters;
#[cfg(test)]
mod tests;
mod track;

use claims::{Claim, Claimer, Piece, STRAY};
use extent::{count, extent};
use foreground::{CellMask, Foreground};
pub use parameters::{CheckedObjectParameters, ObjectError, ObjectParameters};
use track::Track;

/// Frames without a sight for which a track still claims cells.
const CLAIMS_FOR: u32 = 3;
/// Sights below which a track is young: its size follows fast, and it takes all of a region that it has alone.
const YOUNG: u32 = 8;
/// Share by which the size follows a sight.
const FOLLOWS: f64 = 0.1;
/// The same at the picture's border, where an object comes in.
const FOLLOWS_AT_BORDER: f64 = 0.5;
/// The same where the sight seems to be of another size.
const FOLLOWS_ODD: f64 = 0.05;
/// Share of the expected sides from which to whose inverse a sight is of the same size; of a track of few sights.
const ALIKE: (f64, f64) = (0.6, 0.5);
/// Sights up to which they are few.
const FEW: u32 = 10;
/// Frames in a row after which another size is believed.
const ODD_FOR: u32 = 8;
/// Frames in a row after which a track takes all of a region that it has alone, if that is larger by this.
const OUTGROWN: (u32, f64) = (5, 1.5);
/// Share of its usual cells by which a region that a track has alone may go on beyond its claim, for the claim to be its outline.
const CUT: f64 = 0.2;
/// Share of its usual cells that a track must have for a sight.
const FEWEST: f64 = 0.3;
/// Share of its usual foreground that the box of a track must hold where it shares a region.
const FILLED: f64 = 0.4;
/// Distance up to which pieces are one object, in longer sides of the smaller.
const JOINED: f64 = 0.4;
/// Share of the smallest object below which a piece is not looked at.
const SPECK: f64 = 0.1;
/// Gate for a track that was not seen, in sides of its box: at once, more for each frame, and at most.
const GATE: (f64, f64, f64) = (0.6, 0.05, 1.4);
/// Factor of the areas beyond which an object is another, as a logarithm: four.
const OTHER_SIZE: f64 = 1.4;
/// 1 - Bhattacharyya's coefficient of the colours beyond which an object is another.
const OTHER_LOOK: f64 = 0.7;
/// What leaving a track and an object alone costs; each of the three costs is at most 1.
const ALONE: f64 = 1.5;
/// Frames without a sight after which a track that was never established is deleted.
const PATIENCE: u32 = 3;
/// Share of the smaller box that two tracks that coincide have in common, and frames for which they may.
const DOUBLED: (f64, u32) = (0.7, 12);
/// Frames of rest after which what never moved is background.
const ABSORBED: u32 = 25;

/// The tracker, for objects whose centres move by the model `D`.
#[derive(Debug)]
pub struct ObjectTracker<D, const N: usize> {
    parameters: CheckedObjectParameters,
    foreground: Foreground,
    guide: Vec<Learning>,
    tracks: Vec<Track<D, N>>,
    started: u64,
    states: Vec<TrackState>,
    detections: Vec<Rect>,
    assigner: Assigner,
    watch: WarningWatch,
    clock: PredictionClock,
}

/// An object that no track claims.
struct Found {
    piece: Piece,
    seen: Rect,
    look: Appearance,
}

impl<D: CentreModel<N>, const N: usize> ObjectTracker<D, N> {
    /// A tracker that has seen nothing.
    pub fn new(parameters: CheckedObjectParameters) -> Self {
        Self {
            foreground: Foreground::new(&parameters),
            parameters,
            guide: Vec::new(),
            tracks: Vec::new(),
            started: 0,
            states: Vec::new(),
            detections: Vec::new(),
            assigner: Assigner::default(),
            watch: WarningWatch::default(),
            clock: PredictionClock::default(),
        }
    }

    /// Only learns the background from a frame: those of a video's beginning, learnt before the first is tracked, leave no
    /// ghost of who stood there.
    ///
    /// # Errors
    /// [`ObjectError`] if the frame has another size than the first, or is too large.
    pub fn learn(&mut self, frame: FrameView<'_>) -> Result<(), ObjectError> {
        self.foreground.apply(frame, &[])?;
        Ok(())
    }

    /// Steps 1 to 7 for the next frame; gives what became of each track, the oldest first.
    ///
    /// # Errors
    /// [`ObjectError`] if the frame has another size than the first, or is too large.
    pub fn update(&mut self, frame: FrameView<'_>) -> Result<&[TrackState], ObjectError> {
        let share = self.foreground.apply(frame, &self.guide)?;
        self.watch.look(share);
        self.predict();
        let mask = self.foreground.mask().clone();
        let left = self.claim(frame, &mask);
        let found = self.objects(left, &mask, frame);
        let found = self.find_again(found);
        self.delete(frame);
        self.start(found)?;
        self.settle();
        self.guide_learning(&mask);
        self.states.clear();
        self.states.extend(self.tracks.iter().map(|track| TrackState {
            identity: track.identity,
            predicted_in_frame: track.predicted,
            detected_in_frame: track.detected,
            box_in_frame: track.tracked_box(),
            is_established: track.is_established,
        }));
        Ok(&self.states)
    }

    /// The boxes of the last frame's foreground, by themselves: what a detector would give, for other trackers.
    pub fn detections(&mut self) -> &[Rect] {
        let mask = self.foreground.mask();
        let objects = self.group(claims::all_pieces(&mask.cells));
        self.detections.clear();
        self.detections.extend(objects.iter().map(|piece| mask.to_frame(&piece.box_in_cells)));
        &self.detections
    }

    /// A warning, once, if too much of the picture is foreground for long.
    pub fn warning(&mut self) -> Option<SceneWarning> {
        self.watch.take()
    }

    /// Mean time of predicting one track by one frame; `None` before the first.
    pub fn mean_prediction_time(&self) -> Option<Duration> {
        self.clock.mean()
    }

    /// Step 2.
    fn predict(&mut self) {
        self.clock.predict(&mut self.tracks, |track| track.filter.predict());
        for track in &mut self.tracks {
            track.predicted = Some(track.tracked_box());
            track.detected = None;
            track.invisible += 1;
            track.segments.clear();
        }
    }

    /// Steps 3 and 4; gives the pieces that are left.
    fn claim(&mut self, frame: FrameView<'_>, mask: &CellMask) -> Vec<Piece> {
        let near_border = |area: &Rect| {
            let margin = 2.0 * mask.side as f64;
            let (width, height) = (frame.width() as f64, frame.height() as f64);
            area.x < margin
                || area.y < margin
                || area.right() > width - margin
                || area.bottom() > height - margin
        };
        let (mut active, mut claimers, mut at_border) = (Vec::new(), Vec::new(), Vec::new());
        for (index, track) in self.tracks.iter().enumerate().filter(|(_, one)| one.invisible <= CLAIMS_FOR) {
            let area = track.tracked_box();
            active.push(index);
            at_border.push(near_border(&area));
            claimers.push(Claimer {
                box_in_cells: mask.to_cells(&area),
                usual_cells: track.usual_cells,
                is_established: track.is_established,
                takes_all: near_border(&area) || track.sights < YOUNG || track.outgrown >= OUTGROWN.0,
            });
        }
        let (mut claims, mut pieces) = claims::claim(&mask.cells, &claimers);
        let mut parted = GrayImage::new(mask.cells.width(), mask.cells.height());
        let mut boxes: Vec<Rect> = claimers.iter().map(|claimer| claimer.box_in_cells).collect();
        for (place, &index) in active.iter().enumerate() {
            let claim = &mut claims[place];
            if !claim.is_shared {
                self.tracks[index].split(&mut claim.segments, &claimers[place].box_in_cells, &mut parted);
            }
            let sight = Sight {
                frame,
                mask,
                at_border: at_border[place],
                claimer: &claimers[place],
                boxes: &boxes,
                place,
            };
            if let Some(seen) = sight.take(&mut self.tracks[index], claim) {
                boxes[place] = seen;
            }
        }
        pieces.extend(claims::all_pieces(&parted));
        pieces
    }

    /// Pieces near each other are one object; small ones are none.
    fn group(&self, mut pieces: Vec<Piece>) -> Vec<Piece> {
        let cell = (self.foreground.mask().side as f64).powi(2);
        let least = self.parameters.min_area() as f64 / cell;
        pieces.retain(|piece| piece.cells as f64 >= SPECK * least);
        let are_near = |a: &Rect, b: &Rect| claims::gap(a, b) <= JOINED * a.w.max(a.h).min(b.w.max(b.h));
        let mut first = 0;
        while first < pieces.len() {
            let area = pieces[first].box_in_cells;
            let near = (first + 1..pieces.len()).find(|&other| are_near(&area, &pieces[other].box_in_cells));
            match near {
                Some(other) => {
                    let other = pieces.swap_remove(other);
                    let one = &mut pieces[first];
                    one.box_in_cells = one.box_in_cells.union(&other.box_in_cells);
                    one.cells += other.cells;
                    one.segments.extend(other.segments);
                    // The larger one may be near to those before it.
                    first = 0;
                }
                None => first += 1,
            }
        }
        pieces.retain(|piece| piece.cells as f64 >= least);
        pieces
    }

    fn objects(&self, pieces: Vec<Piece>, mask: &CellMask, frame: FrameView<'_>) -> Vec<Found> {
        let found = self.group(pieces).into_iter().map(|piece| {
            let area = extent(&piece.segments, STRAY).unwrap_or(piece.box_in_cells);
            let seen = mask.to_frame(&area);
            Found { piece, seen, look: Appearance::of(frame, &seen) }
        });
        found.collect()
    }

    /// Step 5; gives the objects that are left.
    fn find_again(&mut self, found: Vec<Found>) -> Vec<Found> {
        let unseen: Vec<usize> =
            (0..self.tracks.len()).filter(|&i| self.tracks[i].detected.is_none()).collect();
        let costs = Grid::from_fn(unseen.len(), found.len(), |row, column| {
            cost_of(&self.tracks[unseen[row]], &found[column])
        });
        let mut is_left = vec![true; found.len()];
        for &(row, column) in self.assigner.solve_with_unassigned(&costs, ALONE) {
            let track = &mut self.tracks[unseen[row]];
            track.see(found[column].seen, FOLLOWS, MOST_GROWTH);
            track.segments.clone_from(&found[column].piece.segments);
            is_left[column] = false;
        }
        found.into_iter().zip(is_left).filter_map(|(one, left)| left.then_some(one)).collect()
    }

    /// Step 6, its first half.
    fn delete(&mut self, frame: FrameView<'_>) {
        for index in 0..self.tracks.len() {
            let area = self.tracks[index].tracked_box();
            let coincides = self.tracks[..index].iter().any(|older| {
                let other = older.tracked_box();
                older.detected.is_some()
                    && area.intersection_area(&other) > DOUBLED.0 * area.area().min(other.area())
            });
            let track = &mut self.tracks[index];
            track.doubled = if coincides { track.doubled + 1 } else { 0 };
        }
        let (width, height) = (frame.width() as f64, frame.height() as f64);
        let max_age = self.parameters.max_age;
        self.tracks.retain(|track| {
            let (x, y) = track.tracked_box().centre();
            let inside = x > 0.0 && y > 0.0 && x < width && y < height;
            let patience = if track.is_established { max_age } else { PATIENCE.min(max_age) };
            inside && track.invisible <= patience && track.doubled < DOUBLED.1
        });
    }

    /// Step 6, its second half.
    fn start(&mut self, found: Vec<Found>) -> Result<(), ObjectError> {
        let filter = (self.parameters.filter, self.parameters.filter_options);
        for Found { piece, seen, look } in found {
            self.started += 1;
            self.tracks.push(Track::new(self.started, seen, piece.segments, look, filter)?);
        }
        Ok(())
    }

    /// Step 7.
    fn settle(&mut self) {
        let min_hits = self.parameters.min_hits;
        for track in &mut self.tracks {
            track.is_established |= track.sights_alone >= min_hits && track.has_moved;
            if track.detected.is_none() {
                continue;
            }
            if track.has_leapt() {
                self.started += 1;
                track.identity = self.started;
                track.predicted = None;
            }
        }
    }

    /// Step 1 of the next frame: what is learnt where.
    fn guide_learning(&mut self, mask: &CellMask) {
        let width = mask.cells.width();
        self.guide.clear();
        self.guide.resize(mask.cells.as_raw().len(), Learning::Usual);
        for track in &self.tracks {
            let learning = match track.is_established {
                true => Learning::Hold,
                false if !track.has_moved && track.rests >= ABSORBED => Learning::Replace,
                false => continue,
            };
            for segment in &track.segments {
                self.guide[segment.range(width)].fill(learning);
            }
        }
    }
}

/// Factor by which a sight may change a side in a frame.
const MOST_GROWTH: f64 = 1.33;
/// The same where the sight seems to be of another size.
const MOST_GROWTH_ODD: f64 = 1.1;

/// What a track is about to be shown.
struct Sight<'a> {
    frame: FrameView<'a>,
    mask: &'a CellMask,
    at_border: bool,
    claimer: &'a Claimer,
    /// Where the claiming tracks are, as far as it is known.
    boxes: &'a [Rect],
    /// Its own among them.
    place: usize,
}

impl Sight<'_> {
    /// Step 4; gives where the track is, in cells, if it was seen.
    fn take<D: CentreModel<N>, const N: usize>(
        &self,
        track: &mut Track<D, N>,
        claim: &Claim,
    ) -> Option<Rect> {
        let is_outgrown = claim.region_cells as f64 > OUTGROWN.1 * track.usual_cells;
        track.outgrown = if is_outgrown { track.outgrown + 1 } else { 0 };
        let cells = count(&claim.segments) as f64;
        // Where its region goes on beyond the claim, the claim's edge is none of the object's.
        let is_cut = track.sights > FEW
            && !self.claimer.takes_all
            && claim.region_cells as f64 > cells + CUT * track.usual_cells;
        let area = extent(&claim.segments, STRAY).filter(|_| !claim.is_shared && !is_cut);
        let whole =
            area.filter(|area| cells >= FEWEST * track.usual_cells && self.is_believed(area, track, claim));
        if let Some(area) = whole {
            let seen = self.mask.to_frame(&area);
            let follows = if self.at_border { FOLLOWS_AT_BORDER } else { FOLLOWS };
            track.see(seen, follows.max(1.0 / f64::from(track.sights + 1)), MOST_GROWTH);
            track.sights_alone += 1;
            track.odd = 0;
            track.usual_cells += follows.max(1.0 / f64::from(track.sights)) * (cells - track.usual_cells);
            track.segments.clone_from(&claim.segments);
            let look = Appearance::of(self.frame, &seen);
            match &mut track.appearance {
                Some(known) => known.follow(&look),
                None => track.appearance = Some(look),
            }
            return Some(area);
        }
        let expected = self.claimer.box_in_cells;
        let others: Vec<Rect> =
            (self.boxes.iter().enumerate()).filter(|one| one.0 != self.place).map(|one| *one.1).collect();
        let (fitted, filled) = fit::fit(&self.mask.cells, &expected, &others);
        if filled < FILLED * track.usual_cells / expected.area() {
            return None;
        }
        track.see(self.mask.to_frame(&fitted), 0.0, MOST_GROWTH);
        if let Some(area) = area {
            let seen = self.mask.to_frame(&area);
            let follow = |old: f64, new: f64| {
                old * (new / old).powf(FOLLOWS_ODD).clamp(1.0 / MOST_GROWTH_ODD, MOST_GROWTH_ODD)
            };
            track.odd += 1;
            track.size = (follow(track.size.0, seen.w), follow(track.size.1, seen.h));
            track.usual_cells += FOLLOWS_ODD * (cells - track.usual_cells);
        }
        track.segments.clone_from(&claim.segments);
        Some(fitted)
    }

    /// Whether the box of a track's cells is that of the track.
    fn is_believed<D, const N: usize>(&self, area: &Rect, track: &Track<D, N>, claim: &Claim) -> bool {
        let expected = self.claimer.box_in_cells;
        let least = if track.sights > FEW { ALIKE.0 } else { ALIKE.1 };
        let alike = |a: f64, b: f64| a / b > least && a / b < 1.0 / least;
        (alike(area.w, expected.w) && alike(area.h, expected.h))
            || track.sights < 5
            || self.at_border
            || (self.claimer.takes_all && claim.region_cells > 0)
            || track.odd > ODD_FOR
    }
}

/// What giving an object to a track costs: distance, difference of the areas and of the colours, each as a share of its gate;
/// infinite beyond one of the gates.
fn cost_of<D: CentreModel<N>, const N: usize>(track: &Track<D, N>, found: &Found) -> f64 {
    let tracked = track.tracked_box();
    let reach = (GATE.0 + GATE.1 * f64::from(track.invisible)).min(GATE.2);
    let distance = tracked.centre_distance(&found.seen) / (reach * tracked.area().sqrt());
    let size = (found.seen.area() / tracked.area()).ln().abs() / OTHER_SIZE;
    let likeness = track.appearance.as_ref().map_or(0.5, |known| similarity(known, &found.look));
    let look = (1.0 - likeness) / OTHER_LOOK;
    if distance.max(size).max(look) > 1.0 { f64::INFINITY } else { distance + size + look }
}
