//! `infopart background`: what moves before a static camera, as masks, blobs and one picture to look at.

use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use image::{DynamicImage, GrayImage, RgbImage};
use infopart::{
    background::{BackgroundModel, BackgroundParameters, Blob, CleanUp, ComponentRate, MaskCleaner},
    frame::FrameView,
    output::{Destination, OutputError, PartialFile},
    program::BadInput,
    sequence::{self, OpenOptions},
};

use super::values::parse_count;

pub const EXAMPLES: &str = "\
Examples:
  infopart background atrium.mp4 --components 3 --training-frames 40 --frame 121 --out subtraction.png
  infopart background view1.avi --blobs blobs.csv
  infopart background view1.avi --masks masks --cleaned-masks cleaned

The picture: frame N, its raw mask, and the cleaned mask with the boxes of its blobs, side by side. With --frame the \
input is read no further.
Blobs: `frame,x,y,w,h,area` a blob, frames counted from 1, the first pixel being 0.
Masks: DIR/000001.png and so on; 255 foreground, 0 background, 127 shadow with --shadows.

Exit codes: 0 success, 2 bad input: a flag or a file";

#[derive(Debug, Args)]
pub struct BackgroundArgs {
    /// A video (needs ffmpeg), or a folder or quoted glob of images, from a camera that does not move
    input: String,
    /// Stop at this frame, counted from 1 [default: the last]
    #[arg(long, value_name = "N", value_parser = parse_count)]
    frame: Option<usize>,
    /// A picture of the last frame: as it is, its raw mask, its cleaned mask with blobs
    #[arg(long, value_name = "FILE.png")]
    out: Option<PathBuf>,
    /// Where the blobs of every frame go
    #[arg(long, value_name = "FILE.csv")]
    blobs: Option<PathBuf>,
    /// A folder for the raw masks
    #[arg(long, value_name = "DIR")]
    masks: Option<PathBuf>,
    /// A folder for the cleaned masks
    #[arg(long, value_name = "DIR")]
    cleaned_masks: Option<PathBuf>,
    /// Gaussians a pixel
    #[arg(long, value_name = "K", default_value_t = BackgroundParameters::default().components)]
    components: usize,
    /// How many frames the model looks back
    #[arg(long, value_name = "FRAMES", default_value_t = BackgroundParameters::default().history)]
    history: usize,
    /// Over how many frames the model is a plain mean at first [default: as many as --history]
    #[arg(long, value_name = "FRAMES")]
    training_frames: Option<usize>,
    /// The share of time that a pixel shows background
    #[arg(long, value_name = "SHARE", default_value_t = BackgroundParameters::default().background_ratio)]
    background_ratio: f64,
    /// Standard deviation of the camera's noise, grey levels
    #[arg(long, value_name = "LEVELS", default_value_t = BackgroundParameters::default().noise_sigma)]
    noise_sigma: f64,
    /// How fast a component follows what it explains: by the learning rate over its weight (owned), or by the learning
    /// rate (shared, as OpenCV does)
    #[arg(long, value_name = "owned|shared", default_value = "owned")]
    component_rate: Rate,
    /// Tell shadows apart
    #[arg(long)]
    shadows: bool,
    /// Side of the square that opens the mask, pixels
    #[arg(long, value_name = "ODD", default_value_t = CleanUp::default().opening)]
    opening: usize,
    /// Side of the square that closes the mask, pixels
    #[arg(long, value_name = "ODD", default_value_t = CleanUp::default().closing)]
    closing: usize,
    /// Smallest blob, pixels
    #[arg(long, value_name = "PIXELS", default_value_t = CleanUp::default().min_area)]
    min_area: usize,
    /// No line about speed on standard error
    #[arg(long)]
    quiet: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Rate {
    Owned,
    Shared,
}

pub fn background(args: &BackgroundArgs) -> Result<()> {
    let mut model = BackgroundModel::new(args.parameters().check().map_err(bad_input)?);
    let cleaner = MaskCleaner::new(args.clean_up().check().map_err(bad_input)?);
    let mut outputs = Outputs::open(args)?;
    let options = OpenOptions { end: args.frame, ..OpenOptions::default() };
    let mut source = sequence::open(&args.input, &options)?.source;
    let mut times = Times::default();
    let mut last = None;
    while let Some(frame) = source.next_frame()? {
        let view = frame.frame.view();
        let start = Instant::now();
        let raw = model.apply(view).map_err(|error| BadInput(format!("{}: {error}", frame.label)))?;
        let learnt = Instant::now();
        let cleaned = cleaner.clean(raw);
        let blobs = cleaner.blobs(&cleaned);
        times.add(learnt - start, learnt.elapsed());
        outputs.write(frame.number, raw, &cleaned, &blobs)?;
        last = Some((frame, cleaned, blobs));
    }
    let Some((frame, cleaned, blobs)) = last else {
        return Err(BadInput(format!("{}: no frame there; give an input with frames", args.input)).into());
    };
    if let Some(wanted) = args.frame.filter(|wanted| frame.number < *wanted) {
        return Err(
            BadInput(format!("--frame {wanted}: {} has only {} frames", args.input, frame.number)).into()
        );
    }
    if let Some(path) = &args.out {
        save_png(path, &picture(frame.frame.view(), model.mask(), &cleaned, &blobs).into())?;
    }
    outputs.complete()?;
    if !args.quiet {
        eprintln!("{}", times.told(rayon::current_num_threads()));
    }
    Ok(())
}

fn bad_input(error: infopart::background::BackgroundError) -> BadInput {
    // A key is its flag but for the dash.
    BadInput(format!("the flags of the background model: {error}"))
}

impl BackgroundArgs {
    fn parameters(&self) -> BackgroundParameters {
        BackgroundParameters {
            components: self.components,
            history: self.history,
            training_frames: self.training_frames.unwrap_or(self.history),
            background_ratio: self.background_ratio,
            noise_sigma: self.noise_sigma,
            component_rate: match self.component_rate {
                Rate::Owned => ComponentRate::Owned,
                Rate::Shared => ComponentRate::Shared,
            },
            shadows: self.shadows,
            ..BackgroundParameters::default()
        }
    }

