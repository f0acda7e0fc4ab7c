//! Frames of files, decoded as the program decodes them.

use std::sync::Mutex;

use infopart::{
    frame::PixelFormat,
    geometry::{Origin, Rect},
    sequence::{OpenOptions, Sequence, open},
};
use numpy::{PyArray, PyArrayMethods};
use pyo3::{
    exceptions::{PyRuntimeError, PyValueError},
    prelude::*,
};

/// x, y, w, h in pixels, counted from 0.
type Box4 = (f64, f64, f64, f64);

/// An input's frames, one after another.
#[pyclass(frozen, module = "infopart._infopart")]
pub struct NativeSequence {
    inner: Mutex<Sequence>,
    #[pyo3(get)]
    name: String,
    /// The number of the first pixel in the input's own boxes.
    #[pyo3(get)]
    origin: u8,
    /// The target's true box in each frame, or None, with the first pixel 0.
    #[pyo3(get)]
    ground_truth: Vec<Option<Box4>>,
}

#[pymethods]
impl NativeSequence {
    /// Opens a folder, a glob, an image or a video.
    #[new]
    #[pyo3(signature = (path, target = None, start = None, end = None))]
    fn new(path: &str, target: Option<usize>, start: Option<usize>, end: Option<usize>) -> PyResult<Self> {
        let options = OpenOptions { target, start, end, ..OpenOptions::default() };
        let sequence = open(path, &options).map_err(|error| PyValueError::new_err(error.to_string()))?;
        let numbers = |Rect { x, y, w, h }| (x, y, w, h);
        Ok(Self {
            name: sequence.name.clone(),
            origin: if sequence.origin == Origin::One { 1 } else { 0 },
            ground_truth: sequence.ground_truth.iter().map(|truth| truth.map(numbers)).collect(),
            inner: Mutex::new(sequence),
        })
    }

    /// How many frames are still to come, where that is known.
    fn remaining(&self) -> PyResult<Option<usize>> {
        Ok(self.sequence()?.source.remaining())
    }

    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    /// The next frame: grey, or red first.
    fn __next__<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let mut sequence = self.sequence()?;
        let source = &mut sequence.source;
        let next = py.detach(|| source.next_frame());
        let Some(next) = next.map_err(|error| PyValueError::new_err(error.to_string()))? else {
            return Ok(None);
        };
        let view = next.frame.view();
        let channels = view.format().bytes_per_pixel();
        let mut bytes = Vec::with_capacity(view.width() * view.height() * channels);
        (0..view.height()).for_each(|y| bytes.extend_from_slice(view.row(y)));
        let array = PyArray::from_vec(py, bytes);
        let shaped = match view.format() {
            PixelFormat::Gray => array.reshape([view.height(), view.width()])?.into_any(),
            _ => array.reshape([view.height(), view.width(), channels])?.into_any(),
        };
        Ok(Some(shaped))
    }
}

impl NativeSequence {
    fn sequence(&self) -> PyResult<std::sync::MutexGuard<'_, Sequence>> {
        self.inner.try_lock().map_err(|_| {
            PyRuntimeError::new_err("these frames are being read in another thread: open them once a thread")
        })
    }
}
