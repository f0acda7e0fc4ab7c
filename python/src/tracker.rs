//! The tracker behind Python's `Tracker`.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Mutex, MutexGuard, TryLockError},
};

use infopart::{
    geometry::Rect,
    parallel::Threads,
    tracker::{CheckedParameters, Estimate, InfoPart, Parameters, TrackError, Tracker},
};
use numpy::{PyArray2, ndarray::Array2};
use pyo3::{
    exceptions::{PyRuntimeError, PyValueError},
    prelude::*,
    types::{PyBytes, PyDict},
};
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::frame::Pixels;

/// x, y, w, h in pixels, counted from 0.
type Box4 = (f64, f64, f64, f64);

/// A tracker whose calls give up the interpreter's lock.
#[pyclass(subclass, frozen, module = "infopart._infopart")]
pub struct NativeTracker {
    work: Mutex<Option<Work>>,
    rgb: bool,
    threads: usize,
}

/// What one thread at a time works with.
struct Work {
    tracker: InfoPart,
    pool: Option<OwnPool>,
}

/// A pool and the process that it was made in. Its threads do not come with a fork, and to wait for them there, as even
/// dropping the pool may, is to wait for ever.
struct OwnPool {
    process: u32,
    pool: Option<Arc<ThreadPool>>,
}

impl Drop for OwnPool {
    fn drop(&mut self) {
        if self.process != std::process::id() {
            std::mem::forget(self.pool.take());
        }
    }
}

impl Work {
    /// Makes sure that the tracker works in threads of this process.
    fn settle(&mut self, threads: usize) -> PyResult<()> {
        let process = std::process::id();
        if threads <= 1 || self.pool.as_ref().is_some_and(|own| own.process == process) {
            return Ok(());
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| {
            PyValueError::new_err(format!("threads: {threads} cannot be started: {error}; give fewer"))
        })?;
        let pool = Arc::new(pool);
        let before = self.pool.replace(OwnPool { process, pool: Some(Arc::clone(&pool)) });
        // First the tracker's share of the old pool, whose last share is then given up with regard to its process.
        self.tracker.set_threads(Threads::Pool(pool));
        drop(before);
        Ok(())
    }
}

#[pymethods]
impl NativeTracker {
    /// A tracker with the parameters of that preset, over them those of a TOML text; or the one that was saved.
    #[new]
    #[pyo3(signature = (toml, preset, threads, rgb, saved = None))]
    fn new(toml: &str, preset: &str, threads: usize, rgb: bool, saved: Option<&[u8]>) -> PyResult<Self> {
        let mut tracker = match saved {
            Some(bytes) => InfoPart::load(bytes).map_err(value_error)?,
            None => InfoPart::new(checked(toml, preset)?),
        };
        tracker.set_threads(Threads::Calling);
        Ok(Self { work: Mutex::new(Some(Work { tracker, pool: None })), rgb, threads })
    }

    /// Whether three and four channels are red first.
    #[getter]
    fn rgb(&self) -> bool {
        self.rgb
    }

    /// How many threads it may work on.
    #[getter]
    fn threads(&self) -> usize {
        self.threads
    }

    /// Starts on `frame` with the target in `box`, and gives what is odd about the box.
    fn init_with(
        &self,
        py: Python<'_>,
        frame: &Bound<'_, PyAny>,
        r#box: &Bound<'_, PyAny>,
    ) -> PyResult<Vec<String>> {
        let target = rect_of(r#box)?;
        let pixels = Pixels::of(frame, self.rgb)?;
        let view = pixels.view()?;
        let warnings = self.work(py, |work| work.tracker.init(view, target))?;
        Ok(warnings.iter().map(ToString::to_string).collect())
    }

    /// Finds the target in the next frame: whether it is not lost, and its box.
    fn update(&self, py: Python<'_>, frame: &Bound<'_, PyAny>) -> PyResult<(bool, Box4)> {
        let pixels = Pixels::of(frame, self.rgb)?;
        let view = pixels.view()?;
        let found = self.work(py, |work| work.tracker.update(view))?;
        Ok((is_seen(&found), numbers(found.box_in_frame)))
    }

    /// The confidence of the last frame, in [0, 1].
    #[pyo3(name = "getTrackingScore")]
    fn tracking_score(&self) -> PyResult<f64> {
        self.with(|work| Ok(estimate(work)?.confidence))
    }

    /// What is known of the last frame, as a tuple that Python's side names.
    fn last_estimate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.with(|work| {
            let found = estimate(work)?;
            let evidence = found.evidence.as_ref().map(|evidence| {
                let dict = PyDict::new(py);
                dict.set_item("mean_stump", evidence.mean_stump)?;
                dict.set_item("hog_distance", evidence.hog_distance)?;
                dict.set_item("peak_sharpness", evidence.peak_sharpness)?;
                dict.set_item("likeness", evidence.likeness)?;
                dict.set_item("scenery", evidence.scenery)?;
                dict.set_item("lowest_log_odds", evidence.lowest_log_odds)?;
                PyResult::Ok(dict)
            });
            let times = PyDict::new(py);
            for stage in work.tracker.stage_times() {
                times.set_item(stage.stage, stage.time.as_secs_f64())?;
            }
            let tuple = (
                numbers(found.box_in_frame),
                numbers(found.part_in_frame),
                found.confidence,
                found.status.to_string(),
                found.effective_sample_size,
                found.covariance.map(|[x, y, w]| (x, y, w)),
                evidence.transpose()?,
                times,
            );
            Ok(tuple.into_pyobject(py)?.into_any())
        })
    }

