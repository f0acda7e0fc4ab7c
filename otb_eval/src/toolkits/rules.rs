//! What the toolkits differ in, as data.

use infopart::metrics::SUCCESS_THRESHOLDS;

use super::{ARANGE, Crash, MATLAB, TWENTIETHS, Toolkit};
use crate::{catalogue::AttributeSource, results::Separators};

/// The rules that results are scored by.
#[derive(Debug, Clone, PartialEq)]
pub struct Rules {
    pub(super) toolkit: Toolkit,
    /// Overlap thresholds; a success is strictly above.
    pub(super) thresholds: &'static [f64; SUCCESS_THRESHOLDS],
    pub(super) overlap: OverlapFormula,
    pub(super) first_frame: FirstFrame,
    /// Which truth counts for the overlap; on the others every threshold is missed.
    pub(super) valid_for_overlap: Validity,
    /// Which truth counts for the centre error.
    pub(super) valid_for_error: Validity,
    /// What the others are worth there.
    pub(super) invalid_error: InvalidError,
    /// Whether a NaN in the truth makes it fail.
    pub(super) refuses_nan_truth: bool,
    pub(super) lost_boxes: LostBoxes,
    pub(super) lengths: Lengths,
    pub(super) denominator: Denominator,
    /// Decimals to which a centre error is rounded.
    pub(super) error_decimals: Option<i32>,
    /// Whether curves are kept in 32 bits.
    pub(super) single_precision: bool,
    /// Whether a sequence with a curve of zeros is left out of the mean.
    pub(super) drops_zero_curves: bool,
    /// How many sequences must have an attribute for it to be reported.
    pub(super) least_sequences_of_an_attribute: usize,
    pub(super) attributes: Option<AttributeSource>,
    pub(super) normalisation: Option<Normalisation>,
    /// Whether a frame in which the benchmark says that the target is absent is a miss.
    pub(super) absent_is_miss: bool,
    /// Whether only the frames after the first count, and of those only the ones in which some of the target can be seen.
    pub(super) counts_visible: bool,
    /// Whether frames of all sequences weigh the same, instead of sequences.
    pub(super) pools_frames: bool,
    /// Whether frames per second are the mean of each frame's, the first among them.
    pub(super) mean_of_rates: bool,
    /// Whether its reader takes tabs and spaces besides commas.
    pub(super) takes: (bool, bool),
}

/// How the overlap is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OverlapFormula {
    /// Intersection over union of areas; 0 if a box is improper.
    Areas,
    /// Of corners that are pixels: right = x + w - 1, and a pixel is added to each difference.
    Pixels,
    /// Of areas, limited to [0, 1].
    ClippedAreas,
    /// As `ClippedAreas`, with the smallest step above 1 added to the union.
    ClippedAreasEps,
}

/// What the first row is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstFrame {
    /// The first row of the result stands as given.
    AsGiven,
    /// The first row of the result is overwritten with the truth.
    Truth,
}

/// Which rows of the truth are boxes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Validity {
    /// Every row.
    Any,
    /// Finite numbers and positive sides.
    Proper,
    /// Four positive numbers, which a box at x = 0 has not.
    FourPositive,
    /// Positive sides.
    SidesPositive,
    /// A centre with positive coordinates.
    CentrePositive,
}

/// What a frame without a valid truth is worth in the precision curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InvalidError {
    /// An error of -1: a hit at every threshold.
    Hit,
    /// An infinite error: a miss at every threshold.
    Miss,
}

/// What becomes of a lost box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LostBoxes {
    /// It is scored as it stands.
    AsGiven,
    /// A row that is no box is replaced by the one before.
    Carried,
    /// A row of NaN or without a positive side is replaced by the one before, unless the truth has a NaN.
    CarriedUnlessTruthIsNan,
    /// A side of zero replaces the row by the one before; a NaN or a negative side is refused.
    ZeroCarriedElseRefused,
}

/// What becomes of files of different lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lengths {
    /// The rows that both have are scored.
    Common,
    /// It fails.
    Fail,
    /// It fails unless only rows with an invalid truth are missing.
    FailOnValid,
    /// It fails if the result is shorter; a longer one is cut.
    FailIfShorter,
    /// It fails if the result is longer, and scores as many rows as a shorter one has.
    ResultsOrFail,
    /// A longer result is cut, a shorter one gets rows that miss.
    Misses,
}

/// Over how many frames a share is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Denominator {
    /// Every frame scored.
    Frames,
    /// Frames with a valid truth.
    ValidFrames,
}

/// How the normalised centre error divides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Normalisation {
    /// By the truth's sides.
    Sides,
    /// By the truth's sides plus 1e-16.
    SidesEps,
}

