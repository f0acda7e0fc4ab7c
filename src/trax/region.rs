//! Regions: a rectangle, or a polygon, of which the upright box around it is taken.

use crate::geometry::Rect;

use super::error::{TraxError, shortened};

/// The box of a rectangle `x,y,w,h` or around a polygon `x,y,x,y,x,y...`.
///
/// # Errors
/// [`TraxError::BadRegion`] for masks, for what is no list of numbers, and for numbers that are not finite.
pub fn parse_region(text: &str) -> Result<Rect, TraxError> {
    let bad = |reason| TraxError::BadRegion { region: shortened(text), reason };
    if text.starts_with('m') {
        return Err(bad("is a mask"));
    }
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|word| word.trim().parse()).collect();
    let numbers = numbers.map_err(|_| bad("is no list of numbers"))?;
    if !numbers.iter().all(|number| number.is_finite()) {
        return Err(bad("has a number that is not finite"));
    }
    match numbers[..] {
        [x, y, w, h] => Ok(Rect::new(x, y, w, h)),
        [] | [_] | [_, _] | [_, _, _] | [_, _, _, _, _] => Err(bad("has too few numbers")),
        _ if !numbers.len().is_multiple_of(2) => Err(bad("has an odd number of numbers")),
        _ => {
            let side = |axis: usize| {
                let along = numbers.iter().skip(axis).step_by(2).copied();
                (along.clone().fold(f64::INFINITY, f64::min), along.fold(f64::NEG_INFINITY, f64::max))
            };
            let ((left, right), (top, bottom)) = (side(0), side(1));
            Ok(Rect::new(left, top, right - left, bottom - top))
        }
    }
}

/// A rectangle with every digit, as it is read back.
pub fn rectangle(Rect { x, y, w, h }: Rect) -> String {
    format!("{x},{y},{w},{h}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_and_polygons_are_boxes() {
        let rect = Rect::new(1.5, -2.0, 3.0, 0.1 + 0.2);
        assert_eq!(parse_region(&rectangle(rect)).unwrap(), rect);
        assert_eq!(parse_region("0,5, 10,0, 20,8, 10,30").unwrap(), Rect::new(0.0, 0.0, 20.0, 30.0));
    }

    #[test]
    fn what_is_no_box_is_refused_by_its_reason() {
        for (text, reason) in [
            ("m10,10,2,2,1,2,1", "mask"),
            ("1,2,3", "too few"),
            ("1,2,3,4,5,6,7", "odd"),
            ("1,2,x,4", "no list"),
            ("", "no list"),
            ("1,2,nan,4", "not finite"),
            ("1,2,inf,4", "not finite"),
        ] {
            let message = parse_region(text).unwrap_err().to_string();
            assert!(message.contains(reason), "{text}: {message}");
        }
    }
}