    /// The particles weighed in the last frame: an array of (x, y, w, h, weight) each.
    fn particles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let particles = self.with(|work| {
            estimate(work)?;
            Ok(work.tracker.hypotheses())
        })?;
        let rows = particles.iter().flat_map(|particle| {
            let Rect { x, y, w, h } = particle.box_in_frame;
            [x, y, w, h, particle.weight]
        });
        let array = Array2::from_shape_vec((particles.len(), 5), rows.collect());
        array
            .map(|array| PyArray2::from_owned_array(py, array))
            .map_err(|e| PyRuntimeError::new_err(e.to_string()))
    }

    /// The parameters as JSON.
    fn config_json(&self) -> PyResult<String> {
        self.with(|work| to_json(work.tracker.parameters()))
    }

    /// The tracker as bytes.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.with(|work| work.tracker.save().map_err(value_error))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Frees everything; the tracker is of no use afterwards.
    fn close(&self) -> PyResult<()> {
        *self.lock()? = None;
        Ok(())
    }
}

impl NativeTracker {
    /// The lock, or an exception if another thread has it.
    fn lock(&self) -> PyResult<MutexGuard<'_, Option<Work>>> {
        match self.work.try_lock() {
            Ok(guard) => Ok(guard),
            // Work that panicked was closed.
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "this tracker is at work in another thread: give each thread a tracker of its own, such as a copy.deepcopy",
            )),
        }
    }

    fn with<T>(&self, look: impl FnOnce(&mut Work) -> PyResult<T>) -> PyResult<T> {
        match &mut *self.lock()? {
            Some(work) => look(work),
            None => Err(PyRuntimeError::new_err("this tracker was closed: make a new one")),
        }
    }

    /// Tracks without the interpreter's lock. A panic closes the tracker and is an exception as any other.
    fn work<T: Send>(
        &self,
        py: Python<'_>,
        track: impl FnOnce(&mut Work) -> Result<T, TrackError> + Send,
    ) -> PyResult<T> {
        let mut guard = self.lock()?;
        let Some(work) = guard.as_mut() else {
            return Err(PyRuntimeError::new_err("this tracker was closed: make a new one"));
        };
        work.settle(self.threads)?;
        match py.detach(|| catch_unwind(AssertUnwindSafe(|| track(work)))) {
            Ok(outcome) => outcome.map_err(exception),
            Err(panic) => {
                *guard = None;
                let text = panic.downcast_ref::<String>().map(String::as_str);
                let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
                Err(PyRuntimeError::new_err(format!("the tracker broke down: {text}; please report this")))
            }
        }
    }
}

/// The parameters of a preset with those of a TOML text over them.
///
/// # Errors
/// ValueError, naming the parameter.
pub fn checked(toml: &str, preset: &str) -> PyResult<CheckedParameters> {
    let base = Parameters::preset(preset).map_err(value_error)?;
    Parameters::from_toml(toml, base).map_err(value_error)?.check().map_err(value_error)
}

/// The parameters of a preset as JSON.
#[pyfunction]
pub fn parameters(preset: &str) -> PyResult<String> {
    to_json(&Parameters::preset(preset).map_err(value_error)?)
}

fn to_json(parameters: &Parameters) -> PyResult<String> {
    serde_json::to_string(parameters).map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

fn estimate(work: &Work) -> PyResult<&Estimate> {
    work.tracker.estimate().ok_or_else(|| exception(TrackError::NotStarted))
}

fn is_seen(found: &Estimate) -> bool {
    !matches!(found.status, infopart::tracker::Status::Lost)
}

fn numbers(rect: Rect) -> Box4 {
    (rect.x, rect.y, rect.w, rect.h)
}

fn rect_of(given: &Bound<'_, PyAny>) -> PyResult<Rect> {
    let refused =
        |why: String| PyValueError::new_err(format!("box: {why}; give four numbers, (x, y, w, h) in pixels"));
    let Ok(items) = given.try_iter() else {
        return Err(refused(format!("it is a {}", given.get_type().name()?)));
    };
    let mut sides = Vec::with_capacity(4);
    for item in items {
        let item = item?;
        sides.push(item.extract::<f64>().map_err(|_| refused(format!("{item} is no number")))?);
        if sides.len() > 4 {
            break;
        }
    }
    match sides[..] {
        [x, y, w, h] => Ok(Rect::new(x, y, w, h)),
        _ => Err(refused(format!(
            "it has {} numbers",
            if sides.len() > 4 { "more than 4".to_owned() } else { sides.len().to_string() }
        ))),
    }
}

/// A ValueError that says what an error says.
pub fn value_error(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// The exception of a refusal, which names the argument.
fn exception(error: TrackError) -> PyErr {
    match error {
        TrackError::BadBox { .. } | TrackError::BoxOutside { .. } => {
            PyValueError::new_err(format!("box: {error}"))
        }
        TrackError::SizeChanged { .. } => PyValueError::new_err(format!("frame: {error}")),
        _ => PyRuntimeError::new_err(error.to_string()),
    }
}
