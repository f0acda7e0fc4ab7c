//! Step 1: one tracker with one seed on one sequence.

use super::{
    ScoreOptions, ScoreProblem, Segment, frames_per_second, segments_of, speed::mean_of_rates, start_of,
};
use crate::{
    dataset::Target,
    protocol::{Protocol, unscaled},
    results::{ResultFile, SeedResults, TrackerResults},
    runner::stem,
    toolkits::{Curves, FrameNotes, Hits, evaluate_with},
};

/// What became of a sequence.
pub(super) struct SequenceOutcome {
    /// `None` if a segment is missing, unreadable or crashes the toolkit; times that cannot be read cost no score.
    pub(super) curves: Option<Curves>,
    pub(super) frames_per_second: Option<f64>,
    /// Frames with a time.
    pub(super) timed: usize,
    pub(super) problems: Vec<ScoreProblem>,
}

pub(super) fn score(
    tracker: &TrackerResults,
    seed: &SeedResults,
    target: &Target,
    options: &ScoreOptions,
) -> SequenceOutcome {
    let (mut total, mut problems, mut is_whole) = (None::<Hits>, Vec::new(), true);
    let (mut seconds, mut updates) = (Vec::new(), vec![0.0]);
    let (is_own, tracker) = (tracker.run.is_some(), tracker.name.as_str());
    for segment in segments_of(options.protocol, target, seed).unwrap_or_default() {
        let label = segment.0.as_deref();
        match segment_hits(tracker, seed, target, &segment, options) {
            Ok(Scored { hits, rows, start, notes }) => {
                problems.extend(notes);
                match &mut total {
                    Some(total) => total.merge(&hits),
                    None => total = Some(hits),
                }
                let truth = target.truth.len() - start;
                if rows != truth && !options.accept_lengths {
                    problems.push(ScoreProblem::Lengths {
                        tracker: tracker.to_owned(),
                        stem: stem(&target.name, label),
                        result: rows,
                        truth,
                        is_own,
                        toolkit: options.rules.toolkit(),
                    });
                }
            }
            Err(problem) => {
                is_whole = false;
                problems.push(problem);
            }
        }
        match seed.read_seconds(&target.name, label) {
            Some(Ok(of_segment)) => {
                updates.extend(of_segment.iter().skip(1));
                seconds.extend(of_segment);
            }
            Some(Err(source)) => {
                problems.push(ScoreProblem::Unreadable { tracker: tracker.to_owned(), source });
            }
            None => {}
        }
    }
    let curves = total.filter(|_| is_whole).map(|hits| hits.curves(&options.rules));
    let frames_per_second =
        if options.rules.mean_of_rates() { mean_of_rates(&seconds) } else { frames_per_second(&updates) };
    let timed = seconds.iter().filter(|second| **second > 0.0).count();
    SequenceOutcome { curves, frames_per_second, timed, problems }
}

/// What is said of the frames from a row of the truth on.
fn notes_from(target: &Target, start: usize) -> FrameNotes<'_> {
    let said = &target.annotations;
    FrameNotes {
        absent: said.absent.get(start..).unwrap_or_default(),
        cover: said.cover.get(start..).unwrap_or_default(),
        resolution: said.resolution,
    }
}

struct Scored {
    hits: Hits,
    /// Rows of the result.
    rows: usize,
    /// The row of the truth where it starts.
    start: usize,
    notes: Vec<ScoreProblem>,
}

fn segment_hits(
    tracker: &str,
    seed: &SeedResults,
    target: &Target,
    (label, by_rule): &Segment,
    options: &ScoreOptions,
) -> Result<Scored, ScoreProblem> {
    let label = label.as_deref();
    let stem = stem(&target.name, label);
    let tracker = tracker.to_owned();
    let Some(file) = seed.read(&target.name, label) else {
        let reason = seed.failures().find(|(failed, _)| *failed == stem).map(|(_, reason)| reason.to_owned());
        return Err(ScoreProblem::Missing { tracker, stem, seed: seed.seed, reason });
    };
    let mut file = match file {
        Ok(file) => with_scale_undone(file, label, options),
        Err(source) => return Err(ScoreProblem::Unreadable { tracker, source }),
    };
    let mut notes = Vec::new();
    if let Some(how) = file.read_as.take() {
        notes.push(ScoreProblem::Read { tracker: tracker.clone(), stem: stem.clone(), how });
    }
    if options.protocol != Protocol::Tre {
        let dropped = target.align(&mut file.rows);
        if dropped > 0 {
            notes.push(ScoreProblem::Aligned { tracker: tracker.clone(), stem: stem.clone(), dropped });
        }
    }
    let Some(start) = start_of(options.protocol, target, *by_rule, &file) else {
        let (rows, truth) = (file.rows.len(), target.truth.len());
        return Err(ScoreProblem::Start { tracker, stem, start: file.start, rows, truth });
    };
    let truth = &target.truth[start..];
    if file.first_is_given
        && let (Some(first), Some(given)) = (file.rows.first_mut(), truth.first())
    {
        *first = *given;
    }
    options
        .rules
        .check_separators(file.separators)
        .and_then(|()| evaluate_with(&options.rules, truth, notes_from(target, start), &file.rows))
        .map(|hits| Scored { hits, rows: file.rows.len(), start, notes })
        .map_err(|source| ScoreProblem::Crash { tracker, stem, source })
}

fn with_scale_undone(mut file: ResultFile, label: Option<&str>, options: &ScoreOptions) -> ResultFile {
    if let Some(label) = label.filter(|_| options.undo_scale) {
        file.rows.iter_mut().for_each(|row| *row = unscaled(*row, label));
    }
    file
}
