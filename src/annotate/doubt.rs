//! Where to look: stretches of frames whose boxes may be wrong, the most doubtful first.

use serde::Serialize;

use super::track::Annotated;

/// Below this confidence a box is worth a look.
pub const DOUBTFUL: f64 = 0.5;

/// Neighbouring frames whose boxes are doubtful.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Place {
    /// The most doubtful frame, counted from 0: where one look, or a key frame, tells most.
    pub frame: usize,
    /// The first doubtful frame, counted from 0.
    pub first: usize,
    /// The last doubtful frame, counted from 0.
    pub last: usize,
    /// The confidence of the most doubtful frame, in [0, 1].
    pub confidence: f64,
}

/// The doubtful places of a track, the most doubtful first; of equally doubtful ones the earlier.
pub fn doubtful_places(track: &[Option<Annotated>]) -> Vec<Place> {
    let mut places: Vec<Place> = Vec::new();
    for (frame, found) in track.iter().enumerate() {
        let Some(confidence) =
            found.map(|found| found.confidence).filter(|&confidence| confidence < DOUBTFUL)
        else {
            continue;
        };
        match places.last_mut().filter(|place| place.last + 1 == frame) {
            Some(place) => {
                place.last = frame;
                if confidence < place.confidence {
                    (place.frame, place.confidence) = (frame, confidence);
                }
            }
            None => places.push(Place { frame, first: frame, last: frame, confidence }),
        }
    }
    places.sort_by(|a, b| a.confidence.total_cmp(&b.confidence).then(a.frame.cmp(&b.frame)));
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;

    #[test]
    fn places_are_runs_of_doubtful_frames_in_the_order_of_doubt() {
        let row = |confidence| {
            Some(Annotated { box_in_frame: Rect::new(0.0, 0.0, 1.0, 1.0), confidence, is_key: false })
        };
        let track =
            [row(0.9), row(0.4), row(0.3), row(0.3), row(0.6), None, row(0.1), None, row(0.3), row(0.5)];
        let of = |frame, first, last, confidence| Place { frame, first, last, confidence };
        assert_eq!(doubtful_places(&track), [of(6, 6, 6, 0.1), of(2, 1, 3, 0.3), of(8, 8, 8, 0.3)]);
        assert!(doubtful_places(&[]).is_empty());
    }
}
