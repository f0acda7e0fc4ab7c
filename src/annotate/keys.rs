//! What somebody says of an object: key frames, and the object's name, class and colour.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::geometry::Rect;

/// What a key frame says.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mark {
    /// The object is here: its box in frame coordinates, pixels.
    Box(Rect),
    /// The object is not to be seen from this frame on, until the next key frame with a box.
    Absent,
}

impl Mark {
    /// The box, unless the object is absent.
    pub fn in_frame(&self) -> Option<Rect> {
        match self {
            Self::Box(rect) => Some(*rect),
            Self::Absent => None,
        }
    }
}

/// A colour as `#rrggbb`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Colour {
    /// Red, green, blue.
    pub rgb: [u8; 3],
}

impl Colour {
    /// Colours that are easy to tell apart, one for each object in turn.
    pub const fn of_object(index: usize) -> Self {
        const WHEEL: [[u8; 3]; 8] = [
            [0xe6, 0x19, 0x4b],
            [0x3c, 0xb4, 0x4b],
            [0x43, 0x63, 0xd8],
            [0xf5, 0x82, 0x31],
            [0x91, 0x1e, 0xb4],
            [0x46, 0xf0, 0xf0],
            [0xf0, 0x32, 0xe6],
            [0xff, 0xe1, 0x19],
        ];
        Self { rgb: WHEEL[index % WHEEL.len()] }
    }
}

impl TryFrom<String> for Colour {
    type Error = KeyError;

    fn try_from(text: String) -> Result<Self, KeyError> {
        let digits = text
            .strip_prefix('#')
            .filter(|digits| digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
        let number = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        match number {
            Some(number) => {
                let [_, rgb @ ..] = number.to_be_bytes();
                Ok(Self { rgb })
            }
            None => Err(KeyError::Colour { text }),
        }
    }
}

impl From<Colour> for String {
    fn from(Colour { rgb: [red, green, blue] }: Colour) -> Self {
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}

/// An object with its key frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// What it is called; any text.
    pub name: String,
    /// What it is, such as `person`; any text.
    pub class: String,
    /// How it is drawn.
    pub colour: Colour,
    /// What is said of it, by frame, counted from 0.
    pub keys: BTreeMap<usize, Mark>,
}

impl Object {
    /// Whether an object of a video of `frames` frames of `width` x `height` pixels can be annotated.
    ///
    /// # Errors
    /// [`KeyError`]: no box at all, a frame that the video has not, a box without area or outside the picture.
    pub fn check(&self, frames: usize, width: usize, height: usize) -> Result<(), KeyError> {
        let name = || self.name.clone();
        if !self.keys.values().any(|mark| mark.in_frame().is_some()) {
            return Err(KeyError::NoBox { name: name() });
        }
        for (&frame, mark) in &self.keys {
            let number = frame + 1;
            if frame >= frames {
                return Err(KeyError::NoSuchFrame { name: name(), number, frames });
            }
            let Some(given) = mark.in_frame() else { continue };
            if !given.is_proper() {
                return Err(KeyError::BadBox { name: name(), number, given });
            }
            if given.clipped_to(width, height).is_none() {
                return Err(KeyError::Outside { name: name(), number, given, width, height });
            }
        }
        Ok(())
    }
}

/// Why an object cannot be annotated as it is.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum KeyError {
    /// A colour that is none.
    #[error("the colour {text:?} is not of the form #rrggbb, such as #e6194b")]
    Colour {
        /// What stands there.
        text: String,
    },
    /// An object that is nowhere.
    #[error("object {name:?} has no key frame with a box; give it one, or leave the object out")]
    NoBox {
        /// The object.
        name: String,
    },
    /// A key frame beyond the video.
    #[error("object {name:?}: there is no frame {number}; the input has {frames} frames, counted from 1")]
    NoSuchFrame {
        /// The object.
        name: String,
        /// The frame, counted from 1.
        number: usize,
        /// Frames of the input.
        frames: usize,
    },
    /// A box that is none.
    #[error(
        "object {name:?}, frame {number}: the box {x},{y},{w},{h} needs finite numbers and a positive width and height",
        x = given.x, y = given.y, w = given.w, h = given.h
    )]
    BadBox {
        /// The object.
        name: String,
        /// The frame, counted from 1.
        number: usize,
        /// The box as given.
        given: Rect,
    },
    /// A box that no pixel of the picture is in.
    #[error(
        "object {name:?}, frame {number}: the box {x},{y},{w},{h} has no pixel inside the {width}x{height} frame; \
         draw it inside, or mark the object absent there",
        x = given.x, y = given.y, w = given.w, h = given.h
    )]
    Outside {
        /// The object.
        name: String,
        /// The frame, counted from 1.
        number: usize,
        /// The box as given.
        given: Rect,
        /// Width of a frame, pixels.
        width: usize,
        /// Height of a frame, pixels.
        height: usize,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    fn object(keys: &[(usize, Mark)]) -> Object {
        Object {
            name: "a \"b\"".into(),
            class: "person".into(),
            colour: Colour::of_object(0),
            keys: keys.iter().copied().collect(),
        }
    }

    fn mark(x: f64, w: f64) -> Mark {
        Mark::Box(Rect::new(x, 5.0, w, 20.0))
    }

    #[test]
    fn colours_are_read_as_they_are_written_and_nothing_else_is_one() {
        assert_eq!(Colour::try_from("#0aF0ff".to_owned()).unwrap().rgb, [10, 240, 255]);
        assert_eq!(String::from(Colour { rgb: [10, 240, 255] }), "#0af0ff");
        for bad in ["", "#", "red", "#12345", "#1234567", "#+12345", "#12é45"] {
            assert!(Colour::try_from(bad.to_owned()).is_err(), "{bad}");
        }
    }

    #[test]
    fn what_cannot_be_annotated_is_named_with_its_frame_from_1() {
        let check =
            |keys: &[(usize, Mark)]| object(keys).check(10, 64, 48).map_err(|error| error.to_string());
        assert_eq!(check(&[(9, mark(-5.0, 10.0)), (3, Mark::Absent)]), Ok(()));
        for (keys, reason) in [
            (vec![], "no key frame with a box"),
            (vec![(0, Mark::Absent)], "no key frame with a box"),
            (vec![(10, mark(1.0, 10.0))], "no frame 11; the input has 10 frames"),
            (vec![(4, mark(1.0, 0.0))], "frame 5: the box 1,5,0,20 needs"),
            (vec![(4, mark(f64::NAN, 9.0))], "frame 5: the box NaN"),
            (vec![(4, mark(64.0, 9.0))], "frame 5: the box 64,5,9,20 has no pixel inside the 64x48"),
        ] {
            let message = check(&keys).unwrap_err();
            assert!(message.contains(reason) && message.contains(r#""a \"b\"""#), "{message}");
        }
    }
}
