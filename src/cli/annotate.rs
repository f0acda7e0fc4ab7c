//! `infopart annotate`: from key frames to a box in every frame.

use std::{
    io::{self, BufRead, IsTerminal, Write},
    ops::ControlFlow,
    path::PathBuf,
    sync::atomic::Ordering,
};

use anyhow::{Context, Error, Result};
use clap::{Args, ValueEnum, builder::PossibleValue};
use indicatif::{ProgressBar, ProgressStyle};
use infopart::{
    annotate::{
        Annotated, KeptFrames, KeyEntry, Object, PassError, Passes, Pathfinder, Place, Project, ProjectError,
        Sides, VideoInfo, annotate as annotate_object, doubtful_places,
        export::{Format, Tracks},
        keys_of,
    },
    output::OutputError,
    parallel::Threads,
    program::{self, BadInput},
    sequence::OpenOptions,
    tracker::{CheckedParameters, InfoPart, Tracker},
};
use serde::{Deserialize, Serialize};

use super::{
    parameters::ParameterArgs,
    track::thread_pool,
    values::{parse_count, parse_threads},
};

pub const EXAMPLES: &str = "\
Examples:
  infopart annotate walk.mp4 --keys keys.json --out boxes.csv
  infopart annotate shots/ --keys keys.json --out tracks.xml        CVAT for video 1.1
  infopart annotate walk.mp4 --keys keys.json --out labels --format yolo
  infopart annotate walk.mp4 --keys keys.json --project walk.json --out boxes.csv
  infopart annotate walk.mp4 --project walk.json --out coco.json    what walk.json has

