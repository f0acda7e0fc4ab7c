//! What a first box must be, and what is odd about one.

use crate::{frame::FrameView, geometry::Rect};

use super::{TrackError, estimate::BoxWarning};

/// A side below this many pixels is tiny.
const TINY: f64 = 4.0;
/// Coordinates beyond this many pixels are taken for nonsense, so that no arithmetic on them overflows.
const FARTHEST: f64 = 1e9;

/// Refuses boxes that cannot be tracked and names what is odd about the others.
pub(super) fn check(frame: &FrameView<'_>, box_in_frame: &Rect) -> Result<Vec<BoxWarning>, TrackError> {
    let given = *box_in_frame;
    let Rect { x, y, w, h } = given;
    if !given.is_proper() || [x, y, w, h].iter().any(|v| v.abs() > FARTHEST) {
        return Err(TrackError::BadBox { given });
    }
    let (width, height) = (frame.width(), frame.height());
    let Some(inside) = given.clipped_to(width, height) else {
        return Err(TrackError::BoxOutside { given, width, height });
    };
    let mut warnings = Vec::new();
    if w < TINY || h < TINY {
        warnings.push(BoxWarning::Tiny);
    }
    if inside == Rect::new(0.0, 0.0, width as f64, height as f64) {
        warnings.push(BoxWarning::CoversFrame);
    } else if inside != given {
        warnings.push(BoxWarning::PartlyOutside);
    }
    Ok(warnings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::PixelFormat;

    fn checked(x: f64, y: f64, w: f64, h: f64) -> Result<Vec<BoxWarning>, TrackError> {
        let data = [0; 20 * 10];
        check(&FrameView::new(&data, 20, 10, 20, PixelFormat::Gray).unwrap(), &Rect::new(x, y, w, h))
    }

    #[test]
    fn boxes_are_refused_or_warned_of() {
        use BoxWarning::{CoversFrame, PartlyOutside, Tiny};
        assert_eq!(checked(2.0, 2.0, 6.0, 6.0), Ok(vec![]));
        assert_eq!(checked(2.0, 2.0, 1.0, 1.0), Ok(vec![Tiny]));
        assert_eq!(checked(-2.0, 2.0, 6.0, 6.0), Ok(vec![PartlyOutside]));
        assert_eq!(checked(-5.0, -5.0, 60.0, 60.0), Ok(vec![CoversFrame]));
        for (x, w) in [(0.0, 0.0), (0.0, -1.0), (f64::NAN, 5.0), (0.0, f64::INFINITY), (0.0, 1e300)] {
            assert!(matches!(checked(x, 1.0, w, 5.0), Err(TrackError::BadBox { .. })), "{x} {w}");
        }
        assert!(matches!(checked(20.0, 1.0, 5.0, 5.0), Err(TrackError::BoxOutside { width: 20, .. })));
    }
}
