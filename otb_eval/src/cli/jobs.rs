//! Which jobs a command is about: trackers, sequences, protocol, seeds and shard.

use std::{collections::HashSet, fs, path::PathBuf, str::FromStr, time::Duration};

use anyhow::{Context, Result};
use clap::Args;
use infopart::{program::BadInput, tracker::Parameters};
use otb_eval::{
    external::{ExternalOptions, TrackerList},
    protocol::{HiddenFrames, Protocol, ShiftRules},
    runner::{InfoPartFactory, Job, PlanOptions, Shard, TrackerFactory, named_factory, plan},
    store::Store,
};

use super::{
    SUPERVISE,
    inputs::{DataArgs, Problems},
};

#[derive(Debug, Args)]
pub struct JobArgs {
    #[command(flatten)]
    pub data: DataArgs,
    /// Where results are: OUT/PROTOCOL/TRACKER/seed_S/SEQ[_SEGMENT].txt
    #[arg(long, value_name = "RESULTS")]
    pub out: PathBuf,
    /// Trackers by name: infopart, whole-body (the same on the whole box), paper (the method as printed),
    /// colour (the colour-histogram particle filter)
    /// [default: infopart, unless there is a --config, --tracker or --trackers-file]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    trackers: Option<Vec<String>>,
    /// A tracker of your own: InfoPart with the parameters of a file, such as `infopart config` prints; may be repeated
    #[arg(long, value_name = "NAME=FILE.toml")]
    config: Vec<OwnTracker>,
    /// A tracker of anybody's: a program that speaks TraX on its standard input and output, as a line for the shell; may be
    /// repeated
    #[arg(long, value_name = "NAME=COMMAND")]
    tracker: Vec<OtherTracker>,
    /// What the results of a --tracker are to be told apart by besides its command and its introduction, such as a commit
    #[arg(long, value_name = "NAME=VERSION")]
    tracker_version: Vec<OtherTracker>,
    /// Such trackers from a file: a table [NAME] each, with command and, if wanted, version, seeds and frame_timeout
    #[arg(long, value_name = "FILE.toml")]
    trackers_file: Option<PathBuf>,
    /// How long a --tracker may take for one answer, or to introduce itself
    #[arg(long, value_name = "S", default_value = "120", value_parser = parse_seconds)]
    frame_timeout: Duration,
    /// Where trackers start: ope once, tre from 20 frames, sre from 12 wrong boxes
    #[arg(long, value_name = "ope|tre|sre", default_value = "ope")]
    protocol: Protocol,
    /// Run with seeds 1 to N
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    seeds: u64,
    /// Only a part of the jobs, to split a run over machines or processes: every N-th from the I-th on
    #[arg(long, value_name = "I/N", default_value_t)]
    shard: Shard,
    /// Only this job, by the id that `otb_eval plan` prints; may be repeated
    #[arg(long, value_name = "ID", conflicts_with = "shard")]
    job: Vec<String>,
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
        Ok(Self { name: folder_name(name)?, file: PathBuf::from(file) })
    }
}

/// Something about a tracker given as NAME=TEXT.
#[derive(Debug, Clone)]
struct OtherTracker {
    name: String,
    text: String,
}

impl FromStr for OtherTracker {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let example = "give NAME=TEXT, for example mil='python -m infopart.trax cv2:TrackerMIL_create'";
        let (name, text) = word.split_once('=').ok_or(example.to_owned())?;
        if text.trim().is_empty() {
            return Err(example.to_owned());
        }
        Ok(Self { name: folder_name(name)?, text: text.to_owned() })
    }
}

fn folder_name(name: &str) -> Result<String, String> {
    let is_plain = |letter: char| letter.is_alphanumeric() || "-_.+".contains(letter);
    if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
        return Err(format!("`{name}` is no name for a folder; use letters, digits, -, _, + and ."));
    }
    Ok(name.to_owned())
}

/// Seconds from a flag.
pub fn parse_seconds(word: &str) -> Result<Duration, String> {
    let seconds = word.parse::<f64>().ok().filter(|seconds| *seconds > 0.0);
    let duration = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    duration.ok_or_else(|| format!("`{word}` is no time; give seconds, for example 600"))
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
        let wanted = |job: &Job| {
            let factory = factories.iter().find(|factory| factory.name() == job.tracker);
            factory.and_then(|factory| factory.most_seeds()).is_none_or(|most| job.seed <= most)
        };
        let jobs: Vec<Job> = jobs.into_iter().filter(wanted).collect();
        Ok(Work {
            factories,
            jobs: if self.job.is_empty() { self.shard.of(jobs) } else { self.chosen(jobs)? },
            store: Store::new(&self.out),
            protocol: self.protocol,
            shift_rules: self.sre_shifts,
            hidden: self.data.hidden()?,
            problems,
        })
    }

    /// The jobs of --job.
    fn chosen(&self, jobs: Vec<Job>) -> Result<Vec<Job>> {
        let ids: HashSet<String> = jobs.iter().map(Job::id).collect();
        if let Some(unknown) = self.job.iter().find(|id| !ids.contains(*id)) {
            let remedy =
                "give one that `otb_eval plan` prints for the same data, trackers, protocol and seeds";
            return Err(BadInput(format!("--job {unknown}: there is no such job; {remedy}")).into());
        }
        Ok(jobs.into_iter().filter(|job| self.job.contains(&job.id())).collect())
    }

    /// Trackers of --tracker and --trackers-file.
    fn others(&self) -> Result<Vec<Box<dyn TrackerFactory>>> {
        let mut listed = match &self.trackers_file {
            Some(path) => {
                TrackerList::read(path).with_context(|| format!("--trackers-file {}", path.display()))?
            }
            None => TrackerList::default(),
        };
        for OtherTracker { name, text } in &self.tracker {
            listed.add(name, text)?;
        }
        for OtherTracker { name, text } in &self.tracker_version {
            listed.set_version(name, text)?;
        }
        let supervisor = match std::env::current_exe() {
            Ok(program) if cfg!(unix) => vec![program, SUPERVISE.into()],
            _ => Vec::new(),
        };
        let options = ExternalOptions { answer_timeout: self.frame_timeout, supervisor };
        Ok(listed.into_trackers(&options).into_iter().map(|tracker| Box::new(tracker) as _).collect())
    }

    fn factories(&self) -> Result<Vec<Box<dyn TrackerFactory>>> {
        let mut factories: Vec<Box<dyn TrackerFactory>> = Vec::new();
        let others = self.others()?;
        let none_own = self.config.is_empty() && others.is_empty();
        let unless_own = if none_own { vec!["infopart".to_owned()] } else { Vec::new() };
        for name in self.trackers.as_ref().unwrap_or(&unless_own) {
            factories.push(named_factory(name).context("--trackers")?);
        }
        for own in &self.config {
            factories.push(Box::new(own.factory()?));
        }
        factories.extend(others);
        let mut names = HashSet::new();
        match factories.iter().find(|factory| !names.insert(factory.name().to_owned())) {
            Some(twice) => Err(BadInput(format!(
                "the tracker `{}` is given twice; give each its own name in --trackers, --config, --tracker and --trackers-file",
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
