//! `otb_eval plan`: the jobs as JSON lines.

use std::io::Write;

use anyhow::Result;
use clap::Args;
use infopart::output::{Destination, StandardOutput};

use otb_eval::results::{Kept, kept};

use super::jobs::JobArgs;

pub const EXAMPLES: &str = "\
Examples:
  otb_eval plan --data otb --out results --sequences people8 --protocol tre --seeds 5
  otb_eval plan --data otb --out results | jq -r 'select(.done | not) | .id'

A line is a job, longest first: its id (and the path of its result below RESULTS), tracker, seed, sequence, segment, \
first frame, first box, number of frames, and whether it is done.";

#[derive(Debug, Args)]
pub struct PlanArgs {
    #[command(flatten)]
    jobs: JobArgs,
}

pub fn plan(args: &PlanArgs) -> Result<()> {
    let work = args.jobs.work()?;
    let mut output = StandardOutput::new();
    for job in &work.jobs {
        let line = job.to_json(kept(work.store.root(), job) == Kept::Whole);
        writeln!(output, "{line}").map_err(|error| output.name_error(error))?;
    }
    output.complete()?;
    work.problems.into_result()
}
