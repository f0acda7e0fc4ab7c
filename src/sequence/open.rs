//! Finds out what an input is, and opens it.

use std::path::{Path, PathBuf};

use super::{
    OpenOptions, Sequence, SequenceError,
    benchmark::{benchmark_sequences, chosen},
    images::{ImageFiles, folder_name, has_image_extension, images_in, images_matching},
    otb::OtbFolder,
    range::FrameRange,
    video::{VideoFile, VideoInput},
};
use crate::geometry::Origin;

/// Opens a sequence of OTB or another benchmark (its folder or, where that lies apart, its ground truth), a folder or glob of images,
/// one image, or through the ffmpeg program a video file, a FIFO, standard input (`-`), a URL or a capture device (`/dev/video0`,
/// or any with [`OpenOptions::input_format`]).
///
/// An OTB folder gives the frames that its ground truth is known to cover (David from 0300 on), and its boxes count
/// from 1; inputs without ground truth count from 0. An existing path is never taken for a glob or a URL.
/// Images are decoded when they are asked for; of a video the first wanted frame is decoded here, so that a file
/// that is no video fails here.
///
/// # Errors
/// [`SequenceError`], naming the file, frame or flag and what to do: nothing at `input`, no images, several targets and
/// none chosen, a target that does not exist, unreadable ground truth, an impossible `start` or `end`, a video that
/// ffmpeg cannot read, ffmpeg missing.
pub fn open(input: &str, options: &OpenOptions) -> Result<Sequence, SequenceError> {
    FrameRange::of(options)?;
    let path = Path::new(input);
    if let Some(stream) = stream(input, options)? {
        refuse_target(input, options)?;
        return open_stream(&stream, input, options);
    }
    if options.live {
        return Err(SequenceError::NotLive { input: input.to_owned() });
    }
    if path.is_dir() {
        return open_folder(path, input, options);
    }
    if let [known] = &benchmark_sequences(path)?[..] {
        let options = OpenOptions { target: None, ..options.clone() };
        return known.open(&options);
    }
    refuse_target(input, options)?;
    if path.exists() {
        return open_file(path, input, options);
    }
    if input.contains(['*', '?', '[']) {
        return open_glob(input, options);
    }
    Err(SequenceError::NoSuchInput { path: path.to_owned() })
}

/// The stream that an input is; `None` if it is none.
fn stream(input: &str, options: &OpenOptions) -> Result<Option<VideoInput>, SequenceError> {
    if let Some(format) = &options.input_format {
        let is_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        if format.is_empty() || !format.chars().all(is_name) {
            return Err(SequenceError::InputFormat { format: format.clone() });
        }
        return Ok(Some(VideoInput::Device { format: format.clone(), name: input.to_owned() }));
    }
    if input == "-" {
        return Ok(Some(VideoInput::Standard));
    }
    let path = Path::new(input);
    if let Ok(file) = path.metadata() {
        return Ok(special_file(path, &file));
    }
    let Some((scheme, _)) = input.split_once("://") else { return Ok(None) };
    let is_scheme = |letter: char| letter.is_ascii_alphanumeric() || "+-.".contains(letter);
    if scheme.is_empty() || !scheme.chars().all(is_scheme) {
        return Ok(None);
    }
    if SCHEMES.contains(&scheme.to_ascii_lowercase().as_str()) {
        return Ok(Some(VideoInput::Url(input.to_owned())));
    }
    let (url, scheme) = (input.to_owned(), scheme.to_owned());
    Err(SequenceError::UnknownScheme { url, scheme, schemes: &SCHEMES })
}

/// Schemes of URLs that reach ffmpeg. Others of its protocols read files in ways that a name must not ask for.
const SCHEMES: [&str; 12] =
    ["http", "https", "rtsp", "rtsps", "rtmp", "rtmps", "rtp", "udp", "tcp", "tls", "srt", "ftp"];

/// A FIFO, or a video device of Linux.
#[cfg(unix)]
fn special_file(path: &Path, file: &std::fs::Metadata) -> Option<VideoInput> {
    use std::os::unix::fs::FileTypeExt;
    if file.file_type().is_fifo() {
        return Some(VideoInput::Fifo(path.to_owned()));
    }
    let is_video = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("video"));
    let is_device = cfg!(target_os = "linux") && file.file_type().is_char_device() && is_video;
    is_device.then(|| VideoInput::Device { format: "v4l2".to_owned(), name: path.display().to_string() })
}

