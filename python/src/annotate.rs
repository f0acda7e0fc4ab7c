//! A box in every frame from a few key frames, behind Python's `Annotator`.

use std::{
    ops::ControlFlow,
    path::PathBuf,
    sync::{Arc, Mutex, TryLockError},
};

use infopart::{
    annotate::{
        Annotated, KeptFrames, PassError, Pathfinder, Project, Sides, annotate, doubtful_places,
        export::{Format, Tracks},
    },
    geometry::Rect,
    parallel::Threads,
    sequence::OpenOptions,
    tracker::{CheckedParameters, InfoPart, Tracker},
};
use numpy::{PyArray2, ndarray::Array2};
use pyo3::{
    exceptions::{PyRuntimeError, PyValueError},
    prelude::*,
};
use rayon::ThreadPoolBuilder;

use crate::tracker::{checked, value_error};

/// Frame, first and last frame, counted from 1, and confidence of a doubtful place.
type PlaceRow = (usize, usize, usize, f64);
/// Name, class, a row of x, y, w, h, confidence and whether it was drawn for each frame, and the doubtful places.
type TrackRow<'py> = (String, String, Bound<'py, PyArray2<f64>>, Vec<PlaceRow>);

/// Tracked frames between two looks at whether the interpreter has a signal, such as Ctrl-C.
const GLANCE: usize = 32;

/// A video and what was tracked in it.
#[pyclass(subclass, frozen, module = "infopart._infopart")]
pub struct NativeAnnotator {
    state: Mutex<State>,
    parameters: CheckedParameters,
    threads: Threads,
}

struct State {
    frames: KeptFrames,
    project: Project,
}

#[pymethods]
impl NativeAnnotator {
    /// Reads through the video once; `memory` megabytes of decoded frames are kept.
    #[new]
    #[pyo3(signature = (path, target, memory, toml, preset, threads))]
    fn new(
        py: Python<'_>,
        path: &str,
        target: Option<usize>,
        memory: usize,
        toml: &str,
        preset: &str,
        threads: usize,
    ) -> PyResult<Self> {
        let parameters = checked(toml, preset)?;
        let options = OpenOptions { target, ..OpenOptions::default() };
        let bytes = memory.saturating_mul(1 << 20);
        let frames = py.detach(|| KeptFrames::open(path, &options, bytes)).map_err(value_error)?;
        let threads = match threads {
            0 | 1 => Threads::Calling,
            _ => Threads::Pool(Arc::new(ThreadPoolBuilder::new().num_threads(threads).build().map_err(
                |error| {
                    PyValueError::new_err(format!(
                        "threads: {threads} cannot be started: {error}; give fewer"
                    ))
                },
            )?)),
        };
        Ok(Self { state: Mutex::new(State { frames, project: Project::default() }), parameters, threads })
    }

    /// How many frames the video has.
    #[getter]
    fn frames(&self) -> PyResult<usize> {
        Ok(self.lock()?.frames.about().frames)
    }

    /// Width and height of a frame, pixels.
    #[getter]
    fn size(&self) -> PyResult<(usize, usize)> {
        let state = self.lock()?;
        Ok((state.frames.about().width, state.frames.about().height))
    }

