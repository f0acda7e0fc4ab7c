//! What a run writes: rows, pictures, progress. Everything is opened before the first frame is tracked.

use std::{
    io::{self, IsTerminal},
    path::{Path, PathBuf},
};

use anyhow::{Context, Error, Result};
use infopart::{
    geometry::{Origin, Rect},
    output::{
        FrameEvent, Observer, OutputError, PartialFile, PictureFolder, Progress, RowFormat, RowOptions,
        RowWriter, StandardOutput, VIDEO_EXTENSIONS, VideoWriter,
    },
    program::BadInput,
    run::RunError,
};

use super::track_args::TrackArgs;

/// The observers of a run, and where its rows are if it stops.
pub struct Outputs {
    rows: Box<dyn Observer>,
    rows_until_whole: Option<PathBuf>,
    pictures: Option<Box<dyn Observer>>,
    progress: Progress,
    warnings: Option<WarningPrinter>,
}

impl Outputs {
    /// Opens what the flags ask for; `initial_box_as_given` is to be the first row, `total` the number of frames if known.
    pub fn open(
        args: &TrackArgs,
        origin: Origin,
        initial_box_as_given: Rect,
        total: Option<usize>,
    ) -> Result<Self> {
        if args.out.is_some() && args.out == args.annotate {
            return Err(
                BadInput("--out and --annotate name the same path; give each its own".to_owned()).into()
            );
        }
        let options = RowOptions {
            format: row_format(args),
            origin,
            initial_box_as_given: Some(initial_box_as_given),
            timing: args.timing,
        };
        let (rows, rows_until_whole) = open_rows(args.out.as_deref(), options)?;
        let pictures = args.annotate.as_deref().map(open_pictures).transpose()?;
        // A bar among rows on the same terminal would be a mess, and the rows show progress themselves.
        let rows_on_terminal = args.out.is_none() && io::stdout().is_terminal();
        let progress = if args.quiet || rows_on_terminal { Progress::hidden() } else { Progress::new(total) };
        // With --json the warnings are in the object, which stays the only thing on standard error.
        let warnings = (!args.json).then_some(WarningPrinter);
        Ok(Self { rows, rows_until_whole, pictures, progress, warnings })
    }

    /// In the order in which they are shown a frame. Rows come after pictures: a row says that all of its frame is written.
    pub fn observers(&mut self) -> Vec<&mut dyn Observer> {
        let mut observers: Vec<&mut dyn Observer> = Vec::new();
        if let Some(warnings) = &mut self.warnings {
            observers.push(warnings);
        }
        if let Some(pictures) = &mut self.pictures {
            observers.push(pictures.as_mut());
        }
        observers.push(self.rows.as_mut());
        observers.push(&mut self.progress);
        observers
    }

    /// A run's error with what is left of the run.
    pub fn explain(&self, error: RunError) -> Error {
        let Some(last) = &error.last_good else { return error.into() };
        let place = match &self.rows_until_whole {
            Some(path) => format!("in {}", path.display()),
            None => "on standard output".to_owned(),
        };
        let message = format!("{error}\n  the last good frame is {last}; the rows up to it are {place}");
        Error::new(error).context(message)
    }
}

fn row_format(args: &TrackArgs) -> RowFormat {
    match (args.format, &args.out) {
        (Some(format), _) => format.into(),
        (None, Some(path)) => RowFormat::from_path(path),
        (None, None) => RowFormat::Otb,
    }
}

/// Rows to a file or standard output, and where they are until they are whole.
fn open_rows(out: Option<&Path>, options: RowOptions) -> Result<(Box<dyn Observer>, Option<PathBuf>)> {
    let Some(path) = out else {
        return Ok((Box::new(RowWriter::new(StandardOutput::new(), options)), None));
    };
    let file = PartialFile::create(path).with_context(|| format!("--out {}", path.display()))?;
    let partial = file.partial_path().to_owned();
    Ok((Box::new(RowWriter::new(file, options)), Some(partial)))
}

fn open_pictures(path: &Path) -> Result<Box<dyn Observer>> {
    let context = || format!("--annotate {}", path.display());
    let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    let is_video = extension.is_some_and(|extension| VIDEO_EXTENSIONS.contains(&extension.as_str()));
    Ok(if is_video && !path.is_dir() {
        Box::new(VideoWriter::create(path).with_context(context)?)
    } else {
        Box::new(PictureFolder::create(path).with_context(context)?)
    })
}

/// Tells what is odd about the first box.
struct WarningPrinter;

impl Observer for WarningPrinter {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        for warning in event.warnings {
            eprintln!("warning: {warning}");
        }
        Ok(())
    }
}
