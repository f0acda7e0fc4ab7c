//! What every command takes that scores results: data, results, trackers, rules.

use std::{
    collections::{BTreeMap, BTreeSet, HashSet},
    path::PathBuf,
};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use infopart::program::BadInput;
use otb_eval::{
    catalogue::AttributeSource,
    dataset::Dataset,
    figures::missing_protocols,
    protocol::Protocol,
    results::{Results, ResultsError},
    scoring::{LongTermScores, ScoreOptions, ScoreProblem, Table, Weight, has_absence, long_term, score},
    toolkits::{Rules, Toolkit},
};

use super::inputs::{DataArgs, Problems, note};

#[derive(Debug, Args)]
pub struct ScoredArgs {
    #[command(flatten)]
    pub data: DataArgs,
    /// Results: what `run` wrote, RESULTS/TRACKER/SEQ.txt, or one tracker's folder
    #[arg(long, value_name = "RESULTS")]
    results: Option<PathBuf>,
    /// Only these trackers, in this order [default: all there are]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    trackers: Option<Vec<String>>,
    /// Whose attributes the scores by attribute use: tb100 (tb_100.txt), json (OTB100.json) or none [default: the
    /// toolkit's own; they differ on 14 sequences]
    #[arg(long, value_name = "tb100|json|none")]
    attributes: Option<String>,
    /// What rows are worth that a result lacks, under plain rules; given, a result of another length than its ground
    /// truth is no problem [default: drop, and tell of it]
    #[arg(long, value_enum)]
    missing_rows: Option<MissingRows>,
    /// What a row without a box is worth, under plain rules
    #[arg(long, value_enum, default_value_t = LostRows::AsIs)]
    lost_boxes: LostRows,
    /// Leave frames with an invalid ground truth out of every share, as an option of pytracking's does
    #[arg(long)]
    exclude_invalid: bool,
    /// Undo the scaling of sre's scaled runs before comparing, as one of the benchmark's two codes does
    #[arg(long)]
    sre_undo_scale: bool,
    /// Score how targets are followed that are absent for a while: VOT-LT's F, precision and recall over confidence thresholds;
    /// plot and report do so unasked where the data has frames without a target
    #[arg(long)]
    pub long_term: bool,
    /// Exit with 2 also where results that others made have defects, which are listed and scored as the rules have it:
    /// rows too few or too many, or what the toolkit itself would fail on
    #[arg(long)]
    pub strict: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MissingRows {
    /// They are dropped from the ground truth too
    Drop,
    /// They are misses
    Miss,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum LostRows {
    /// It is a miss
    AsIs,
    /// The box before is carried forward
    Carry,
}

/// Sequences or segments that are named where many have one problem: results may have many more sequences than the data, and a
/// seed that was not run lacks every segment.
const NAMED: usize = 3;

/// Tells what could not be scored, or not as it stands. Many sequences without ground truth, many results that a seed lacks,
/// and many results of a tracker with the same defect are told in one line.
pub fn tell<'a>(unscored: impl IntoIterator<Item = &'a ScoreProblem>, problems: &mut Problems) {
    let (mut without_truth, mut first_only) = (Vec::new(), Vec::new());
    let mut missing: BTreeMap<(&str, u64), Vec<&'a ScoreProblem>> = BTreeMap::new();
    let mut alike: BTreeMap<(Weight, &str, String), Vec<&'a ScoreProblem>> = BTreeMap::new();
    let mut others = Vec::new();
    for problem in unscored {
        match problem {
            ScoreProblem::Lengths { tracker, .. } => {
                let what = "the results have not as many rows as the ground truth".to_owned();
                alike.entry((problem.weight(), tracker, what)).or_default().push(problem);
            }
            ScoreProblem::Crash { tracker, source, .. } => {
                let what = format!("{} would fail: {}", source.toolkit(), source.cause());
                alike.entry((problem.weight(), tracker, what)).or_default().push(problem);
            }
            ScoreProblem::Read { tracker, how, .. } => {
                alike
                    .entry((problem.weight(), tracker, format!("read with {how}")))
                    .or_default()
                    .push(problem);
            }
            ScoreProblem::Start { tracker, .. } => {
                let what = "nothing tells where the runs start, and their rows do not fit the benchmark's starts; convert them from the published JSON or .mat files with this version, which keeps the starts".to_owned();
                alike.entry((problem.weight(), tracker, what)).or_default().push(problem);
            }
            ScoreProblem::NoTruth { .. } => without_truth.push(problem),
            ScoreProblem::FirstOnly { .. } => first_only.push(problem),
            ScoreProblem::Missing { tracker, seed, reason: None, .. } => {
                missing.entry((tracker, *seed)).or_default().push(problem);
            }
            _ => others.push(problem),
        }
    }
    tell_folded(&without_truth, problems, |named| {
        format!(
            "{named}: no ground truth of them; add their folders with --data, or choose others with --sequences"
        )
    });
    tell_folded(&first_only, problems, |named| {
        format!(
            "{named}: only their first boxes are known: the benchmark's server scores them; make what it takes with `otb_eval submit`"
        )
    });
    for ((tracker, seed), group) in missing {
        tell_folded(&group, problems, |named| {
            format!(
                "{tracker}, {named}: no results (seed {seed}); run them, or leave the sequences out with --sequences"
            )
        });
    }
    for ((_, tracker, what), group) in alike {
        tell_folded(&group, problems, |named| format!("{tracker}, {named}: {what}"));
    }
    others.iter().for_each(|problem| tell_one(problem, problem.weight(), problems));
}

fn tell_one(told: &dyn std::fmt::Display, weight: Weight, problems: &mut Problems) {
    match weight {
        Weight::Note => note(&told.to_string()),
        Weight::Defect => problems.tell_defect(told),
        Weight::Problem => problems.tell(told),
    }
}

/// Tells each problem of a kind, or where there are many all of them in a line, made from the names of a few.
fn tell_folded(group: &[&ScoreProblem], problems: &mut Problems, line: impl Fn(&str) -> String) {
    if group.len() <= NAMED {
        return group.iter().for_each(|problem| tell_one(problem, problem.weight(), problems));
    }
    let named: Vec<&str> = group.iter().take(NAMED).filter_map(|problem| problem.subject()).collect();
    let told = line(&format!("{} and {} more", named.join(", "), group.len() - NAMED));
    tell_one(&told, group[0].weight(), problems);
}

impl ScoredArgs {
    /// For a command that names its trackers otherwise.
    pub fn refuse_trackers(&self) -> Result<()> {
        if self.trackers.is_some() {
            let how = "--trackers: the two trackers are A and B themselves; leave the flag out";
            return Err(BadInput(how.into()).into());
        }
        Ok(())
    }

