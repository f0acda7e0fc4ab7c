//! Step 4: the rows of ground truth.

use std::fs;

use infopart::{geometry::Rect, sequence::otb_targets};

use super::{Finding, file_name, folder::annotations};
use crate::{
    catalogue,
    dataset::{FrameFolder, Target},
    results::Separators,
};

/// How the target's file is written: what separates numbers, the line ends, and whether the last one is there.
pub(super) fn written(frames: &FrameFolder, findings: &mut Vec<Finding>) -> Option<String> {
    let targets = if frames.path.is_dir() { otb_targets(&frames.path).ok()? } else { Vec::new() };
    for path in annotations(&frames.path) {
        if fs::metadata(&path).is_ok_and(|file| file.len() == 0) {
            findings
                .push(Finding::oddity(format!("{} is empty: that target does not exist", file_name(&path))));
        }
    }
    if targets.len() > 1 {
        let names: Vec<&str> = targets.iter().map(|target| target.name.as_str()).collect();
        findings.push(Finding::oddity(format!("its folder has several targets: {}", names.join(", "))));
    }
    let bytes = fs::read(&frames.ground_truth).ok()?;
    let text = String::from_utf8_lossy(&bytes);
    let Separators { comma, tab, space, .. } = Separators::of(&text);
    let found = [(comma, "comma"), (tab, "tab"), (space, "space")];
    let separators: Vec<&str> = found.iter().filter(|(there, _)| *there).map(|(_, name)| *name).collect();
    if separators.len() > 1 {
        let separators = separators.join(" and ");
        findings.push(Finding::oddity(format!("its rows mix {separators}, which not every toolkit reads")));
    }
    let ends = if text.contains("\r\n") { "CRLF" } else { "LF" };
    let last = if text.ends_with('\n') { "" } else { ", last line without its end" };
    Some(format!("{}, {ends}{last}", separators.join("+")))
}

/// Rows that are no boxes, or boxes that toolkits take for none; and how many there are, beside so many `images`.
pub(super) fn rows(target: &Target, images: Option<usize>, findings: &mut Vec<Finding>) {
    let truth = &target.truth;
    let numbers = |row: &Rect| [row.x, row.y, row.w, row.h];
    let is_nan = |row: &Rect| numbers(row).iter().any(|number| number.is_nan());
    let has_no_area = |row: &Rect| row.w <= 0.0 || row.h <= 0.0;
    let is_at_zero = |row: &Rect| row.is_proper() && (row.x <= 0.0 || row.y <= 0.0);
    let mut tell = |is_odd: &dyn Fn(&Rect) -> bool, what: &str| {
        let odd: Vec<usize> =
            (1..).zip(truth).filter(|(_, row)| is_odd(row)).map(|(number, _)| number).collect();
        if let Some(first) = odd.first() {
            let rows = if odd.len() == 1 { "row" } else { "rows" };
            findings.push(Finding::oddity(format!("{} {rows} {what}; the first is row {first}", odd.len())));
        }
    };
    if target.annotations.first_only {
        findings
            .push(Finding::oddity("only its first box is known: the benchmark's server keeps the others"));
        return;
    }
    tell(&is_nan, "with NaN (the target is absent)");
    tell(&has_no_area, "without area, which toolkits score differently");
    tell(&is_at_zero, "with x or y of 0 or less, which some toolkits take for invalid");
    // Elsewhere fractions are the rule.
    if target.annotations.benchmark.is_none() {
        tell(
            &|row| row.is_proper() && numbers(row).iter().any(|number| number.fract() != 0.0),
            "with fractions",
        );
    }
    of_benchmark(target, findings);
    if !truth.first().is_some_and(Rect::is_proper) {
        let remedy = "write a box there, or remove the frames before the target appears";
        findings.push(Finding::damage(format!("the first row is no box, so no tracker can start; {remedy}")));
    }
    if let Some(known) = catalogue::find(&target.name)
        && truth.len() != known.rows
    {
        findings.push(other_length(truth.len(), known.rows, images));
    }
}

/// What the benchmark says of frames besides their boxes.
fn of_benchmark(target: &Target, findings: &mut Vec<Finding>) {
    let absent = target.annotations.absent.iter().filter(|absent| **absent).count();
    let unseen = target.annotations.cover.iter().filter(|eighths| **eighths == 0).count();
    let rows = |count: usize| if count == 1 { "row" } else { "rows" };
    if absent > 0 {
        findings.push(Finding::oddity(format!("{absent} {} marked as without the target", rows(absent))));
    }
    if unseen > 0 {
        findings.push(Finding::oddity(format!(
            "{unseen} {} in which nothing of the target is seen",
            rows(unseen)
        )));
    }
}

/// A shorter sequence with an image a row was cut on purpose; anything else is an accident.
fn other_length(rows: usize, benchmark: usize, images: Option<usize>) -> Finding {
    let both = format!("{rows} rows, but the benchmark has {benchmark}");
    if rows < benchmark && images == Some(rows) {
        return Finding::oddity(format!(
            "{both}: it was cut, with its images, and its scores are not the benchmark's"
        ));
    }
    Finding::damage(format!(
        "{both}; get the sequence again, or give the folder another name if it is your own cut"
    ))
}
