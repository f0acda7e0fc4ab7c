//! From what became of tracks, frame by frame, to rows that say it with hindsight, in the order of frames.
//!
//! 1. A track's rows wait until it is established; then they are reported from its first sight on.
//! 2. While a track is not seen nothing is reported of it. If it is seen again, the frames between are filled in on the straight
//!    line, and marked as hidden.
//! 3. The rows of a frame are ready once no living track can add one to it. None waits for more than [`LONGEST_WAIT`] frames.

use std::collections::{BTreeMap, HashMap};

use infopart::geometry::Rect;

use super::TrackState;

/// Frames that a row waits at most.
const LONGEST_WAIT: u32 = 100;

/// How an object was known in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowKind {
    /// It was seen.
    Seen,
    /// It was not seen, but before and after.
    Hidden,
}

/// One object in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// The frame.
    pub frame: u32,
    /// The object.
    pub identity: u64,
    /// Its box.
    pub box_in_frame: Rect,
    /// How it was known.
    pub kind: RowKind,
}

/// A track whose rows may still become more.
#[derive(Debug)]
struct Open {
    first: u32,
    last: u32,
    last_box: Rect,
    is_established: bool,
}

/// Collects and orders.
#[derive(Debug, Default)]
pub struct Reports {
    rows: BTreeMap<u32, Vec<Report>>,
    open: HashMap<u64, Open>,
}

impl Reports {
    /// Takes what became of each track in a frame, with the box to report of it: step 1 and 2. Frames come in order. Gives the
    /// rows that are ready.
    pub fn add(
        &mut self,
        frame: u32,
        states: &[TrackState],
        box_of: impl Fn(&TrackState) -> Rect,
    ) -> Vec<Report> {
        for state in states {
            if state.detected_in_frame.is_some() {
                self.see(frame, state.identity, box_of(state), state.is_established);
            }
        }
        let alive = |identity: &u64| states.iter().any(|state| state.identity == *identity);
        let gone: Vec<u64> = self.open.keys().filter(|identity| !alive(identity)).copied().collect();
        for identity in gone {
            self.close(identity);
        }
        let waits = |open: &Open| if open.is_established { open.last + 1 } else { open.first };
        let oldest = self.open.values().map(waits).min().unwrap_or(frame + 1);
        self.ready(oldest.max(frame.saturating_sub(LONGEST_WAIT) + 1))
    }

    /// All rows that are left: there is no further frame.
    pub fn finish(&mut self) -> Vec<Report> {
        let open: Vec<u64> = self.open.keys().copied().collect();
        for identity in open {
            self.close(identity);
        }
        self.ready(u32::MAX)
    }

    fn see(&mut self, frame: u32, identity: u64, seen: Rect, is_established: bool) {
        let fresh = Open { first: frame, last: frame, last_box: seen, is_established };
        let open = self.open.entry(identity).or_insert(fresh);
        open.is_established |= is_established;
        let (last, last_box) = (open.last, open.last_box);
        (open.last, open.last_box) = (frame, seen);
        for hidden in last + 1..frame {
            let share = f64::from(hidden - last) / f64::from(frame - last);
            let report = Report {
                frame: hidden,
                identity,
                box_in_frame: between(&last_box, &seen, share),
                kind: RowKind::Hidden,
            };
            self.rows.entry(hidden).or_default().push(report);
        }
        let report = Report { frame, identity, box_in_frame: seen, kind: RowKind::Seen };
        self.rows.entry(frame).or_default().push(report);
    }

    /// A track that ends without having been established was none.
    fn close(&mut self, identity: u64) {
        if self.open.remove(&identity).is_some_and(|open| !open.is_established) {
            self.rows.values_mut().for_each(|rows| rows.retain(|row| row.identity != identity));
        }
    }

    /// Step 3: the rows before a frame.
    fn ready(&mut self, before: u32) -> Vec<Report> {
        let later = self.rows.split_off(&before);
        let ready = std::mem::replace(&mut self.rows, later);
        // Who waited too long may be one later, but not in these frames.
        let is_real = |row: &Report| self.open.get(&row.identity).is_none_or(|open| open.is_established);
        ready
            .into_values()
            .flat_map(|mut rows| {
                rows.sort_by_key(|row| row.identity);
                rows
            })
            .filter(is_real)
            .collect()
    }
}

fn between(before: &Rect, after: &Rect, share: f64) -> Rect {
    let mix = |a: f64, b: f64| a + share * (b - a);
    Rect::new(mix(before.x, after.x), mix(before.y, after.y), mix(before.w, after.w), mix(before.h, after.h))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(identity: u64, x: f64, is_seen: bool, is_established: bool) -> TrackState {
        let area = Rect::new(x, 0.0, 10.0, 20.0);
        TrackState {
            identity,
            predicted_in_frame: None,
            detected_in_frame: is_seen.then_some(area),
            box_in_frame: area,
            is_established,
        }
    }

    fn keys(rows: &[Report]) -> Vec<(u32, u64, f64, RowKind)> {
        rows.iter().map(|row| (row.frame, row.identity, row.box_in_frame.x, row.kind)).collect()
    }

    #[test]
    fn first_frames_come_once_a_track_is_one_and_gaps_are_filled_between_sights() {
        use RowKind::{Hidden, Seen};
        let mut reports = Reports::default();
        let mut add =
            |frame, states: &[TrackState]| keys(&reports.add(frame, states, |one| one.box_in_frame));
        assert_eq!(add(1, &[state(1, 0.0, true, false)]), []);
        // A flicker, 2, goes with nothing left; 1 is established.
        assert_eq!(add(2, &[state(1, 1.0, true, false), state(2, 50.0, true, false)]), []);
        assert_eq!(
            add(3, &[state(1, 2.0, true, true)]),
            [(1, 1, 0.0, Seen), (2, 1, 1.0, Seen), (3, 1, 2.0, Seen)]
        );
        assert_eq!(add(4, &[state(1, 99.0, false, true)]), []);
        assert_eq!(add(5, &[state(1, 99.0, false, true), state(3, 70.0, true, true)]), []);
        let filled = [(4, 1, 3.0, Hidden), (5, 1, 4.0, Hidden), (5, 3, 70.0, Seen)];
        assert_eq!(add(6, &[state(1, 5.0, true, true), state(3, 70.0, false, true)]), filled);
        // Frame 6 waited for 3, who is hidden and was not seen again.
        assert_eq!(keys(&reports.finish()), [(6, 1, 5.0, Seen)]);
    }

    #[test]
    fn nobody_waits_for_ever_for_a_track_that_never_is_one() {
        let mut reports = Reports::default();
        let mut count = 0;
        for frame in 1..=500 {
            let states = [state(1, 0.0, true, false), state(2, 90.0, true, true)];
            count += reports.add(frame, &states, |one| one.box_in_frame).len();
            assert!(reports.rows.len() <= LONGEST_WAIT as usize);
        }
        assert_eq!(count, 400);
        assert_eq!(reports.finish().len(), 100);
    }
}
