//! What several subcommands take: data, sequences; and how problems that end nothing are told.

use std::{fmt::Display, path::PathBuf};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use infopart::{program::BadInput, sequence::PolygonBox};
use otb_eval::{catalogue, dataset::Dataset, protocol::HiddenFrames};

#[derive(Debug, Args)]
pub struct DataArgs {
    /// Data sets or single sequences, recognised by what is in them: OTB, UAV123, UAV20L (its anno/UAV20L), LaSOT, GOT-10k (its
    /// train, val or test), TrackingNet (its TEST), NfS, VOT, TLD, TC128; where frames are not needed, also a JSON file of
    /// boxes such as OTB100.json
    #[arg(long, value_name = "DATA", num_args = 1..)]
    pub data: Vec<PathBuf>,
    /// Sequences by name, in any toolkit's spelling, and lists of them: tb100, tb50, cvpr13, person, people8, people11,
    /// people19, other7, others12, longterm [default: all of the data]
    #[arg(long, value_name = "NAME,LIST,...")]
    pub sequences: Option<String>,
    /// Lists of the frames on which tre starts no run, NAME.txt of a range a line, in place of the benchmark's 27 that are
    /// built in, and of more sequences
    #[arg(long, value_name = "DIR")]
    init_omit: Option<PathBuf>,
    /// The box of a polygon of VOT: min-max, as most have it, or equal-area, as got10k and pysot
    #[arg(long, value_enum, default_value_t = Polygons::MinMax)]
    polygons: Polygons,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Polygons {
    /// Between its smallest and largest coordinates
    MinMax,
    /// Of its area, about the mean of its corners
    EqualArea,
}

impl DataArgs {
    /// The data, and the problems of sequences that could not be read.
    pub fn open(&self) -> Result<(Dataset, Problems)> {
        if self.data.is_empty() {
            let how = "give --data: folders of data sets, single sequences, or a JSON file of boxes";
            return Err(BadInput(how.into()).into());
        }
        let polygons = match self.polygons {
            Polygons::MinMax => PolygonBox::MinMax,
            Polygons::EqualArea => PolygonBox::EqualArea,
        };
        let (mut dataset, unreadable) = Dataset::open_with(&self.data, polygons).context("--data")?;
        dataset.hide(&self.hidden()?);
        let mut problems = Problems::default();
        for problem in unreadable {
            problems.tell(&problem);
        }
        Ok((dataset, problems))
    }

    /// The lists of hidden frames.
    pub fn hidden(&self) -> Result<HiddenFrames> {
        let built_in = HiddenFrames::default();
        match &self.init_omit {
            Some(folder) => built_in.with_folder(folder).context("--init-omit"),
            None => Ok(built_in),
        }
    }

    /// The sequences asked for, if any are.
    pub fn selected(&self) -> Result<Option<Vec<String>>> {
        self.sequences.as_deref().map(|words| catalogue::select(words).context("--sequences")).transpose()
    }
}

/// Problems of single sequences: told at once, and in the end the reason for exit code 2. Defects of others' results are
/// told too, and are a reason only if they are taken for problems.
#[derive(Debug, Default)]
pub struct Problems {
    told: Vec<String>,
    problems: usize,
    defects: usize,
}

/// Tells on standard error what is worth knowing and no problem.
pub fn note(text: &str) {
    eprintln!("note: {}", printable(text));
}

/// With control characters of files and names escaped, which a terminal would obey.
fn printable(text: &str) -> String {
    let escaped = |letter: char| {
        if letter.is_control() { letter.escape_default().to_string() } else { letter.to_string() }
    };
    text.chars().map(escaped).collect()
}

impl Problems {
    /// Tells one on standard error.
    pub fn tell(&mut self, problem: &dyn Display) {
        let problem = printable(&problem.to_string());
        eprintln!("problem: {problem}");
        self.told.push(problem);
        self.problems += 1;
    }

    /// Tells a defect of results that others made on standard error.
    pub fn tell_defect(&mut self, defect: &dyn Display) {
        let defect = printable(&defect.to_string());
        eprintln!("defect: {defect}");
        self.told.push(defect);
        self.defects += 1;
    }

    /// An error if there was any problem or, if these count too, any defect.
    pub fn into_strict_result(mut self, is_strict: bool) -> Result<()> {
        if is_strict {
            self.problems += self.defects;
        } else if self.defects > 0 && self.problems == 0 {
            note("everything was done; with --strict the defects above count as problems");
        }
        self.into_result()
    }

    /// Those told so far.
    pub fn told(&self) -> &[String] {
        &self.told
    }

    /// An error if there was any problem.
    pub fn into_result(self) -> Result<()> {
        match self.problems {
            0 => Ok(()),
            1 => Err(BadInput("1 problem, told above; everything else was done".into()).into()),
            count => Err(BadInput(format!("{count} problems, told above; everything else was done")).into()),
        }
    }
}