    /// The folder of results.
    pub fn results(&self) -> Result<&PathBuf> {
        let how = "give --results: what `otb_eval run` wrote, or a folder of TRACKER/SEQ.txt";
        Ok(self.results.as_ref().ok_or_else(|| BadInput(how.into()))?)
    }

    /// The results of a protocol, of the trackers asked for.
    pub fn open_results(&self, protocol: Protocol) -> Result<Results> {
        self.tell_ignored()?;
        let results = Results::open(self.results()?, protocol).context("--results")?;
        Ok(match &self.trackers {
            Some(names) => results.only(names).context("--trackers")?,
            None => results,
        })
    }

    /// Tells of flat results beside those of `run`, which no command looks at.
    fn tell_ignored(&self) -> Result<()> {
        let path = self.results()?;
        let ignored = Results::ignored(path).unwrap_or_default();
        if !ignored.is_empty() {
            note(&format!(
                "{}: {} beside ope, tre or sre are left alone, for they are flat; `otb_eval convert {} OUT --from flat --to run` gives them the others' layout",
                path.display(),
                ignored.join(", "),
                ignored.first().map(|name| path.join(name)).unwrap_or_default().display()
            ));
        }
        Ok(())
    }

    /// Long-term scores of one-pass results: where they are asked for or, if `unasked`, where the data has frames without a target.
    pub fn long_term(
        &self,
        dataset: &Dataset,
        results: &Results,
        toolkit: Toolkit,
        unasked: bool,
    ) -> Result<Option<Vec<LongTermScores>>> {
        let is_wanted = self.long_term || (unasked && has_absence(dataset));
        if !is_wanted {
            return Ok(None);
        }
        Ok(Some(long_term(dataset, results, &self.options(toolkit, Protocol::Ope)?)))
    }

