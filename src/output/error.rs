//! What can be wrong with an output. Every message says what to do.

use std::{io, path::PathBuf};

use thiserror::Error;

/// Output that could not be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The file system refused.
    #[error("{path}: cannot be written: {source}; choose another path or make room", path = path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The path names a folder where a file is to be written.
    #[error("{path}: is a folder; give the path of a file", path = path.display())]
    IsFolder {
        /// The path as given.
        path: PathBuf,
    },
    /// A picture could not be encoded or written.
    #[error("{path}: the picture cannot be written: {source}; choose another path or make room", path = path.display())]
    Picture {
        /// The picture's file.
        path: PathBuf,
        /// The encoder's reason.
        source: image::ImageError,
    },
    /// Standard output refused a row.
    #[error("standard output cannot be written: {source}; write to a file with --out")]
    StandardOutput {
        /// The system's reason.
        source: io::Error,
    },
    /// Whoever read standard output has seen enough (`infopart ... | head`). Not a failure of the user's.
    #[error("standard output was closed by its reader")]
    Closed,
    /// The ffmpeg program is not there.
    #[error(
        "{path}: a video needs the ffmpeg program, and `{program}` cannot be started: {source}; install it \
         (apt install ffmpeg, brew install ffmpeg, winget install ffmpeg), set INFOPART_FFMPEG to where it is, \
         or annotate into a folder instead",
        path = path.display()
    )]
    NoFfmpeg {
        /// The video's file.
        path: PathBuf,
        /// The program that was tried.
        program: String,
        /// The system's reason.
        source: io::Error,
    },
    /// ffmpeg ended before the video was whole.
    #[error("{path}: ffmpeg could not write the video: {message}; annotate into a folder instead, or use an ffmpeg with libx264", path = path.display())]
    Ffmpeg {
        /// The video's file.
        path: PathBuf,
        /// The last thing ffmpeg said.
        message: String,
    },
}
