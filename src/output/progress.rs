//! A progress bar on the terminal's standard error.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{FrameEvent, Observer, OutputError};

/// How many times a second the bar is drawn.
const DRAWS_PER_SECOND: u8 = 10;

/// Shows how far the loop is, how fast, and what the tracker says. It hides itself off a terminal.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    tracking_time: Duration,
    updates: u32,
}

impl Progress {
    /// A bar over `total` frames, or a counter where their number is not known.
    pub fn new(total: Option<usize>) -> Self {
        let bar = ProgressBar::with_draw_target(
            total.map(|frames| frames as u64),
            ProgressDrawTarget::stderr_with_hz(DRAWS_PER_SECOND),
        );
        bar.set_style(style(total.is_some()));
        Self { bar, tracking_time: Duration::ZERO, updates: 0 }
    }

    /// A bar that is never drawn.
    pub fn hidden() -> Self {
        Self { bar: ProgressBar::hidden(), tracking_time: Duration::ZERO, updates: 0 }
    }
}

fn style(total_is_known: bool) -> ProgressStyle {
    let template = if total_is_known {
        "{bar:24.green/black.bright} {pos}/{len} frames  {eta} left  {wide_msg}"
    } else {
        "{spinner:.green} {pos} frames  {wide_msg}"
    };
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

impl Observer for Progress {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        if self.bar.position() > 0 {
            self.tracking_time += event.tracking_time;
            self.updates += 1;
        }
        self.bar.inc(1);
        if !self.bar.is_hidden() {
            let speed = f64::from(self.updates) / self.tracking_time.as_secs_f64().max(1e-9);
            let estimate = event.estimate;
            self.bar.set_message(format!("{speed:.0} fps  {} {:.2}", estimate.status, estimate.confidence));
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), OutputError> {
        self.bar.finish_and_clear();
        Ok(())
    }

    fn flush(&mut self) -> Result<(), OutputError> {
        self.bar.finish_and_clear();
        Ok(())
    }
}
