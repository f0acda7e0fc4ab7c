//! `mot compare`: how well each filter predicts, beside the paper's table.

use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

use anyhow::Result;
use clap::Args;
use infopart::{
    geometry::Rect,
    output::{OutputError, TextTable},
    program::BadInput,
    sequence::{OpenOptions, open},
};
use multi_object::{
    comparison::{
        FilterRun, FrameMeasures, Measures, PaperRow, Sample, Visibility, mean_over_frames, paper_row,
        run_filter,
    },
    line_plot::{Curve, LinePlot},
    motion::{ConstantTurn, ConstantVelocity, FilterKind, FilterOptions},
    tracking::{Detector, TrackingParameters, USUAL_MIN_AREA},
};

use super::deliver;

pub const EXAMPLES: &str = "\
Examples:
  mot compare view1_vtest.avi atrium.mp4 --out comparison
  mot compare Sample1.mp4 --particles 1000 --seeds 5

For each video the detections are found once, and each filter tracks them by itself: under constant velocity (cv) KF, EKF, UKF \
and PF, under constant turn rate and speed (ctrv) EKF, UKF and PF. Printed are RMSE / overlap / accuracy against the \
detections, before and after each correction, and the paper's beside; the means over seeds for PF. With --out also per-frame \
CSV (FILE.csv) and a plot of each video and model (FILE.svg).";

/// The filters of each model, constant turn not being linear.
const NONLINEAR: [FilterKind; 3] = [FilterKind::Ekf, FilterKind::Ukf, FilterKind::Pf];
/// Frames that a plotted curve is the running mean of.
const SMOOTHING: usize = 15;

#[derive(Debug, Args)]
pub struct CompareArgs {
    /// Videos (need ffmpeg), or folders of images, of a static camera
    #[arg(required = true)]
    videos: Vec<String>,
    /// Particles of a track, for PF
    #[arg(long, default_value_t = 300, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    particles: u32,
    /// PF runs with seeds 1 to this, and its figures are means over them
    #[arg(long, default_value_t = 1, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..=100))]
    seeds: u64,
    /// Smallest object, pixels
    #[arg(long, default_value_t = USUAL_MIN_AREA, value_name = "PIXELS")]
    min_area: usize,
    /// A folder for per-frame CSV files and plots
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Motion {
    Cv,
    Ctrv,
}

impl Motion {
    fn name(self) -> &'static str {
        match self {
            Self::Cv => "cv",
            Self::Ctrv => "ctrv",
        }
    }

    fn filters(self) -> &'static [FilterKind] {
        match self {
            Self::Cv => &FilterKind::ALL,
            Self::Ctrv => &NONLINEAR,
        }
    }
}

/// One filter under one model on one video, a run a seed.
struct Compared {
    filter: FilterKind,
    runs: Vec<FilterRun>,
}

pub fn compare(args: &CompareArgs) -> Result<()> {
    if let Some(folder) = &args.out {
        fs::create_dir_all(folder).map_err(|source| OutputError::Io { path: folder.clone(), source })?;
    }
    for video in &args.videos {
        let (name, detections) = detect(video, args.min_area)?;
        for motion in [Motion::Cv, Motion::Ctrv] {
            let compared: Vec<Compared> = motion
                .filters()
                .iter()
                .map(|&filter| run_seeds(args, motion, filter, &detections))
                .collect::<Result<_>>()?;
            deliver(None, &report(&name, motion, &compared, detections.len()))?;
            if let Some(folder) = &args.out {
                write_files(folder, &name, motion, &compared)?;
            }
        }
    }
    Ok(())
}

/// The name of the video, and what is detected in each frame.
fn detect(video: &str, min_area: usize) -> Result<(String, Vec<Vec<Rect>>)> {
    let mut sequence = open(video, &OpenOptions::default())?;
    let mut detector = Detector::new(min_area)?;
    let mut detections = Vec::new();
    while let Some(frame) = sequence.source.next_frame()? {
        let detected = detector.detect(frame.frame.view());
        let (boxes, warning) =
            detected.map_err(|error| BadInput(format!("{video}, {}: {error}", frame.label)))?;
        if let Some(warning) = warning {
            eprintln!("warning: {video}: {warning}");
        }
        detections.push(boxes);
    }
    Ok((sequence.name, detections))
}

fn run_seeds(
    args: &CompareArgs,
    motion: Motion,
    filter: FilterKind,
    detections: &[Vec<Rect>],
) -> Result<Compared> {
    let seeds = if filter == FilterKind::Pf { args.seeds } else { 1 };
    let run = |seed| {
        let filter_options = FilterOptions { particles: args.particles as usize, seed };
        let parameters = TrackingParameters { filter, filter_options, ..TrackingParameters::default() };
        match motion {
            Motion::Cv => run_filter::<ConstantVelocity, 4>(detections, parameters),
            Motion::Ctrv => run_filter::<ConstantTurn, 5>(detections, parameters),
        }
    };
    Ok(Compared { filter, runs: (1..=seeds).map(run).collect::<Result<_, _>>()? })
}

/// Which box of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Moment {
    Before,
    After,
}

fn frames_of(run: &FilterRun, moment: Moment, wanted: impl Fn(&Sample) -> bool) -> Vec<FrameMeasures> {
    let samples = run.samples.iter().filter(|sample| wanted(sample));
    FrameMeasures::of(samples.filter_map(|sample| {
        let found = match moment {
            Moment::Before => Some(sample.predicted),
            Moment::After => sample.corrected,
        };
        found.map(|found| (sample.frame, sample.truth, found))
    }))
}

