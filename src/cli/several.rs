//! `infopart track` with several --init: one pass over the frames, a file of rows a target.

use std::{
    io::Write,
    path::{Path, PathBuf},
    sync::{Arc, atomic::Ordering},
};

use anyhow::{Context, Result};
use infopart::{
    geometry::Rect,
    output::{Destination, PartialFile, RowFormat},
    program::{self, BadInput},
    sequence::Sequence,
    tracker::colour::{CheckedColourParameters, ColourFlock},
};
use rayon::ThreadPool;

use super::{first_box::FirstBox, track_args::TrackArgs};

/// What is told when it is over.
pub struct SeveralReport {
    pub frames: usize,
    pub files: Vec<PathBuf>,
}

/// Ctrl-C came.
#[derive(Debug, thiserror::Error)]
#[error("interrupted after {frames} frames; the rows up to there are in {}", files.iter().map(|file| format!("{}.partial", file.display())).collect::<Vec<_>>().join(", "))]
pub struct Interrupted {
    frames: usize,
    files: Vec<PathBuf>,
}

/// Follows every target of --init with one flock.
pub fn track_several(
    args: &TrackArgs,
    boxes: &[Rect],
    mut sequence: Sequence,
    parameters: CheckedColourParameters,
    pool: Option<Arc<ThreadPool>>,
) -> Result<SeveralReport> {
    let out = refuse_other_outputs(args)?;
    let origin = sequence.origin;
    let firsts =
        boxes.iter().map(|given| FirstBox::find(Some(*given), "", &sequence)).collect::<Result<Vec<_>>>()?;
    let names: Vec<PathBuf> = (1..=boxes.len()).map(|number| numbered(out, number)).collect();
    let mut files = names.iter().map(|name| PartialFile::create(name)).collect::<Result<Vec<_>, _>>()?;
    let mut flock = match pool {
        Some(pool) => ColourFlock::with_pool(parameters, pool),
        None => ColourFlock::new(parameters),
    };
    let interrupted = program::watch().context("Ctrl-C cannot be watched for")?;
    let mut frames = 0;
    while let Some(frame) = sequence.source.next_frame()? {
        if interrupted.load(Ordering::Relaxed) {
            return Err(Interrupted { frames, files: names }.into());
        }
        let view = frame.frame.view();
        if frames == 0 {
            let in_frame: Vec<Rect> = firsts.iter().map(|first| first.in_frame).collect();
            let warnings = flock.init(view, &in_frame);
            let warnings = warnings.map_err(|error| BadInput(format!("--init: {}: {error}", frame.label)))?;
            if !args.json {
                for (number, warning) in
                    warnings.iter().enumerate().flat_map(|(i, all)| all.iter().map(move |w| (i + 1, w)))
                {
                    eprintln!("warning: target {number}: {warning}");
                }
            }
            for (file, first) in files.iter_mut().zip(&firsts) {
                write_row(file, first.as_given)?;
            }
        } else {
            let found = flock.update(view).map_err(|error| BadInput(format!("{}: {error}", frame.label)))?;
            for (file, estimate) in files.iter_mut().zip(&found) {
                write_row(file, origin.from_frame(estimate.box_in_frame))?;
            }
        }
        frames += 1;
    }
    if frames == 0 {
        return Err(BadInput(format!("{}: there is no frame to track", args.input)).into());
    }
    for file in &mut files {
        file.complete()?;
    }
    Ok(SeveralReport { frames, files: names })
}

fn write_row(file: &mut PartialFile, row: Rect) -> Result<()> {
    writeln!(file, "{},{},{},{}", row.x, row.y, row.w, row.h).map_err(|error| file.name_error(error).into())
}

fn refuse_other_outputs(args: &TrackArgs) -> Result<&Path> {
    let refused = |message: &str| Err(BadInput(message.to_owned()).into());
    if args.annotate.is_some() {
        return refused("--annotate draws one target; leave it out, or give one --init");
    }
    let Some(out) = &args.out else {
        return refused(
            "several --init need --out FILE: the rows of target K go to FILE with .K before its extension",
        );
    };
    let is_otb = args.format.map_or_else(|| RowFormat::from_path(out), Into::into) == RowFormat::Otb;
    if !is_otb {
        return refused("several --init write plain rows x,y,w,h only; give --out FILE.txt, or --format otb");
    }
    Ok(out)
}

/// `boxes.txt` for target 2: `boxes.2.txt`.
fn numbered(out: &Path, number: usize) -> PathBuf {
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    let name = match out.extension() {
        Some(extension) => format!("{stem}.{number}.{}", extension.to_string_lossy()),
        None => format!("{stem}.{number}"),
    };
    out.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_targets_number_stands_before_the_extension() {
        assert_eq!(numbered(Path::new("a/boxes.txt"), 2), Path::new("a/boxes.2.txt"));
        assert_eq!(numbered(Path::new("boxes"), 10), Path::new("boxes.10"));
    }
}
