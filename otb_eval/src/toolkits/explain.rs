//! The rules in words, made from their values so that they say what runs.

use std::fmt::Write;

use super::{
    Denominator, FirstFrame, InvalidError, Lengths, LostBoxes, Normalisation, OverlapFormula, Rules,
    TWENTIETHS, Validity,
};

impl Rules {
    /// The thresholds, inequalities and rules in force, a line each.
    pub fn explain(&self) -> String {
        let mut text = format!("{}: {}\n", self.toolkit, self.toolkit.title());
        let mut line = |name: &str, rule: &str| {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "  {name:<22}{rule}");
        };
        line(
            "success",
            &format!(
                "share of frames with overlap > t, strictly, at the 21 thresholds 0, 0.05, ..., 1{}",
                self.bits()
            ),
        );
        line("AUC", "plain mean of the 21 shares; success at 0.5 is the 11th");
        line(
            "a perfect tracker",
            "scores 20/21 = 0.952381: at t = 1 nothing is above, for no overlap exceeds 1",
        );
        line(
            "precision",
            "share of frames with a centre error <= p pixels at p = 0, 1, ..., 50; quoted at 20",
        );
        line("normalised precision", self.normalised());
        line("overlap", self.formula());
        line("first frame", self.first());
        line("invalid ground truth", &self.invalid());
        line("lost boxes", self.lost());
        line("other lengths", self.other_lengths());
        line("share of", self.share());
        line("rounding", self.rounding());
        line("over sequences", &self.over_sequences());
        line(
            "attributes",
            &self.attributes.map_or("none are reported".to_owned(), |source| {
                format!(
                    "by {source}, of those that at least {} sequence(s) have",
                    self.least_sequences_of_an_attribute
                )
            }),
        );
        line("frames/s", self.speed());
        line("reads", &format!("numbers separated by {}", self.taken()));
        text
    }

    fn bits(&self) -> String {
        let differing: Vec<String> = (0..TWENTIETHS.len())
            .filter(|&index| self.thresholds[index] != TWENTIETHS[index])
            .map(|index| format!("{}", self.thresholds[index]))
            .collect();
        match differing.len() {
            0 => String::new(),
            _ => format!(" (to the last bit, {} of them: {})", differing.len(), differing.join(", ")),
        }
    }

    fn normalised(&self) -> &'static str {
        match self.normalisation {
            None => "this toolkit has none",
            Some(Normalisation::Sides) => {
                "centre error in sides of the ground truth <= 0, 0.01, ..., 0.5; quoted at 0.2; its area is the mean of the 51 shares"
            }
            Some(Normalisation::SidesEps) => {
                "centre error in sides of the ground truth + 1e-16 <= 0, 0.01, ..., 0.5; quoted at 0.2; its area is the mean of the 51 shares"
            }
        }
    }

    fn formula(&self) -> &'static str {
        match self.overlap {
            OverlapFormula::Areas => "intersection over union of areas; 0 if a box has no area",
            OverlapFormula::Pixels => {
                "intersection over union with right = x + w - 1 and a pixel added to each difference, which cancels"
            }
            OverlapFormula::ClippedAreas => "intersection over union of areas, limited to [0, 1]",
            OverlapFormula::ClippedAreasEps if self.counts_visible => {
                "intersection over union of areas + 2.2e-16 of the boxes clipped to the frame, limited to [0, 1]"
            }
            OverlapFormula::ClippedAreasEps => {
                "intersection over union of areas + 2.2e-16, limited to [0, 1]"
            }
        }
    }

    fn first(&self) -> &'static str {
        match self.first_frame {
            _ if self.counts_visible => "not counted",
            FirstFrame::AsGiven => "counted, as the result has it",
            FirstFrame::Truth => "counted, overwritten with the ground truth",
        }
    }

    fn invalid(&self) -> String {
        let valid = |validity| match validity {
            Validity::Any => "every row is valid",
            Validity::Proper => "valid if finite with positive sides",
            Validity::FourPositive => "valid if x, y, w and h are all > 0",
            Validity::SidesPositive => "valid if w and h are > 0",
            Validity::CentrePositive => "valid if the centre's x and y are > 0",
        };
        let miss = match self.valid_for_overlap {
            Validity::Any => "",
            _ => ", else a miss at every t",
        };
        let error = match (self.valid_for_error, self.invalid_error) {
            (Validity::Any, _) => "",
            (_, InvalidError::Hit) => ", else a HIT at every p",
            (_, InvalidError::Miss) => ", else a miss at every p",
        };
        let absent = if self.absent_is_miss {
            "; where the benchmark says that the target is out of sight, a miss at every t and p"
        } else {
            ""
        };
        let nan = if self.refuses_nan_truth { "; a NaN in it is refused" } else { "" };
        format!(
            "success: {}{miss}; precision: {}{error}{nan}{absent}",
            valid(self.valid_for_overlap),
            valid(self.valid_for_error)
        )
    }

    fn lost(&self) -> &'static str {
        match self.lost_boxes {
            LostBoxes::AsGiven => "scored as they stand: no overlap",
            LostBoxes::Carried => "replaced by the box before",
            LostBoxes::CarriedUnlessTruthIsNan => {
                "w <= 0, h <= 0 or NaN: replaced by the box before, unless the ground truth is NaN"
            }
            LostBoxes::ZeroCarriedElseRefused => {
                "w or h = 0: replaced by the box before; negative or NaN: refused"
            }
        }
    }

    fn other_lengths(&self) -> &'static str {
        match self.lengths {
            Lengths::Common => "the rows that both have are scored",
            Lengths::Fail => "refused",
            Lengths::FailIfShorter => "a shorter result is refused, a longer one cut",
            Lengths::FailOnValid => "refused, unless only rows with an invalid ground truth are missing",
            Lengths::ResultsOrFail => "a longer result is refused, of a shorter one its own rows are scored",
            Lengths::Misses => "a longer result is cut, rows that a shorter one lacks are misses",
        }
    }

    fn share(&self) -> &'static str {
        match self.denominator {
            Denominator::Frames if self.counts_visible => {
                "frames after the first in which some of the target can be seen (cover.label above 0)"
            }
            Denominator::Frames => "all frames scored, those with an invalid ground truth among them",
            Denominator::ValidFrames => "frames with a valid ground truth",
        }
    }

    fn rounding(&self) -> &'static str {
        match (self.error_decimals, self.single_precision) {
            (Some(_), _) => "centre errors to 4 decimals",
            (None, true) => "curves to 32 bits",
            (None, false) => "none",
        }
    }

    fn speed(&self) -> &'static str {
        match self.mean_of_rates {
            true if self.pools_frames => "mean of 1/t over all frames of all sequences with t > 0",
            true => "mean of 1/t over the frames with t > 0, the first among them; then over sequences",
            false => "updates over their seconds, without the first frame; then the mean over sequences",
        }
    }

    fn over_sequences(&self) -> String {
        if self.pools_frames {
            return "all frames of all sequences together, whatever sequence they are of".to_owned();
        }
        let dropped = if self.drops_zero_curves { ", those with a curve of zeros left out" } else { "" };
        format!(
            "unweighted mean of the sequences' curves{dropped}; segments of TRE and SRE weigh by their frames"
        )
    }
}
