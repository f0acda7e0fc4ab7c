//! The trackers of a detector's boxes behind Python's `Sort`.

use std::sync::{Mutex, MutexGuard, TryLockError};

use infopart::geometry::Rect;
use multi_object::{
    camera_motion::CameraWatch,
    sort::{
        BoxTracker, ByteParameters, ByteTracker, OcParameters, OcTracker, ReportedBox, ScoredBox, Sort,
        SortParameters, is_trackable,
    },
};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::{
    exceptions::{PyRuntimeError, PyValueError},
    prelude::*,
};

use crate::frame::Pixels;

/// Identity, box, class and index of the detection.
type Row = (u64, (f64, f64, f64, f64), Option<u32>, usize);

/// A tracker of given boxes.
#[pyclass(subclass, frozen, module = "infopart._infopart")]
pub struct NativeSort {
    state: Mutex<State>,
    rgb: bool,
}

struct State {
    tracker: Box<dyn BoxTracker>,
    /// Where the camera's motion is told, from the frames.
    watch: Option<CameraWatch>,
    /// The boxes of the frame before, which are no background.
    before: Vec<Rect>,
    boxes: Vec<ScoredBox>,
}

/// What was given; `None` is the method's default.
struct Given {
    max_age: Option<u32>,
    min_hits: Option<u32>,
    min_overlap: Option<f64>,
    high: Option<f64>,
    low: Option<f64>,
}

#[pymethods]
impl NativeSort {
    /// A tracker that has seen nothing.
    #[new]
    #[pyo3(signature = (method, max_age, min_hits, min_overlap, high, low, camera_motion, rgb))]
    #[expect(clippy::too_many_arguments, reason = "Python's side names them")]
    fn new(
        method: &str,
        max_age: Option<u32>,
        min_hits: Option<u32>,
        min_overlap: Option<f64>,
        high: Option<f64>,
        low: Option<f64>,
        camera_motion: bool,
        rgb: bool,
    ) -> PyResult<Self> {
        let tracker = Given { max_age, min_hits, min_overlap, high, low }.tracker(method)?;
        let watch = camera_motion.then(CameraWatch::default);
        let state = State { tracker, watch, before: Vec::new(), boxes: Vec::new() };
        Ok(Self { state: Mutex::new(state), rgb })
    }

    /// The next frame's boxes, (x, y, w, h) a row, with a confidence each and perhaps a class; gives the tracks to report.
    fn step(
        &self,
        py: Python<'_>,
        boxes: PyReadonlyArray2<'_, f64>,
        scores: PyReadonlyArray1<'_, f64>,
        classes: Option<PyReadonlyArray1<'_, i64>>,
        frame: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Vec<Row>> {
        let mut state = self.lock()?;
        let State { tracker, watch, before, boxes: seen } = &mut *state;
        read(seen, &boxes, &scores, classes.as_ref())?;
        let pixels = frame.map(|frame| Pixels::of(frame, self.rgb)).transpose()?;
        let view = pixels.as_ref().map(Pixels::view).transpose()?;
        let found = py.detach(|| {
            if let (Some(watch), Some(view)) = (watch, view) {
                if let Some(motion) = watch.look(view, before) {
                    tracker.move_camera(&motion);
                }
                before.clear();
                before.extend(seen.iter().map(|one| one.area));
            }
            tracker.track(seen).map(|reported| reported.iter().map(row).collect())
        });
        found.map_err(|error| PyValueError::new_err(format!("boxes: {error}")))
    }
}

impl NativeSort {
    /// The lock, or an exception if another thread has it.
    fn lock(&self) -> PyResult<MutexGuard<'_, State>> {
        match self.state.try_lock() {
            Ok(guard) => Ok(guard),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "this tracker is at work in another thread: give each thread a tracker of its own",
            )),
        }
    }
}

