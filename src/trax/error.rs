//! What can go wrong between a client and a server.

use std::io;

use thiserror::Error;

use crate::{sequence::SequenceError, tracker::TrackError};

/// A conversation that cannot go on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TraxError {
    /// A message that cannot be read.
    #[error("the message `{line}` cannot be read: {reason}")]
    BadMessage {
        /// The line as it came, shortened.
        line: String,
        /// What is wrong.
        reason: String,
    },
    /// A message that should not have come now.
    #[error("`{kind}` was not expected {when}")]
    Unexpected {
        /// The message's kind.
        kind: String,
        /// What should have come.
        when: &'static str,
    },
    /// A region that is neither a rectangle nor a polygon.
    #[error(
        "the region `{region}` {reason}; send a rectangle (x,y,w,h) or a polygon (x,y of three corners or more)"
    )]
    BadRegion {
        /// The region as it came, shortened.
        region: String,
        /// What is wrong.
        reason: &'static str,
    },
    /// An image that cannot be decoded.
    #[error(
        "the image `{image}` {reason}; send file:///PATH, data:image/png;base64;... or image:W;H;rgb;..."
    )]
    BadImage {
        /// The address as it came, shortened.
        image: String,
        /// What is wrong.
        reason: String,
    },
    /// An image file that cannot be decoded.
    #[error(transparent)]
    File(#[from] SequenceError),
    /// The tracker refuses a box or an image.
    #[error(transparent)]
    Track(#[from] TrackError),
    /// The other side cannot be heard or spoken to.
    #[error("the client cannot be reached: {0}")]
    Io(#[from] io::Error),
}

/// The start of a text that came from outside, for messages.
pub(super) fn shortened(text: &str) -> String {
    match text.char_indices().nth(120) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}
