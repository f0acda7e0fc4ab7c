//! From frames to detections, and a warning where the camera is not static.

use std::{collections::VecDeque, fmt};

use infopart::{
    background::{BackgroundError, BackgroundModel, BackgroundParameters, CleanUp, FOREGROUND, MaskCleaner},
    frame::FrameView,
    geometry::Rect,
};

/// Share of foreground, over the frames looked at, above which a camera seems to move. Before static cameras it stays
/// within a few hundredths; a moving one shows more as soon as its picture has edges.
const TOO_MUCH: f64 = 0.12;
/// Frames that the share is the mean of.
const FRAMES_LOOKED_AT: usize = 30;
/// Frames that the model is left alone with before its masks are judged.
const SETTLING: u64 = 10;

/// The picture is not that of a static camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneWarning {
    /// Frames seen so far.
    pub frames: u64,
    /// The mean share of foreground over the last 30, in [0, 1].
    pub foreground: f64,
}

impl fmt::Display for SceneWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:.0} % of the picture is foreground in the {FRAMES_LOOKED_AT} frames up to frame {}: does the camera move, or \
             did the light change? Objects are found only before a static camera",
            100.0 * self.foreground,
            self.frames
        )
    }
}

/// Smallest object, pixels, where nothing else is said.
pub const USUAL_MIN_AREA: usize = 400;

/// Finds what moves.
#[derive(Debug)]
pub struct Detector {
    model: BackgroundModel,
    cleaner: MaskCleaner,
    /// The share of foreground in each of the last frames.
    shares: VecDeque<f64>,
    has_warned: bool,
}

impl Detector {
    /// A detector that has learnt nothing: 3 Gaussians, 40 training frames, blobs of at least `min_area` pixels, and else
    /// the background model's and the clean-up's defaults.
    ///
    /// # Errors
    /// [`BackgroundError`] never, unless the constants are broken.
    pub fn new(min_area: usize) -> Result<Self, BackgroundError> {
        let background =
            BackgroundParameters { components: 3, training_frames: 40, ..BackgroundParameters::default() };
        Ok(Self {
            model: BackgroundModel::new(background.check()?),
            cleaner: MaskCleaner::new(CleanUp { min_area, ..CleanUp::default() }.check()?),
            shares: VecDeque::new(),
            has_warned: false,
        })
    }

    /// The boxes of what moves in the next frame, and a warning, once, if that is too much of the picture for long.
    ///
    /// # Errors
    /// [`BackgroundError`] if the frame has another size than the first, or is too large.
    pub fn detect(
        &mut self,
        frame: FrameView<'_>,
    ) -> Result<(Vec<Rect>, Option<SceneWarning>), BackgroundError> {
        let raw = self.model.apply(frame)?;
        let foreground = raw.iter().filter(|&&value| value == FOREGROUND).count();
        let share = foreground as f64 / raw.len().max(1) as f64;
        let cleaned = self.cleaner.clean(raw);
        let blobs = self.cleaner.blobs(&cleaned);
        let warning = self.judge(share);
        Ok((blobs.iter().map(|blob| blob.box_in_frame).collect(), warning))
    }

    fn judge(&mut self, share: f64) -> Option<SceneWarning> {
        let frames = self.model.frames();
        if frames <= SETTLING || self.has_warned {
            return None;
        }
        self.shares.push_back(share);
        if self.shares.len() > FRAMES_LOOKED_AT {
            self.shares.pop_front();
        }
        let foreground = self.shares.iter().sum::<f64>() / FRAMES_LOOKED_AT as f64;
        self.has_warned = self.shares.len() == FRAMES_LOOKED_AT && foreground > TOO_MUCH;
        self.has_warned.then_some(SceneWarning { frames, foreground })
    }
}
