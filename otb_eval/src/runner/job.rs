//! One job and its stable id.

use std::path::PathBuf;

use infopart::geometry::Rect;

use crate::{
    dataset::FrameFolder,
    protocol::{Protocol, Segment},
};

/// One tracker with one seed on one segment of one sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Job {
    /// The protocol it belongs to.
    pub protocol: Protocol,
    /// The tracker's name.
    pub tracker: String,
    /// The seed.
    pub seed: u64,
    /// The sequence.
    pub sequence: String,
    /// Where it starts, and with which box.
    pub segment: Segment,
    /// Frames to track, the first among them.
    pub frames: usize,
    /// Where the frames are.
    pub folder: FrameFolder,
}

impl Job {
    /// `PROTOCOL/TRACKER/seed_S/SEQ[_SEGMENT]`, the same in every run.
    pub fn id(&self) -> String {
        let stem = stem(&self.sequence, self.segment.label.as_deref());
        format!("{}/{}/seed_{}/{stem}", self.protocol, self.tracker, self.seed)
    }

    /// What `otb_eval plan` prints of it.
    pub fn to_json(&self, done: bool) -> serde_json::Value {
        let Rect { x, y, w, h } = self.segment.first_box;
        serde_json::json!({
            "id": self.id(),
            "protocol": self.protocol,
            "tracker": self.tracker,
            "seed": self.seed,
            "sequence": self.sequence,
            "segment": self.segment.label,
            "folder": self.folder.path,
            "target": self.folder.target,
            "first_frame": self.first_frame(),
            "frames": self.frames,
            "first_box": [x, y, w, h],
            "done": done,
        })
    }

    /// The first frame to track, counted from 1 among the frames that opening the folder delivers.
    pub fn first_frame(&self) -> usize {
        self.folder.first_frame + self.segment.start
    }

    /// The result's path below the results' folder.
    pub fn result_path(&self) -> PathBuf {
        PathBuf::from(format!("{}.txt", self.id()))
    }

    /// The path of the seconds a frame took, below the results' folder.
    pub fn time_path(&self) -> PathBuf {
        PathBuf::from(format!("{}_time.txt", self.id()))
    }

    /// The path of what is told of a tracker in another process, below the results' folder.
    pub fn external_path(&self) -> PathBuf {
        PathBuf::from(format!("{}.external.json", self.id()))
    }

    /// The path of the confidence of each frame, below the results' folder.
    pub fn confidence_path(&self) -> PathBuf {
        PathBuf::from(format!("{}_confidence.txt", self.id()))
    }

    /// The path of what is told of a failure, below the results' folder.
    pub fn failure_path(&self) -> PathBuf {
        PathBuf::from(format!("{}.failed.json", self.id()))
    }
}

/// `SEQ` or `SEQ_SEGMENT`: what a sequence's files are called.
pub fn stem(sequence: &str, label: Option<&str>) -> String {
    match label {
        Some(label) => format!("{sequence}_{label}"),
        None => sequence.to_owned(),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn job(label: Option<&str>) -> Job {
        Job {
            protocol: Protocol::Tre,
            tracker: "infopart".into(),
            seed: 3,
            sequence: "Jogging-1".into(),
            segment: Segment {
                label: label.map(str::to_owned),
                start: 6,
                first_box: Rect::new(1.0, 2.5, 3.0, 4.0),
            },
            frames: 301,
            folder: FrameFolder {
                path: "otb/Jogging".into(),
                target: Some(1),
                first_frame: 1,
                origin: infopart::geometry::Origin::One,
                ground_truth: "otb/Jogging/groundtruth_rect.1.txt".into(),
            },
        }
    }

    #[test]
    fn ids_are_where_the_results_go() {
        let job = job(Some("02"));
        assert_eq!(job.id(), "tre/infopart/seed_3/Jogging-1_02");
        assert_eq!(job.result_path(), PathBuf::from("tre/infopart/seed_3/Jogging-1_02.txt"));
        assert_eq!(job.time_path(), PathBuf::from("tre/infopart/seed_3/Jogging-1_02_time.txt"));
        let json = job.to_json(true);
        assert_eq!((&json["first_frame"], &json["done"]), (&7.into(), &true.into()));
        assert_eq!(json["first_box"][1], 2.5);
    }
}
