//! The flags that choose what is foreground, as `infopart background` has them; what is not given is the preset's.

use clap::Args;
use infopart::{
    background::{BackgroundParameters, CleanUp},
    geometry::Rect,
};

#[derive(Debug, Args)]
pub struct ForegroundArgs {
    /// Gaussians a pixel
    #[arg(long, value_name = "K")]
    components: Option<usize>,
    /// How many frames the background model looks back
    #[arg(long, value_name = "FRAMES")]
    history: Option<usize>,
    /// Over how many frames the background model is a plain mean at first
    #[arg(long, value_name = "FRAMES")]
    training_frames: Option<usize>,
    /// The share of time that a pixel shows background
    #[arg(long, value_name = "SHARE")]
    background_ratio: Option<f64>,
    /// Standard deviation of the camera's noise, grey levels: less is more sensitive
    #[arg(long, value_name = "LEVELS")]
    noise_sigma: Option<f64>,
    /// Standard deviations from the background at which foreground begins: fewer are more sensitive
    #[arg(long, value_name = "COUNT")]
    match_deviations: Option<f64>,
    /// Whether shadows are told apart and left out
    #[arg(long, value_name = "true|false")]
    shadows: Option<bool>,
    /// How dark a shadow may be, as a share of the background's brightness
    #[arg(long, value_name = "SHARE")]
    darkest_shadow: Option<f64>,
    /// Side of the square that opens the mask, pixels
    #[arg(long, value_name = "ODD")]
    opening: Option<usize>,
    /// Side of the square that closes the mask, pixels
    #[arg(long, value_name = "ODD")]
    closing: Option<usize>,
    /// Smallest object, pixels
    #[arg(long, value_name = "PIXELS")]
    min_area: Option<usize>,
    /// Look for objects only here, X,Y,W,H in pixels from 0; may be given several times
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_region)]
    region_of_interest: Vec<Rect>,
}

impl ForegroundArgs {
    pub fn background(&self, preset: BackgroundParameters) -> BackgroundParameters {
        BackgroundParameters {
            components: self.components.unwrap_or(preset.components),
            history: self.history.unwrap_or(preset.history),
            training_frames: self.training_frames.unwrap_or(preset.training_frames),
            background_ratio: self.background_ratio.unwrap_or(preset.background_ratio),
            noise_sigma: self.noise_sigma.unwrap_or(preset.noise_sigma),
            match_deviations: self.match_deviations.unwrap_or(preset.match_deviations),
            shadows: self.shadows.unwrap_or(preset.shadows),
            darkest_shadow: self.darkest_shadow.unwrap_or(preset.darkest_shadow),
            ..preset
        }
    }

    pub fn clean_up(&self, preset: CleanUp) -> CleanUp {
        CleanUp {
            opening: self.opening.unwrap_or(preset.opening),
            closing: self.closing.unwrap_or(preset.closing),
            min_area: self.min_area.unwrap_or(preset.min_area),
            ..preset
        }
    }

    /// In the frame; none means everywhere.
    pub fn regions(&self) -> Vec<Rect> {
        self.region_of_interest.clone()
    }
}

fn parse_region(text: &str) -> Result<Rect, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, w, h]) if Rect::new(x, y, w, h).is_proper() => Ok(Rect::new(x, y, w, h)),
        _ => {
            Err("give X,Y,W,H, four numbers with a width and a height above 0, such as 0,200,640,160"
                .to_owned())
        }
    }
}
