//! Where frames and ground truth come from. A source streams: it holds one frame at a time.
//!
//! [`open`] takes a sequence of a benchmark, a folder or glob of images, one image, or a video or a stream (through the ffmpeg program);
//! [`Walker`] renders a sequence that needs no data.
//!
//! ```no_run
//! use infopart::sequence::{OpenOptions, open};
//!
//! let options = OpenOptions { target: Some(2), ..OpenOptions::default() };
//! let mut sequence = open("otb/Jogging", &options)?;
//! println!("{} starts at {:?}", sequence.name, sequence.ground_truth.first());
//! while let Some(frame) = sequence.source.next_frame()? {
//!     println!("{}: {} x {}", frame.label, frame.frame.width(), frame.frame.height());
//! }
//! # Ok::<(), infopart::sequence::SequenceError>(())
//! ```

use std::{
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
    time::Duration,
};

use crate::{
    frame::Frame,
    geometry::{Origin, Rect},
};

mod benchmark;
mod decode;
mod error;
mod ground_truth;
mod images;
mod natural;
mod open;
mod otb;
mod range;
mod size_guard;
mod video;
mod walker;

pub use benchmark::{
    Benchmark, BenchmarkSequence, BenchmarkTruth, FramePlace, PolygonBox, benchmark_sequences,
};
pub(crate) use decode::decode as decode_bytes;
pub use decode::{decode_image, probe_image};
pub use error::{RowProblem, SequenceError};
pub use ground_truth::{parse_boxes, parse_ground_truth, read_boxes, read_ground_truth};
pub use open::{is_stream, open};
pub use otb::{OtbImages, OtbTarget, otb_images, otb_targets};
pub use walker::{Absence, Companion, Occluder, Walker, WalkerOptions};

/// A frame and where it stands in its source.
#[derive(Debug, Clone)]
pub struct SourceFrame {
    /// The pixels: grey or RGB. 16-bit images are scaled to 8 bits, alpha is dropped, EXIF orientation applied.
    pub frame: Frame,
    /// Position among the input's frames, counted from 1 (the first frame of a known OTB range is 1). Opened with
    /// `start: Some(10)`, the first frame delivered has number 10.
    pub number: usize,
    /// What a message calls the frame: its file's name, or `frame N` of a video.
    pub label: String,
    /// Presentation time since the start of a video; `None` for images.
    pub time: Option<Duration>,
}

/// Frames, one after another.
pub trait FrameSource: Send {
    /// The next frame, or `None` after the last. Every frame has the first one's size.
    ///
    /// # Errors
    /// [`SequenceError`], naming the file or frame and what to do.
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, SequenceError>;

    /// How many frames are still to come, where that is known.
    fn remaining(&self) -> Option<usize>;
}

/// An input made ready: its frames and what is known of them.
pub struct Sequence {
    /// The name of the folder or file, with the target's number if there are several (`Jogging-1`).
    pub name: String,
    /// The frames.
    pub source: Box<dyn FrameSource>,
    /// The target's true box in each frame of the source, in frame coordinates, from its first frame on; `None` where
    /// the target is absent (a NaN row or a box without area). Empty if there is no ground truth.
    pub ground_truth: Vec<Option<Rect>>,
    /// The file and the row, counted from 1, of the first true box.
    pub ground_truth_row: Option<(PathBuf, usize)>,
    /// The number of the first pixel in the input's boxes: 1 for OTB folders, else 0, unless it was given.
    pub origin: Origin,
}

/// How an input is opened.
#[derive(Debug, Clone, Default)]
pub struct OpenOptions {
    /// Which target of an OTB folder that has several (`groundtruth_rect.K.txt`).
    pub target: Option<usize>,
    /// First frame to deliver, counted from 1.
    pub start: Option<usize>,
    /// Last frame to deliver, counted from 1; beyond the last one it means the last.
    pub end: Option<usize>,
    /// The number of the first pixel in the input's boxes, if it is not the usual one.
    pub origin: Option<Origin>,
    /// Of a stream, deliver the newest frame each time and leave out those that came meanwhile. Devices are always read so.
    pub live: bool,
    /// ffmpeg's name (`-f`) of what the input is: a capture device's, such as `v4l2`, `avfoundation` or `dshow`, to which the input
    /// is passed as it stands.
    pub input_format: Option<String>,
    /// What happens while a stream sends nothing.
    pub wait: Wait,
}

/// What happens while a stream sends nothing. A stream is waited for without end, a file for a minute.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wait {
    /// Ends the wait once it is true: the stream then is as one that ended.
    pub stop: Option<&'static AtomicBool>,
    /// Is called with the stream's name the first time that nothing came for five seconds.
    pub tell: Option<fn(&Path)>,
}
