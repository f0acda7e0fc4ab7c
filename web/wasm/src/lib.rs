//! The tracker and the annotation engine as a page calls them: numbers in and out, and two buffers.
//!
//! A call goes so:
//! 1. the page asks for a buffer ([`input`] for JSON, [`pixels`] for a frame) and writes into it,
//! 2. it calls [`request`] (JSON in, JSON out) or one of the calls that are made once a frame,
//! 3. which gives 0 and leaves its answer in the output buffer, or 1 and leaves a sentence for the user there.
//!
//! The buffers are this side's own, so nothing here follows an address that comes from outside. Boxes are in pixels, the first being 0;
//! frames count from 0, but in what people read they count from 1.
#![deny(missing_docs)]

use std::{cell::RefCell, panic};

mod request;
mod session;

use request::Request;
use session::Session;

#[derive(Default)]
struct Page {
    input: Vec<u8>,
    pixels: Vec<u8>,
    output: Vec<u8>,
    session: Session,
}

thread_local! {
    static PAGE: RefCell<Page> = RefCell::default();
}

/// Runs a call and keeps its answer.
fn answer(call: impl FnOnce(&mut Page) -> Result<Vec<u8>, String>) -> u32 {
    PAGE.with_borrow_mut(|page| match call(page) {
        Ok(answer) => {
            page.output = answer;
            0
        }
        Err(message) => {
            page.output = message.into_bytes();
            1
        }
    })
}

fn resized(buffer: &mut Vec<u8>, bytes: usize) -> *mut u8 {
    buffer.resize(bytes, 0);
    buffer.as_mut_ptr()
}

/// Once, before all else: what fails inside this module is kept as the output.
#[unsafe(no_mangle)]
pub extern "C" fn start() {
    panic::set_hook(Box::new(|failure| {
        let message = failure.to_string().into_bytes();
        // The page's state may be borrowed by the call that failed: then the trap alone has to do.
        PAGE.with(|page| {
            if let Ok(mut page) = page.try_borrow_mut() {
                page.output = message;
            }
        });
    }));
}

/// Where `bytes` bytes of JSON are to be written; valid until the next call.
#[unsafe(no_mangle)]
pub extern "C" fn input(bytes: usize) -> *mut u8 {
    PAGE.with_borrow_mut(|page| resized(&mut page.input, bytes))
}

/// Where `bytes` bytes of a frame, red, green, blue and alpha, are to be written; valid until the next call.
#[unsafe(no_mangle)]
pub extern "C" fn pixels(bytes: usize) -> *mut u8 {
    PAGE.with_borrow_mut(|page| resized(&mut page.pixels, bytes))
}

/// Where the answer of the last call is.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    PAGE.with_borrow(|page| page.output.as_ptr())
}

/// How many bytes it has.
#[unsafe(no_mangle)]
pub extern "C" fn output_bytes() -> usize {
    PAGE.with_borrow(|page| page.output.len())
}

/// Answers the JSON in the input buffer by JSON.
#[unsafe(no_mangle)]
pub extern "C" fn request() -> u32 {
    answer(|page| {
        let request: Request = serde_json::from_slice(&page.input).map_err(|error| error.to_string())?;
        request.answer(&mut page.session).map(|answer| answer.to_string().into_bytes())
    })
}

/// Starts the pass that the last request of a leg named, on the frame in the buffer.
#[unsafe(no_mangle)]
pub extern "C" fn begin_pass() -> u32 {
    answer(|page| page.session.begin_pass(&page.pixels).map(|()| Vec::new()))
}

/// Tracks into the frame in the buffer. The answer: left, top, width, height, confidence as 64-bit numbers.
#[unsafe(no_mangle)]
pub extern "C" fn see() -> u32 {
    answer(|page| page.session.see(&page.pixels).map(|seen| bytes(&seen)))
}

/// The track of the object with this id: six 64-bit numbers a frame: left, top, width, height, confidence, and what it is: 0 nothing
/// that is known, 1 drawn, 2 tracked, 3 absent.
#[unsafe(no_mangle)]
pub extern "C" fn track(object: u32) -> u32 {
    answer(|page| page.session.rows(object).map(|rows| bytes(&rows)))
}

/// The pixels, red, green, blue and alpha, of a frame of the demo clip.
#[unsafe(no_mangle)]
pub extern "C" fn demo_frame(index: usize) -> u32 {
    answer(|page| page.session.demo_frame(index))
}

fn bytes(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}