    /// The toolkit's rules with the options asked for.
    pub fn rules(&self, toolkit: Toolkit) -> Rules {
        let mut rules = toolkit.rules();
        if toolkit == Toolkit::Plain {
            if self.missing_rows == Some(MissingRows::Miss) {
                rules = rules.with_missing_rows_as_misses();
            }
            if self.lost_boxes == LostRows::Carry {
                rules = rules.with_lost_boxes_carried();
            }
        }
        if self.exclude_invalid { rules.with_invalid_frames_excluded() } else { rules }
    }

    /// How to score the results of a protocol under a toolkit's rules.
    pub fn options(&self, toolkit: Toolkit, protocol: Protocol) -> Result<ScoreOptions> {
        let rules = self.rules(toolkit);
        let attributes = match self.attributes.as_deref() {
            None => rules.attributes(),
            Some("none") => None,
            Some(word) => Some(word.parse::<AttributeSource>().context("--attributes")?),
        };
        Ok(ScoreOptions {
            rules,
            protocol,
            sequences: self.data.selected()?,
            attributes,
            undo_scale: self.sre_undo_scale,
            accept_lengths: self.missing_rows.is_some(),
        })
    }

    /// Scores the results of a protocol under a toolkit's rules.
    pub fn score(
        &self,
        dataset: &Dataset,
        results: &Results,
        toolkit: Toolkit,
        protocol: Protocol,
    ) -> Result<(Table, Vec<ScoreProblem>)> {
        let (table, unscored) = score(dataset, results, &self.options(toolkit, protocol)?);
        if table.sequences.is_empty() {
            let path = self.results()?;
            let deeper: Vec<String> =
                Results::deeper(path).iter().map(|folder| folder.display().to_string()).collect();
            if !deeper.is_empty() {
                note(&format!(
                    "{}: nothing there fits the data, but there are results in {}",
                    path.display(),
                    deeper.join(", ")
                ));
            }
        }
        Ok((table, unscored))
    }

    /// Scores every protocol asked for, or all there are, and tells what could not be scored. Each table has the same
    /// trackers in the same order; one without results of a protocol has no scores there, and that is told.
    pub fn tables(
        &self,
        dataset: &Dataset,
        protocol: Option<Protocol>,
        toolkit: Toolkit,
        problems: &mut Problems,
    ) -> Result<Vec<(Results, Table)>> {
        let protocols = match protocol {
            Some(protocol) => vec![protocol],
            None => Results::protocols(self.results()?).context("--results")?,
        };
        self.tell_ignored()?;
        let mut opened = Vec::new();
        for protocol in protocols {
            opened.push((protocol, Results::open(self.results()?, protocol).context("--results")?));
        }
        let names = self.names(&opened)?;
        let mut tables = Vec::new();
        for (protocol, results) in opened {
            let results = results.with_trackers(&names);
            let (table, unscored) = self.score(dataset, &results, toolkit, protocol)?;
            tell(&unscored, problems);
            tables.push((results, table));
        }
        missing_protocols(&tables).iter().for_each(|missing| note(missing));
        Ok(tables)
    }

    /// The trackers asked for, each of which has results of some protocol, or all that have.
    fn names(&self, opened: &[(Protocol, Results)]) -> Result<Vec<String>> {
        let all = opened.iter().flat_map(|(_, results)| &results.trackers);
        let there: BTreeSet<String> = all.map(|tracker| tracker.name.clone()).collect();
        let names = self.trackers.clone().unwrap_or_else(|| there.iter().cloned().collect());
        let mut known = HashSet::new();
        for name in &names {
            if !there.contains(name) || !known.insert(name) {
                let there = there.into_iter().collect::<Vec<_>>().join(", ");
                let error = ResultsError::NoTracker { name: name.clone(), there };
                return Err(error).context("--trackers");
            }
        }
        Ok(names)
    }
}
