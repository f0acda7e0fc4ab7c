//! `infopart estimate`: state estimators compared, away from images.

use std::{fmt::Write as _, io::Write, path::PathBuf};

use anyhow::{Context, Result};
use clap::{Args, Subcommand, ValueEnum};
use infopart::{
    bayes::unscented::MeasuredPoints,
    experiments::van_der_pol::{
        Comparison, Convergence, ExperimentError, Filter, NoiseShape, PUBLISHED_EKF_RMSE, Setup, calibrated,
        compare, convergence, plot,
    },
    output::{Destination, PartialFile, StandardOutput},
    program::BadInput,
};
use rayon::ThreadPoolBuilder;
use serde::Serialize;

use super::values::{parse_count, parse_positive, parse_threads};

pub const EXAMPLES: &str = "\
Examples:
  infopart estimate van-der-pol --runs 100                     a table in seconds
  infopart estimate van-der-pol --noise bimodal --mu 3         another noise, a stronger non-linearity
  infopart estimate convergence                                particles against the exact filter

Exit codes: 0 success, 1 internal failure, 2 bad input: a flag or a file, 130 interrupted with Ctrl-C";

const VAN_DER_POL: &str = "\
For each process variance q: the errors and times of the extended and the unscented Kalman filter and of particle \
filters on the same measurements, means over the runs with intervals of 95 % confidence, and whether each filter errs \
more than the next. Without --measurement-noise the measurements' variance r is the one at which the extended filter \
has the published RMSE of 0.0328 in Gaussian noise at mu 1.

RMSE: root of the mean squared error over the 101 samples of a run. bias: root of the mean over samples of the squared \
mean error of x over runs. NEES: normalised estimation error squared, 2 if a filter's covariance is right.

Examples:
  infopart estimate van-der-pol                                1000 runs at five q; takes minutes
  infopart estimate van-der-pol --runs 100 --process-noise 1e-3
  infopart estimate van-der-pol --mu 3 --noise student --particles 500
  infopart estimate van-der-pol --runs 100 --plot states.svg --json scores.json

--plot draws run 0 at the middle one of the q. Results, but for times, do not depend on --threads.

Exit codes: 0 success, 1 internal failure, 2 bad input: a flag or a file, 130 interrupted with Ctrl-C";

const CONVERGENCE: &str = "\
The root mean squared difference of a particle filter's estimate from that of one with very many particles, on the same \
measurements, and the slope of its logarithm over that of the particles: -0.5 in theory.

Examples:
  infopart estimate convergence                                takes minutes
  infopart estimate convergence --reference 100000 --particles 100,400,1600

Exit codes: 0 success, 1 internal failure, 2 bad input: a flag or a file, 130 interrupted with Ctrl-C";

#[derive(Debug, Args)]
pub struct EstimateArgs {
    #[command(subcommand)]
    experiment: Experiment,
}

#[derive(Debug, Subcommand)]
enum Experiment {
    /// Compare Kalman and particle filters on a Van der Pol oscillator
    #[command(after_help = VAN_DER_POL)]
    VanDerPol(VanDerPolArgs),
    /// Measure how fast a particle filter nears the exact filter as its particles grow
    #[command(after_help = CONVERGENCE)]
    Convergence(ConvergenceArgs),
}

/// The distribution of measurement errors.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Noise {
    /// Normal
    Gauss,
    /// Student's t with 3 degrees of freedom: heavy tails
    Student,
    /// Two modes, hardly ever near 0
    Bimodal,
}

impl From<Noise> for NoiseShape {
    fn from(noise: Noise) -> Self {
        match noise {
            Noise::Gauss => Self::Gauss,
            Noise::Student => Self::Student,
            Noise::Bimodal => Self::Bimodal,
        }
    }
}

/// Sigma points of the unscented filter's measurement.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum UkfPoints {
    /// New ones of the predicted mean and covariance
    Redrawn,
    /// The propagated ones, as in the paper
    Reused,
}

