//! The flags of `infopart track`.

use std::{num::NonZeroUsize, path::PathBuf};

use clap::Args;
use infopart::geometry::Origin;

use super::{
    parameters::ParameterArgs,
    values::{
        Format, Init, TrackerName, parse_count, parse_init, parse_origin, parse_positive, parse_stride,
        parse_threads,
    },
};

#[derive(Debug, Args)]
pub struct TrackArgs {
    /// A sequence of a benchmark (OTB, UAV123, LaSOT, GOT-10k, TrackingNet, NfS, VOT, TLD, TC128: its folder, or its ground
    /// truth where that lies apart), a folder or a quoted glob of images (jpg, png, bmp, tif, webp), or with ffmpeg a
    /// video, a FIFO, - for standard input, a URL or a capture device
    pub input: String,
    /// What tracks
    #[arg(long, value_name = "infopart|colour", default_value = "infopart")]
    pub tracker: TrackerName,
    /// The target's box in the first frame: left, top, width, height in pixels; with --tracker colour it may be
    /// given several times, once a target; or auto, before a static camera: the first object that moves for 15 frames,
    /// from then on [default: the ground truth's]
    #[arg(long, value_name = "X,Y,W,H|auto", value_parser = parse_init, allow_hyphen_values = true)]
    pub init: Vec<Init>,
    /// Which target of a folder that has several: the K of groundtruth_rect.K.txt, or of UAV123's NAME_K.txt; with --init auto
    /// the K-th object
    #[arg(long, value_name = "K", value_parser = parse_count)]
    pub target: Option<usize>,
    /// The number of the first pixel, in --init, the ground truth and the rows [default: 1 for OTB, UAV123, LaSOT and TC128, else
    /// 0]
    #[arg(long, value_name = "0|1", value_parser = parse_origin)]
    pub origin: Option<Origin>,
    /// The first frame to track, counted from 1; the first box is that of this frame [default: 1]
    #[arg(long, value_name = "N", value_parser = parse_count)]
    pub start: Option<usize>,
    /// The last frame to track, counted from 1 [default: the last there is]
    #[arg(long, value_name = "M", value_parser = parse_count)]
    pub end: Option<usize>,
    /// Where the rows go, one a frame; they are in FILE.partial until they are all there [default: standard output]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// How rows are written [default: by the extension of --out, else otb]
    #[arg(long)]
    pub format: Option<Format>,
    #[command(flatten)]
    pub parameters: ParameterArgs,
    /// Draw boxes, particles, other places that look like the target (violet) and where a lost one is searched (blue) on
    /// every frame: pictures DIR/000001.jpg and so on, or a video (mp4, mkv, mov, avi; needs ffmpeg)
    #[arg(long, value_name = "DIR|FILE.mp4")]
    pub annotate: Option<PathBuf>,
    /// Track only every K-th frame from the first on, and predict the boxes between
    #[arg(long, value_name = "K", value_parser = parse_stride, conflicts_with = "realtime")]
    pub stride: Option<NonZeroUsize>,
    /// Let frames arrive at this rate, as from a camera with a buffer of one frame: those that arrive while tracking is
    /// busy are skipped, and their boxes predicted. It depends on measured times, so the boxes differ from run to run
    #[arg(long, value_name = "FPS", value_parser = parse_positive)]
    pub realtime: Option<f64>,
    /// Of a stream, track the newest frame each time and leave out those that came meanwhile, which have no row; devices are
    /// always read so
    #[arg(long, conflicts_with_all = ["stride", "realtime"])]
    pub live: bool,
    /// What ffmpeg is to take the input for, its -f: a capture device such as v4l2, avfoundation, dshow, x11grab or gdigrab
    /// [default: v4l2 for /dev/video*]
    #[arg(long, value_name = "NAME")]
    pub input_format: Option<String>,
    /// How many threads weigh particles; the boxes do not depend on it [default: one a core]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    pub threads: Option<usize>,
    /// Add the milliseconds of each stage to the summary, and of each frame to csv and jsonl rows
    #[arg(long)]
    pub timing: bool,
    /// Make the summary (on standard error) one JSON object
    #[arg(long)]
    pub json: bool,
    /// No progress bar and no summary (--json still gives its object)
    #[arg(long)]
    pub quiet: bool,
}
