//! `infopart demo`: a rendered walker, tracked by its part and by its whole body, and one who leaves and comes back, to look
//! at.

use std::{io::Write, path::PathBuf, sync::atomic::AtomicBool};

use anyhow::{Context, Result};
use clap::Args;
use infopart::{
    geometry::Region,
    output::{
        ContactSheet, Destination, Observer, PartialFile, Progress, RowFormat, RowOptions, RowWriter,
        SheetSampler, StandardOutput, Tile,
    },
    program::{self, BadInput},
    run::{RunReport, run, tracker_title},
    sequence::{self, Absence, Occluder, OpenOptions, Walker, WalkerOptions},
    tracker::{CheckedParameters, InfoPart, Parameters},
};

use super::demo_folder::DemoFolder;

pub const EXAMPLES: &str = "\
The person walks 150 frames down a street, while the legs swing, the light and the person's size change, and a \
young tree passes in front. The same tracker then follows the upper 5/8 of the first box (infopart) and all of it \
(whole-body). In a second scene the person leaves at the right, and comes back at the left (leaving): lost, searched and \
found again. A table of all three is printed. It takes some seconds.

Examples:
  infopart demo                       everything into ./infopart-demo
  infopart demo --out /tmp/walk --seed 7

Written into DIR:
  walker/            an OTB folder: 150 pictures and exact boxes
  leaving/           another: the person is away for a while
  results/           the boxes: infopart.txt, whole-body.txt, leaving.txt
  contact_sheet.png  frames of each, annotated
An earlier demo is replaced; a folder that holds anything else is refused.

Exit codes: 0 success, 2 DIR cannot be used, 130 interrupted with Ctrl-C";

/// What the sheet shows, counted from 1: the walk, and around frame 84 the person behind the young tree.
const FRAMES_ON_SHEET: [usize; 8] = [1, 40, 72, 80, 84, 88, 112, 150];
/// The share of a frame around the person that the sheet shows.
const SHOWN: f64 = 0.6;
/// Frames of the scene in which the person leaves.
const LEAVING_FRAMES: usize = 280;
const COLUMNS: u32 = 4;
const TILE_WIDTH: u32 = 320;

