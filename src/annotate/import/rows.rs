//! Text with a row a line: CSV with a header, MOTChallenge, OTB.

use super::{Row, RowTrack, no_class, track_of};
use crate::geometry::Rect;

pub(super) fn tracks(text: &str) -> Result<Vec<RowTrack>, String> {
    let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    if first.split(',').any(|cell| cell.trim() == "frame") {
        return csv(text);
    }
    match numbers(first).map(|row| row.len()) {
        Some(4) => otb(text),
        Some(6..) => mot(text),
        _ => Err("is none of CSV with a header (frame,x,y,w,h,...), MOTChallenge (frame,id,x,y,w,h,...), OTB (x,y,w,h), \
                  JSON lines, CVAT for video XML and COCO"
            .to_owned()),
    }
}

/// Numbers between commas, semicolons, tabs or spaces.
fn numbers(line: &str) -> Option<Vec<f64>> {
    let cells = line.split([',', ';', '\t', ' ']).map(str::trim).filter(|cell| !cell.is_empty());
    cells.map(|cell| cell.parse().ok()).collect()
}

/// The first pixel is 1.
fn from_one_based(x: f64, y: f64, w: f64, h: f64) -> Rect {
    Rect::new(x - 1.0, y - 1.0, w, h)
}

fn otb(text: &str) -> Result<Vec<RowTrack>, String> {
    let mut track = RowTrack { name: "object 1".to_owned(), class: no_class(), ..RowTrack::default() };
    for (frame, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let row = numbers(line);
        let Some(&[x, y, w, h]) = row.as_deref() else {
            return Err(format!("line {}: {line:?} is not x,y,w,h", frame + 1));
        };
        if x.is_finite() && y.is_finite() && w > 0.0 && h > 0.0 {
            let rect = from_one_based(x, y, w, h);
            track.rows.insert(frame, Row { rect, confidence: 1.0, is_key: None });
        }
    }
    Ok(vec![track])
}

/// Rows with a confidence of 0 do not count.
fn mot(text: &str) -> Result<Vec<RowTrack>, String> {
    let mut tracks = Vec::new();
    for (line, row) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let cells = numbers(row).unwrap_or_default();
        let (Some(&[number, id, x, y, w, h]), true) = (cells.first_chunk(), cells.first() >= Some(&1.0))
        else {
            return Err(format!(
                "line {}: {row:?} is not frame,id,x,y,w,h,..., with frames from 1",
                line + 1
            ));
        };
        if cells.get(6) == Some(&0.0) {
            continue;
        }
        let words = || (format!("object {id}"), no_class());
        let row = Row { rect: from_one_based(x, y, w, h), confidence: 1.0, is_key: None };
        track_of(&mut tracks, id.to_bits(), words).rows.insert(number as usize - 1, row);
    }
    Ok(tracks.into_iter().map(|(_, track)| track).collect())
}

fn csv(text: &str) -> Result<Vec<RowTrack>, String> {
    let mut lines = records(text)?.into_iter();
    let (_, header) = lines.next().unwrap_or_default();
    let column = |name: &str| header.iter().position(|cell| cell.trim() == name);
    let needed = |name: &str| column(name).ok_or_else(|| format!("the header has no column {name:?}"));
    let places = [needed("frame")?, needed("x")?, needed("y")?, needed("w")?, needed("h")?];
    let (object, name, class) = (column("object"), column("name"), column("class"));
    let (confidence, key) = (column("confidence"), column("key"));
    let mut tracks = Vec::new();
    for (line, cells) in lines {
        let cell = |at: Option<usize>| at.and_then(|at| cells.get(at)).map_or("", |cell| cell.trim());
        let number = |at: usize| -> Result<f64, String> {
            let text = cell(Some(at));
            text.parse().map_err(|_| format!("line {line}: {text:?} in column {:?} is no number", header[at]))
        };
        let [frame, x, y, w, h] = places.map(number);
        let frame = frame?;
        if !(frame >= 1.0 && frame.fract() == 0.0) {
            return Err(format!("line {line}: frame {frame}; frames count from 1"));
        }
        let id = format!("{}\n{}", cell(object), cell(name));
        let words = || {
            let name = [cell(name), cell(object), "object"].into_iter().find(|text| !text.is_empty());
            let class = [cell(class), "object"].into_iter().find(|text| !text.is_empty());
            (name.unwrap_or_default().to_owned(), class.unwrap_or_default().to_owned())
        };
        let row = Row {
            rect: Rect::new(x?, y?, w?, h?),
            confidence: cell(confidence).parse().unwrap_or(1.0),
            is_key: key.map(|_| matches!(cell(key), "1" | "true")),
        };
        track_of(&mut tracks, id, words).rows.insert(frame as usize - 1, row);
    }
    Ok(tracks.into_iter().map(|(_, track)| track).collect())
}

/// Records by RFC 4180 with the line, counted from 1, where each begins: cells in quotes may hold commas, line ends and doubled quotes.
fn records(text: &str) -> Result<Vec<(usize, Vec<String>)>, String> {
    let mut records = Vec::new();
    let (mut line, mut begin) = (1, 1);
    let (mut cells, mut cell) = (Vec::new(), String::new());
    let mut is_quoted = false;
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        line += usize::from(letter == '\n');
        match letter {
            '"' if is_quoted && letters.peek() == Some(&'"') => {
                cell.push('"');
                letters.next();
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(std::mem::take(&mut cell)),
            '\r' if !is_quoted && letters.peek() == Some(&'\n') => {}
            '\n' if !is_quoted => {
                cells.push(std::mem::take(&mut cell));
                push_record(&mut records, begin, std::mem::take(&mut cells));
                begin = line;
            }
            letter => cell.push(letter),
        }
    }
    if is_quoted {
        return Err(format!("line {begin}: a quote is not closed; is the file cut short?"));
    }
    cells.push(cell);
    push_record(&mut records, begin, cells);
    Ok(records)
}

/// Empty lines are none.
fn push_record(records: &mut Vec<(usize, Vec<String>)>, line: usize, cells: Vec<String>) {
    if cells.len() > 1 || cells.iter().any(|cell| !cell.trim().is_empty()) {
        records.push((line, cells));
    }
}
