//! Images as addresses: of a file, with the bytes of a JPEG or PNG file, or with the pixels themselves.

use std::path::Path;

use base64::{Engine, engine::general_purpose::STANDARD};

use crate::{
    frame::{Frame, PixelFormat},
    sequence::{decode_bytes, decode_image},
};

use super::error::{TraxError, shortened};

/// The image of an address.
///
/// # Errors
/// [`TraxError::BadImage`], or [`TraxError::File`] for a file that cannot be read.
pub(super) fn read(address: &str) -> Result<Frame, TraxError> {
    let bad = |reason: String| TraxError::BadImage { image: shortened(address), reason };
    if let Some(path) = address.strip_prefix("file://") {
        return Ok(decode_image(Path::new(path))?);
    }
    if let Some(data) = address.strip_prefix("data:") {
        let coded = data.split_once(";base64").map(|(_, coded)| coded.trim_start_matches([';', ',']));
        let coded = coded.ok_or_else(|| bad("has no ;base64".to_owned()))?;
        let bytes = STANDARD.decode(coded).map_err(|error| bad(format!("is not base64: {error}")))?;
        return decode_bytes(&bytes).map_err(|error| bad(format!("cannot be decoded: {error}")));
    }
    if let Some(memory) = address.strip_prefix("image:") {
        return of_pixels(memory).map_err(bad);
    }
    if address.contains("://") {
        return Err(bad("is of a kind that is not read".to_owned()));
    }
    Ok(decode_image(Path::new(address))?)
}

/// `WIDTH;HEIGHT;FORMAT;BASE64`.
fn of_pixels(memory: &str) -> Result<Frame, String> {
    let parts: Vec<&str> = memory.splitn(4, ';').collect();
    let [width, height, format, coded] = parts[..] else {
        return Err("has not width, height, format and pixels".to_owned());
    };
    let side = |word: &str| word.parse::<usize>().map_err(|_| format!("has `{word}` for a side"));
    let (width, height) = (side(width)?, side(height)?);
    let bytes = STANDARD.decode(coded).map_err(|error| format!("is not base64: {error}"))?;
    let (bytes, format) = match format {
        "rgb" => (bytes, PixelFormat::Rgb),
        "gray8" => (bytes, PixelFormat::Gray),
        // Native byte order, as the reference client sends it; the high byte is what is kept.
        "gray16" => {
            let high = |pair: &[u8]| (u16::from_ne_bytes([pair[0], pair[1]]) >> 8) as u8;
            (bytes.chunks_exact(2).map(high).collect(), PixelFormat::Gray)
        }
        _ => return Err(format!("is of the format `{format}`, which is not known")),
    };
    let needed = width.saturating_mul(height).saturating_mul(format.bytes_per_pixel());
    if bytes.len() != needed {
        return Err(format!("has {} bytes of pixels instead of {needed}", bytes.len()));
    }
    Frame::new(bytes, width, height, format).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_and_files_in_the_address_are_the_image() {
        let pixels = [10, 20, 30, 40, 50, 60];
        let frame = read(&format!("image:2;1;rgb;{}", STANDARD.encode(pixels))).unwrap();
        assert_eq!((frame.width(), frame.height(), frame.view().row(0)), (2, 1, &pixels[..]));
        let deep: Vec<u8> = [0x1234_u16, 0xff00].iter().flat_map(|value| value.to_ne_bytes()).collect();
        let frame = read(&format!("image:1;2;gray16;{}", STANDARD.encode(deep))).unwrap();
        assert_eq!((frame.view().row(0), frame.view().row(1)), (&[0x12][..], &[0xff][..]));

        let mut png = std::io::Cursor::new(Vec::new());
        let picture = image::RgbImage::from_raw(2, 1, pixels.to_vec()).unwrap();
        picture.write_to(&mut png, image::ImageFormat::Png).unwrap();
        let coded = STANDARD.encode(png.into_inner());
        for separator in [";", ","] {
            let frame = read(&format!("data:image/png;base64{separator}{coded}")).unwrap();
            assert_eq!(frame.view().row(0), pixels);
        }
    }

    #[test]
    fn what_is_no_image_is_refused_by_its_reason() {
        for (address, reason) in [
            ("image:2;1;rgb;AAAA", "3 bytes of pixels instead of 6"),
            ("image:2;x;rgb;AAAA", "`x` for a side"),
            ("image:2;1;yuv;AAAA", "`yuv`"),
            ("image:2;1", "width, height, format"),
            ("image:99999999999;99999999999;rgb;AAAA", "instead of"),
            ("image:0;0;rgb;", "0x0"),
            ("data:image/png;base64;!!", "not base64"),
            ("data:image/png;base64;AAAA", "cannot be decoded"),
            ("data:image/png,AAAA", "no ;base64"),
            ("http://host/a.png", "not read"),
            ("file:///no/such/file.png", "/no/such/file.png"),
        ] {
            let message = read(address).unwrap_err().to_string();
            assert!(message.contains(reason), "{address}: {message}");
        }
    }
}
