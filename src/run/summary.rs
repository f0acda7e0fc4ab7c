//! What a run came to, for people and for programs.

use std::fmt::Write;

use serde::Serialize;

use super::{Pace, RunReport};
use crate::geometry::Region;

/// What a run came to. Serialised, it is one flat JSON object but for `scores`, `warnings` and `stages`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// The sequence's name.
    pub sequence: String,
    /// The tracker's name, as [`tracker_title`] gives it.
    pub tracker: String,
    /// The tracked region.
    pub region: Region,
    /// The preset that the parameters started from.
    pub preset: String,
    /// The seed of the run's randomness.
    pub seed: u64,
    /// Threads that evaluated particles.
    pub threads: usize,
    /// What the loop measured.
    #[serde(flatten)]
    pub report: RunReport,
}

/// What a tracker is called in tables by the region it tracks: its own name for the part, `whole-body` for the
/// baseline, and the name with the fraction for any other.
pub fn tracker_title(name: &str, region: Region) -> String {
    let fraction = region.fraction();
    if fraction == Region::Whole.fraction() {
        "whole-body".to_owned()
    } else if fraction == Region::Part.fraction() {
        name.to_owned()
    } else {
        format!("{name} ({fraction})")
    }
}

impl Summary {
    /// Aligned lines for a terminal, without a newline at the end; with `timing`, the milliseconds of each stage.
    pub fn to_text(&self, timing: bool) -> String {
        let report = &self.report;
        let mut text = String::new();
        // Writing to a string cannot fail.
        let mut line = |name: &str, value: String| {
            let _ = writeln!(text, "{name:<11}{value}");
        };
        line("sequence", self.sequence.clone());
        line("tracker", format!("{}, region {}, preset {}", self.tracker, self.region, self.preset));
        line("frames", frames_text(report));
        line("speed", speed_text(report, self.threads));
        if report.pace != Pace::EveryFrame {
            line("pace", pace_text(report));
        }
        line(
            "apart",
            format!(
                "decoding {:.2} s, first frame {:.0} ms",
                report.decoding_seconds,
                1e3 * report.init_seconds
            ),
        );
        line("seed", self.seed.to_string());
        if let Some(scores) = &report.scores {
            let counted = if scores.frames == report.frames {
                String::new()
            } else {
                format!("   ({} of {} frames have ground truth)", scores.frames, report.frames)
            };
            line("R1", format!("{:>6.2} %  centre error of at most 20 pixels{counted}", scores.r1));
            line("R2", format!("{:>6.2} %  overlap greater than 0.5", scores.r2));
            line("AUC", format!("{:>6.3}    area under the success curve", scores.auc));
        }
        if timing {
            let updates = report.updates().max(1) as f64;
            line(
                "timing",
                format!("{:>9.3} ms  update (mean of a frame)", 1e3 * report.update_seconds / updates),
            );
            for stage in &report.stages {
                line("", format!("{:>9.3} ms    {}", stage.mean_milliseconds, stage.stage));
            }
        }
        text.trim_end().to_owned()
    }

    /// One JSON object on one line; `stages` is only there with `timing`.
    ///
    /// # Errors
    /// Only if serialisation fails, which these types do not.
    pub fn to_json(&self, timing: bool) -> serde_json::Result<String> {
        let mut object = serde_json::to_value(self)?;
        if let (false, Some(fields)) = (timing, object.as_object_mut()) {
            fields.remove("stages");
        }
        serde_json::to_string(&object)
    }
}

fn frames_text(report: &RunReport) -> String {
    let mut text = format!("{}: {} tracking", report.frames, report.tracking_frames);
    for (count, name) in [(report.uncertain_frames, "uncertain"), (report.lost_frames, "lost")] {
        text += &format!(", {count} {name}");
    }
    text
}

