//! What ffmpeg is to read, and how it is told.

use std::{
    ffi::OsString,
    path::{Path, PathBuf},
    process::Stdio,
};

/// What ffmpeg is to read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in super::super) enum VideoInput {
    /// A file.
    File(PathBuf),
    /// A named pipe.
    #[cfg_attr(not(unix), allow(dead_code))]
    Fifo(PathBuf),
    /// Standard input.
    Standard,
    /// An address that was meant as one.
    Url(String),
    /// A capture device, by ffmpeg's name of its kind and its own.
    Device {
        /// ffmpeg's `-f`.
        format: String,
        /// What ffmpeg calls the device.
        name: String,
    },
}

impl VideoInput {
    /// What messages call it.
    pub(super) fn name(&self) -> PathBuf {
        match self {
            Self::File(path) | Self::Fifo(path) => path.clone(),
            Self::Standard => PathBuf::from("standard input"),
            Self::Url(name) | Self::Device { name, .. } => PathBuf::from(name),
        }
    }

    /// The options before `-i`, and what follows it. With the protocol named, no path is taken for an option, a URL or a pattern.
    pub(super) fn arguments(&self) -> (Vec<&str>, OsString) {
        let file = |path: &Path| {
            let mut input = OsString::from("file:");
            input.push(path);
            input
        };
        match self {
            Self::File(path) | Self::Fifo(path) => (vec![], file(path)),
            Self::Standard => (vec![], "pipe:0".into()),
            Self::Url(url) => (vec!["-fflags", "nobuffer"], url.into()),
            Self::Device { format, name } => (vec!["-fflags", "nobuffer", "-f", format], name.into()),
        }
    }

    pub(super) fn stdin(&self) -> Stdio {
        if *self == Self::Standard { Stdio::inherit() } else { Stdio::null() }
    }
}
