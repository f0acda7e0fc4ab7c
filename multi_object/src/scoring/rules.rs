//! Whose rules a result is judged by.

/// The two toolkits that everybody's numbers come from. They differ in how a frame's matches are chosen, in where a track is
/// mostly tracked, and in what a fragment is; the identity and HOTA scores are the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rules {
    /// py-motmetrics: a pairing is kept for as long as it overlaps enough, however long it was interrupted; mostly
    /// tracked from 80 % on; a fragment is a tracked object that is missed and found again.
    #[default]
    Motmetrics,
    /// TrackEval, as the MOTChallenge server: only pairings of the frame before are kept; mostly tracked above 80 %; a
    /// fragment is an object that is found again after a frame in which something was matched, but not it.
    Trackeval,
}
