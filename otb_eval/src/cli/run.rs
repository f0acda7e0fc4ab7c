//! `otb_eval run`: all jobs in parallel.

use std::{num::NonZeroUsize, thread, time::Duration};

use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use infopart::program;
use otb_eval::{
    results::{Kept, kept},
    runner::{Job, Outcome, RunOptions, RunSummary, run_jobs},
    store::{Identity, Machine, StoreError},
};

use super::{
    inputs::note,
    jobs::{JobArgs, Work, parse_seconds},
};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval run --data otb people --sequences people8 --trackers infopart,whole-body --out results
  otb_eval run --data otb people --sequences people8 --seeds 5 --protocol tre --out results

Half of the jobs here and, with --shard 2/2, the other half elsewhere, into one folder or two:
  otb_eval run --data otb --sequences person --out results --shard 1/2

A tracker of your own, from `infopart config > fast.toml` and an editor:
  otb_eval run --data otb/Crossing --config fast=fast.toml --out results

A tracker of anybody's, in any language, that speaks TraX on standard input and output; docs/trackers.md has more:
  otb_eval run --data otb --tracker mil='python -m infopart.trax cv2:TrackerMIL_create' --timeout 600 --out results

Each job of such a tracker starts its own process, and a crash, a hang or nonsense fails that job alone. It is told its seed in \
INFOPART_SEED. Times are its own if it tells them with every answer, else from a frame sent to its answer; SEQ.external.json \
says which, and has the latter. Starting it belongs to neither. Its results are not promised to come out the same again.

Every result is written whole, when its job ends. Run the same command again to continue where it was stopped; jobs \
that failed are tried again. Results of other parameters or another version are refused, not mixed. The boxes do not \
depend on --jobs, --shard or on interruptions; times do.

A result that is there counts as done only if it is whole: its rows, numbers, times and checksum are looked at, and a \
damaged one is told and made again.

tre starts where the benchmark's rule says, on no frame of its lists of hidden frames (initOmit), which are built in; \
--init-omit gives others. On 22 of the 100 targets the published runs start elsewhere all the same.

Exit codes: 0 success, 1 internal failure, 2 bad input or failed jobs (the others are done), 130 interrupted";

#[derive(Debug, Args)]
pub struct RunArgs {
    #[command(flatten)]
    jobs_of: JobArgs,
    /// How many jobs run at the same time; the cores are shared among them [default: one a core]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Fail a job that takes longer than S seconds [default: none does]
    #[arg(long, value_name = "S", value_parser = parse_seconds)]
    timeout: Option<Duration>,
}

pub fn run(args: &RunArgs) -> Result<()> {
    let mut work = args.jobs_of.work()?;
    let options = args.options();
    prepare(&mut work);
    claim(&work, options)?;
    let total = work.jobs.len();
    let left: Vec<Job> = work.jobs.iter().filter(|job| !is_done(&work, job)).cloned().collect();
    let interrupted = program::watch().context("Ctrl-C cannot be watched for")?;
    let progress = Progress::new(&left);
    let summary = run_jobs(&left, &work.factories, options, interrupted, |job, outcome| -> Result<()> {
        match outcome {
            Outcome::Done(recording) => work.store.keep(job, &recording)?,
            Outcome::Failed(reason) => {
                work.store.keep_failure(job, &reason)?;
                progress.bar.suspend(|| work.problems.tell(&format!("{}: {reason}", job.id())));
            }
        }
        progress.count(job);
        Ok(())
    })?;
    progress.bar.finish_and_clear();
    tell(&work, summary, total, left.len());
    if summary.interrupted && summary.done + summary.failed < left.len() {
        return Err(Interrupted.into());
    }
    work.problems.into_result()
}

/// The run was stopped by Ctrl-C; what is done is kept.
#[derive(Debug, thiserror::Error)]
#[error("interrupted; run the same command again to go on")]
pub struct Interrupted;

impl RunArgs {
    fn options(&self) -> RunOptions {
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let jobs = self.jobs.map_or(cores, usize::from);
        RunOptions { jobs, threads_per_job: (cores / jobs).max(1), timeout: self.timeout }
    }
}

/// Whether a job's result is there; one that is damaged is told, and made again.
fn is_done(work: &Work, job: &Job) -> bool {
    let there = kept(work.store.root(), job);
    if let Kept::Damaged(damage) = &there {
        note(&format!("{}: the result there is damaged, and is made again: {damage}", job.id()));
    }
    there == Kept::Whole
}

/// Hears what trackers in other processes say of themselves; of one that says nothing sensible no job is run.
fn prepare(work: &mut Work) {
    let Work { factories, jobs, problems, .. } = work;
    factories.retain(|factory| jobs.iter().any(|job| job.tracker == factory.name()));
    factories.retain_mut(|factory| match factory.prepare() {
        Ok(()) => true,
        Err(error) => {
            problems.tell(&error);
            jobs.retain(|job| job.tracker != factory.name());
            false
        }
    });
}

/// Makes sure that every tracker's folder is of the same parameters, before anything is run.
fn claim(work: &Work, options: RunOptions) -> Result<(), StoreError> {
    let machine = Machine::here(options.jobs, options.threads_per_job);
    for factory in &work.factories {
        let (program, parameters) = (factory.program(), factory.parameters());
        let identity =
            Identity::new(factory.name(), program, parameters, work.protocol, work.shift_rules, &work.hidden);
        work.store.claim(&identity, &machine)?;
    }
    Ok(())
}

/// A bar over the frames of all jobs, hidden off a terminal.
struct Progress {
    bar: ProgressBar,
}

impl Progress {
    fn new(left: &[Job]) -> Self {
        let frames = left.iter().map(|job| job.frames as u64).sum();
        let bar = ProgressBar::with_draw_target(Some(frames), ProgressDrawTarget::stderr_with_hz(4));
        let style = "{bar:24.green/black.bright} {percent:>3} %  {eta} left  {msg}";
        bar.set_style(ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.set_message(format!("{} jobs", left.len()));
        Self { bar }
    }

    fn count(&self, job: &Job) {
        self.bar.inc(job.frames as u64);
        self.bar.set_message(job.id());
    }
}

fn tell(work: &Work, summary: RunSummary, total: usize, left: usize) {
    let RunSummary { done, failed, .. } = summary;
    let there = total - left;
    let out = work.store.root().display();
    eprintln!("{total} jobs: {there} were there, {done} done, {failed} failed; results in {out}");
}
