//! Which segments of a sequence are scored, and against which rows of its truth.
//!
//! A result that says where its run starts is believed: published runs of TRE start where their own lists of hidden frames
//! had them start. Without that the protocol's rule says it, and only a result of just the rows that are left from there
//! can have started there.

use crate::{
    dataset::Target,
    protocol::{Protocol, ProtocolError},
    results::{ResultFile, SeedResults},
};

/// A segment: its label, and the row of the truth, counted from 0, where the protocol's rule has it start.
pub type Segment = (Option<String>, Option<usize>);

/// The segments of a sequence to score for a seed: those of the protocol's rule, and in TRE those besides that there are
/// results of.
///
/// # Errors
/// [`ProtocolError`] if the rule has none and there are none.
pub fn segments_of(
    protocol: Protocol,
    target: &Target,
    seed: &SeedResults,
) -> Result<Vec<Segment>, ProtocolError> {
    let by_rule = target.starts(protocol);
    let ruled = by_rule.as_deref().unwrap_or_default();
    let mut segments: Vec<Segment> =
        ruled.iter().map(|(label, start)| (label.clone(), Some(*start))).collect();
    if protocol == Protocol::Tre {
        for label in seed.numbers(&target.name) {
            if !segments.iter().any(|(known, _)| known.as_deref() == Some(label)) {
                segments.push((Some(label.to_owned()), None));
            }
        }
    }
    match by_rule {
        Err(error) if segments.is_empty() => Err(error),
        _ => Ok(segments),
    }
}

/// The row of the truth, counted from 0, that a segment's first row is of; `None` if nothing tells.
pub fn start_of(
    protocol: Protocol,
    target: &Target,
    by_rule: Option<usize>,
    file: &ResultFile,
) -> Option<usize> {
    if protocol != Protocol::Tre {
        return Some(0);
    }
    let fits = |start: &usize| file.rows.len() + start == target.truth.len();
    file.start.or_else(|| by_rule.filter(fits)).filter(|start| *start < target.truth.len())
}