Key frames: a JSON file made by hand or by another tool. Frames count from 1; boxes are left, top, width, height in pixels, the \
first pixel being 0; class and colour may be left out:

  {\"version\": 1, \"objects\": [
    {\"name\": \"walker\", \"class\": \"person\", \"colour\": \"#e6194b\", \"keys\": [
      {\"frame\": 1, \"box\": [120, 80, 40, 110]},
      {\"frame\": 90, \"absent\": true},
      {\"frame\": 140, \"box\": [300, 82, 41, 112]}]}]}

From each key frame the tracker goes forward and backward to the next; between two boxes the passes are fused, and a box never \
leaves a key frame. An object that is absent has no box until its next one.

Doubtful places are told on standard error, the most doubtful first: draw the object in the frame that is named, add that \
to the key frames, and run again. With --project only what touches a new key frame is tracked again.

Formats, by the extension of --out or by --format: csv, jsonl, otb (txt; one object, the first pixel being 1), cvat (xml), coco (json), \
mot (MOTChallenge ground truth, the first pixel being 1), yolo (a new folder). csv and jsonl have the confidence of each box, and \
the time of each frame of a video.

--serve: for programs. Each line of standard input is {\"keys\": [...]} as above, and may have \"sides\": \"forward\"; each line of standard \
output {\"boxes\": [[x, y, w, h] or null, ...], \"confidence\": [...], \"doubtful\": [{\"frame\", \"first\", \"last\", \"confidence\"}, \
...], \"tracked\": N} or {\"error\": \"...\"}. What was tracked for one line serves for the next.

Exit codes:
  0    success
  1    internal failure
  2    bad input: a flag, a file or a box
  130  interrupted with Ctrl-C";

#[derive(Debug, Args)]
pub struct AnnotateArgs {
    /// A video, a folder or a quoted glob of images, or a sequence of a benchmark; not a stream, for it is gone through both ways
    input: String,
    /// Which target of a benchmark's folder that has several: only its frames matter here
    #[arg(long, value_name = "K", value_parser = parse_count)]
    target: Option<usize>,
    /// The objects and their key frames, as JSON (below) [default: those of --project]
    #[arg(long, value_name = "FILE.json", required_unless_present_any = ["project", "serve"])]
    keys: Option<PathBuf>,
    /// Where key frames and what was tracked are kept, so that only what changed is tracked the next time; made if it is not there
    #[arg(long, value_name = "FILE.json")]
    project: Option<PathBuf>,
    /// Where the boxes go [default: standard output]
    #[arg(long, value_name = "FILE|FOLDER")]
    out: Option<PathBuf>,
    /// How boxes are written [default: by the extension of --out, else csv]
    #[arg(long)]
    format: Option<FormatName>,
    /// Which ways the tracker goes from a key frame: both, or forward only
    #[arg(long, default_value = "both")]
    sides: SidesName,
    /// How many megabytes of decoded frames are kept; of a longer video parts are decoded again and again
    #[arg(long, value_name = "MB", value_parser = parse_count, default_value = "1024")]
    memory: usize,
    #[command(flatten)]
    parameters: ParameterArgs,
    /// How many threads weigh particles; the boxes do not depend on it [default: one a core]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    /// Answer requests on standard input instead: JSON lines (below)
    #[arg(long, conflicts_with_all = ["keys", "project", "out", "format"])]
    serve: bool,
    /// Make the summary (on standard error) one JSON object
    #[arg(long)]
    json: bool,
    /// No progress bar and no summary (--json still gives its object)
    #[arg(long)]
    quiet: bool,
}

#[derive(Debug, Clone, Copy)]
struct FormatName(Format);

impl ValueEnum for FormatName {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [FormatName; 7] = {
            let mut all = [FormatName(Format::Csv); 7];
            let mut at = 0;
            while at < all.len() {
                all[at] = FormatName(Format::NAMES[at].1);
                at += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Format::NAMES.iter().find(|(_, format)| *format == self.0).map(|(name, _)| PossibleValue::new(*name))
    }
}

#[derive(Debug, Clone, Copy, ValueEnum, Deserialize, Default)]
#[serde(rename_all = "lowercase")]
enum SidesName {
    #[default]
    Both,
    Forward,
}

impl From<SidesName> for Sides {
    fn from(name: SidesName) -> Self {
        match name {
            SidesName::Both => Self::Both,
            SidesName::Forward => Self::Forward,
        }
    }
}

pub fn annotate(args: &AnnotateArgs) -> Result<()> {
    let parameters = args.parameters.resolve()?;
    let mut project = if args.serve { Project::default() } else { args.read_project()? };
    let format = args.checked_format(&project.objects)?;
    let options = OpenOptions { target: args.target, ..OpenOptions::default() };
    let mut frames = KeptFrames::open(&args.input, &options, args.memory.saturating_mul(1 << 20))?;
    let about = frames.about().clone();
    for object in &project.objects {
        check(object, &about)?;
    }
    let threads = match args.threads {
        Some(1) => Threads::Calling,
        Some(threads) => Threads::Pool(thread_pool(threads)?),
        None => Threads::default(),
    };
    let mut tracker =
        || Box::new(InfoPart::with_threads(parameters.clone(), threads.clone())) as Box<dyn Tracker>;
    if args.serve {
        return serve(args, &mut frames, &about, &mut tracker);
    }
    project.forget_what_others_tracked(tracked_by(&parameters, &about));
    let outcome = track_all(args, &mut project, &mut frames, &about, &mut tracker);
    if let Some(path) = &args.project {
        // Also after a failure: what was tracked until then is not tracked again.
        project.write(path).with_context(|| format!("--project {}", path.display()))?;
    }
    let (tracks, tracked) = outcome?;
    write_tracks(args, format, Tracks { about: &about, objects: &project.objects, tracks: &tracks })?;
    tell(args, &project.objects, &about, &tracks, tracked)
}

impl AnnotateArgs {
    /// The objects of --keys with what --project has tracked, or all of --project.
    fn read_project(&self) -> Result<Project> {
        let mut project = match &self.project {
            Some(path) if path.exists() || self.keys.is_none() => read_project("--project", path)?,
            _ => Project::default(),
        };
        if let Some(path) = &self.keys {
            let given = read_project("--keys", path)?;
            let mut passes: Vec<(String, Passes)> =
                project.objects.into_iter().map(|object| object.name).zip(project.passes).collect();
            project.passes = given
                .objects
                .iter()
                .map(|object| {
                    let known = passes.iter_mut().find(|(name, _)| *name == object.name);
                    known.map(|(_, passes)| std::mem::take(passes)).unwrap_or_default()
                })
                .collect();
            project.objects = given.objects;
        }
        if project.objects.is_empty() {
            return Err(BadInput("there is no object: give one with a key frame in --keys".to_owned()).into());
        }
        Ok(project)
    }

    fn checked_format(&self, objects: &[Object]) -> Result<Format> {
        let format = match (self.format, &self.out) {
            (Some(FormatName(format)), _) => format,
            (None, Some(path)) => Format::from_path(path),
            (None, None) => Format::Csv,
        };
        let message = match (format, &self.out) {
            (Format::Yolo, None) => "--format yolo makes a folder: give its path with --out",
            (Format::Yolo, Some(path)) if path.exists() => {
                let message = format!(
                    "--out {}: is there already; yolo makes a new folder: give another path",
                    path.display()
                );
                return Err(BadInput(message).into());
            }
            (Format::Otb, _) if objects.len() > 1 => {
                "otb has no place for several objects: use --format csv, mot, cvat, coco or yolo"
            }
            _ => return Ok(format),
        };
        Err(BadInput(message.to_owned()).into())
    }
}

fn read_project(flag: &str, path: &std::path::Path) -> Result<Project> {
    Project::read(path).map_err(|error: ProjectError| BadInput(format!("{flag} {error}")).into())
}

fn check(object: &Object, about: &VideoInfo) -> Result<()> {
    object.check(about.frames, about.width, about.height).map_err(|error| BadInput(error.to_string()).into())
}

/// What passes follow from, beside key frames.
fn tracked_by(parameters: &CheckedParameters, about: &VideoInfo) -> String {
    let VideoInfo { frames, width, height, first_frame_hash, .. } = about;
    let parameters = serde_json::to_string(&**parameters).unwrap_or_default();
    format!(
        "infopart {}; {frames} frames of {width}x{height}, {first_frame_hash:016x}; {parameters}",
        infopart::VERSION
    )
}

/// Ctrl-C came while tracking.
#[derive(Debug, thiserror::Error)]
#[error("interrupted; nothing was written but what --project keeps")]
pub struct Interrupted;

type TrackerMaker<'a> = dyn FnMut() -> Box<dyn Tracker> + 'a;
type Track = Vec<Option<Annotated>>;

/// The track of each object, and how many frames were tracked for them.
fn track_all(
    args: &AnnotateArgs,
    project: &mut Project,
    frames: &mut KeptFrames,
    about: &VideoInfo,
    tracker: &mut TrackerMaker<'_>,
) -> Result<(Vec<Track>, usize)> {
    let interrupted = program::watch().context("Ctrl-C cannot be watched for")?;
    let bar = progress_bar(args.quiet || (args.out.is_none() && io::stdout().is_terminal()));
    let mut tracked = 0;
    let mut tracks = Vec::new();
    for index in 0..project.objects.len() {
        let mut watch = || {
            tracked += 1;
            bar.inc(1);
            if interrupted.load(Ordering::Relaxed) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let mut finder = Pathfinder { frames: &mut *frames, tracker: &mut *tracker, watch: &mut watch };
        let (object, passes) = (&project.objects[index], &mut project.passes[index]);
        let track = annotate_object(object, about.frames, args.sides.into(), passes, &mut finder);
        tracks.push(track.map_err(|error| explain(error, &args.input))?);
        project.passes[index].forget_unused();
        if let Some(path) = &args.project {
            project.write(path).with_context(|| format!("--project {}", path.display()))?;
        }
    }
    bar.finish_and_clear();
    Ok((tracks, tracked))
}

fn explain(error: PassError, input: &str) -> Error {
    match error {
        PassError::Interrupted => Interrupted.into(),
        other => BadInput(format!("{input}: {other}")).into(),
    }
}

fn progress_bar(is_hidden: bool) -> ProgressBar {
    if is_hidden {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{pos} frames tracked, {per_sec}, {elapsed}");
    ProgressBar::new_spinner().with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()))
}

fn write_tracks(args: &AnnotateArgs, format: Format, tracks: Tracks<'_>) -> Result<()> {
    match &args.out {
        Some(path) => tracks.write(path, format).with_context(|| format!("--out {}", path.display())),
        None => {
            let text = tracks.text(format).unwrap_or_default();
            let failed = |source: io::Error| match source.kind() {
                io::ErrorKind::BrokenPipe => OutputError::Closed,
                _ => OutputError::StandardOutput { source },
            };
            let mut out = io::stdout().lock();
            Ok(out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(failed)?)
        }
    }
}

/// A doubtful place as people count frames.
#[derive(Serialize)]
struct ToldPlace<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    object: Option<&'a str>,
    frame: usize,
    first: usize,
    last: usize,
    confidence: f64,
}

impl<'a> ToldPlace<'a> {
    fn of(object: Option<&'a str>, place: &Place) -> Self {
        let Place { frame, first, last, confidence } = *place;
        Self { object, frame: frame + 1, first: first + 1, last: last + 1, confidence }
    }
}

/// How many doubtful places are told in words.
const MOST_TOLD: usize = 10;

fn tell(
    args: &AnnotateArgs,
    objects: &[Object],
    about: &VideoInfo,
    tracks: &[Track],
    tracked: usize,
) -> Result<()> {
    let mut places: Vec<ToldPlace<'_>> = Vec::new();
    for (object, track) in objects.iter().zip(tracks) {
        places.extend(doubtful_places(track).iter().map(|place| ToldPlace::of(Some(&object.name), place)));
    }
    places.sort_by(|a, b| a.confidence.total_cmp(&b.confidence));
    let boxes: usize = tracks.iter().map(|track| track.iter().flatten().count()).sum();
    let keys: usize = objects.iter().map(|object| object.keys.len()).sum();
    if args.json {
        let summary = serde_json::json!({
            "input": args.input, "frames": about.frames, "objects": objects.len(), "key_frames": keys, "boxes": boxes,
            "tracked": tracked, "doubtful": places,
        });
        eprintln!("{summary}");
    } else if !args.quiet {
        eprintln!(
            "{} frames, {} objects, {keys} key frames: {boxes} boxes; {tracked} frames tracked",
            about.frames,
            objects.len()
        );
        if !places.is_empty() {
            eprintln!("doubtful, the most doubtful first; draw the object there, or mark it absent:");
        }
        for ToldPlace { object, frame, first, last, confidence } in places.iter().take(MOST_TOLD) {
            let object = object.unwrap_or_default();
            eprintln!("  frame {frame} ({first} to {last}), {object:?}, confidence {confidence:.2}");
        }
        if places.len() > MOST_TOLD {
            eprintln!("  and {} more places; --json has them all", places.len() - MOST_TOLD);
        }
    }
    Ok(())
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    keys: Vec<KeyEntry>,
    #[serde(default)]
    sides: SidesName,
}

#[derive(Serialize)]
struct Answer {
    boxes: Vec<Option<[f64; 4]>>,
    confidence: Vec<Option<f64>>,
    doubtful: Vec<ToldPlace<'static>>,
    tracked: usize,
}

/// A request's answer a line, until standard input ends.
fn serve(
    args: &AnnotateArgs,
    frames: &mut KeptFrames,
    about: &VideoInfo,
    tracker: &mut TrackerMaker<'_>,
) -> Result<()> {
    let mut passes = Passes::default();
    let closed = |source| OutputError::StandardOutput { source };
    for line in io::stdin().lock().lines() {
        let line = line.map_err(|error| BadInput(format!("standard input: {error}; send JSON lines")))?;
        let answer = match answer(&line, args, frames, about, tracker, &mut passes) {
            Ok(answer) => serde_json::to_string(&answer)?,
            Err(reason) => serde_json::json!({ "error": reason }).to_string(),
        };
        let mut out = io::stdout().lock();
        writeln!(out, "{answer}").and_then(|()| out.flush()).map_err(closed)?;
    }
    Ok(())
}

fn answer(
    line: &str,
    args: &AnnotateArgs,
    frames: &mut KeptFrames,
    about: &VideoInfo,
    tracker: &mut TrackerMaker<'_>,
    passes: &mut Passes,
) -> Result<Answer, String> {
    let request: Request = serde_json::from_str(line).map_err(|error| error.to_string())?;
    let object = Object {
        name: "object".to_owned(),
        class: "object".to_owned(),
        colour: infopart::annotate::Colour::of_object(0),
        keys: keys_of(&request.keys)?,
    };
    object.check(about.frames, about.width, about.height).map_err(|error| error.to_string())?;
    let mut tracked = 0;
    let mut watch = || {
        tracked += 1;
        ControlFlow::Continue(())
    };
    let mut finder = Pathfinder { frames, tracker, watch: &mut watch };
    let track = annotate_object(&object, about.frames, request.sides.into(), passes, &mut finder)
        .map_err(|error| format!("{}: {error}", args.input))?;
    let numbers = |found: &Annotated| {
        let rect = found.box_in_frame;
        [rect.x, rect.y, rect.w, rect.h]
    };
    Ok(Answer {
        boxes: track.iter().map(|found| found.as_ref().map(numbers)).collect(),
        confidence: track.iter().map(|found| found.map(|found| found.confidence)).collect(),
        doubtful: doubtful_places(&track).iter().map(|place| ToldPlace::of(None, place)).collect(),
        tracked,
    })
}
