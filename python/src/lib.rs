//! The InfoPart tracker for Python: what `infopart/__init__.py` stands on. Python's own side checks names and defaults; this
//! side borrows frames, tracks without the interpreter's lock, and turns every error into an exception with its remedy.
#![deny(missing_docs)]

use pyo3::prelude::*;

mod annotate;
mod frame;
mod sequence;
mod sort;
mod tracker;

/// The native half of the package `infopart`.
#[pymodule]
mod _infopart {
    #[pymodule_export]
    use crate::annotate::NativeAnnotator;
    #[pymodule_export]
    use crate::sequence::NativeSequence;
    #[pymodule_export]
    use crate::sort::NativeSort;
    #[pymodule_export]
    use crate::tracker::{NativeTracker, parameters};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("VERSION", infopart::VERSION)
    }
}
