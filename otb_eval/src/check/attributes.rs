//! Step 4: three attributes are defined by the boxes alone, so labels can be held against them.

use std::collections::BTreeMap;

use infopart::geometry::Rect;
use serde::Serialize;

use super::Finding;
use crate::catalogue::{self, Attribute, AttributeSource};

/// Scale variation: the area leaves [1/2, 2] times the first one.
const SCALE_RATIO: f64 = 2.0;
/// Fast motion: a step of more pixels.
const FAST_STEP: f64 = 20.0;
/// Low resolution: fewer pixels in the box.
const FEW_PIXELS: f64 = 400.0;

const SOURCES: [(AttributeSource, &str); 2] =
    [(AttributeSource::Tb100Txt, "tb_100.txt"), (AttributeSource::Json, "OTB100.json")];

/// Extremes of a target's boxes, each with its row, counted from 1. Rows that are no boxes do not count.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Measured {
    /// The area over the first one, or the first one over it, whichever is more: the largest.
    pub area_ratio: (f64, usize),
    /// The largest step of the centre between frames that follow each other, pixels.
    pub step: (f64, usize),
    /// The smallest area, pixels.
    pub area: (f64, usize),
}

impl Measured {
    /// Whether the boxes have an attribute that they define; `None` for the other eight.
    pub fn has(&self, attribute: Attribute) -> Option<bool> {
        match attribute {
            Attribute::ScaleVariation => Some(self.area_ratio.0 > SCALE_RATIO),
            Attribute::FastMotion => Some(self.step.0 > FAST_STEP),
            Attribute::LowResolution => Some(self.area.0 < FEW_PIXELS),
            _ => None,
        }
    }

    fn reason(&self, attribute: Attribute) -> String {
        match attribute {
            Attribute::ScaleVariation => {
                format!("area x or / {:.2} in row {}", self.area_ratio.0, self.area_ratio.1)
            }
            Attribute::FastMotion => format!("largest step {:.1} px to row {}", self.step.0, self.step.1),
            _ => format!("smallest box {:.0} px in row {}", self.area.0, self.area.1),
        }
    }
}

/// Measures a target's boxes; `None` if the first row is no box.
pub fn measure(truth: &[Rect]) -> Option<Measured> {
    let first = truth.first().filter(|row| row.is_proper())?;
    let mut measured = Measured { area_ratio: (1.0, 1), step: (0.0, 1), area: (first.area(), 1) };
    for (index, row) in truth.iter().enumerate().skip(1).filter(|(_, row)| row.is_proper()) {
        let (number, ratio) = (index + 1, row.area() / first.area());
        let ratio = ratio.max(ratio.recip());
        if ratio > measured.area_ratio.0 {
            measured.area_ratio = (ratio, number);
        }
        if row.area() < measured.area.0 {
            measured.area = (row.area(), number);
        }
        let before = &truth[index - 1];
        let step = if before.is_proper() { before.centre_distance(row) } else { 0.0 };
        if step > measured.step.0 {
            measured.step = (step, number);
        }
    }
    Some(measured)
}

/// A target's attributes by source; nothing if it is none of TB-100.
pub(super) fn labels(name: &str) -> BTreeMap<&'static str, String> {
    let codes = |source: AttributeSource| {
        let known = catalogue::find(name)?;
        Some(known.attributes(source).iter().map(Attribute::code).collect::<Vec<_>>().join(" "))
    };
    SOURCES.into_iter().filter_map(|(source, file)| Some((file, codes(source)?))).collect()
}

/// Where the sources differ, and where a label says something else than the boxes.
pub(super) fn contradictions(name: &str, measured: Option<&Measured>, findings: &mut Vec<Finding>) {
    let Some(known) = catalogue::find(name) else { return };
    let sets = SOURCES.map(|(source, file)| (known.attributes(source), file));
    if sets[0].0 != sets[1].0 {
        let only = |this: usize, other: usize| {
            let codes: Vec<&str> = sets[this]
                .0
                .iter()
                .filter(|one| !sets[other].0.contains(*one))
                .map(Attribute::code)
                .collect();
            (!codes.is_empty()).then(|| format!("only {} has {}", sets[this].1, codes.join(" ")))
        };
        let differences: Vec<String> = [only(0, 1), only(1, 0)].into_iter().flatten().collect();
        findings
            .push(Finding::oddity(format!("the sources of attributes differ: {}", differences.join(", "))));
    }
    for attribute in Attribute::ALL {
        let Some((measured, has)) = measured.and_then(|measured| Some((measured, measured.has(attribute)?)))
        else {
            continue;
        };
        let wrong: Vec<&str> =
            sets.iter().filter(|(set, _)| set.contains(attribute) != has).map(|(_, file)| *file).collect();
        if !wrong.is_empty() {
            let boxes = if has { "have" } else { "do not have" };
            let labels = match (wrong.len(), has) {
                (1, true) => "does not say so",
                (1, false) => "says so",
                (_, true) => "do not say so",
                (_, false) => "say so",
            };
            findings.push(Finding::oddity(format!(
                "the boxes {boxes} {attribute} ({}), but {} {labels}",
                measured.reason(attribute),
                wrong.join(" and ")
            )));
        }
    }
}