impl Toolkit {
    /// The toolkit's rules.
    pub fn rules(self) -> Rules {
        let plain = Rules {
            toolkit: self,
            thresholds: &TWENTIETHS,
            overlap: OverlapFormula::Areas,
            first_frame: FirstFrame::AsGiven,
            valid_for_overlap: Validity::Proper,
            valid_for_error: Validity::Proper,
            invalid_error: InvalidError::Miss,
            refuses_nan_truth: false,
            lost_boxes: LostBoxes::AsGiven,
            lengths: Lengths::Common,
            denominator: Denominator::Frames,
            error_decimals: None,
            single_precision: false,
            drops_zero_curves: false,
            least_sequences_of_an_attribute: 1,
            attributes: Some(AttributeSource::Tb100Txt),
            normalisation: Some(Normalisation::Sides),
            absent_is_miss: false,
            counts_visible: false,
            pools_frames: false,
            mean_of_rates: false,
            takes: (true, true),
        };
        match self {
            Self::Plain => plain,
            Self::Matlab => Rules {
                thresholds: &MATLAB,
                lost_boxes: LostBoxes::CarriedUnlessTruthIsNan,
                lengths: Lengths::FailOnValid,
                drops_zero_curves: true,
                least_sequences_of_an_attribute: 2,
                ..plain.of_the_benchmark()
            },
            Self::Jwlim => {
                Rules { lengths: Lengths::ResultsOrFail, error_decimals: Some(4), ..plain.of_the_benchmark() }
            }
            Self::Pysot => plain.of_pysot(Validity::FourPositive),
            Self::Stvir => plain.of_pysot(Validity::SidesPositive),
            Self::Got10k => Rules {
                thresholds: &ARANGE,
                overlap: OverlapFormula::ClippedAreasEps,
                first_frame: FirstFrame::Truth,
                valid_for_overlap: Validity::Any,
                valid_for_error: Validity::Any,
                attributes: None,
                normalisation: None,
                mean_of_rates: true,
                takes: (false, false),
                ..plain
            },
            Self::Pytracking => plain.of_pytracking(),
            Self::Lasot => Rules {
                absent_is_miss: true,
                refuses_nan_truth: false,
                lengths: Lengths::FailIfShorter,
                ..plain.of_pytracking()
            },
            Self::Uav => {
                Rules { invalid_error: InvalidError::Hit, refuses_nan_truth: false, ..plain.of_pytracking() }
            }
            Self::AverageOverlap => Rules {
                thresholds: &ARANGE,
                overlap: OverlapFormula::ClippedAreasEps,
                valid_for_overlap: Validity::Any,
                valid_for_error: Validity::Any,
                lengths: Lengths::Fail,
                attributes: None,
                normalisation: None,
                counts_visible: true,
                pools_frames: true,
                mean_of_rates: true,
                takes: (false, false),
                ..plain
            },
        }
    }
}

impl Rules {
    fn of_the_benchmark(self) -> Self {
        Self {
            overlap: OverlapFormula::Pixels,
            first_frame: FirstFrame::Truth,
            valid_for_overlap: Validity::FourPositive,
            valid_for_error: Validity::FourPositive,
            invalid_error: InvalidError::Hit,
            normalisation: None,
            ..self
        }
    }

    fn of_pytracking(self) -> Self {
        Self {
            thresholds: &ARANGE,
            overlap: OverlapFormula::Pixels,
            first_frame: FirstFrame::Truth,
            valid_for_overlap: Validity::FourPositive,
            valid_for_error: Validity::FourPositive,
            refuses_nan_truth: true,
            lost_boxes: LostBoxes::ZeroCarriedElseRefused,
            lengths: Lengths::Misses,
            single_precision: true,
            attributes: None,
            takes: (true, false),
            ..self
        }
    }

    fn of_pysot(self, valid_for_overlap: Validity) -> Self {
        Self {
            thresholds: &ARANGE,
            overlap: OverlapFormula::ClippedAreas,
            valid_for_overlap,
            valid_for_error: Validity::CentrePositive,
            invalid_error: InvalidError::Hit,
            lengths: Lengths::Fail,
            attributes: Some(AttributeSource::Json),
            normalisation: Some(Normalisation::SidesEps),
            takes: (false, false),
            ..self
        }
    }

    /// Whose rules they are.
    pub fn toolkit(&self) -> Toolkit {
        self.toolkit
    }

    /// Whose attributes the toolkit uses; `None` if it reports none.
    pub fn attributes(&self) -> Option<AttributeSource> {
        self.attributes
    }

    /// Whether frames per second are the mean of each frame's own, the first among them, as got10k has them.
    pub fn mean_of_rates(&self) -> bool {
        self.mean_of_rates
    }

    /// Whether frames of all sequences weigh the same, instead of sequences.
    pub fn pools_frames(&self) -> bool {
        self.pools_frames
    }

    /// How many sequences must have an attribute for it to be reported.
    pub fn least_sequences_of_an_attribute(&self) -> usize {
        self.least_sequences_of_an_attribute
    }

    /// Whether a sequence's curve counts in the mean over sequences: some toolkits leave curves of zeros out.
    pub fn counts(&self, curve: &[f64]) -> bool {
        !self.drops_zero_curves || curve.iter().sum::<f64>() > f64::EPSILON
    }

    /// With frames of invalid truth left out of every share, as pytracking's `exclude_invalid_frames`.
    pub fn with_invalid_frames_excluded(self) -> Self {
        Self { denominator: Denominator::ValidFrames, ..self }
    }

    /// With rows that the result lacks as misses.
    pub fn with_missing_rows_as_misses(self) -> Self {
        Self { lengths: Lengths::Misses, ..self }
    }

    /// With lost boxes replaced by the box before.
    pub fn with_lost_boxes_carried(self) -> Self {
        Self { lost_boxes: LostBoxes::Carried, ..self }
    }

    /// Whether the toolkit's reader takes a file with these separators.
    ///
    /// # Errors
    /// [`Crash::Separators`].
    pub fn check_separators(&self, found: Separators) -> Result<(), Crash> {
        let (tabs, spaces) = self.takes;
        let refused = |found| Crash::Separators { toolkit: self.toolkit, takes: self.taken(), found };
        if found.tab && !tabs {
            return Err(refused("tabs"));
        }
        if found.space && !spaces {
            return Err(refused("spaces"));
        }
        if found.other && self.toolkit != Toolkit::Plain {
            return Err(refused("semicolons, or other columns or lines than x,y,w,h"));
        }
        Ok(())
    }

    pub(super) fn taken(&self) -> &'static str {
        match self.takes {
            (true, true) => "commas, tabs or spaces",
            (true, false) => "tabs or commas",
            _ => "commas",
        }
    }
}
