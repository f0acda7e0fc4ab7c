//! Jobs in parallel: every worker takes the longest job left, tracks in a thread pool of its own, and hands the result
//! over at once. One job's failure ends no other.

use std::{
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, AtomicUsize, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};

use super::{
    Job, Recording, TrackerFactory,
    execute::{JobFailure, execute},
};

/// How often running jobs are looked at for their time.
const WATCH_INTERVAL: Duration = Duration::from_millis(50);

/// How jobs are run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RunOptions {
    /// Jobs that run at the same time; at least 1.
    pub jobs: usize,
    /// Threads that each job's tracker may use; at least 1.
    pub threads_per_job: usize,
    /// How long one job may take.
    pub timeout: Option<Duration>,
}

/// How one job ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// With a result.
    Done(Recording),
    /// Without one, for this reason.
    Failed(String),
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RunSummary {
    /// Jobs with a result.
    pub done: usize,
    /// Jobs that failed.
    pub failed: usize,
    /// Whether it was interrupted before the last job.
    pub interrupted: bool,
}

/// Runs jobs in their order. `finished` is called with each job as it ends, one at a time; an error of it stops
/// the run.
///
/// # Errors
/// What `finished` or the making of threads returns.
pub fn run_jobs<E: From<rayon::ThreadPoolBuildError>>(
    jobs: &[Job],
    factories: &[Box<dyn TrackerFactory>],
    options: RunOptions,
    interrupted: &AtomicBool,
    mut finished: impl FnMut(&Job, Outcome) -> Result<(), E>,
) -> Result<RunSummary, E> {
    let mut workers = Vec::new();
    for _ in 0..options.jobs.clamp(1, jobs.len().max(1)) {
        workers.push(Worker::new(options)?);
    }
    let next = AtomicUsize::new(0);
    let (ended, endings) = mpsc::channel();
    let mut summary = RunSummary::default();
    let mut failure = None;
    thread::scope(|scope| {
        for worker in &workers {
            let (ended, next) = (ended.clone(), &next);
            scope.spawn(move || worker.work(jobs, next, factories, &ended));
        }
        drop(ended);
        loop {
            match endings.recv_timeout(WATCH_INTERVAL) {
                Ok((job, outcome)) if failure.is_none() => {
                    summary.count(&outcome);
                    failure = finished(job, outcome).err();
                }
                Ok(_) | Err(mpsc::RecvTimeoutError::Timeout) => {}
                Err(mpsc::RecvTimeoutError::Disconnected) => break,
            }
            let closing = failure.is_some() || interrupted.load(Ordering::Relaxed);
            workers.iter().for_each(|worker| worker.watch(closing));
        }
    });
    summary.interrupted = interrupted.load(Ordering::Relaxed);
    failure.map_or(Ok(summary), Err)
}

impl RunSummary {
    fn count(&mut self, outcome: &Outcome) {
        match outcome {
            Outcome::Done(_) => self.done += 1,
            Outcome::Failed(_) => self.failed += 1,
        }
    }
}

/// A thread that works through jobs, and how it is told to stop.
struct Worker {
    pool: rayon::ThreadPool,
    timeout: Option<Duration>,
    /// Since when it has been at its job; `None` between jobs.
    started: Mutex<Option<Instant>>,
    /// Ends the job at hand.
    stop: AtomicBool,
    /// Ends the worker.
    closing: AtomicBool,
}

impl Worker {
    fn new(options: RunOptions) -> Result<Self, rayon::ThreadPoolBuildError> {
        Ok(Self {
            pool: rayon::ThreadPoolBuilder::new().num_threads(options.threads_per_job.max(1)).build()?,
            timeout: options.timeout,
            started: Mutex::new(None),
            stop: AtomicBool::new(false),
            closing: AtomicBool::new(false),
        })
    }

    fn work<'a>(
        &self,
        jobs: &'a [Job],
        next: &AtomicUsize,
        factories: &[Box<dyn TrackerFactory>],
        ended: &mpsc::Sender<(&'a Job, Outcome)>,
    ) {
        while !self.closing.load(Ordering::Relaxed) {
            let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) else { break };
            self.set_started(Some(Instant::now()));
            let outcome = self.pool.install(|| self.run(job, factories));
            self.set_started(None);
            self.stop.store(false, Ordering::Relaxed);
            if outcome.is_some_and(|outcome| ended.send((job, outcome)).is_err()) {
                break;
            }
        }
    }

    /// `None` if the job was stopped with the whole run.
    fn run(&self, job: &Job, factories: &[Box<dyn TrackerFactory>]) -> Option<Outcome> {
        let Some(factory) = factories.iter().find(|factory| factory.name() == job.tracker) else {
            return Some(Outcome::Failed(format!("nobody makes the tracker `{}`", job.tracker)));
        };
        let started = Instant::now();
        let out_of_time = || {
            let seconds = self.timeout.unwrap_or_default().as_secs_f64();
            Some(Outcome::Failed(format!("it took longer than --timeout {seconds}; give it more seconds")))
        };
        match execute(job, factory.as_ref(), &self.stop) {
            // The watch looks only now and then: a job may end between its time and the next look.
            Ok(_) if self.timeout.is_some_and(|timeout| started.elapsed() > timeout) => out_of_time(),
            Ok(recording) => Some(Outcome::Done(recording)),
            Err(JobFailure::Failed(reason)) => Some(Outcome::Failed(reason)),
            Err(JobFailure::Stopped) if self.closing.load(Ordering::Relaxed) => None,
            Err(JobFailure::Stopped) => out_of_time(),
        }
    }

    /// Stops the job at hand if the run is closing or the job's time is up.
    fn watch(&self, closing: bool) {
        if closing {
            self.closing.store(true, Ordering::Relaxed);
        }
        let started = self.started.lock().unwrap_or_else(PoisonError::into_inner);
        let is_over = started.zip(self.timeout).is_some_and(|(started, timeout)| started.elapsed() > timeout);
        if closing || is_over {
            self.stop.store(true, Ordering::Relaxed);
        }
    }

    fn set_started(&self, started: Option<Instant>) {
        *self.started.lock().unwrap_or_else(PoisonError::into_inner) = started;
    }
}
