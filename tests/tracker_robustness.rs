//! The tracker on any box and any image: a typed error or a proper estimate, never a panic.

use infopart::{
    frame::{Frame, FrameView, PixelFormat},
    geometry::Rect,
    tracker::{Estimate, InfoPart, Parameters, TrackError, Tracker},
};
use proptest::prelude::*;

fn tracker() -> InfoPart {
    InfoPart::new(Parameters::default().check().unwrap())
}

/// Every number of an estimate, so that two can be compared bit by bit.
fn bits(estimate: &Estimate) -> Vec<u64> {
    let Estimate { box_in_frame: full, part_in_frame: part, .. } = estimate;
    let boxes = [full.x, full.y, full.w, full.h, part.x, part.y, part.w, part.h];
    let others = [estimate.confidence, estimate.effective_sample_size];
    boxes
        .into_iter()
        .chain(others)
        .chain(estimate.covariance.into_iter().flatten())
        .map(f64::to_bits)
        .collect()
}

fn assert_sane(estimate: &Estimate) {
    assert!(estimate.box_in_frame.is_proper(), "{estimate:?}");
    assert!(estimate.part_in_frame.is_proper(), "{estimate:?}");
    assert!((0.0..=1.0).contains(&estimate.confidence), "{estimate:?}");
    assert!(estimate.covariance.iter().flatten().all(|value| value.is_finite()), "{estimate:?}");
    assert!(estimate.effective_sample_size >= 1.0 - 1e-9, "{estimate:?}");
}

/// Follows `frames` from `box_in_frame` in the first of them.
fn follow(tracker: &mut InfoPart, frames: &[Frame], box_in_frame: Rect) -> Result<Vec<Estimate>, TrackError> {
    tracker.init(frames[0].view(), box_in_frame)?;
    frames[1..].iter().map(|frame| tracker.update(frame.view())).collect()
}

/// `count` frames of one size and random content, grey or RGB.
fn frames(count: usize) -> impl Strategy<Value = Vec<Frame>> {
    let format = prop_oneof![Just(PixelFormat::Gray), Just(PixelFormat::Rgb)];
    (1usize..=64, 1usize..=64, format).prop_flat_map(move |(width, height, format)| {
        let bytes = width * height * format.bytes_per_pixel();
        prop::collection::vec(content(bytes), count).prop_map(move |contents| {
            contents.into_iter().map(|data| Frame::new(data, width, height, format).unwrap()).collect()
        })
    })
}

/// Noise, or one value everywhere.
fn content(bytes: usize) -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        4 => prop::collection::vec(any::<u8>(), bytes),
        1 => any::<u8>().prop_map(move |value| vec![value; bytes]),
    ]
}

/// Tiny and huge sides, places inside and outside, and numbers that are none.
fn any_box() -> impl Strategy<Value = Rect> {
    let place = prop_oneof![6 => -20.0..80.0f64, 1 => -2000.0..2000.0f64, 1 => odd_number()];
    let side = prop_oneof![6 => 0.01..70.0f64, 1 => 70.0..1000.0f64, 1 => 1e-12..1e-3f64, 1 => odd_number()];
    (place.clone(), place, side.clone(), side).prop_map(|(x, y, w, h)| Rect::new(x, y, w, h))
}

fn odd_number() -> impl Strategy<Value = f64> {
    prop::sample::select(vec![
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        0.0,
        -0.0,
        -3.0,
        f64::MIN_POSITIVE,
        1e300,
    ])
}

/// A box that lies well in a frame of at least 24 x 24.
fn inner_box() -> impl Strategy<Value = Rect> {
    (1.0..8.0f64, 1.0..6.0f64, 6.0..14.0f64, 10.0..16.0f64).prop_map(|(x, y, w, h)| Rect::new(x, y, w, h))
}

/// Frames of a fixed size with a bright block that moves by a pixel a frame.
fn moving_block(width: usize, height: usize, count: usize, format: PixelFormat) -> Vec<Frame> {
    let pixel = |x: usize, y: usize, at: usize| {
        let inside = (at..at + 10).contains(&x) && (5..19).contains(&y);
        let texture = (x * 37 + y * 91 + x * y * 5) % 90;
        (if inside { 140 + texture } else { texture }) as u8
    };
    let bytes = format.bytes_per_pixel();
    (0..count)
        .map(|number| {
            let samples = (0..width * height * bytes).map(|i| {
                let (x, y) = (i / bytes % width, i / bytes / width);
                pixel(x, y, 4 + number).wrapping_add((i % bytes * 40) as u8)
            });
            Frame::new(samples.collect(), width, height, format).unwrap()
        })
        .collect()
}

