//! Runs trackers over sequences: which jobs there are, who makes the trackers, and the jobs in parallel.
//!
//! A job is one tracker with one seed on one segment of one sequence. Jobs have stable ids, which are also where
//! their results go, so that a run can be split over machines, killed and continued.

mod execute;
mod factory;
pub(crate) mod job;
mod plan;
mod pool;

pub use execute::{Conversation, JobFailure, Recording, execute};
pub use factory::{
    ColourFactory, FactoryError, InfoPartFactory, Made, NAMES, OwnFactory, Recorder, TrackerFactory,
    TrackerParameters, named_factory,
};
pub use job::{Job, stem};

pub use plan::{PlanOptions, PlanProblem, Shard, plan};
pub use pool::{Outcome, RunOptions, RunSummary, run_jobs};
