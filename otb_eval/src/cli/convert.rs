//! `otb_eval convert`: results from one toolkit's layout to another's.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use infopart::program::BadInput;
use otb_eval::{
    convert::{Layout, read, write},
    protocol::Protocol,
    results::Results,
};

use super::inputs::{Problems, note};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval convert results pysot_results --from run --to pysot
  otb_eval convert got10k/results flat_results --from got10k --to flat
  otb_eval convert tracker_benchmark/results results --from jwlim --to run --trackers STRUCK,TLD

Layouts:
  run         PROTOCOL/TRACKER/seed_S/SEQ[_SEGMENT].txt, as `otb_eval run` writes; times and confidences beside
  flat        TRACKER/SEQ.txt, SEQ_time.txt and SEQ_confidence.txt beside
  pysot       TRACKER/SEQ.txt, no times
  got10k      OTB2015/TRACKER/SEQ.txt, times/SEQ_time.txt
  got10k-set  TRACKER/SEQ/SEQ_00K.txt, repetition K being a seed; SEQ/SEQ_time.txt, a column a repetition
  pytracking  TRACKER/PARAM[_RRR]/SEQ.txt with tabs, SEQ_time.txt and SEQ_object_presence_scores.txt beside; RRR is the seed
  jwlim       OPE|TRE|SRE/TRACKER/SEQ.json of the Python benchmark: frames/s instead of times

Sequences get the spelling of the layout (Jogging-1, Jogging_1, Jogging.1), and what --prefix says before it; boxes keep every \
digit. uav_ and nfs_ before names are left out when they are read.

The .mat files of the MATLAB benchmark are read by a script with SciPy:
  python3 otb_eval/scripts/mat_to_text.py results_OPE/*.mat --out results

Exit codes: 0 success, 1 internal failure, 2 bad input, or something could not be converted (it is named, and everything \
else is)";

#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// The folder of results to read
    #[arg(value_name = "FROM_DIR")]
    input: PathBuf,
    /// The folder to write to; a tracker that is there already is not overwritten
    #[arg(value_name = "TO_DIR")]
    output: PathBuf,
    /// The layout to read
    #[arg(long, value_name = "LAYOUT")]
    from: Layout,
    /// The layout to write
    #[arg(long, value_name = "LAYOUT")]
    to: Layout,
    /// Only these trackers [default: all there are]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    trackers: Vec<String>,
    /// Put before every sequence's name, as pytracking has uav_ for UAV123 and nfs_ for Need for Speed
    #[arg(long, value_name = "TEXT", default_value = "")]
    prefix: String,
    /// Only results of this protocol [default: all there are]
    #[arg(long, value_name = "ope|tre|sre")]
    protocol: Option<Protocol>,
}

pub fn run(args: &ConvertArgs) -> Result<()> {
    let (mut tracks, unreadable) = read(args.from, &args.input)?;
    let mut problems = Problems::default();
    for problem in &unreadable {
        if problem.is_note() { note(&problem.to_string()) } else { problems.tell(problem) }
    }
    if args.from == Layout::Run {
        let ignored = Results::ignored(&args.input)?;
        if !ignored.is_empty() {
            let input = args.input.display();
            note(&format!(
                "{input}: {} beside ope, tre or sre are left alone, for they are flat",
                ignored.join(", ")
            ));
        }
    }
    let mut there: Vec<String> = tracks.iter().map(|track| track.tracker.clone()).collect();
    there.sort();
    there.dedup();
    if let Some(name) = args.trackers.iter().find(|name| !there.contains(name)) {
        let there = there.join(", ");
        let message = format!("--trackers: there are no results of the tracker `{name}`, but of: {there}");
        return Err(BadInput(message).into());
    }
    tracks.retain(|track| args.trackers.is_empty() || args.trackers.contains(&track.tracker));
    tracks.retain(|track| args.protocol.is_none_or(|protocol| protocol == track.protocol));
    if tracks.is_empty() {
        problems.into_result()?;
        let protocol = args.protocol.map_or("", Protocol::name);
        return Err(BadInput(format!("{}: no results of {protocol} there", args.input.display())).into());
    }
    tracks.iter_mut().for_each(|track| track.sequence.insert_str(0, &args.prefix));
    let files = write(args.to, &args.output, &tracks)?;
    eprintln!("{} results in {files} files written to {}", tracks.len(), args.output.display());
    problems.into_result()
}