const BLOCK: Rect = Rect::new(4.0, 5.0, 10.0, 14.0);

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_box_on_any_image_is_refused_or_tracked(frames in frames(4), first in any_box()) {
        let mut tracker = tracker();
        match tracker.init(frames[0].view(), first) {
            Err(TrackError::BadBox { .. } | TrackError::BoxOutside { .. }) => {
                prop_assert!(tracker.estimate().is_none());
                prop_assert_eq!(tracker.update(frames[1].view()), Err(TrackError::NotStarted));
            }
            Err(other) => prop_assert!(false, "{other}"),
            Ok(_) => {
                prop_assert_eq!(tracker.estimate().map(|estimate| estimate.box_in_frame), Some(first));
                for frame in &frames[1..] {
                    assert_sane(&tracker.update(frame.view()).unwrap());
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn init_in_the_middle_leaves_nothing_of_the_earlier_target(
        first in inner_box(), second in inner_box(), (width, height) in (24usize..64, 24usize..64),
    ) {
        let earlier = moving_block(40, 30, 6, PixelFormat::Rgb);
        let later = moving_block(width, height, 6, PixelFormat::Gray);
        let mut used = tracker();
        follow(&mut used, &earlier, first).unwrap();
        let again = follow(&mut used, &later, second).unwrap();
        let fresh = follow(&mut tracker(), &later, second).unwrap();
        for (again, fresh) in again.iter().zip(&fresh) {
            prop_assert_eq!(bits(again), bits(fresh));
        }
    }

    #[test]
    fn the_layout_of_pixels_changes_no_bit(frames in frames(4), padding in 1usize..9) {
        let rgb: Vec<Frame> = frames.iter().map(to_rgb).collect();
        let (width, height) = (rgb[0].width(), rgb[0].height());
        let first = Rect::new(0.0, 0.0, (width as f64 / 2.0).max(1.0), (height as f64 / 2.0).max(1.0));
        let expected: Vec<_> = follow(&mut tracker(), &rgb, first).unwrap().iter().map(bits).collect();
        for (format, padding) in [
            (PixelFormat::Bgr, 0),
            (PixelFormat::Rgba, 0),
            (PixelFormat::Bgra, padding),
            (PixelFormat::Rgb, padding),
        ] {
            let stride = width * format.bytes_per_pixel() + padding;
            let buffers: Vec<_> = rgb.iter().map(|frame| laid_out(frame, format, stride)).collect();
            let view = |buffer| FrameView::new(buffer, width, height, stride, format).unwrap();
            let mut tracker = tracker();
            tracker.init(view(&buffers[0]), first).unwrap();
            for (buffer, expected) in buffers[1..].iter().zip(&expected) {
                prop_assert_eq!(&bits(&tracker.update(view(buffer)).unwrap()), expected, "{:?}", format);
            }
        }
    }
}

fn to_rgb(frame: &Frame) -> Frame {
    let view = frame.view();
    let offsets = view.format().rgb_offsets();
    let pixels = (0..view.height()).flat_map(|y| view.row(y).chunks_exact(view.format().bytes_per_pixel()));
    let data = pixels.flat_map(|pixel| offsets.map(|offset| pixel[offset])).collect();
    Frame::new(data, view.width(), view.height(), PixelFormat::Rgb).unwrap()
}

/// The bytes of an RGB frame in another layout; what is no sample (alpha, padding) holds 171.
fn laid_out(rgb: &Frame, format: PixelFormat, stride: usize) -> Vec<u8> {
    let mut buffer = vec![171; stride * rgb.height()];
    for (y, out) in buffer.chunks_exact_mut(stride).enumerate() {
        let pixels = rgb.view().row(y).chunks_exact(3);
        for (pixel, out) in pixels.zip(out.chunks_exact_mut(format.bytes_per_pixel())) {
            for (sample, offset) in pixel.iter().zip(format.rgb_offsets()) {
                out[offset] = *sample;
            }
        }
    }
    buffer
}

#[test]
fn an_update_before_init_is_told() {
    let frames = moving_block(40, 30, 1, PixelFormat::Rgb);
    assert_eq!(tracker().update(frames[0].view()), Err(TrackError::NotStarted));
}

#[test]
fn a_frame_of_another_size_is_refused_and_does_no_harm() {
    let frames = moving_block(40, 30, 8, PixelFormat::Rgb);
    let other = moving_block(41, 30, 1, PixelFormat::Rgb);
    let expected = follow(&mut tracker(), &frames, BLOCK).unwrap();
    let mut tracker = tracker();
    tracker.init(frames[0].view(), BLOCK).unwrap();
    for (frame, expected) in frames[1..].iter().zip(&expected) {
        let refused = tracker.update(other[0].view()).unwrap_err();
        let (width, height, first_width, first_height) = (41, 30, 40, 30);
        assert_eq!(refused, TrackError::SizeChanged { width, height, first_width, first_height });
        assert_eq!(bits(&tracker.update(frame.view()).unwrap()), bits(expected));
    }
}

#[test]
fn a_refused_box_leaves_the_tracker_as_it_was() {
    let frames = moving_block(40, 30, 6, PixelFormat::Rgb);
    let expected = follow(&mut tracker(), &frames, BLOCK).unwrap();
    let mut tracker = tracker();
    tracker.init(frames[0].view(), BLOCK).unwrap();
    for (frame, expected) in frames[1..].iter().zip(&expected) {
        for bad in [Rect::new(f64::NAN, 1.0, 2.0, 2.0), Rect::new(500.0, 1.0, 5.0, 5.0)] {
            assert!(tracker.init(frame.view(), bad).is_err());
        }
        assert_eq!(bits(&tracker.update(frame.view()).unwrap()), bits(expected));
    }
}

#[test]
fn a_box_far_larger_than_the_frame_is_tracked() {
    let frames = moving_block(40, 30, 3, PixelFormat::Rgb);
    for side in [1e5, 1e8] {
        let estimates = follow(&mut tracker(), &frames, Rect::new(-5.0, -5.0, side, side)).unwrap();
        estimates.iter().for_each(assert_sane);
    }
}
