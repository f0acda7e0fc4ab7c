//! Which jobs there are.

use std::{fmt, str::FromStr};

use infopart::sequence::{OpenOptions, SequenceError, open};
use thiserror::Error;

use super::Job;
use crate::{
    dataset::{Dataset, FrameFolder, Target},
    protocol::{Protocol, ProtocolError, ShiftRules, segments},
    words::of_sequence,
};

/// What is to be run.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanOptions {
    /// Where the trackers start.
    pub protocol: Protocol,
    /// The trackers' names.
    pub trackers: Vec<String>,
    /// Sequences by name; `None` for all of the data.
    pub sequences: Option<Vec<String>>,
    /// Seeds 1 to this number.
    pub seeds: u64,
    /// Whose shifts SRE uses.
    pub shift_rules: ShiftRules,
}

/// A part of all jobs: every N-th from the I-th on, I from 1 to N.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Default for Shard {
    fn default() -> Self {
        Self { index: 1, count: 1 }
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let parsed = word
            .split_once('/')
            .and_then(|(index, count)| Some(Self { index: index.parse().ok()?, count: count.parse().ok()? }));
        parsed
            .filter(|shard| (1..=shard.count).contains(&shard.index))
            .ok_or_else(|| format!("`{word}` is no I/N with 1 <= I <= N; give, for example, 1/2"))
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl Shard {
    /// The shard's jobs out of all, in their order. Longest first, every shard gets as much work.
    pub fn of(self, jobs: Vec<Job>) -> Vec<Job> {
        jobs.into_iter().skip(self.index - 1).step_by(self.count).collect()
    }
}

/// A sequence that gives no job; the others do.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlanProblem {
    /// The data has no such sequence.
    #[error("{name}: no such sequence in the data; check the spelling, or add its folder with --data")]
    NoSuchSequence {
        /// The sequence.
        name: String,
    },
    /// Only the boxes of the sequence are known.
    #[error("{name}: only its boxes are known; give its folder with --data")]
    NoFrames {
        /// The sequence.
        name: String,
    },
    /// The protocol cannot start on it.
    #[error("{name}: {source}")]
    Protocol {
        /// The sequence.
        name: String,
        /// Why not.
        source: ProtocolError,
    },
    /// Its first frame cannot be read.
    #[error("{name}: {}", of_sequence(source))]
    Frames {
        /// The sequence.
        name: String,
        /// What is wrong, and what to do.
        source: SequenceError,
    },
}

/// All jobs, longest first and then by id, so that no long one is left to run alone at the end; and what gives none.
pub fn plan(dataset: &Dataset, options: &PlanOptions) -> (Vec<Job>, Vec<PlanProblem>) {
    let (mut jobs, mut problems) = (Vec::new(), Vec::new());
    let names = options.sequences.clone();
    let names = names.unwrap_or_else(|| dataset.targets.iter().map(|target| target.name.clone()).collect());
    for name in names {
        match dataset.target(&name) {
            None => problems.push(PlanProblem::NoSuchSequence { name }),
            Some(target) => match jobs_of(target, options) {
                Ok(of_target) => jobs.extend(of_target),
                Err(problem) => problems.push(problem),
            },
        }
    }
    jobs.sort_by_cached_key(|job| (std::cmp::Reverse(job.frames), job.id()));
    (jobs, problems)
}

fn jobs_of(target: &Target, options: &PlanOptions) -> Result<Vec<Job>, PlanProblem> {
    let name = || target.name.clone();
    let folder = target.frames.as_ref().ok_or_else(|| PlanProblem::NoFrames { name: name() })?;
    let frame_size =
        first_frame_size(folder).map_err(|source| PlanProblem::Frames { name: name(), source })?;
    let segments = segments(options.protocol, &target.truth, &target.hidden, frame_size, options.shift_rules)
        .map_err(|source| PlanProblem::Protocol { name: name(), source })?;
    let mut jobs = Vec::new();
    for tracker in &options.trackers {
        for seed in 1..=options.seeds {
            jobs.extend(segments.iter().map(|segment| Job {
                protocol: options.protocol,
                tracker: tracker.clone(),
                seed,
                sequence: name(),
                frames: target.truth.len() - segment.start,
                segment: segment.clone(),
                folder: folder.clone(),
            }));
        }
    }
    Ok(jobs)
}

/// Width and height of the target's first frame, pixels.
fn first_frame_size(folder: &FrameFolder) -> Result<(usize, usize), SequenceError> {
    let options =
        OpenOptions { target: folder.target, start: Some(folder.first_frame), ..OpenOptions::default() };
    let first = open(&folder.path.to_string_lossy(), &options)?.source.next_frame()?;
    first
        .map(|first| (first.frame.width(), first.frame.height()))
        .ok_or_else(|| SequenceError::NoImages { path: folder.path.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runner::job::tests::job;

    #[test]
    fn shards_share_all_jobs_and_no_job_twice() {
        let jobs: Vec<Job> = (0..7)
            .map(|seed| {
                let mut job = job(None);
                job.seed = seed;
                job
            })
            .collect();
        let shard = |word: &str| word.parse::<Shard>().unwrap().of(jobs.clone());
        let mut seeds: Vec<u64> =
            ["1/3", "2/3", "3/3"].iter().flat_map(|word| shard(word)).map(|job| job.seed).collect();
        seeds.sort_unstable();
        assert_eq!(seeds, (0..7).collect::<Vec<u64>>());
        assert_eq!(shard("2/3").iter().map(|job| job.seed).collect::<Vec<_>>(), [1, 4]);
        for word in ["0/2", "3/2", "1", "a/b", "1/0"] {
            assert!(word.parse::<Shard>().unwrap_err().contains(word));
        }
    }

    #[test]
    fn unknown_sequences_and_boxes_without_frames_are_named() {
        let target = Target {
            name: "Boxes".into(),
            truth: vec![infopart::geometry::Rect::new(1.0, 1.0, 2.0, 2.0); 3],
            hidden: vec![],
            frames: None,
            annotations: crate::dataset::Annotations::default(),
        };
        let options = PlanOptions {
            protocol: Protocol::Ope,
            trackers: vec!["infopart".into()],
            sequences: Some(vec!["Boxes".into(), "Nowhere".into()]),
            seeds: 1,
            shift_rules: ShiftRules::Matlab,
        };
        let (jobs, problems) = plan(&Dataset { targets: vec![target] }, &options);
        assert!(jobs.is_empty());
        let text: Vec<String> = problems.iter().map(PlanProblem::to_string).collect();
        assert!(
            text[0].starts_with("Boxes: only its boxes") && text[1].starts_with("Nowhere: no such"),
            "{text:?}"
        );
    }
}