fn pace_text(report: &RunReport) -> String {
    let mut text = format!("{}: {} of {} frames skipped", report.pace, report.skipped_frames, report.frames);
    if let Some(rate) = report.sustained_frames_per_second {
        text += &format!("; {rate:.1} frames per second can be borne without skipping more");
    }
    text
}

fn speed_text(report: &RunReport, threads: usize) -> String {
    let plural = if threads == 1 { "" } else { "s" };
    match report.frames_per_second {
        Some(speed) => format!("{speed:.1} frames per second (updates only, {threads} thread{plural})"),
        None => "only one frame, nothing to measure".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{geometry::Rect, metrics, run::StageMean};

    fn summary() -> Summary {
        let truth = Rect::new(0.0, 0.0, 10.0, 10.0);
        let report = RunReport {
            frames: 11,
            tracking_frames: 8,
            uncertain_frames: 2,
            lost_frames: 1,
            pace: Pace::EveryFrame,
            skipped_frames: 0,
            sustained_frames_per_second: Some(150.0),
            update_seconds: 0.05,
            frames_per_second: Some(200.0),
            init_seconds: 0.012,
            decoding_seconds: 0.3,
            scores: metrics::score(&[(truth, truth); 10]),
            stages: vec![StageMean { stage: "likelihood", mean_milliseconds: 3.25 }],
            warnings: Vec::new(),
        };
        Summary {
            sequence: "Crossing".into(),
            tracker: "InfoPart".into(),
            region: Region::Part,
            preset: "default".into(),
            seed: 7,
            threads: 2,
            report,
        }
    }

    #[test]
    fn a_tracker_is_called_by_what_it_tracks() {
        for (region, title) in [
            (Region::Part, "infopart"),
            (Region::Upper(0.625), "infopart"),
            (Region::Whole, "whole-body"),
            (Region::Upper(1.0), "whole-body"),
            (Region::Upper(0.5), "infopart (0.5)"),
        ] {
            assert_eq!(tracker_title("infopart", region), title);
        }
    }

    #[test]
    fn the_text_says_what_a_user_asks() {
        let text = summary().to_text(false);
        for part in [
            "sequence   Crossing\n",
            "frames     11: 8 tracking, 2 uncertain, 1 lost\n",
            "speed      200.0 frames per second (updates only, 2 threads)\n",
            "decoding 0.30 s",
            "seed       7\n",
            "R1         100.00 %",
            "AUC         0.952",
            "10 of 11 frames",
        ] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
        assert!(!text.contains("likelihood") && !text.contains("skipped"));
        assert!(summary().to_text(true).contains("3.250 ms    likelihood"));
    }

    #[test]
    fn a_pace_tells_what_was_skipped_and_what_rate_can_be_borne() {
        let mut summary = summary();
        summary.report.pace = Pace::RealTime { frames_per_second: 240.0 };
        summary.report.skipped_frames = 4;
        let text = summary.to_text(false);
        let line =
            "pace       real time at 240 per second: 4 of 11 frames skipped; 150.0 frames per second can";
        assert!(text.contains(line), "{text}");
        let value: serde_json::Value = serde_json::from_str(&summary.to_json(false).unwrap()).unwrap();
        assert_eq!(
            (&value["skipped_frames"], &value["pace"]),
            (&4.into(), &"real time at 240 per second".into())
        );
        assert_eq!(value["sustained_frames_per_second"], 150.0);
    }

    #[test]
    fn the_json_is_one_line_with_the_same_numbers() {
        let json = summary().to_json(true).unwrap();
        assert_eq!(json.lines().count(), 1);
        let value: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(value["region"], "part");
        assert_eq!(value["frames_per_second"], 200.0);
        assert_eq!(value["scores"]["r1"], 100.0);
        assert_eq!(value["stages"][0]["stage"], "likelihood");
        let value: serde_json::Value = serde_json::from_str(&summary().to_json(false).unwrap()).unwrap();
        assert!(value.get("stages").is_none());
    }
}