    /// The tracks of the objects of a JSON text, as `infopart annotate --keys` reads it; also written to `out`, if it is given.
    #[pyo3(signature = (keys, forward_only, out, format))]
    fn tracks<'py>(
        &self,
        py: Python<'py>,
        keys: &str,
        forward_only: bool,
        out: Option<PathBuf>,
        format: Option<&str>,
    ) -> PyResult<Vec<TrackRow<'py>>> {
        let mut state = self.lock()?;
        let State { frames, project } = &mut *state;
        let about = frames.about().clone();
        let mut given = Project::parse(keys, "objects").map_err(value_error)?;
        for object in &given.objects {
            object.check(about.frames, about.width, about.height).map_err(value_error)?;
        }
        let format = out.as_deref().map(|path| format_of(format, path, given.objects.len())).transpose()?;
        // What is known of objects of the same name serves again.
        for (object, passes) in given.objects.iter().zip(&mut given.passes) {
            let known = project.objects.iter().position(|other| other.name == object.name);
            *passes = known.map(|index| std::mem::take(&mut project.passes[index])).unwrap_or_default();
        }
        *project = given;
        let sides = if forward_only { Sides::Forward } else { Sides::Both };
        let mut tracks = Vec::with_capacity(project.objects.len());
        let (mut tracked, mut signal) = (0, None);
        let outcome: Result<(), PassError> = py.detach(|| {
            let mut watch = || {
                tracked += 1;
                if tracked % GLANCE == 0 {
                    signal = Python::attach(|py| py.check_signals()).err();
                }
                if signal.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            };
            let mut tracker = || {
                Box::new(InfoPart::with_threads(self.parameters.clone(), self.threads.clone()))
                    as Box<dyn Tracker>
            };
            for (object, passes) in project.objects.iter().zip(&mut project.passes) {
                let mut finder =
                    Pathfinder { frames: &mut *frames, tracker: &mut tracker, watch: &mut watch };
                tracks.push(annotate(object, about.frames, sides, passes, &mut finder)?);
                passes.forget_unused();
            }
            Ok(())
        });
        if let Some(signal) = signal {
            return Err(signal);
        }
        outcome.map_err(value_error)?;
        if let (Some(path), Some(format)) = (&out, format) {
            let all = Tracks { about: &about, objects: &project.objects, tracks: &tracks };
            all.write(path, format).map_err(|error| PyValueError::new_err(format!("out: {error}")))?;
        }
        let rows = project.objects.iter().zip(&tracks).map(|(object, track)| {
            let places = doubtful_places(track);
            let place = |one: &infopart::annotate::Place| {
                (one.frame + 1, one.first + 1, one.last + 1, one.confidence)
            };
            Ok((
                object.name.clone(),
                object.class.clone(),
                array(py, track)?,
                places.iter().map(place).collect(),
            ))
        });
        rows.collect()
    }
}

impl NativeAnnotator {
    fn lock(&self) -> PyResult<std::sync::MutexGuard<'_, State>> {
        match self.state.try_lock() {
            Ok(guard) => Ok(guard),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "this annotator is at work in another thread: give each thread an annotator of its own",
            )),
        }
    }
}

fn format_of(name: Option<&str>, path: &std::path::Path, objects: usize) -> PyResult<Format> {
    let format = match name {
        None => Format::from_path(path),
        Some(name) => match Format::NAMES.iter().find(|(known, _)| *known == name) {
            Some((_, format)) => *format,
            None => {
                let known: Vec<&str> = Format::NAMES.iter().map(|(known, _)| *known).collect();
                let message = format!("format: there is no `{name}`; give one of {}", known.join(", "));
                return Err(PyValueError::new_err(message));
            }
        },
    };
    let problem = match format {
        Format::Otb if objects > 1 => {
            "format: otb has no place for several objects; give csv, mot, cvat, coco or yolo"
        }
        Format::Yolo if path.exists() => {
            "out: it is there already, and yolo makes a new folder; give another path"
        }
        _ => return Ok(format),
    };
    Err(PyValueError::new_err(problem))
}

fn array<'py>(py: Python<'py>, track: &[Option<Annotated>]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows = track.iter().flat_map(|seen| match seen {
        Some(Annotated { box_in_frame: Rect { x, y, w, h }, confidence, is_key }) => {
            [*x, *y, *w, *h, *confidence, f64::from(u8::from(*is_key))]
        }
        None => [f64::NAN, f64::NAN, f64::NAN, f64::NAN, f64::NAN, 0.0],
    });
    let array = Array2::from_shape_vec((track.len(), 6), rows.collect());
    array
        .map(|array| PyArray2::from_owned_array(py, array))
        .map_err(|e| PyRuntimeError::new_err(e.to_string()))
}
