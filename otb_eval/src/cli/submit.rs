//! `otb_eval submit`: what the servers of GOT-10k and TrackingNet take.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use infopart::program::BadInput;
use otb_eval::{
    protocol::Protocol,
    results::Results,
    submission::{Server, archive},
};

use super::{
    inputs::{DataArgs, Problems, note},
    score::write,
};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval run --data GOT-10k/test --seeds 3 --out results
  otb_eval submit --data GOT-10k/test --results results --tracker infopart --out infopart.zip
  otb_eval submit --data TrackingNet/TEST --results results --tracker infopart --out infopart.zip

GOT-10k: SEQ/SEQ_001.txt and up to two repetitions more, the first three seeds, and SEQ/SEQ_time.txt. TrackingNet: SEQ.txt of the \
first seed. The archive is made only if every sequence of the data has a row a frame, all of them boxes; else everything \
that is missing is told, and the exit code is 2.";

#[derive(Debug, Args)]
pub struct SubmitArgs {
    #[command(flatten)]
    data: DataArgs,
    /// Results: what `run` wrote, RESULTS/TRACKER/SEQ.txt, or the GOT-10k toolkit's RESULTS/TRACKER/SEQ/SEQ_001.txt
    #[arg(long, value_name = "RESULTS")]
    results: PathBuf,
    /// Whose results
    #[arg(long, value_name = "NAME")]
    tracker: String,
    /// Whose server: got10k or trackingnet [default: by the data]
    #[arg(long = "for", value_name = "got10k|trackingnet")]
    server: Option<Server>,
    /// The archive
    #[arg(long, value_name = "FILE.zip")]
    out: PathBuf,
}

pub fn submit(args: &SubmitArgs) -> Result<()> {
    let (mut dataset, mut problems) = args.data.open()?;
    if let Some(names) = args.data.selected()? {
        dataset.targets.retain(|target| names.contains(&target.name));
    }
    let server = args.server.or_else(|| Server::of(dataset.benchmark())).ok_or_else(|| {
        BadInput(
            "--data is neither GOT-10k nor TrackingNet, whose servers are known; say which with --for".into(),
        )
    })?;
    let results = Results::open(&args.results, Protocol::Ope).context("--results")?;
    let results = results.only(std::slice::from_ref(&args.tracker)).context("--tracker")?;
    match archive(server, &dataset, &results.trackers[0]) {
        Ok(bytes) if !dataset.targets.is_empty() => {
            let sequences = dataset.targets.len();
            if sequences != server.sequences() {
                note(&format!(
                    "{sequences} sequences, where the test set of {} has {}: its server may refuse them",
                    server.name(),
                    server.sequences()
                ));
            }
            write(&args.out, &bytes)?;
            eprintln!("{}: {sequences} sequences, {} kB", args.out.display(), bytes.len().div_ceil(1000));
        }
        Ok(_) => problems.tell(&"--data: there is no sequence to put into the archive"),
        Err(found) => tell(&found, &mut problems, &args.out),
    }
    problems.into_result()
}

fn tell(found: &[otb_eval::submission::SubmissionProblem], problems: &mut Problems, out: &std::path::Path) {
    found.iter().for_each(|problem| problems.tell(problem));
    note(&format!("{} is not written: a server takes only whole results", out.display()));
}