#[cfg(not(unix))]
fn special_file(_path: &Path, _file: &std::fs::Metadata) -> Option<VideoInput> {
    None
}

/// Whether an input is a stream, which can be read only once.
///
/// # Errors
/// [`SequenceError`] for a URL or a format that is not passed on.
pub fn is_stream(input: &str, options: &OpenOptions) -> Result<bool, SequenceError> {
    Ok(stream(input, options)?.is_some())
}

fn open_stream(stream: &VideoInput, input: &str, options: &OpenOptions) -> Result<Sequence, SequenceError> {
    let range = FrameRange::of(options)?;
    let is_live = options.live || matches!(stream, VideoInput::Device { .. });
    let source: Box<dyn super::FrameSource> = if is_live {
        Box::new(VideoFile::open(stream.clone(), range, options.wait)?.live())
    } else {
        Box::new(VideoFile::open(stream.clone(), range, options.wait)?)
    };
    Ok(without_ground_truth(source, input.to_owned(), options))
}

fn open_folder(path: &Path, input: &str, options: &OpenOptions) -> Result<Sequence, SequenceError> {
    let name = folder_name(path);
    if let Some(folder) = OtbFolder::recognise(path, &name)? {
        return folder.open(options);
    }
    let known = benchmark_sequences(path)?;
    if !known.is_empty() {
        return chosen(&known, input, options.target)?.open(options);
    }
    refuse_target(input, options)?;
    let mut images = images_in(path)?;
    let nested = path.join("img");
    if images.is_empty() && nested.is_dir() {
        images = images_in(&nested)?;
    }
    of_images(images, name, input, options)
}

fn open_glob(input: &str, options: &OpenOptions) -> Result<Sequence, SequenceError> {
    let images = images_matching(input)?;
    let name = images.first().and_then(|first| first.parent()).map_or_else(|| input.to_owned(), folder_name);
    of_images(images, name, input, options)
}

fn open_file(path: &Path, input: &str, options: &OpenOptions) -> Result<Sequence, SequenceError> {
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    if has_image_extension(path) {
        return of_images(vec![path.to_owned()], name, input, options);
    }
    let source = VideoFile::open(VideoInput::File(path.to_owned()), FrameRange::of(options)?, options.wait)?;
    Ok(without_ground_truth(Box::new(source), name, options))
}

fn of_images(
    images: Vec<PathBuf>,
    name: String,
    input: &str,
    options: &OpenOptions,
) -> Result<Sequence, SequenceError> {
    if images.is_empty() {
        return Err(SequenceError::NoImages { path: PathBuf::from(input) });
    }
    let range = FrameRange::of(options)?;
    let positions = range.positions(images.len(), input)?;
    let source = ImageFiles::new(images[positions].to_vec(), range.start);
    Ok(without_ground_truth(Box::new(source), name, options))
}

fn without_ground_truth(
    source: Box<dyn super::FrameSource>,
    name: String,
    options: &OpenOptions,
) -> Sequence {
    let origin = options.origin.unwrap_or(Origin::Zero);
    Sequence { name, source, ground_truth: Vec::new(), ground_truth_row: None, origin }
}