impl Given {
    fn tracker(&self, method: &str) -> PyResult<Box<dyn BoxTracker>> {
        within("min_overlap", self.min_overlap)?;
        within("high", self.high)?;
        within("low", self.low)?;
        Ok(match method {
            "sort" => {
                not_for(method, &[("high", self.high.is_some()), ("low", self.low.is_some())])?;
                let usual = SortParameters::default();
                Box::new(Sort::new(SortParameters {
                    max_age: self.max_age.unwrap_or(usual.max_age),
                    min_hits: self.min_hits.unwrap_or(usual.min_hits),
                    min_overlap: self.min_overlap.unwrap_or(usual.min_overlap),
                    ..usual
                }))
            }
            "byte" => {
                not_for(method, &[("min_hits", self.min_hits.is_some())])?;
                let usual = ByteParameters::default();
                let (high, low) = (self.high.unwrap_or(usual.high), self.low.unwrap_or(usual.low));
                if low > high {
                    let message = format!("low: {low} is above high, {high}; give one that is not");
                    return Err(PyValueError::new_err(message));
                }
                Box::new(ByteTracker::new(ByteParameters {
                    high,
                    low,
                    max_age: self.max_age.unwrap_or(usual.max_age),
                    min_overlap: self.min_overlap.unwrap_or(usual.min_overlap),
                    ..usual
                }))
            }
            "oc" => {
                not_for(method, &[("low", self.low.is_some())])?;
                let usual = OcParameters::default();
                Box::new(OcTracker::new(OcParameters {
                    high: self.high.unwrap_or(usual.high),
                    max_age: self.max_age.unwrap_or(usual.max_age),
                    min_hits: self.min_hits.unwrap_or(usual.min_hits),
                    min_overlap: self.min_overlap.unwrap_or(usual.min_overlap),
                    ..usual
                }))
            }
            _ => {
                let message = format!("method: there is no `{method}`; give sort, byte or oc");
                return Err(PyValueError::new_err(message));
            }
        })
    }
}

fn within(name: &str, given: Option<f64>) -> PyResult<()> {
    match given {
        Some(value) if !(0.0..=1.0).contains(&value) => {
            Err(PyValueError::new_err(format!("{name}: it is {value}; give a number from 0 to 1")))
        }
        _ => Ok(()),
    }
}

fn not_for(method: &str, parameters: &[(&str, bool)]) -> PyResult<()> {
    match parameters.iter().find(|(_, is_given)| *is_given) {
        Some((name, _)) => {
            Err(PyValueError::new_err(format!("{name}: method {method} does not look at it; leave it out")))
        }
        None => Ok(()),
    }
}

/// Checks what was given for a frame before anything of it is tracked.
fn read(
    seen: &mut Vec<ScoredBox>,
    boxes: &PyReadonlyArray2<'_, f64>,
    scores: &PyReadonlyArray1<'_, f64>,
    classes: Option<&PyReadonlyArray1<'_, i64>>,
) -> PyResult<()> {
    let (boxes, scores) = (boxes.as_array(), scores.as_array());
    seen.clear();
    for (place, (row, &confidence)) in boxes.rows().into_iter().zip(scores).enumerate() {
        let area = Rect::new(row[0], row[1], row[2], row[3]);
        let Rect { x, y, w, h } = area;
        if !is_trackable(&area) {
            return Err(PyValueError::new_err(format!(
                "boxes: row {place} is {x},{y},{w},{h}; give x, y, width and height in pixels, finite, the sides above 0"
            )));
        }
        if confidence.is_nan() {
            return Err(PyValueError::new_err(format!(
                "scores: that of row {place} is no number; give a confidence"
            )));
        }
        let class = classes.map(|classes| class_of(classes.as_array()[place], place)).transpose()?;
        seen.push(ScoredBox { area, confidence, class });
    }
    Ok(())
}

fn class_of(given: i64, place: usize) -> PyResult<u32> {
    u32::try_from(given).map_err(|_| {
        PyValueError::new_err(format!("classes: that of row {place} is {given}; give numbers from 0 on"))
    })
}

fn row(one: &ReportedBox) -> Row {
    let Rect { x, y, w, h } = one.tracked_box;
    (one.identity, (x, y, w, h), one.class, one.detection)
}
