//! From frames to detections, and a warning where the camera is not static.

use std::fmt;

use infopart::{
    background::{
        BackgroundError, BackgroundModel, BackgroundParameters, CleanUp, FOREGROUND, MaskCleaner,
    },
    frame::FrameView,
    geometry::Rect,
};

/// Share of foreground above which a frame is mostly foreground.
const MOSTLY: f64 = 0.5;
/// Frames in a row that are mostly foreground before it is said. A light that is switched is learnt in fewer.
const PATIENCE: u32 = 10;
/// Frames that the model is left alone with before its masks are judged.
const SETTLING: u64 = 10;

/// The picture is not that of a static camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SceneWarning {
    /// Frames, from the first on, of which the last ones were mostly foreground.
    pub frames: u64,
}

impl fmt::Display for SceneWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "most of the picture is foreground in the {PATIENCE} frames up to frame {}: does the camera move, or did the \
             light change? Objects are found only before a static camera",
            self.frames
        )
    }
}

/// Finds what moves.
#[derive(Debug)]
pub struct Detector {
    model: BackgroundModel,
    cleaner: MaskCleaner,
    mostly_foreground: u32,
    has_warned: bool,
}

impl Detector {
    /// A detector that has learnt nothing: 3 Gaussians, 40 training frames, and else the background model's and the
    /// clean-up's defaults.
    ///
    /// # Errors
    /// [`BackgroundError`] never, unless the constants are broken.
    pub fn new() -> Result<Self, BackgroundError> {
        let background = BackgroundParameters { components: 3, training_frames: 40, ..BackgroundParameters::default() };
        Ok(Self {
            model: BackgroundModel::new(background.check()?),
            cleaner: MaskCleaner::new(CleanUp::default().check()?),
            mostly_foreground: 0,
            has_warned: false,
        })
    }

    /// The boxes of what moves in the next frame, and a warning, once, if that is most of the picture for long.
    ///
    /// # Errors
    /// [`BackgroundError`] if the frame has another size than the first, or is too large.
    pub fn detect(&mut self, frame: FrameView<'_>) -> Result<(Vec<Rect>, Option<SceneWarning>), BackgroundError> {
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
        let is_mostly = frames > SETTLING && share > MOSTLY;
        self.mostly_foreground = if is_mostly { self.mostly_foreground + 1 } else { 0 };
        let is_due = self.mostly_foreground >= PATIENCE && !self.has_warned;
        self.has_warned |= is_due;
        is_due.then_some(SceneWarning { frames })
    }
}
