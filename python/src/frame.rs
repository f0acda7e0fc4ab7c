//! Frames as numpy arrays: borrowed where their rows are contiguous, copied otherwise.

use infopart::frame::{FrameView, PixelFormat};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::{exceptions::PyValueError, prelude::*};

/// Pixels of an array that is kept alive beside them.
pub struct Pixels<'py> {
    array: Bound<'py, PyArrayDyn<u8>>,
    layout: Layout,
}

/// How the pixels of an array lie in memory.
struct Layout {
    /// Bytes from the array's first element back to the first byte of its first pixel: swapped channels begin behind.
    back: usize,
    width: usize,
    height: usize,
    stride: usize,
    format: PixelFormat,
}

impl<'py> Pixels<'py> {
    /// The pixels of `frame`, an argument of that name; three channels are BGR unless `rgb`.
    ///
    /// # Errors
    /// ValueError for anything that is not an image of bytes.
    pub fn of(frame: &Bound<'py, PyAny>, rgb: bool) -> PyResult<Self> {
        let array = bytes_of(frame)?;
        if let Some(layout) = Layout::of(&array, rgb)? {
            return Ok(Self { array, layout });
        }
        let copy = frame.py().import("numpy")?.call_method1("ascontiguousarray", (&array,))?;
        let array = bytes_of(&copy)?;
        match Layout::of(&array, rgb)? {
            Some(layout) => Ok(Self { array, layout }),
            None => Err(refused("numpy gave no contiguous copy of it")),
        }
    }

    /// The pixels as the tracker takes them.
    ///
    /// # Errors
    /// ValueError if there is no pixel.
    pub fn view(&self) -> PyResult<FrameView<'_>> {
        let Layout { back, width, height, stride, format } = self.layout;
        let row = width * format.bytes_per_pixel();
        let bytes = match height.checked_sub(1) {
            Some(others) if row > 0 => {
                let length = others * stride + row;
                let first = self.array.data().cast_const().wrapping_sub(back);
                // SAFETY: by `Layout::of` every row of the array is `row` bytes from `first` on, rows `stride` apart, so all
                // bytes up to the end of the last row lie between the array's own elements, in the memory that it owns or
                // views and that `self.array` keeps alive. Whoever writes into a frame while it is tracked in another
                // thread gets boxes of what was read; bytes have no invalid values.
                unsafe { std::slice::from_raw_parts(first, length) }
            }
            _ => &[],
        };
        FrameView::new(bytes, width, height, stride, format).map_err(|error| refused(&error.to_string()))
    }
}

impl Layout {
    /// `None` if the rows are not contiguous in memory.
    fn of(array: &Bound<'_, PyArrayDyn<u8>>, rgb: bool) -> PyResult<Option<Self>> {
        let (shape, strides) = (array.shape(), array.strides());
        let (height, width, channels, steps) = match (shape, strides) {
            (&[height, width], &[row, pixel]) => (height, width, 1, [row, pixel, 1]),
            (&[height, width, channels @ (1 | 3 | 4)], &[row, pixel, sample]) => {
                (height, width, channels, [row, pixel, sample])
            }
            _ => {
                let shape: Vec<_> = shape.iter().map(ToString::to_string).collect();
                return Err(refused(&format!(
                    "its shape is ({}); give (height, width), (height, width, 3) or (height, width, 4)",
                    shape.join(", ")
                )));
            }
        };
        let [row, pixel, sample] = steps;
        let swapped = channels == 3 && sample == -1;
        // The stride of an axis without a second element means nothing.
        let is_contiguous = (width <= 1 || pixel == channels as isize)
            && (sample == 1 || swapped || channels == 1)
            && (height <= 1 || row >= (width * channels) as isize);
        let stride = if height <= 1 { width * channels } else { row.unsigned_abs() };
        if width * height == 0 {
            return Ok(Some(Self { back: 0, width, height, stride, format: PixelFormat::Gray }));
        }
        let format = match (channels, rgb != swapped) {
            (1, _) => PixelFormat::Gray,
            (3, true) => PixelFormat::Rgb,
            (3, false) => PixelFormat::Bgr,
            (_, true) => PixelFormat::Rgba,
            (_, false) => PixelFormat::Bgra,
        };
        let back = if swapped { 2 } else { 0 };
        Ok(is_contiguous.then_some(Self { back, width, height, stride, format }))
    }
}

fn bytes_of<'py>(frame: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<u8>>> {
    let Ok(array) = frame.cast::<PyUntypedArray>() else {
        return Err(refused(&format!("it is a {}; give a numpy array of uint8", frame.get_type().name()?)));
    };
    match array.cast::<PyArrayDyn<u8>>() {
        Ok(bytes) => Ok(bytes.clone()),
        Err(_) => Err(refused(&format!(
            "its dtype is {}; give uint8, such as numpy.clip(frame, 0, 255).astype(numpy.uint8)",
            array.dtype()
        ))),
    }
}

fn refused(why: &str) -> PyErr {
    PyValueError::new_err(format!("frame: {why}"))
}
