//! Tracks what any detector sees, a call a frame: `cargo run -p multi_object --example any_detector`.
//!
//! Here the detector is made up: two people who pass each other, one of whom it is unsure of while they do, and a dog.

use infopart::geometry::Rect;
use multi_object::sort::{BoxTracker, ByteParameters, ByteTracker, OcParameters, OcTracker, ScoredBox};

const PERSON: u32 = 1;
const DOG: u32 = 2;

/// What the detector sees in a frame; boxes are x, y, width, height in pixels.
fn detect(frame: u32) -> Vec<ScoredBox> {
    let x = 6.0 * f64::from(frame);
    let confidence = if (18..23).contains(&frame) { 0.3 } else { 0.9 };
    let seen = |x, y, w, h, confidence, class| ScoredBox {
        area: Rect::new(x, y, w, h),
        confidence,
        class: Some(class),
    };
    vec![
        seen(x, 100.0, 40.0, 90.0, 0.95, PERSON),
        seen(240.0 - x, 110.0, 40.0, 90.0, confidence, PERSON),
        seen(100.0, 170.0, 50.0, 30.0, 0.8, DOG),
    ]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let trackers: [(&str, Box<dyn BoxTracker>); 2] = [
        ("ByteTrack", Box::new(ByteTracker::new(ByteParameters::default()))),
        ("OC-SORT", Box::new(OcTracker::new(OcParameters::default()))),
    ];
    for (name, mut tracker) in trackers {
        println!("{name}");
        for frame in 1..=40 {
            let seen = detect(frame);
            // Before a moving camera: tracker.move_camera(&motion), as multi_object::camera_motion tells it from two frames.
            let reported = tracker.track(&seen)?;
            if frame % 10 == 0 {
                for one in reported {
                    let Rect { x, y, w, h } = one.tracked_box;
                    // `detection` leads back to whatever else the detector said of it.
                    let sure = seen[one.detection].confidence;
                    println!(
                        "  frame {frame}: {} of class {:?} at {x:.0}, {y:.0}, {w:.0} x {h:.0} ({sure})",
                        one.identity, one.class
                    );
                }
            }
        }
    }
    Ok(())
}
