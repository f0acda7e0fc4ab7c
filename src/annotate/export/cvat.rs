//! CVAT for video XML 1.1.
//!
//! A track has a box in every frame. Those that CVAT is to treat as key frames are few, so that a person can edit the track: the key
//! frames that were drawn, and where straight lines between key frames would err by more than a pixel.

use std::fmt::Write;

use super::Tracks;
use crate::{annotate::track::Annotated, geometry::Rect};

/// How far, in pixels, a side of a box may be off the straight line between key frames.
const TOLERANCE: f64 = 1.0;

pub(super) fn xml(tracks: &Tracks<'_>) -> String {
    let about = tracks.about;
    let mut xml =
        String::from("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<annotations>\n  <version>1.1</version>\n");
    // Writing to a String does not fail.
    let _ = write!(
        xml,
        "  <meta>\n    <task>\n      <name>{}</name>\n      <size>{}</size>\n      <mode>interpolation</mode>\n      \
         <overlap>0</overlap>\n      <start_frame>0</start_frame>\n      <stop_frame>{}</stop_frame>\n      <frame_filter></frame_filter>\n      \
         <labels>\n",
        escaped(&about.name),
        about.frames,
        about.frames.saturating_sub(1),
    );
    for class in tracks.classes() {
        let _ = write!(
            xml,
            "        <label>\n          <name>{}</name>\n          <type>any</type>\n          <attributes>\n            <attribute>\n              \
             <name>name</name>\n              <mutable>False</mutable>\n              <input_type>text</input_type>\n              \
             <default_value></default_value>\n              <values></values>\n            </attribute>\n          </attributes>\n        \
             </label>\n",
            escaped(class)
        );
    }
    let _ = write!(
        xml,
        "      </labels>\n      <original_size>\n        <width>{}</width>\n        <height>{}</height>\n      </original_size>\n    \
         </task>\n  </meta>\n",
        about.width, about.height
    );
    for (number, (object, track)) in tracks.objects.iter().zip(tracks.tracks).enumerate() {
        let class = escaped(&object.class);
        let _ = writeln!(xml, "  <track id=\"{number}\" label=\"{class}\" source=\"semi-auto\">");
        let name = escaped(&object.name);
        let is_key = editable_frames(track);
        let mut before: Option<Rect> = None;
        for (frame, found) in track.iter().enumerate() {
            match (found, before) {
                (Some(found), _) => {
                    write_box(&mut xml, frame, &found.box_in_frame, is_key[frame], false, &name)
                }
                (None, Some(last)) => write_box(&mut xml, frame, &last, true, true, &name),
                (None, None) => {}
            }
            before = found.map(|found| found.box_in_frame);
        }
        xml.push_str("  </track>\n");
    }
    xml.push_str("</annotations>\n");
    xml
}

fn write_box(xml: &mut String, frame: usize, rect: &Rect, is_key: bool, is_outside: bool, name: &str) {
    let (key, outside) = (u8::from(is_key), u8::from(is_outside));
    let _ = write!(
        xml,
        "    <box frame=\"{frame}\" keyframe=\"{key}\" outside=\"{outside}\" occluded=\"0\" xtl=\"{:.2}\" ytl=\"{:.2}\" xbr=\"{:.2}\" \
         ybr=\"{:.2}\" z_order=\"0\">\n      <attribute name=\"name\">{name}</attribute>\n    </box>\n",
        rect.x,
        rect.y,
        rect.right(),
        rect.bottom(),
    );
}

/// Text for XML 1.0, in elements and in attributes; characters that XML cannot have become U+FFFD.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&apos;"),
            '\n' | '\r' | '\t' => {
                let _ = write!(escaped, "&#{};", u32::from(letter));
            }
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// Which frames are key frames of an editable track: those that were drawn, the first and last of each stretch, and between them as many
/// as straight lines need to err by no more than a pixel.
pub fn editable_frames(track: &[Option<Annotated>]) -> Vec<bool> {
    let mut is_key = vec![false; track.len()];
    let mut start = 0;
    while start < track.len() {
        let stretch = track[start..].iter().take_while(|found| found.is_some()).count();
        if stretch > 0 {
            let edges: Vec<[f64; 4]> = track[start..start + stretch]
                .iter()
                .flatten()
                .map(|found| edges(&found.box_in_frame))
                .collect();
            let mut fixed: Vec<usize> =
                (0..stretch).filter(|&k| track[start + k].is_some_and(|found| found.is_key)).collect();
            fixed.extend([0, stretch - 1]);
            fixed.sort_unstable();
            fixed.dedup();
            fixed.iter().for_each(|&k| is_key[start + k] = true);
            let mut open: Vec<(usize, usize)> = fixed.windows(2).map(|pair| (pair[0], pair[1])).collect();
            while let Some((a, b)) = open.pop() {
                if let Some(worst) = furthest(&edges, a, b) {
                    is_key[start + worst] = true;
                    open.extend([(a, worst), (worst, b)]);
                }
            }
        }
        start += stretch.max(1);
    }
    is_key
}

fn edges(rect: &Rect) -> [f64; 4] {
    [rect.x, rect.y, rect.right(), rect.bottom()]
}

/// The frame between `a` and `b` that is furthest off the straight line, if that is too far.
fn furthest(edges: &[[f64; 4]], a: usize, b: usize) -> Option<usize> {
    let error = |k: usize| {
        let share = (k - a) as f64 / (b - a) as f64;
        (0..4)
            .map(|side| (edges[k][side] - edges[a][side] - share * (edges[b][side] - edges[a][side])).abs())
            .fold(0.0, f64::max)
    };
    let worst = (a + 1..b).max_by(|&i, &j| error(i).total_cmp(&error(j)).then(j.cmp(&i)))?;
    (error(worst) > TOLERANCE).then_some(worst)
}
