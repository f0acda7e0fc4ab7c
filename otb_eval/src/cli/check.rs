//! `otb_eval check`: what data holds, and what is odd or damaged.

use std::{fmt::Write as _, path::PathBuf};

use anyhow::Result;
use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use otb_eval::check::{CheckReport, CheckedTarget, ImageSummary, ListCoverage, Severity, check};

use super::{
    inputs::Problems,
    score::{print, write},
};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval check otb                     # a folder of sequences: people/, ships/ and so on too
  otb_eval check otb/Crossing --decode   # one sequence, every pixel decoded
  otb_eval check LaSOT GOT-10k/val       # other data sets, recognised by what is in their folders
  otb_eval check OTB100.json             # boxes alone: which rows and labels are odd
  otb_eval check otb people --json check.json

A line is a target: rows, images, their size, how the rows are written, its lists. Below it what is odd (commands cope \
with it) and what is DAMAGED (put it right before a run). Without --decode every file is read and one cut short is \
found, but broken pixels inside a whole file are not.

Exit codes: 0 nothing is damaged, 1 internal failure, 2 something is damaged (it is named, everything else is checked)";

#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Data sets or single sequences (OTB, UAV123, LaSOT, GOT-10k, TrackingNet, NfS, VOT, TLD, TC128), or JSON files of boxes
    #[arg(value_name = "DATA", required = true)]
    data: Vec<PathBuf>,
    /// Decode every image, which takes a few milliseconds each
    #[arg(long)]
    decode: bool,
    /// Write everything as JSON, names in every toolkit's spelling too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub fn run(args: &CheckArgs) -> Result<()> {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(4));
    let style = ProgressStyle::with_template("{bar:24.green/black.bright} {pos} of {len}  {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let report = check(&args.data, args.decode, |done, total| {
        bar.set_length(total as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    print(&text(&report))?;
    if let Some(path) = &args.json {
        write(path, format!("{}\n", serde_json::to_string_pretty(&report)?).as_bytes())?;
    }
    let mut problems = Problems::default();
    report.unreadable.iter().for_each(|text| problems.tell(text));
    report.damage().for_each(|(name, text)| problems.tell(&format!("{name}: {text}")));
    problems.into_result()
}

fn text(report: &CheckReport) -> String {
    let mut text: String = report.targets.iter().map(of_target).collect();
    for unreadable in &report.unreadable {
        text += &format!("DAMAGED: {unreadable}\n");
    }
    let count = |severity: Severity| {
        let has = |target: &&CheckedTarget| target.findings.iter().any(|one| one.severity == severity);
        report.targets.iter().filter(has).count()
    };
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "\n{} targets: {} with oddities, {} damaged; {} without a target",
        report.targets.len(),
        count(Severity::Oddity),
        count(Severity::Damage),
        report.unreadable.len()
    );
    report.lists.iter().for_each(|list| text += &of_list(list));
    text
}

fn of_target(target: &CheckedTarget) -> String {
    let mut text = format!("{}: {} rows", target.name, target.rows);
    if let Some(ImageSummary { count, first, last, size }) = &target.images {
        text += &format!(", {count} images");
        if let Some((width, height)) = size {
            text += &format!(" {width}x{height}");
        }
        if let (Some(first), Some(last)) = (first, last) {
            text += &format!(" ({first} to {last})");
        }
    }
    for more in target.written.iter().cloned().chain([target.lists.join(" ")]) {
        if !more.is_empty() {
            text += &format!("; {more}");
        }
    }
    text.push('\n');
    if let Some(labels) = target.attributes.get("tb_100.txt") {
        text += &format!("  attributes in tb_100.txt: {labels}\n");
    }
    for finding in &target.findings {
        let severity = match finding.severity {
            Severity::Oddity => "odd",
            Severity::Damage => "DAMAGED",
        };
        text += &format!("  {severity}: {}\n", finding.text);
    }
    text
}

/// A list is told with what is missing if that is little.
fn of_list(ListCoverage { list, sequences, missing }: &ListCoverage) -> String {
    let there = sequences - missing.len();
    let missing = match missing.len() {
        1..=5 => format!(" (without {})", missing.join(", ")),
        _ => String::new(),
    };
    format!("{list}: {there} of {sequences}{missing}\n")
}