    fn clean_up(&self) -> CleanUp {
        CleanUp {
            opening: self.opening,
            closing: self.closing,
            min_area: self.min_area,
            ..CleanUp::default()
        }
    }
}

/// How long the model and the clean-up took.
#[derive(Default)]
struct Times {
    frames: u32,
    model: Duration,
    clean_up: Duration,
}

impl Times {
    fn add(&mut self, model: Duration, clean_up: Duration) {
        self.frames += 1;
        self.model += model;
        self.clean_up += clean_up;
    }

    fn told(&self, threads: usize) -> String {
        let mean = |time: Duration| 1e3 * time.as_secs_f64() / f64::from(self.frames.max(1));
        let both = self.model + self.clean_up;
        format!(
            "{} frames on {threads} threads: background model {:.2} ms, clean-up and blobs {:.2} ms a frame; {:.1} frames/s",
            self.frames,
            mean(self.model),
            mean(self.clean_up),
            1e3 / mean(both).max(1e-9),
        )
    }
}

/// What is written of every frame.
struct Outputs {
    blobs: Option<PartialFile>,
    masks: Option<PathBuf>,
    cleaned_masks: Option<PathBuf>,
}

impl Outputs {
    fn open(args: &BackgroundArgs) -> Result<Self> {
        if let Some(folder) = args.out.as_deref().filter(|path| path.is_dir()) {
            return Err(OutputError::IsFolder { path: folder.to_owned() }.into());
        }
        let mut blobs = args.blobs.as_deref().map(PartialFile::create).transpose().context("--blobs")?;
        if let Some(file) = &mut blobs {
            writeln!(file, "frame,x,y,w,h,area").map_err(|error| file.name_error(error))?;
        }
        for folder in args.masks.iter().chain(&args.cleaned_masks) {
            fs::create_dir_all(folder)
                .map_err(|source| OutputError::Io { path: folder.to_owned(), source })?;
        }
        Ok(Self { blobs, masks: args.masks.clone(), cleaned_masks: args.cleaned_masks.clone() })
    }

    fn write(&mut self, number: usize, raw: &GrayImage, cleaned: &GrayImage, blobs: &[Blob]) -> Result<()> {
        for (folder, mask) in [(&self.masks, raw), (&self.cleaned_masks, cleaned)] {
            if let Some(folder) = folder {
                save_png(&folder.join(format!("{number:06}.png")), &mask.clone().into())?;
            }
        }
        let Some(file) = &mut self.blobs else { return Ok(()) };
        for Blob { box_in_frame: b, area, .. } in blobs {
            writeln!(file, "{number},{},{},{},{},{area}", b.x, b.y, b.w, b.h)
                .map_err(|error| file.name_error(error))?;
        }
        Ok(())
    }

    fn complete(&mut self) -> Result<()> {
        Ok(self.blobs.as_mut().map_or(Ok(()), Destination::complete)?)
    }
}

/// Writes a whole PNG or none.
fn save_png(path: &Path, picture: &DynamicImage) -> Result<()> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture
        .write_to(&mut bytes, image::ImageFormat::Png)
        .map_err(|source| OutputError::Picture { path: path.to_owned(), source })?;
    let mut file = PartialFile::create(path)?;
    file.write_all(bytes.get_ref()).map_err(|error| file.name_error(error))?;
    Ok(file.complete()?)
}

/// White between the panels, pixels.
const GAP: u32 = 6;
const BLOB: [u8; 3] = [255, 90, 60];

/// The frame, its raw mask and its cleaned mask side by side.
fn picture(frame: FrameView<'_>, raw: &GrayImage, cleaned: &GrayImage, blobs: &[Blob]) -> RgbImage {
    let (width, height) = raw.dimensions();
    let panel = |mask: &GrayImage| DynamicImage::from(mask.clone()).into_rgb8();
    let mut with_blobs = panel(cleaned);
    for Blob { box_in_frame: b, .. } in blobs {
        let rect = imageproc::rect::Rect::at(b.x as i32, b.y as i32).of_size(b.w as u32, b.h as u32);
        imageproc::drawing::draw_hollow_rect_mut(&mut with_blobs, rect, image::Rgb(BLOB));
    }
    let mut all = RgbImage::from_pixel(3 * width + 2 * GAP, height, image::Rgb([255; 3]));
    for (place, panel) in [rgb(frame), panel(raw), with_blobs].iter().enumerate() {
        image::imageops::replace(&mut all, panel, i64::from(place as u32 * (width + GAP)), 0);
    }
    all
}

fn rgb(frame: FrameView<'_>) -> RgbImage {
    let (bytes, offsets) = (frame.format().bytes_per_pixel(), frame.format().rgb_offsets());
    RgbImage::from_fn(frame.width() as u32, frame.height() as u32, |x, y| {
        let pixel = &frame.row(y as usize)[x as usize * bytes..];
        image::Rgb(offsets.map(|channel| pixel[channel]))
    })
}