#[derive(Debug, Args)]
struct ModelArgs {
    /// How non-linear the oscillator is, above 0 and at most 10
    #[arg(long, value_name = "M", value_parser = parse_positive, default_value = "1")]
    mu: f64,
    /// Distribution of the measurements' errors; the Kalman filters take it for normal
    #[arg(long, default_value = "gauss")]
    noise: Noise,
    /// Variance of the measurements' errors [default: where the extended filter has the published RMSE]
    #[arg(long, value_name = "R", value_parser = parse_positive)]
    measurement_noise: Option<f64>,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// How many threads share the runs [default: one a core]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    /// Write everything found as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(Debug, Args)]
struct VanDerPolArgs {
    #[command(flatten)]
    model: ModelArgs,
    /// How many runs, each with measurements of its own; at least 2
    #[arg(long, value_name = "N", value_parser = parse_count, default_value_t = 1000)]
    runs: usize,
    /// Sizes of the particle filters
    #[arg(long, value_name = "N,N,...", value_delimiter = ',', value_parser = parse_count, default_value = "500,10000")]
    particles: Vec<usize>,
    /// Variances of the process noise that the filters assume, of x and of x' a step
    #[arg(long, value_name = "Q,Q,...", value_delimiter = ',', value_parser = parse_positive,
          default_value = "1e-5,1e-4,1e-3,1e-2,1e-1")]
    process_noise: Vec<f64>,
    /// Which sigma points the unscented filter measures
    #[arg(long, default_value = "redrawn")]
    ukf_points: UkfPoints,
    /// Draw the state, the measurements and the estimates of run 0 as an SVG
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

#[derive(Debug, Args)]
struct ConvergenceArgs {
    #[command(flatten)]
    model: ModelArgs,
    /// How many sets of measurements
    #[arg(long, value_name = "N", value_parser = parse_count, default_value_t = 20)]
    runs: usize,
    /// Sizes of the particle filters, each below --reference
    #[arg(long, value_name = "N,N,...", value_delimiter = ',', value_parser = parse_count,
          default_value = "250,1000,4000,16000")]
    particles: Vec<usize>,
    /// Particles of the filter that stands for the exact one
    #[arg(long, value_name = "N", value_parser = parse_count, default_value_t = 1_000_000)]
    reference: usize,
    /// Variance of the process noise that the filters assume, of x and of x' a step
    #[arg(long, value_name = "Q", value_parser = parse_positive, default_value = "1e-3")]
    process_noise: f64,
}

pub fn estimate(args: &EstimateArgs) -> Result<()> {
    let model = match &args.experiment {
        Experiment::VanDerPol(args) => &args.model,
        Experiment::Convergence(args) => &args.model,
    };
    let run = || match &args.experiment {
        Experiment::VanDerPol(args) => van_der_pol(args),
        Experiment::Convergence(args) => converge(args),
    };
    let Some(threads) = model.threads else { return run() };
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| BadInput(format!("--threads {threads}: {error}; give fewer threads")))?;
    pool.install(run)
}

/// Runs whose extended filter is held to the published error.
const CALIBRATION_RUNS: usize = 1000;

impl ModelArgs {
    /// The set-up of a process variance, calibrated unless r is given.
    fn setup(&self, process_variance: f64) -> Result<Setup> {
        let measurement_variance = match self.measurement_noise {
            Some(given) => given,
            None => calibrated(1.0, process_variance, CALIBRATION_RUNS, self.seed).map_err(refused)?,
        };
        let setup = Setup { mu: self.mu, process_variance, measurement_variance, noise: self.noise.into() };
        setup.check().map_err(refused)?;
        Ok(setup)
    }

    fn json_file(&self) -> Result<Option<PartialFile>> {
        self.json.as_deref().map(|path| PartialFile::create(path).context("--json")).transpose()
    }
}

/// The error with the flag that it is about.
fn refused(error: ExperimentError) -> BadInput {
    let flag = match error {
        ExperimentError::Mu(_) => "--mu",
        ExperimentError::Variance { what: "measurement", .. } => "--measurement-noise",
        ExperimentError::Variance { .. } | ExperimentError::NoCalibration { .. } => "--process-noise",
        ExperimentError::TooFewRuns(_) => "--runs",
        _ => "--particles",
    };
    BadInput(format!("{flag}: {error}"))
}

fn van_der_pol(args: &VanDerPolArgs) -> Result<()> {
    let json = args.model.json_file()?;
    let svg = args.plot.as_deref().map(|path| PartialFile::create(path).context("--plot")).transpose()?;
    let points = match args.ukf_points {
        UkfPoints::Redrawn => MeasuredPoints::Redrawn,
        UkfPoints::Reused => MeasuredPoints::Reused,
    };
    let mut filters = vec![Filter::Extended, Filter::Unscented(points)];
    filters.extend(args.particles.iter().copied().map(Filter::Particle));
    if args.runs < 2 {
        return Err(refused(ExperimentError::TooFewRuns(args.runs)).into());
    }
    let setups: Vec<Setup> =
        args.process_noise.iter().map(|&q| args.model.setup(q)).collect::<Result<_>>()?;
    if let Some(file) = svg {
        let setup = &setups[setups.len() / 2];
        write_whole(file, &plot(setup, &filters, args.model.seed).map_err(refused)?)?;
    }
    let mut output = StandardOutput::new();
    let mut comparisons = Vec::new();
    for (number, setup) in setups.iter().enumerate() {
        let comparison = compare(setup, &filters, args.runs, args.model.seed).map_err(refused)?;
        let gap = if number == 0 { "" } else { "\n" };
        let text = format!("{gap}{}", table(&comparison, args.model.measurement_noise.is_none()));
        output.write_all(text.as_bytes()).map_err(|error| output.name_error(error))?;
        comparisons.push(comparison);
    }
    write_json(json, &comparisons)?;
    Ok(output.complete()?)
}