#[derive(Debug, Args)]
pub struct DemoArgs {
    /// Where everything is written
    #[arg(long, value_name = "DIR", default_value = "infopart-demo")]
    out: PathBuf,
    /// The seed of the rendered street and of both trackers
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

pub fn demo(args: &DemoArgs) -> Result<()> {
    let [part, whole] = [Region::Part, Region::Whole].map(|region| parameters(args.seed, region));
    let (part, whole) = (part?, whole?);
    let walk = Walker::new(WalkerOptions {
        seed: args.seed,
        occluder: Occluder::YoungTree,
        ..WalkerOptions::default()
    });
    let leaving = Walker::new(WalkerOptions {
        seed: args.seed,
        frames: LEAVING_FRAMES,
        absence: Absence::Leaves,
        ..WalkerOptions::default()
    });
    let folder = DemoFolder::claim(&args.out, walk.ground_truth().len(), leaving.ground_truth().len())?;
    let interrupted = program::watch().context("Ctrl-C cannot be watched for")?;
    for (walker, into) in [(&walk, folder.walker()), (&leaving, folder.leaving())] {
        let frames = walker.ground_truth().len();
        eprintln!("rendering {frames} frames of a walking person into {}", into.display());
        walker.write_otb_folder(&into).context("--out")?;
    }
    let walked = |parameters: &CheckedParameters, what| Pass {
        title: tracker_title("infopart", parameters.region),
        what,
        input: folder.walker(),
        frames_on_sheet: FRAMES_ON_SHEET.to_vec(),
        shown: SHOWN,
    };
    let passes = [
        (walked(&part, "the upper 5/8 is tracked"), &part),
        (walked(&whole, "the whole box is tracked"), &whole),
        (leaves_and_returns(&folder, &leaving), &part),
    ];
    let mut finished = Vec::new();
    for (pass, parameters) in passes {
        finished.push(track(&folder, pass, parameters, interrupted)?);
    }
    contact_sheet(&finished).save(&folder.contact_sheet())?;
    tell(&folder, &finished)
}

/// Shown before the person leaves, while the street is empty, and when the person is back.
fn leaves_and_returns(folder: &DemoFolder, walker: &Walker) -> Pass {
    let truth = walker.ground_truth();
    let leaves = truth.iter().position(Option::is_none).unwrap_or(truth.len());
    let back = truth.iter().rposition(Option::is_none).map_or(truth.len(), |last| last + 1);
    // Counted from 1, these are the last frame with the person in it, and the first after that.
    let frames =
        [1, leaves.saturating_sub(12), leaves + 4, leaves.midpoint(back), back + 10, back + 16, back + 40];
    Pass {
        title: "leaving".to_owned(),
        what: "the person leaves at the right and comes back at the left: dashed, where it is searched",
        input: folder.leaving(),
        frames_on_sheet: frames.into_iter().chain([truth.len()]).collect(),
        shown: 1.0,
    }
}

fn parameters(seed: u64, region: Region) -> Result<CheckedParameters> {
    let mut parameters = Parameters::default();
    parameters.seed = seed;
    parameters.region = region;
    parameters.check().context("--seed")
}

/// A tracker's way through a sequence.
struct Pass {
    title: String,
    what: &'static str,
    /// An OTB folder.
    input: PathBuf,
    /// Counted from 1.
    frames_on_sheet: Vec<usize>,
    /// The share of a frame around the person that the sheet shows.
    shown: f64,
}

/// What became of it.
struct Finished {
    pass: Pass,
    report: RunReport,
    tiles: Vec<Tile>,
}

/// Tracks the person from the written folder, as `infopart track` would.
fn track(
    folder: &DemoFolder,
    pass: Pass,
    parameters: &CheckedParameters,
    interrupted: &AtomicBool,
) -> Result<Finished> {
    let input = pass.input.display().to_string();
    let mut sequence = sequence::open(&input, &OpenOptions::default())?;
    let first_box = sequence.ground_truth.first().copied().flatten();
    let first_box = first_box.ok_or_else(|| BadInput(format!("{input}: no box in the first frame")))?;
    let mut tracker = InfoPart::new(parameters.clone());
    let (format, origin) = (RowFormat::Otb, sequence.origin);
    let options = RowOptions { format, origin, initial_box_as_given: None, timing: false };
    let mut rows = RowWriter::new(PartialFile::create(&folder.result(&pass.title))?, options);
    let mut sampler = SheetSampler::at(&pass.frames_on_sheet).close_up(pass.shown);
    let mut progress = Progress::new(sequence.source.remaining());
    let mut observers: [&mut dyn Observer; 3] = [&mut rows, &mut sampler, &mut progress];
    let report = run(
        sequence.source.as_mut(),
        &sequence.ground_truth,
        &mut tracker,
        first_box,
        &mut observers,
        interrupted,
    )?;
    Ok(Finished { pass, report, tiles: sampler.into_tiles() })
}

fn contact_sheet(passes: &[Finished]) -> ContactSheet {
    let mut sheet = ContactSheet::new(
        "infopart demo: a walker, crossed by a young tree near frame 84, and one who leaves",
        COLUMNS,
        TILE_WIDTH,
    );
    for finished in passes {
        sheet.section(heading(finished), finished.tiles.clone());
    }
    sheet
}

fn heading(Finished { pass, report, .. }: &Finished) -> String {
    let scores = report
        .scores
        .map(|scores| format!("   R1 {:.1} %   R2 {:.1} %   AUC {:.3}", scores.r1, scores.r2, scores.auc));
    format!("{} ({}){}", pass.title, pass.what, scores.unwrap_or_default())
}

fn tell(folder: &DemoFolder, passes: &[Finished]) -> Result<()> {
    let mut output = StandardOutput::new();
    let text = format!("{}\n{}", table(passes), next_steps(folder, passes));
    output.write_all(text.as_bytes()).map_err(|error| output.name_error(error))?;
    Ok(output.complete()?)
}

fn table(passes: &[Finished]) -> String {
    let mut text = format!(
        "{:<11}{:>8}{:>9}{:>8}{:>10}{:>11}{:>6}\n",
        "tracker", "R1 %", "R2 %", "AUC", "frames/s", "uncertain", "lost"
    );
    for Finished { pass: Pass { title, .. }, report, .. } in passes {
        let (r1, r2, auc) =
            report.scores.map_or((0.0, 0.0, 0.0), |scores| (scores.r1, scores.r2, scores.auc));
        let speed = report.frames_per_second.unwrap_or_default();
        let (uncertain, lost) = (report.uncertain_frames, report.lost_frames);
        text += &format!("{title:<11}{r1:>8.2}{r2:>9.2}{auc:>8.3}{speed:>10.1}{uncertain:>11}{lost:>6}\n");
    }
    text + "\
R1: frames with a centre error of at most 20 pixels. R2: overlap greater than 0.5. AUC: area under the success
curve, at most 0.952. frames/s: updates only. uncertain, lost: frames of which the tracker says so itself.
"
}

fn next_steps(folder: &DemoFolder, passes: &[Finished]) -> String {
    let sheet = folder.contact_sheet();
    let (walker, annotated) = (quoted(folder.walker()), quoted(folder.annotated()));
    let mut text = format!("look at   {}\n", sheet.display());
    for finished in passes {
        text += &format!("boxes     {}\n", folder.result(&finished.pass.title).display());
    }
    text + &format!("run next  infopart track {walker} --annotate {annotated}\n")
}

/// A path as a shell takes it.
fn quoted(path: PathBuf) -> String {
    let text = path.display().to_string();
    let is_plain = |letter: char| letter.is_alphanumeric() || "/\\._-:".contains(letter);
    if text.chars().all(is_plain) { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
}
