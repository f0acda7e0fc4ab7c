//! Every frame has the first one's size.

use super::SequenceError;
use crate::frame::Frame;

/// Remembers the first frame's size and refuses every other.
#[derive(Debug, Default)]
pub(super) struct SizeGuard {
    first: Option<(usize, usize)>,
}

impl SizeGuard {
    pub(super) fn check(
        &mut self,
        frame: &Frame,
        label: impl FnOnce() -> String,
    ) -> Result<(), SequenceError> {
        let (width, height) = (frame.width(), frame.height());
        let (first_width, first_height) = *self.first.get_or_insert((width, height));
        if (width, height) == (first_width, first_height) {
            return Ok(());
        }
        Err(SequenceError::SizeChanged { label: label(), width, height, first_width, first_height })
    }
}