fn refuse_target(input: &str, options: &OpenOptions) -> Result<(), SequenceError> {
    match options.target {
        Some(target) => Err(SequenceError::TargetWithoutChoice { input: input.to_owned(), target }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(input: &str, options: &OpenOptions) -> String {
        open(input, options).map(|_| ()).unwrap_err().to_string()
    }

    fn folder_of_images(count: usize) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for number in 1..=count {
            image::GrayImage::new(8, 6).save(folder.path().join(format!("{number}.png"))).unwrap();
        }
        folder
    }

    #[test]
    fn what_does_not_exist_is_named_with_a_remedy() {
        let text = message("no/such/folder", &OpenOptions::default());
        assert!(text.starts_with("no/such/folder: no such file or folder; check the spelling"), "{text}");
        let text = message("no/such/*.jpg", &OpenOptions::default());
        assert!(text.starts_with("no/such/*.jpg: no images there"), "{text}");
        let empty = tempfile::tempdir().unwrap();
        let text = message(empty.path().to_str().unwrap(), &OpenOptions::default());
        assert!(text.contains(": no images there; give a folder or glob"), "{text}");
    }

    #[test]
    fn folders_globs_and_single_images_are_plain_sequences() {
        let folder = folder_of_images(3);
        let path = folder.path().to_str().unwrap().to_owned();
        let name = folder.path().file_name().unwrap().to_str().unwrap();
        for (input, frames, expected) in [
            (path.clone(), 3, name),
            (format!("{path}/[12].png"), 2, name),
            (format!("{path}/3.png"), 1, "3"),
        ] {
            let mut sequence = open(&input, &OpenOptions::default()).unwrap();
            assert_eq!((sequence.source.remaining(), sequence.name.as_str()), (Some(frames), expected));
            assert_eq!((sequence.origin, sequence.ground_truth.len()), (Origin::Zero, 0));
            assert_eq!(sequence.source.next_frame().unwrap().unwrap().frame.width(), 8);
        }
    }

    #[test]
    fn a_range_cuts_any_images_and_keeps_their_numbers() {
        let folder = folder_of_images(5);
        let path = folder.path().to_str().unwrap();
        let options =
            OpenOptions { start: Some(2), end: Some(3), origin: Some(Origin::One), ..OpenOptions::default() };
        let mut sequence = open(path, &options).unwrap();
        assert_eq!((sequence.source.remaining(), sequence.origin), (Some(2), Origin::One));
        let numbers: Vec<usize> =
            std::iter::from_fn(|| sequence.source.next_frame().unwrap()).map(|frame| frame.number).collect();
        assert_eq!(numbers, [2, 3]);
        let text = message(path, &OpenOptions { start: Some(6), ..OpenOptions::default() });
        assert!(text.contains("--start 6:") && text.contains("only 5 frames"), "{text}");
    }

    #[test]
    fn only_known_urls_and_names_of_formats_reach_ffmpeg() {
        let stream = |input: &str| super::stream(input, &OpenOptions::default());
        assert!(matches!(stream("-"), Ok(Some(VideoInput::Standard))));
        assert!(matches!(stream("RTSP://camera/1"), Ok(Some(VideoInput::Url(_)))));
        for name in ["-i.mp4", "concat:a|b", "file:///etc", "://x", "a b://c"] {
            assert!(!matches!(stream(name), Ok(Some(_))), "{name}");
        }
        assert!(
            message("subfile://x", &OpenOptions::default())
                .contains("`subfile`; give one of: http, https, rtsp")
        );
        let folder = folder_of_images(1);
        let odd = folder.path().join("http:");
        std::fs::create_dir_all(odd.join("host")).unwrap();
        let text = message("-odd.mp4", &OpenOptions::default());
        assert!(text.contains("a file of that name is ./-odd.mp4"), "{text}");
        let options = OpenOptions { input_format: Some("v4l2 -y".into()), ..OpenOptions::default() };
        assert!(message("0", &options).contains("letters, digits and _ only"));
        let live = OpenOptions { live: true, ..OpenOptions::default() };
        assert!(message(folder.path().to_str().unwrap(), &live).contains("--realtime FPS"));
    }

    #[test]
    fn a_target_without_targets_names_the_flag() {
        let folder = folder_of_images(1);
        let path = folder.path().to_str().unwrap();
        let options = OpenOptions { target: Some(2), ..OpenOptions::default() };
        for input in [path.to_owned(), format!("{path}/*.png"), format!("{path}/1.png")] {
            assert!(message(&input, &options).contains("--target 2 has no meaning here"));
        }
    }

    #[test]
    fn an_existing_folder_is_not_a_glob_and_img_alone_is_plain() {
        let folder = folder_of_images(2);
        let odd = folder.path().join("odd[1]");
        std::fs::create_dir_all(odd.join("img")).unwrap();
        std::fs::copy(folder.path().join("1.png"), odd.join("img/1.png")).unwrap();
        let sequence = open(odd.to_str().unwrap(), &OpenOptions::default()).unwrap();
        assert_eq!((sequence.name.as_str(), sequence.origin), ("odd[1]", Origin::Zero));
        assert_eq!(sequence.source.remaining(), Some(1));
    }

    #[test]
    fn a_folder_given_by_dots_still_has_its_name() {
        let folder = folder_of_images(1);
        let dotted = folder.path().join("..").join(folder.path().file_name().unwrap()).join(".");
        let inner = folder.path().join("inner");
        std::fs::create_dir(&inner).unwrap();
        assert_eq!(folder_name(&dotted), folder_name(folder.path()));
        assert_eq!(folder_name(&inner.join("..")), folder_name(folder.path()));
    }
}
