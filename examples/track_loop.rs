//! A caller's own loop: it owns its frames, lends each to the tracker, and reads what the tracker says.
//!
//! `cargo run --release --example track_loop` follows the synthetic walker. Any other 8-bit pixels are lent the same
//! way, without a copy: `FrameView::new(&bytes, width, height, bytes_per_row, PixelFormat::Bgr)`.

use infopart::{
    sequence::{FrameSource, Walker, WalkerOptions},
    tracker::{InfoPart, Parameters, Tracker},
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut camera = Walker::new(WalkerOptions::default());
    let first_box = camera.ground_truth()[0].ok_or("the walker is not in its first frame")?;
    let first = camera.next_frame()?.ok_or("there is no frame")?;

    let mut parameters = Parameters::default();
    parameters.seed = 7;
    let mut tracker = InfoPart::new(parameters.check()?);
    for warning in tracker.init(first.frame.view(), first_box)? {
        eprintln!("warning: {warning}");
    }
    while let Some(next) = camera.next_frame()? {
        let found = tracker.update(next.frame.view())?;
        let b = found.box_in_frame;
        print!("{}: {:.1},{:.1},{:.1},{:.1}  ", next.label, b.x, b.y, b.w, b.h);
        println!("confidence {:.2}, {}", found.confidence, found.status);
    }
    Ok(())
}
