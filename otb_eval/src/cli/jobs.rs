//! Which jobs a command is about: trackers, sequences, protocol, seeds and shard.

use std::{collections::HashSet, fs, path::PathBuf, str::FromStr};

use anyhow::{Context, Result};
use clap::Args;
use infopart::{program::BadInput, tracker::Parameters};
use otb_eval::{
    protocol::{HiddenFrames, Protocol, ShiftRules},
    runner::{InfoPartFactory, Job, PlanOptions, Shard, TrackerFactory, named_factory, plan},
    store::Store,
};

use super::inputs::{DataArgs, Problems};

#[derive(Debug, Args)]
pub struct JobArgs {
    #[command(flatten)]
    pub data: DataArgs,
    /// Where results are: OUT/PROTOCOL/TRACKER/seed_S/SEQ[_SEGMENT].txt
    #[arg(long, value_name = "RESULTS")]
    pub out: PathBuf,
    /// Trackers by name: infopart, whole-body (the same on the whole box), paper (the method as printed),
    /// colour (the colour-histogram particle filter)
    /// [default: infopart, unless there is a --config]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    trackers: Option<Vec<String>>,
    /// A tracker of your own: InfoPart with the parameters of a file, such as `infopart config` prints; may be repeated
    #[arg(long, value_name = "NAME=FILE.toml")]
    config: Vec<OwnTracker>,
    /// Where trackers start: ope once, tre from 20 frames, sre from 12 wrong boxes
    #[arg(long, value_name = "ope|tre|sre", default_value = "ope")]
    protocol: Protocol,
    /// Run with seeds 1 to N
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    seeds: u64,
    /// Only a part of the jobs, to split a run over machines or processes: every N-th from the I-th on
    #[arg(long, value_name = "I/N", default_value_t)]
    shard: Shard,
    /// Whose wrong boxes sre uses: matlab (the published ones) or otb-py (the Python benchmark's, whose `down` widens
    /// the box)
    #[arg(long, value_name = "matlab|otb-py", default_value = "matlab", value_parser = parse_shifts)]
    sre_shifts: ShiftRules,
}

/// A tracker given as NAME=FILE.
#[derive(Debug, Clone)]
struct OwnTracker {
    name: String,
    file: PathBuf,
}

impl FromStr for OwnTracker {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let (name, file) =
            word.split_once('=').ok_or("give NAME=FILE.toml, for example fast=fast.toml".to_owned())?;
        let is_plain = |letter: char| letter.is_alphanumeric() || "-_.+".contains(letter);
        if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
            return Err(format!("`{name}` is no name for a folder; use letters, digits, -, _, + and ."));
        }
        Ok(Self { name: name.to_owned(), file: PathBuf::from(file) })
    }
}

fn parse_shifts(word: &str) -> Result<ShiftRules, String> {
    match word {
        "matlab" => Ok(ShiftRules::Matlab),
        "otb-py" => Ok(ShiftRules::OtbPy),
        _ => Err("give matlab or otb-py".to_owned()),
    }
}

/// What is to be done.
pub struct Work {
    pub factories: Vec<Box<dyn TrackerFactory>>,
    /// The shard's jobs, longest first.
    pub jobs: Vec<Job>,
    pub store: Store,
    pub protocol: Protocol,
    pub shift_rules: ShiftRules,
    pub hidden: HiddenFrames,
    pub problems: Problems,
}

impl JobArgs {
    /// Finds the trackers and the jobs. Sequences that give no job are told as problems.
    pub fn work(&self) -> Result<Work> {
        let factories = self.factories()?;
        let sequences = self.data.selected()?;
        let (dataset, mut problems) = self.data.open()?;
        let options = PlanOptions {
            protocol: self.protocol,
            trackers: factories.iter().map(|factory| factory.name().to_owned()).collect(),
            sequences,
            seeds: self.seeds,
            shift_rules: self.sre_shifts,
        };
        let (jobs, without_jobs) = plan(&dataset, &options);
        without_jobs.iter().for_each(|problem| problems.tell(problem));
        Ok(Work {
            factories,
            jobs: self.shard.of(jobs),
            store: Store::new(&self.out),
            protocol: self.protocol,
            shift_rules: self.sre_shifts,
            hidden: self.data.hidden()?,
            problems,
        })
    }

    fn factories(&self) -> Result<Vec<Box<dyn TrackerFactory>>> {
        let mut factories: Vec<Box<dyn TrackerFactory>> = Vec::new();
        let unless_own = if self.config.is_empty() { vec!["infopart".to_owned()] } else { Vec::new() };
        for name in self.trackers.as_ref().unwrap_or(&unless_own) {
            factories.push(named_factory(name).context("--trackers")?);
        }
        for own in &self.config {
            factories.push(Box::new(own.factory()?));
        }
        let mut names = HashSet::new();
        match factories.iter().find(|factory| !names.insert(factory.name().to_owned())) {
            Some(twice) => Err(BadInput(format!(
                "the tracker `{}` is given twice; give each its own name in --trackers and --config",
                twice.name()
            ))
            .into()),
            None => Ok(factories),
        }
    }
}

impl OwnTracker {
    fn factory(&self) -> Result<InfoPartFactory> {
        let flag = || format!("--config {}={}", self.name, self.file.display());
        let text = fs::read_to_string(&self.file).map_err(|error| {
            BadInput(format!("{}: {error}; give a TOML file (`infopart config` prints one)", flag()))
        })?;
        let parameters = Parameters::from_toml(&text, Parameters::default()).with_context(flag)?;
        InfoPartFactory::new(&self.name, parameters).with_context(flag)
    }
}
