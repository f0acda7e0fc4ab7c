//! RMSE, overlap and accuracy of boxes against the truth.

use infopart::geometry::Rect;

/// How near boxes are to the truth.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Measures {
    /// Root of the mean squared distance of the centres, pixels.
    pub rmse: f64,
    /// Mean intersection over union, in [0, 1].
    pub overlap: f64,
    /// Mean intersection over the smaller area, in [0, 1].
    pub accuracy: f64,
    /// Boxes compared.
    pub boxes: usize,
}

/// The measures of one frame.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct FrameMeasures {
    /// The frame, counted from 1.
    pub frame: usize,
    /// Its measures.
    pub measures: Measures,
}

impl FrameMeasures {
    /// The measures of each frame with a box; the pairs (frame, truth, box) come in the order of their frames.
    pub fn of(pairs: impl IntoIterator<Item = (usize, Rect, Rect)>) -> Vec<Self> {
        let mut frames: Vec<Self> = Vec::new();
        for (frame, truth, found) in pairs {
            if frames.last().is_none_or(|last| last.frame != frame) {
                let measures = Measures { rmse: 0.0, overlap: 0.0, accuracy: 0.0, boxes: 0 };
                frames.push(Self { frame, measures });
            }
            let Some(Self { measures, .. }) = frames.last_mut() else { continue };
            // Sums for now.
            measures.rmse += truth.centre_distance(&found).powi(2);
            measures.overlap += truth.overlap(&found);
            measures.accuracy += truth.intersection_area(&found) / truth.area().min(found.area());
            measures.boxes += 1;
        }
        for Self { measures, .. } in &mut frames {
            let boxes = measures.boxes as f64;
            measures.rmse = (measures.rmse / boxes).sqrt();
            measures.overlap /= boxes;
            measures.accuracy /= boxes;
        }
        frames
    }
}

/// The means over frames, each frame counting once; `None` if there is no frame.
pub fn mean_over_frames(frames: &[FrameMeasures]) -> Option<Measures> {
    let mean = |of: fn(&Measures) -> f64| {
        frames.iter().map(|frame| of(&frame.measures)).sum::<f64>() / frames.len() as f64
    };
    (!frames.is_empty()).then(|| Measures {
        rmse: mean(|measures| measures.rmse),
        overlap: mean(|measures| measures.overlap),
        accuracy: mean(|measures| measures.accuracy),
        boxes: frames.iter().map(|frame| frame.measures.boxes).sum(),
    })
}
