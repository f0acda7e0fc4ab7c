//! A tracker as bytes, and back: a tracker saved at a frame goes on from there to the same bits.
//!
//! The bytes are a mark, the version of this package, a checksum, and the parameters and all that is known of the target
//! as MessagePack. They are read by the version that wrote them.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{
    InfoPart, ParameterError, Parameters,
    infopart::{Target, Unsaved},
};
use crate::VERSION;

const MARK: &[u8] = b"InfoPart tracker\n";

/// Bytes that no tracker can be made of.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// They do not begin as a saved tracker does.
    #[error("these bytes are no saved tracker; give what `save` gave")]
    NotATracker,
    /// Another version wrote them.
    #[error(
        "the tracker was saved by InfoPart {theirs}, this is {VERSION}: load it with that version, or start anew"
    )]
    OtherVersion {
        /// The version that saved it.
        theirs: String,
    },
    /// They are not those that were saved.
    #[error("the saved tracker is damaged ({reason}); save it again")]
    Damaged {
        /// What is wrong.
        reason: String,
    },
    /// The parameters among them cannot run.
    #[error("the saved tracker's parameters: {0}")]
    Parameters(#[from] ParameterError),
}

#[derive(Serialize)]
struct Leaving<'a> {
    parameters: &'a Parameters,
    target: Option<&'a Target>,
}

#[derive(Deserialize)]
struct Coming {
    parameters: Parameters,
    target: Option<Target>,
}

impl InfoPart {
    /// The tracker as bytes, of some megabytes at most: parameters and all that is known of the target, but not where it works.
    ///
    /// # Errors
    /// [`LoadError::Damaged`] if something cannot be written, which nothing is known to cause.
    pub fn save(&self) -> Result<Vec<u8>, LoadError> {
        let Unsaved { parameters, target } = self.unsaved();
        let body = rmp_serde::to_vec_named(&Leaving { parameters, target })
            .map_err(|error| LoadError::Damaged { reason: error.to_string() })?;
        let head = [MARK, VERSION.as_bytes(), b"\n", &checksum(&body).to_le_bytes()];
        Ok([&head.concat(), body.as_slice()].concat())
    }

    /// The tracker that [`save`](Self::save) made these bytes of. It works where a new one would.
    ///
    /// # Errors
    /// [`LoadError`] for any other bytes.
    pub fn load(bytes: &[u8]) -> Result<Self, LoadError> {
        let rest = bytes.strip_prefix(MARK).ok_or(LoadError::NotATracker)?;
        let end = rest.iter().position(|byte| *byte == b'\n').ok_or(LoadError::NotATracker)?;
        let (version, rest) = (&rest[..end], &rest[end + 1..]);
        if version != VERSION.as_bytes() {
            return Err(LoadError::OtherVersion { theirs: String::from_utf8_lossy(version).into_owned() });
        }
        let damaged = |reason: &str| LoadError::Damaged { reason: reason.to_owned() };
        let (sum, body) = rest.split_first_chunk().ok_or_else(|| damaged("it ends too soon"))?;
        if u64::from_le_bytes(*sum) != checksum(body) {
            return Err(damaged("its checksum is another"));
        }
        let Coming { parameters, target } =
            rmp_serde::from_slice(body).map_err(|error| damaged(&error.to_string()))?;
        Ok(Self::resumed(parameters.check()?, target))
    }
}

/// FNV-1a of 64 bits: finds damage, not malice.
fn checksum(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        frame::{Frame, PixelFormat},
        geometry::Rect,
        tracker::{Estimate, Tracker},
    };

    /// A textured square that moves by (2, 1) pixels a frame, in colour.
    fn scene(frame: usize) -> Frame {
        let (left, top) = (20 + 2 * frame, 24 + frame);
        let pixel = |i: usize| {
            let (x, y) = (i % 96, i / 96);
            let inside = (left..left + 16).contains(&x) && (top..top + 24).contains(&y);
            let texture = if inside { (x - left) * 9 + (y - top) * 5 } else { x * 3 + y * 7 } % 120;
            [texture as u8, if inside { 200 } else { 40 }, (texture / 2) as u8]
        };
        Frame::new((0..96 * 72).flat_map(pixel).collect(), 96, 72, PixelFormat::Rgb).unwrap()
    }

    fn started(preset: &str) -> InfoPart {
        let mut tracker = InfoPart::new(Parameters::preset(preset).unwrap().check().unwrap());
        tracker.init(scene(0).view(), Rect::new(20.0, 24.0, 16.0, 24.0)).unwrap();
        tracker
    }

    fn go_on(tracker: &mut InfoPart, frames: std::ops::Range<usize>) -> Vec<Estimate> {
        frames.map(|frame| tracker.update(scene(frame).view()).unwrap()).collect()
    }

    #[test]
    fn a_tracker_saved_at_any_frame_goes_on_to_the_same_bits() {
        for (preset, saved_at) in [("default", 1), ("default", 2), ("default", 5), ("paper", 4)] {
            let mut tracker = started(preset);
            go_on(&mut tracker, 1..saved_at);
            let mut loaded = InfoPart::load(&tracker.save().unwrap()).unwrap();
            assert_eq!(loaded.estimate(), tracker.estimate());
            assert_eq!(loaded.hypotheses(), tracker.hypotheses());
            let frames = saved_at..saved_at + 10;
            assert_eq!(
                go_on(&mut loaded, frames.clone()),
                go_on(&mut tracker, frames),
                "{preset} {saved_at}"
            );
            assert_eq!(loaded.save().unwrap(), tracker.save().unwrap(), "{preset} {saved_at}");
        }
    }

    #[test]
    fn a_tracker_that_was_not_started_is_saved_too() {
        let parameters = Parameters { seed: 77, ..Parameters::default() };
        let tracker = InfoPart::new(parameters.check().unwrap());
        let loaded = InfoPart::load(&tracker.save().unwrap()).unwrap();
        assert_eq!(loaded.parameters().seed, 77);
        assert!(loaded.estimate().is_none());
    }

    #[test]
    fn other_bytes_are_refused_with_what_is_wrong() {
        let saved = started("default").save().unwrap();
        let why = |bytes: &[u8]| InfoPart::load(bytes).map(|_| ()).unwrap_err().to_string();
        assert!(why(b"").contains("no saved tracker"));
        assert!(why(&saved[1..]).contains("no saved tracker"));
        assert!(why(&saved[..MARK.len() + VERSION.len() + 3]).contains("too soon"));
        assert!(why(&saved[..saved.len() - 1]).contains("checksum"));
        let mut flipped = saved.clone();
        *flipped.last_mut().unwrap() ^= 1;
        assert!(why(&flipped).contains("checksum"));
        let mut older = saved;
        older[MARK.len()] = b'7';
        assert!(why(&older).contains(&format!("7{}", &VERSION[1..])));
    }
}
