//! The paper's "structure N": a body partitioned top to bottom into head, torso and legs (Fig. 5).

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::Rect;

/// Shares of the full box's height that head, torso and legs take; they sum to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyPlan {
    /// S1, from the top edge down.
    pub head: f64,
    /// S2, below the head.
    pub torso: f64,
    /// S3, down to the bottom edge.
    pub legs: f64,
}

impl BodyPlan {
    /// A standing person: a head of 1/8, a torso of 4/8 and legs of 3/8, so that S1 + S2 is the upper 5/8.
    pub const PERSON: Self = Self { head: 0.125, torso: 0.5, legs: 0.375 };

    /// Share of the height above the legs: S1 + S2.
    pub fn informative_fraction(&self) -> f64 {
        self.head + self.torso
    }
}

/// Which part of the full box is tracked. The full box is recovered from it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Region {
    /// Head and torso of [`BodyPlan::PERSON`]: the upper 5/8.
    #[default]
    Part,
    /// The whole box: the baseline.
    Whole,
    /// The upper fraction of the box, in (0, 1].
    Upper(f64),
}

impl Region {
    /// The share of the full box's height that is tracked, from the top edge down, in (0, 1].
    pub fn fraction(&self) -> f64 {
        match *self {
            Self::Part => BodyPlan::PERSON.informative_fraction(),
            Self::Whole => 1.0,
            Self::Upper(fraction) => fraction,
        }
    }

    /// The tracked part of a full box.
    pub fn part_from_full(&self, full: Rect) -> Rect {
        Rect { h: full.h * self.fraction(), ..full }
    }

    /// The full box around a tracked part.
    pub fn full_from_part(&self, part: Rect) -> Rect {
        Rect { h: part.h / self.fraction(), ..part }
    }
}

/// A region that is neither a name nor a fraction.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("region `{given}` is neither `part`, `whole` nor a fraction in (0, 1], such as 0.625 or 5/8")]
pub struct RegionError {
    given: String,
}

impl FromStr for Region {
    type Err = RegionError;

    fn from_str(text: &str) -> Result<Self, RegionError> {
        let error = || RegionError { given: text.to_owned() };
        let fraction = match text {
            "part" => return Ok(Self::Part),
            "whole" => return Ok(Self::Whole),
            _ => match text.split_once('/') {
                Some((top, bottom)) => {
                    let number = |t: &str| t.trim().parse::<f64>().map_err(|_| error());
                    number(top)? / number(bottom)?
                }
                None => text.parse().map_err(|_| error())?,
            },
        };
        if fraction > 0.0 && fraction <= 1.0 { Ok(Self::Upper(fraction)) } else { Err(error()) }
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Part => f.write_str("part"),
            Self::Whole => f.write_str("whole"),
            Self::Upper(fraction) => write!(f, "{fraction}"),
        }
    }
}

impl Serialize for Region {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Region {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl serde::de::Visitor<'_> for Visitor {
            type Value = Region;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("`part`, `whole` or a fraction in (0, 1]")
            }
            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Region, E> {
                text.parse().map_err(E::custom)
            }
            fn visit_f64<E: serde::de::Error>(self, fraction: f64) -> Result<Region, E> {
                fraction.to_string().parse().map_err(E::custom)
            }
            fn visit_i64<E: serde::de::Error>(self, fraction: i64) -> Result<Region, E> {
                fraction.to_string().parse().map_err(E::custom)
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_informative_part_of_a_person_is_the_upper_five_eighths() {
        let full = Rect::new(10.0, 20.0, 32.0, 80.0);
        assert_eq!(Region::Part.part_from_full(full), Rect::new(10.0, 20.0, 32.0, 50.0));
        let plan = BodyPlan::PERSON;
        assert_eq!(plan.head + plan.torso + plan.legs, 1.0);
    }

    #[test]
    fn regions_parse_print_and_refuse() {
        assert_eq!("part".parse(), Ok(Region::Part));
        assert_eq!("5/8".parse(), Ok(Region::Upper(0.625)));
        assert_eq!("1".parse(), Ok(Region::Upper(1.0)));
        assert_eq!(Region::Upper(0.625).to_string().parse(), Ok(Region::Upper(0.625)));
        for bad in ["0", "-1", "1.01", "nan", "inf", "1/0", "legs", "", "/"] {
            assert!(bad.parse::<Region>().is_err(), "{bad}");
        }
    }

    proptest::proptest! {
        #[test]
        fn part_and_full_are_inverse(
            x in -1e3..1e3f64, y in -1e3..1e3f64, w in 0.1..1e3f64, h in 0.1..1e3f64, fraction in 0.05..1.0f64
        ) {
            let full = Rect::new(x, y, w, h);
            for region in [Region::Part, Region::Whole, Region::Upper(fraction)] {
                let back = region.full_from_part(region.part_from_full(full));
                proptest::prop_assert!((back.h - h).abs() <= 1e-12 * h);
                proptest::prop_assert_eq!((back.x, back.y, back.w), (x, y, w));
            }
        }
    }
}
