//! The eleven attributes that sequences are marked with.

use std::{fmt, str::FromStr};

use serde::{Serialize, Serializer};

use super::CatalogueError;

/// A difficulty that a sequence has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Attribute {
    /// The illumination of the target changes much.
    IlluminationVariation,
    /// The target turns out of the image plane.
    OutOfPlaneRotation,
    /// The box's area leaves [1/2, 2] times the first one.
    ScaleVariation,
    /// The target is partly or fully hidden.
    Occlusion,
    /// The target is not rigid.
    Deformation,
    /// The target is blurred by motion.
    MotionBlur,
    /// The target moves by more than 20 pixels a frame.
    FastMotion,
    /// The target turns in the image plane.
    InPlaneRotation,
    /// Some of the target leaves the view.
    OutOfView,
    /// The background near the target looks like it.
    BackgroundClutters,
    /// Fewer than 400 pixels are in the box.
    LowResolution,
}

impl Attribute {
    /// All eleven, in the order of the benchmark's attribute files.
    pub const ALL: [Self; 11] = [
        Self::IlluminationVariation,
        Self::OutOfPlaneRotation,
        Self::ScaleVariation,
        Self::Occlusion,
        Self::Deformation,
        Self::MotionBlur,
        Self::FastMotion,
        Self::InPlaneRotation,
        Self::OutOfView,
        Self::BackgroundClutters,
        Self::LowResolution,
    ];

    /// The short name, such as `SV`.
    pub const fn code(self) -> &'static str {
        match self {
            Self::IlluminationVariation => "IV",
            Self::OutOfPlaneRotation => "OPR",
            Self::ScaleVariation => "SV",
            Self::Occlusion => "OCC",
            Self::Deformation => "DEF",
            Self::MotionBlur => "MB",
            Self::FastMotion => "FM",
            Self::InPlaneRotation => "IPR",
            Self::OutOfView => "OV",
            Self::BackgroundClutters => "BC",
            Self::LowResolution => "LR",
        }
    }

    /// The long name, such as `scale variation`.
    pub const fn title(self) -> &'static str {
        match self {
            Self::IlluminationVariation => "illumination variation",
            Self::OutOfPlaneRotation => "out-of-plane rotation",
            Self::ScaleVariation => "scale variation",
            Self::Occlusion => "occlusion",
            Self::Deformation => "deformation",
            Self::MotionBlur => "motion blur",
            Self::FastMotion => "fast motion",
            Self::InPlaneRotation => "in-plane rotation",
            Self::OutOfView => "out of view",
            Self::BackgroundClutters => "background clutters",
            Self::LowResolution => "low resolution",
        }
    }
}

impl fmt::Display for Attribute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.code())
    }
}

impl FromStr for Attribute {
    type Err = CatalogueError;

    fn from_str(word: &str) -> Result<Self, CatalogueError> {
        let is_meant = |attribute: &Self| attribute.code().eq_ignore_ascii_case(word.trim());
        Self::ALL
            .into_iter()
            .find(is_meant)
            .ok_or_else(|| CatalogueError::Attribute { word: word.to_owned() })
    }
}

impl Serialize for Attribute {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.code())
    }
}

/// Some of the eleven attributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AttributeSet(u16);

impl AttributeSet {
    /// Whether the attribute is among them.
    pub fn contains(self, attribute: Attribute) -> bool {
        self.0 & (1 << attribute as u16) != 0
    }

    /// The attributes, in the order of [`Attribute::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Attribute> {
        Attribute::ALL.into_iter().filter(move |attribute| self.contains(*attribute))
    }
}

impl FromIterator<Attribute> for AttributeSet {
    fn from_iter<I: IntoIterator<Item = Attribute>>(attributes: I) -> Self {
        Self(attributes.into_iter().fold(0, |bits, attribute| bits | 1 << attribute as u16))
    }
}

/// Who says which attributes a sequence has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum AttributeSource {
    /// The benchmark's own list, `tb_100.txt`, which the published scores by attribute and most papers use.
    #[serde(rename = "tb_100.txt")]
    Tb100Txt,
    /// pysot's `OTB100.json`, which agrees with the benchmark's attribute files and better with the boxes.
    #[serde(rename = "OTB100.json")]
    Json,
}

impl fmt::Display for AttributeSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Tb100Txt => "tb_100.txt",
            Self::Json => "OTB100.json",
        })
    }
}

impl FromStr for AttributeSource {
    type Err = CatalogueError;

    fn from_str(word: &str) -> Result<Self, CatalogueError> {
        match word.to_ascii_lowercase().as_str() {
            "tb100" | "tb_100.txt" => Ok(Self::Tb100Txt),
            "json" | "otb100.json" => Ok(Self::Json),
            _ => Err(CatalogueError::Source { word: word.to_owned() }),
        }
    }
}