fn converge(args: &ConvergenceArgs) -> Result<()> {
    let json = args.model.json_file()?;
    let setup = args.model.setup(args.process_noise)?;
    let found =
        convergence(&setup, &args.particles, args.reference, args.runs, args.model.seed).map_err(refused)?;
    let mut output = StandardOutput::new();
    output.write_all(convergence_table(&found).as_bytes()).map_err(|error| output.name_error(error))?;
    write_json(json, &found)?;
    Ok(output.complete()?)
}

fn write_json(file: Option<PartialFile>, found: &impl Serialize) -> Result<()> {
    let Some(file) = file else { return Ok(()) };
    let text = serde_json::to_string_pretty(found).context("what was found cannot be made JSON")?;
    write_whole(file, &(text + "\n"))
}

fn write_whole(mut file: PartialFile, text: &str) -> Result<()> {
    file.write_all(text.as_bytes()).map_err(|error| file.name_error(error))?;
    Ok(file.complete()?)
}

fn heading(setup: &Setup, runs: usize, seed: u64) -> String {
    let Setup { mu, process_variance, measurement_variance, noise } = setup;
    let noise = format!("{noise:?}").to_lowercase();
    format!(
        "mu {mu}, q {process_variance:e}, r {measurement_variance:.4e}, {noise} noise, {runs} runs, seed {seed}"
    )
}

fn table(comparison: &Comparison, calibrated: bool) -> String {
    let mut text = heading(&comparison.setup, comparison.runs, comparison.seed);
    if calibrated {
        let _ = write!(text, "; r is where the EKF has RMSE {PUBLISHED_EKF_RMSE} at mu 1 in gauss noise");
    }
    let _ = write!(
        text,
        "\n{:<12}{:>19}{:>19}{:>9}{:>19}{:>11}{:>8}\n",
        "filter", "RMSE of x", "RMSE of x'", "bias", "NEES", "ms a run", "failed"
    );
    for score in &comparison.filters {
        let plus_minus = |s: infopart::experiments::van_der_pol::Statistic, digits: usize| {
            format!("{:.digits$} +- {:.digits$}", s.mean, s.half_width)
        };
        let _ = writeln!(
            text,
            "{:<12}{:>19}{:>19}{:>9.5}{:>19}{:>11.3}{:>8}",
            score.filter,
            plus_minus(score.rmse, 5),
            plus_minus(score.rmse_of_velocity, 4),
            score.bias,
            plus_minus(score.nees, 2),
            1000.0 * score.seconds,
            score.failed
        );
    }
    for gap in &comparison.gaps {
        let difference = gap.rmse_difference;
        let verdict = ["reversed", "no difference", "holds"][(difference.sign() + 1) as usize];
        let _ = writeln!(
            text,
            "RMSE {} > {}: {verdict} ({:+.2e} +- {:.1e})",
            gap.first, gap.second, difference.mean, difference.half_width
        );
    }
    let _ = writeln!(text, "all of this order in {:.1} % of the runs", 100.0 * comparison.share_in_order);
    let mut by_time: Vec<_> = comparison.filters.iter().collect();
    by_time.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let names: Vec<&str> = by_time.iter().map(|score| score.filter.as_str()).collect();
    let _ = writeln!(text, "time {}", names.join(" < "));
    text
}

fn convergence_table(found: &Convergence) -> String {
    let mut text = heading(&found.setup, found.runs, found.seed);
    let _ = write!(
        text,
        "\nagainst {} particles\n{:>10}{:>16}\n",
        found.reference, "particles", "RMS difference"
    );
    for point in &found.points {
        let _ = writeln!(text, "{:>10}{:>16.3e}", point.particles, point.rms_difference);
    }
    let _ = writeln!(text, "slope {:.3}", found.slope);
    text
}
