//! TraX, the protocol by which evaluation tools speak with trackers of any language (Cehovin 2017), in both directions:
//! [`serve`] puts a tracker behind standard input and output, and [`Message`] is what a client reads and writes.
//!
//! A message is a line, `@@TRAX:` with its kind and arguments. The tracker says `hello`, then for each `initialize` and `frame`
//! it is sent it answers with `state`; either side may `quit`. Up to version 3 `initialize` carries image and region, since
//! version 4 the region only, and the image follows with `frame`.

mod error;
mod image;
mod message;
mod region;
mod server;

pub use error::TraxError;
pub use message::{Kind, Message, PREFIX};
pub use region::{parse_region, rectangle};
pub use server::{About, serve};
