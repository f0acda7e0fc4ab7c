//! What can be chosen.

use infopart::{
    background::{
        BackgroundError, BackgroundParameters, CheckedBackgroundParameters, CheckedCleanUp, CleanUp,
    },
    bayes::FilterError,
    geometry::Rect,
};
use thiserror::Error;

use crate::{
    motion::{FilterKind, FilterOptions},
    tracking::USUAL_MIN_AREA,
};

/// A tracker that cannot be, or a frame that it cannot take.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ObjectError {
    /// The background model's.
    #[error(transparent)]
    Background(#[from] BackgroundError),
    /// A filter's.
    #[error(transparent)]
    Filter(#[from] FilterError),
}

/// How objects are found and followed.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectParameters {
    /// The background model, over cells. The default has 3 Gaussians, a mean over the first 40 frames, matches within 3 standard
    /// deviations, a noise of 5 grey levels (cells are means of pixels) and 10 of a new Gaussian, and tells shadows apart.
    pub background: BackgroundParameters,
    /// Sides of the squares that open and close the mask, pixels; 1 for none. Specks of a cell go and gaps of a cell close anyhow.
    pub clean_up: CleanUp,
    /// Boxes in the frame in which objects are looked for; none means everywhere.
    pub regions_in_frame: Vec<Rect>,
    /// What predicts a track.
    pub filter: FilterKind,
    /// How the filter runs.
    pub filter_options: FilterOptions,
    /// Frames in a row without a sight after which a track is deleted.
    pub max_age: u32,
    /// Sights in a region of its own before a track is established.
    pub min_hits: u32,
}

impl Default for ObjectParameters {
    fn default() -> Self {
        let background = BackgroundParameters {
            components: 3,
            training_frames: 40,
            match_deviations: 3.0,
            noise_sigma: 5.0,
            initial_sigma: 10.0,
            shadows: true,
            ..BackgroundParameters::default()
        };
        Self {
            background,
            clean_up: CleanUp { opening: 1, closing: 1, fill_holes: false, min_area: USUAL_MIN_AREA },
            regions_in_frame: Vec::new(),
            filter: FilterKind::Kalman,
            filter_options: FilterOptions::default(),
            max_age: 20,
            min_hits: 3,
        }
    }
}

impl ObjectParameters {
    /// Checks every value; only what passes can run.
    ///
    /// # Errors
    /// [`BackgroundError`], naming the key.
    pub fn check(self) -> Result<CheckedObjectParameters, BackgroundError> {
        let background = self.background.clone().check()?;
        self.clean_up.clone().check()?;
        Ok(CheckedObjectParameters { given: self, background })
    }
}

/// Parameters that have passed [`ObjectParameters::check`].
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedObjectParameters {
    given: ObjectParameters,
    background: CheckedBackgroundParameters,
}

impl CheckedObjectParameters {
    pub(super) fn background(&self) -> CheckedBackgroundParameters {
        self.background.clone()
    }

    pub(super) fn min_area(&self) -> usize {
        self.given.clean_up.min_area
    }

    /// The squares in cells of `side` pixels; `None` if there is nothing to open or close.
    pub(super) fn clean_up(&self, side: usize) -> Option<CheckedCleanUp> {
        let CleanUp { opening, closing, .. } = self.given.clean_up;
        let cells = |pixels: usize| 2 * ((pixels / 2) as f64 / side as f64).round() as usize + 1;
        let clean_up =
            CleanUp { opening: cells(opening), closing: cells(closing), fill_holes: false, min_area: 0 };
        // What is checked in pixels holds in cells: there are fewer.
        (opening.max(closing) > 1).then(|| clean_up.check().ok()).flatten()
    }
}

impl std::ops::Deref for CheckedObjectParameters {
    type Target = ObjectParameters;

    fn deref(&self) -> &ObjectParameters {
        &self.given
    }
}
