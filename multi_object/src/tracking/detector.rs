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

/// Looks out for pictures that are foreground too much and too long.
#[derive(Debug, Default)]
pub struct WarningWatch {
    /// The share of foreground in each of the last frames.
    shares: VecDeque<f64>,
    frames: u64,
    has_warned: bool,
    warning: Option<SceneWarning>,
}

impl WarningWatch {
    /// Takes the next frame's share of foreground.
    pub fn look(&mut self, share: f64) {
        self.frames += 1;
        if self.frames <= SETTLING || self.has_warned {
            return;
        }
        self.shares.push_back(share);
        if self.shares.len() > FRAMES_LOOKED_AT {
            self.shares.pop_front();
        }
        let foreground = self.shares.iter().sum::<f64>() / FRAMES_LOOKED_AT as f64;
        self.has_warned = self.shares.len() == FRAMES_LOOKED_AT && foreground > TOO_MUCH;
        self.warning = self.has_warned.then_some(SceneWarning { frames: self.frames, foreground });
    }

    /// The warning, once.
    pub fn take(&mut self) -> Option<SceneWarning> {
        self.warning.take()
    }
}

/// Finds what moves, as the filters paper does.
#[derive(Debug)]
pub struct Detector {
    model: BackgroundModel,
    cleaner: MaskCleaner,
    regions_in_frame: Vec<Rect>,
    watch: WarningWatch,
}

impl Detector {
    /// The paper's background model: 3 Gaussians, 40 training frames, and else the model's defaults.
    pub fn paper_background() -> BackgroundParameters {
        BackgroundParameters { components: 3, training_frames: 40, ..BackgroundParameters::default() }
    }

    /// A detector that has learnt nothing, of [`paper_background`](Self::paper_background), blobs of at least `min_area` pixels,
    /// and else the clean-up's defaults.
    ///
    /// # Errors
    /// [`BackgroundError`] never, unless the constants are broken.
    pub fn new(min_area: usize) -> Result<Self, BackgroundError> {
        Self::with(Self::paper_background(), CleanUp { min_area, ..CleanUp::default() }, Vec::new())
    }

    /// A detector that has learnt nothing. Blobs are looked for in the regions given, boxes in the frame; none means everywhere.
    ///
    /// # Errors
    /// [`BackgroundError`], naming the key that cannot be.
    pub fn with(
        background: BackgroundParameters,
        clean_up: CleanUp,
        regions_in_frame: Vec<Rect>,
    ) -> Result<Self, BackgroundError> {
        Ok(Self {
            model: BackgroundModel::new(background.check()?),
            cleaner: MaskCleaner::new(clean_up.check()?),
            regions_in_frame,
            watch: WarningWatch::default(),
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
        self.watch.look(foreground as f64 / raw.len().max(1) as f64);
        let blobs = self.cleaner.blobs(&self.cleaner.clean(raw));
        let is_wanted = |area: &Rect| {
            let (x, y) = area.centre();
            let inside =
                |region: &Rect| x > region.x && x < region.right() && y > region.y && y < region.bottom();
            self.regions_in_frame.is_empty() || self.regions_in_frame.iter().any(inside)
        };
        let boxes = blobs.iter().map(|blob| blob.box_in_frame).filter(is_wanted).collect();
        Ok((boxes, self.watch.take()))
    }
}
