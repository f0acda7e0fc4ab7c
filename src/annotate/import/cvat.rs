//! CVAT for video XML 1.1: tracks of boxes; what is not a box is left out.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};

use super::{Row, RowTrack, no_class};
use crate::geometry::Rect;

pub(super) fn tracks(text: &str) -> Result<Vec<RowTrack>, String> {
    let xml = Document::parse(text).map_err(|error| format!("is no whole XML: {error}"))?;
    if !xml.root_element().has_tag_name("annotations") {
        return Err("is no XML of CVAT, which begins with <annotations>".to_owned());
    }
    let tracks: Vec<Node<'_, '_>> =
        xml.root_element().children().filter(|node| node.has_tag_name("track")).collect();
    if tracks.is_empty() && xml.descendants().any(|node| node.has_tag_name("image")) {
        return Err(
            "is CVAT for images, which does not say which boxes are one object; export CVAT for video"
                .to_owned(),
        );
    }
    tracks.iter().map(track).collect()
}

fn track(node: &Node<'_, '_>) -> Result<RowTrack, String> {
    let class = node.attribute("label").map_or_else(no_class, ToOwned::to_owned);
    let id = node.attribute("id").unwrap_or("?");
    let mut name = None;
    let mut rows = BTreeMap::new();
    for shape in node.children().filter(|child| child.has_tag_name("box")) {
        if name.is_none() {
            name = named(&shape);
        }
        if shape.attribute("outside") == Some("1") {
            continue;
        }
        let number = |attribute: &str| -> Result<f64, String> {
            shape
                .attribute(attribute)
                .and_then(|text| text.parse().ok())
                .ok_or_else(|| format!("track {id}: a box has no number as {attribute:?}"))
        };
        let frame = number("frame")?;
        if !(frame >= 0.0 && frame.fract() == 0.0) {
            return Err(format!("track {id}: a box is in frame {frame}; frames count from 0 here"));
        }
        let (x, y) = (number("xtl")?, number("ytl")?);
        let rect = Rect::new(x, y, number("xbr")? - x, number("ybr")? - y);
        let is_key = Some(shape.attribute("keyframe") == Some("1"));
        rows.insert(frame as usize, Row { rect, confidence: 1.0, is_key });
    }
    Ok(RowTrack { name: name.unwrap_or_else(|| format!("{class} {id}")), class, rows })
}

/// The attribute `name`, which the export writes.
fn named(shape: &Node<'_, '_>) -> Option<String> {
    let attribute = shape.children().find(|child| child.attribute("name") == Some("name"))?;
    attribute.text().map(ToOwned::to_owned).filter(|text| !text.is_empty())
}
