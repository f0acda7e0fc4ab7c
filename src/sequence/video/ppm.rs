//! Reads the binary PPM images that ffmpeg writes one after another.

use std::io::{self, BufRead, Read};

use crate::frame::{Frame, PixelFormat};

/// No video is larger; a header that says so is garbage and must not make us allocate.
const LARGEST_SIDE: usize = 1 << 16;

/// The next image, or `None` where the stream ends between two.
pub(super) fn read_ppm(stream: &mut impl BufRead) -> io::Result<Option<Frame>> {
    if stream.fill_buf()?.is_empty() {
        return Ok(None);
    }
    if word(stream)? != "P6" {
        return Err(malformed("it does not begin with P6"));
    }
    let (width, height, maximum) = (number(stream)?, number(stream)?, number(stream)?);
    if width > LARGEST_SIDE || height > LARGEST_SIDE || maximum != 255 {
        return Err(malformed(&format!("its header says {width}x{height}, maximum {maximum}")));
    }
    let length = width * height * 3;
    let mut pixels = Vec::with_capacity(length);
    stream.take(length as u64).read_to_end(&mut pixels)?;
    if pixels.len() < length {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Frame::new(pixels, width, height, PixelFormat::Rgb)
        .map(Some)
        .map_err(|error| malformed(&error.to_string()))
}

fn number(stream: &mut impl BufRead) -> io::Result<usize> {
    let text = word(stream)?;
    text.parse().map_err(|_| malformed(&format!("`{text}` is not a number")))
}

/// The bytes up to the next single white space, which is consumed.
fn word(stream: &mut impl BufRead) -> io::Result<String> {
    let mut text = String::new();
    for byte in stream.take(16).bytes() {
        match byte? {
            b' ' | b'\n' => return Ok(text),
            byte => text.push(char::from(byte)),
        }
    }
    Err(io::ErrorKind::UnexpectedEof.into())
}

fn malformed(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, format!("ffmpeg sent an image that cannot be read: {what}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_follow_each_other_without_a_gap() {
        let mut stream = &b"P6\n2 1\n255\nabcdefP6\n1 1\n255\n\n\n\n"[..];
        let first = read_ppm(&mut stream).unwrap().unwrap();
        assert_eq!((first.width(), first.height(), first.view().row(0)), (2, 1, &b"abcdef"[..]));
        assert_eq!(read_ppm(&mut stream).unwrap().unwrap().view().row(0), b"\n\n\n");
        assert!(read_ppm(&mut stream).unwrap().is_none());
    }

    #[test]
    fn what_breaks_off_or_is_garbage_is_an_error() {
        for bytes in
            ["P6\n2 1\n255\nabcde", "P6\n2", "P5\n1 1\n255\nabc", "P6\n1 1\n65535\nabcabc", "P6\n0 1\n255\n"]
        {
            assert!(read_ppm(&mut bytes.as_bytes()).is_err(), "{bytes:?}");
        }
        assert!(read_ppm(&mut &b"P6\n99999999 99999999\n255\n"[..]).is_err());
    }
}
