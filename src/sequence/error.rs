//! What can be wrong with an input. Every message says what to do.

use std::path::PathBuf;

use thiserror::Error;

/// An input that cannot be read as meant.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// The file system refused to read.
    #[error("{path}: {source}; check that it exists and can be read", path = path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The file system refused to write.
    #[error("{path}: cannot be written: {source}; choose another folder or make room", path = path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The input names nothing.
    #[error("{path}: no such file or folder; check the spelling, or give a benchmark's sequence, a folder or quoted glob of images, a video file, a URL, or - for standard input{hint}", path = path.display(), hint = dash_hint(path))]
    NoSuchInput {
        /// The input as given.
        path: PathBuf,
    },
    /// A glob pattern that means nothing.
    #[error("{pattern}: not a valid glob pattern: {reason}; write for example 'frames/*.jpg'")]
    BadPattern {
        /// The pattern as given.
        pattern: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A folder or glob in which no image is found.
    #[error("{path}: no images there; give a folder or glob of .jpg, .png, .bmp, .tif or .webp files", path = path.display())]
    NoImages {
        /// The folder or pattern.
        path: PathBuf,
    },
    /// An image that cannot be decoded.
    #[error("{path}: cannot be decoded: {reason}; replace the file, or leave it out with --start and --end", path = path.display())]
    BadImage {
        /// The image file.
        path: PathBuf,
        /// What the decoder says.
        reason: String,
    },
    /// A frame whose size is not the first frame's.
    #[error(
        "{label}: this frame is {width}x{height} but the first is {first_width}x{first_height}; resize it, or leave it out with --start and --end"
    )]
    SizeChanged {
        /// The frame's file, or its number and the video's file.
        label: String,
        /// Width of this frame, pixels.
        width: usize,
        /// Height of this frame, pixels.
        height: usize,
        /// Width of the first frame, pixels.
        first_width: usize,
        /// Height of the first frame, pixels.
        first_height: usize,
    },
    /// A row of ground truth that is no box.
    #[error("{path}, line {line}: `{text}` {problem}; write x,y,w,h there, or NaN,NaN,NaN,NaN if the target is absent", path = path.display())]
    GroundTruth {
        /// The ground truth file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The line as it stands.
        text: String,
        /// What is wrong with it.
        problem: RowProblem,
    },
    /// An OTB folder with several targets of which none was chosen.
    #[error("{path} has {count} targets: {names}; choose one with --target K", path = path.display(), count = targets.len(), names = listed(targets))]
    SeveralTargets {
        /// The OTB folder.
        path: PathBuf,
        /// The targets' numbers.
        targets: Vec<usize>,
    },
    /// A chosen target that the OTB folder does not have.
    #[error("{path} has no target {target}; give --target one of: {names}", path = path.display(), names = listed(targets))]
    NoSuchTarget {
        /// The OTB folder.
        path: PathBuf,
        /// The target asked for.
        target: usize,
        /// The targets' numbers.
        targets: Vec<usize>,
    },
    /// A target chosen where there is no choice.
    #[error(
        "{input}: --target {target} has no meaning here, for this input has no numbered targets (groundtruth_rect.K.txt); leave --target out"
    )]
    TargetWithoutChoice {
        /// The input as given.
        input: String,
        /// The target asked for.
        target: usize,
    },
    /// A first or last frame of 0.
    #[error("{flag} 0: frames are counted from 1; give 1 or more")]
    FrameZero {
        /// The flag: `--start` or `--end`.
        flag: &'static str,
    },
    /// A last frame before the first.
    #[error("--end {end} lies before --start {start}; give an --end of at least {start}")]
    EndBeforeStart {
        /// First frame asked for.
        start: usize,
        /// Last frame asked for.
        end: usize,
    },
    /// A first frame behind the last one there is.
    #[error("--start {start}: {input} has only {frames} frames; give a --start of at most {frames}")]
    StartBeyondEnd {
        /// The input as given.
        input: String,
        /// First frame asked for.
        start: usize,
        /// Frames there are.
        frames: usize,
    },
    /// The ffmpeg program, which decodes videos, cannot be started.
    #[error(
        "{path}: reading a video needs the ffmpeg program, but `{program}` cannot be started: {source}; install it (Debian, Ubuntu: apt install ffmpeg; macOS: brew install ffmpeg; Windows: winget install ffmpeg), or set INFOPART_FFMPEG to its path",
        path = path.display()
    )]
    FfmpegMissing {
        /// The video file.
        path: PathBuf,
        /// The program that was tried.
        program: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A file of which ffmpeg gives no frame.
    #[error("{path}: ffmpeg finds no video in it: {message}; give a video file, or a folder of images", path = path.display())]
    BadVideo {
        /// The file.
        path: PathBuf,
        /// ffmpeg's own last message.
        message: String,
    },
    /// A URL whose scheme is not one of those that are passed on.
    #[error("{url}: there is no way to read `{scheme}`; give one of: {}", schemes.join(", "))]
    UnknownScheme {
        /// The URL as given.
        url: String,
        /// Its scheme.
        scheme: String,
        /// Those that are known.
        schemes: &'static [&'static str],
    },
    /// Live wanted of what is no stream.
    #[error(
        "{input}: --live is for streams (a device, a URL, a FIFO or standard input); a file can be played as from a camera with --realtime FPS"
    )]
    NotLive {
        /// The input as given.
        input: String,
    },
    /// A stream wanted twice.
    #[error(
        "{input}: a stream can be read only once, and {purpose} reads it twice; record it first, or give --init X,Y,W,H"
    )]
    ReadOnce {
        /// The input as given.
        input: String,
        /// What reads it twice.
        purpose: &'static str,
    },
    /// A name of an input format that is none.
    #[error(
        "--input-format {format}: a name of ffmpeg's has letters, digits and _ only; `ffmpeg -devices` lists them"
    )]
    InputFormat {
        /// The name as given.
        format: String,
    },
    /// A video that broke off.
    #[error("{path}: the video broke off after frame {last_good}: {message}; repair the file, or stop before with --end {last_good}", path = path.display())]
    VideoBroken {
        /// The video file.
        path: PathBuf,
        /// The last frame that was whole, counted from 1.
        last_good: usize,
        /// ffmpeg's own last message.
        message: String,
    },
}

/// Why a row of ground truth is no box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RowProblem {
    /// The row has nothing in it though rows follow.
    #[error("is blank though rows follow")]
    Blank,
    /// Something is not a number.
    #[error("has something that is not a number")]
    NotANumber,
    /// A number is infinite.
    #[error("has an infinite number")]
    Infinite,
    /// Not four numbers.
    #[error("has {0} numbers instead of 4")]
    Count(usize),
    /// A flag of a frame that is none.
    #[error("is no whole number from 0 to {most}")]
    NoFlag {
        /// The largest.
        most: u8,
    },
    /// Not a flag for each row of the ground truth.
    #[error("begins {flags} flags of frames, but the ground truth has {rows} rows")]
    Flags {
        /// Flags in the file.
        flags: usize,
        /// Rows of the ground truth.
        rows: usize,
    },
}

/// What begins with a dash may be meant for a file.
fn dash_hint(path: &std::path::Path) -> String {
    let name = path.display().to_string();
    if name.starts_with('-') { format!("; a file of that name is ./{name}") } else { String::new() }
}

fn listed(targets: &[usize]) -> String {
    targets.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