impl Compared {
    /// The means over frames and then over seeds.
    fn mean(&self, moment: Moment, wanted: impl Fn(&Sample) -> bool) -> Option<Measures> {
        let of_runs: Vec<Measures> =
            self.runs.iter().filter_map(|run| mean_over_frames(&frames_of(run, moment, &wanted))).collect();
        let mean = |of: fn(&Measures) -> f64| of_runs.iter().map(of).sum::<f64>() / of_runs.len() as f64;
        (!of_runs.is_empty()).then(|| Measures {
            rmse: mean(|one| one.rmse),
            overlap: mean(|one| one.overlap),
            accuracy: mean(|one| one.accuracy),
            boxes: of_runs.iter().map(|one| one.boxes).sum::<usize>() / of_runs.len(),
        })
    }

    fn prediction_microseconds(&self) -> Option<f64> {
        let times = self.runs.iter().filter_map(|run| run.prediction_time);
        let (sum, count) =
            times.fold((0.0, 0u32), |(sum, count), time| (sum + time.as_secs_f64() * 1e6, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    }
}

/// What Table III's rows are of: every sample that was detected.
fn is_seen(sample: &Sample) -> bool {
    sample.visibility != Visibility::Hidden
}

fn report(name: &str, motion: Motion, compared: &[Compared], frames: usize) -> String {
    let mut table =
        TextTable::new(["", "before correction", "after correction", "the paper", "µs a prediction"]);
    let mut split = TextTable::new(["before correction", "free", "overlapping", "hidden"]);
    for one in compared {
        let title = one.filter.title().to_owned();
        let paper = paper_row(name, one.filter)
            .map(|PaperRow { rmse, overlap, accuracy }| format!("{rmse:.4} / {overlap:.4} / {accuracy:.4}"));
        let time = one.prediction_microseconds().map(|time| format!("{time:.2}"));
        let [before, after] = [Moment::Before, Moment::After].map(|moment| cell(one.mean(moment, is_seen)));
        table.row([title.clone(), before, after, paper.unwrap_or("-".into()), time.unwrap_or("-".into())]);
        let of = |visibility| one.mean(Moment::Before, |sample| sample.visibility == visibility);
        let cells = Visibility::ALL.map(|visibility| with_count(of(visibility)));
        split.row(std::iter::once(title).chain(cells));
    }
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "{name}, {frames} frames, {}: RMSE (pixels) / overlap / accuracy against the detections\n\n{table}\n{split}",
        motion.name()
    );
    text
}

fn cell(measures: Option<Measures>) -> String {
    measures.map_or("-".into(), |one| format!("{:.4} / {:.4} / {:.4}", one.rmse, one.overlap, one.accuracy))
}

/// With how many boxes it is of.
fn with_count(measures: Option<Measures>) -> String {
    measures.map_or("-".into(), |one| format!("{} ({})", cell(Some(one)), one.boxes))
}

fn write_files(folder: &Path, name: &str, motion: Motion, compared: &[Compared]) -> Result<()> {
    let stem = format!("{name}_{}", motion.name());
    let mut csv = String::from("frame,filter,seed,moment,visibility,boxes,rmse,overlap,accuracy\n");
    let mut curves = Vec::new();
    for one in compared {
        for (index, run) in one.runs.iter().enumerate() {
            for moment in [Moment::Before, Moment::After] {
                write_rows(&mut csv, one.filter, index + 1, run, moment);
            }
        }
        let first = one.runs.first().map(|run| frames_of(run, Moment::Before, is_seen)).unwrap_or_default();
        curves.push(Curve { name: one.filter.title().to_owned(), points: smoothed(&first) });
    }
    deliver(Some(&folder.join(format!("{stem}.csv"))), &csv)?;
    let plot = LinePlot {
        title: format!("{name}, {}: error of the predictions, mean over {SMOOTHING} frames", motion.name()),
        x_label: "frame".into(),
        y_label: "RMSE, pixels".into(),
        curves,
    };
    deliver(Some(&folder.join(format!("{stem}.svg"))), &plot.to_svg())
}

fn write_rows(csv: &mut String, filter: FilterKind, seed: usize, run: &FilterRun, moment: Moment) {
    let moment_name = if moment == Moment::Before { "before" } else { "after" };
    for visibility in Visibility::ALL {
        for frame in frames_of(run, moment, |sample| sample.visibility == visibility) {
            let Measures { rmse, overlap, accuracy, boxes } = frame.measures;
            // Writing to a String cannot fail.
            let _ = writeln!(
                csv,
                "{},{},{seed},{moment_name},{},{boxes},{rmse},{overlap},{accuracy}",
                frame.frame,
                filter.title(),
                visibility.title()
            );
        }
    }
}

/// The running mean of the RMSE.
fn smoothed(frames: &[FrameMeasures]) -> Vec<(f64, f64)> {
    let windows = frames.windows(SMOOTHING.min(frames.len().max(1)));
    windows
        .map(|window| {
            let sum: f64 = window.iter().map(|frame| frame.measures.rmse).sum();
            (window[window.len() / 2].frame as f64, sum / window.len() as f64)
        })
        .collect()
}
