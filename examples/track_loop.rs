//! A caller's own loop: it owns its frames, lends each to the tracker, and reads what the tracker says.
//!
//! `cargo run --release --example track_loop` tracks the synthetic walker;
//! `cargo run --release --example track_loop -- FOLDER` tracks the target of an OTB folder.

use infopart::{
    frame::{FrameView, PixelFormat},
    sequence::{FrameSource, OpenOptions, Walker, WalkerOptions, open},
    tracker::{InfoPart, Parameters, Tracker},
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut source, truth): (Box<dyn FrameSource>, _) = match std::env::args().nth(1) {
        Some(folder) => {
            let sequence = open(&folder, &OpenOptions::default())?;
            (sequence.source, sequence.ground_truth)
        }
        None => {
            let walker = Walker::new(WalkerOptions::default());
            let truth = walker.ground_truth();
            (Box::new(walker), truth)
        }
    };
    let first_box = truth.first().copied().flatten().ok_or("no ground truth to take the first box from")?;

    let mut parameters = Parameters::default();
    parameters.seed = 7;
    let mut tracker = InfoPart::new(parameters.check()?);
    let mut started = false;
    while let Some(frame) = source.next_frame()? {
        // Any 8-bit buffer will do: FrameView::new(&bytes, width, height, bytes_per_row, PixelFormat::Bgr).
        let view: FrameView<'_> = frame.frame.view();
        debug_assert!(matches!(view.format(), PixelFormat::Rgb | PixelFormat::Gray));
        if !started {
            for warning in tracker.init(view, first_box)? {
                eprintln!("warning: {warning}");
            }
            started = true;
            continue;
        }
        let found = tracker.update(view)?;
        let [x, y, w, h] =
            [found.box_in_frame.x, found.box_in_frame.y, found.box_in_frame.w, found.box_in_frame.h];
        println!("{}: {x:.1},{y:.1},{w:.1},{h:.1}  {} {:.2}", frame.label, found.status, found.confidence);
    }
    Ok(())
}
