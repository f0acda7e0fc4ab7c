//! Step 4: what the catalogue knows of a target.

use std::collections::BTreeMap;

use super::Finding;
use crate::{
    catalogue::{self, Dialect, SequenceList},
    dataset::Target,
};

/// The named lists that a sequence is in.
pub(super) fn lists(name: &str) -> Vec<&'static str> {
    let has = |list: &SequenceList| list.sequences().contains(&name);
    SequenceList::ALL.into_iter().filter(has).map(SequenceList::name).collect()
}

/// Its name in each toolkit; nothing if it is none of TB-100.
pub(super) fn spellings(name: &str) -> BTreeMap<&'static str, String> {
    let toolkit = |dialect: Dialect| match dialect {
        Dialect::Benchmark => "jwlim, pysot",
        Dialect::Pytracking => "pytracking",
        Dialect::Got10k => "got10k",
        Dialect::Vot => "vot",
        Dialect::Matlab => "matlab",
    };
    let Some(known) = catalogue::find(name) else { return BTreeMap::new() };
    Dialect::ALL.into_iter().map(|dialect| (toolkit(dialect), known.spelling(dialect))).collect()
}

/// What the benchmark itself does with the sequence.
pub(super) fn known(target: &Target, findings: &mut Vec<Finding>) {
    let Some(known) = catalogue::find(&target.name) else { return };
    let omitted = known.omitted_frames();
    if omitted > 0 {
        let here = match target.frames.as_ref().map_or(0, |frames| frames.first_frame - 1) {
            0 => "which are not in this copy".to_owned(),
            left_out => format!("and so are the {left_out} in this copy"),
        };
        findings.push(Finding::oddity(format!(
            "the benchmark leaves out its first {omitted} frames, {here}; got10k and VOT use them"
        )));
    }
    let own = target.name.as_str();
    let differing = |(_, spelling): &(&'static str, String)| !spelling.eq_ignore_ascii_case(own);
    let others: Vec<String> = spellings(own)
        .into_iter()
        .filter(differing)
        .map(|(toolkit, spelling)| format!("{spelling} in {toolkit}"))
        .collect();
    if !others.is_empty() {
        findings.push(Finding::oddity(format!("it is called {}", others.join(", "))));
    }
}
