//! One image file becomes one frame of 8-bit grey or RGB.

use std::{fs, io::Cursor, path::Path};

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, metadata::Orientation};

use super::SequenceError;
use crate::frame::{Frame, PixelFormat};

/// Decodes a JPEG, PNG, BMP, TIFF (its first page) or WebP file, whatever its name says. Grey stays grey, all else becomes RGB; 16-bit samples are
/// scaled to 8 bits, alpha is dropped, and the image is turned upright as its EXIF orientation says.
///
/// # Errors
/// [`SequenceError::Io`] if the file cannot be read, [`SequenceError::BadImage`] if it is no whole image.
pub fn decode_image(path: &Path) -> Result<Frame, SequenceError> {
    let bytes = fs::read(path).map_err(|source| SequenceError::Io { path: path.to_owned(), source })?;
    decode(&bytes).map_err(|reason| SequenceError::BadImage { path: path.to_owned(), reason })
}

/// Width and height in pixels of an image file, which must be whole. The pixels of a JPEG are not decoded, so that many
/// files can be looked through; other formats are decoded.
///
/// # Errors
/// [`SequenceError::Io`] or [`SequenceError::BadImage`], as decoding the file would give; damage inside the pixels of a
/// JPEG that is not cut short is not found.
pub fn probe_image(path: &Path) -> Result<(usize, usize), SequenceError> {
    let bytes = fs::read(path).map_err(|source| SequenceError::Io { path: path.to_owned(), source })?;
    probe(&bytes).map_err(|reason| SequenceError::BadImage { path: path.to_owned(), reason })
}

fn probe(bytes: &[u8]) -> Result<(usize, usize), String> {
    if format_of(bytes)? != ImageFormat::Jpeg {
        let frame = decode(bytes)?;
        return Ok((frame.width(), frame.height()));
    }
    if !jpeg_is_whole(bytes) {
        return Err("the file is truncated".to_owned());
    }
    let reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Jpeg);
    let mut decoder = reader.into_decoder().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions();
    let orientation = decoder.orientation().map_err(|error| error.to_string())?;
    let is_turned = matches!(
        orientation,
        Orientation::Rotate90
            | Orientation::Rotate270
            | Orientation::Rotate90FlipH
            | Orientation::Rotate270FlipH
    );
    let (width, height) = if is_turned { (height, width) } else { (width, height) };
    Ok((width as usize, height as usize))
}

/// [`decode_image`] for the bytes of a file.
pub(crate) fn decode(bytes: &[u8]) -> Result<Frame, String> {
    let format = format_of(bytes)?;
    if format == ImageFormat::Jpeg && !jpeg_is_whole(bytes) {
        return Err("the file is truncated".to_owned());
    }
    frame_of(upright(bytes, format).map_err(|error| error.to_string())?)
}

fn format_of(bytes: &[u8]) -> Result<ImageFormat, String> {
    match image::guess_format(bytes) {
        Ok(
            format @ (ImageFormat::Jpeg
            | ImageFormat::Png
            | ImageFormat::Bmp
            | ImageFormat::Tiff
            | ImageFormat::WebP),
        ) => Ok(format),
        _ if bytes.is_empty() => Err("the file is empty".to_owned()),
        _ => Err("the file is no JPEG, PNG, BMP, TIFF or WebP image".to_owned()),
    }
}

fn upright(bytes: &[u8], format: ImageFormat) -> image::ImageResult<DynamicImage> {
    let mut decoder = ImageReader::with_format(Cursor::new(bytes), format).into_decoder()?;
    let orientation = decoder.orientation()?;
    let mut image = DynamicImage::from_decoder(decoder)?;
    image.apply_orientation(orientation);
    Ok(image)
}

fn frame_of(image: DynamicImage) -> Result<Frame, String> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let frame = if image.color().has_color() {
        Frame::new(image.into_rgb8().into_raw(), width, height, PixelFormat::Rgb)
    } else {
        Frame::new(image.into_luma8().into_raw(), width, height, PixelFormat::Gray)
    };
    frame.map_err(|error| error.to_string())
}

const START_OF_SCAN: u8 = 0xDA;
const END_OF_IMAGE: u8 = 0xD9;

/// Whether an end-of-image marker follows the last scan. The decoder fills what is missing with grey and reports
/// nothing, so a file cut short must be found here.
fn jpeg_is_whole(bytes: &[u8]) -> bool {
    let mut at = 2;
    while let Some((marker, after)) = next_marker(bytes, at) {
        if marker == END_OF_IMAGE {
            return true;
        }
        let Some(&[high, low]) = bytes.get(after..after + 2) else {
            return false;
        };
        let length = usize::from(u16::from_be_bytes([high, low]));
        at = after + length;
        if marker == START_OF_SCAN {
            at = end_of_scan(bytes, at);
        }
    }
    false
}

/// The code of the next marker and the position behind it; fill bytes before it are passed over.
fn next_marker(bytes: &[u8], from: usize) -> Option<(u8, usize)> {
    let start = from + bytes.get(from..)?.iter().position(|&byte| byte == 0xFF)?;
    let code = start + bytes[start..].iter().position(|&byte| byte != 0xFF)?;
    Some((bytes[code], code + 1))
}

/// Where the first marker stands that is neither a stuffed 0xFF nor a restart marker.
fn end_of_scan(bytes: &[u8], from: usize) -> usize {
    let mut at = from;
    while let Some((code, after)) = next_marker(bytes, at) {
        if code != 0 && !(0xD0..=0xD7).contains(&code) {
            return after - 2;
        }
        at = after;
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use image::{
        GrayImage, ImageBuffer, ImageEncoder, Luma, LumaA, Rgb, RgbImage, Rgba, codecs::jpeg::JpegEncoder,
    };

    use super::*;

    fn png<P: image::PixelWithColorType>(image: &ImageBuffer<P, Vec<P::Subpixel>>) -> Vec<u8>
    where
        [P::Subpixel]: image::EncodableLayout,
    {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    fn jpeg(image: &RgbImage, exif: Option<Vec<u8>>) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = JpegEncoder::new_with_quality(&mut bytes, 95);
        if let Some(exif) = exif {
            encoder.set_exif_metadata(exif).unwrap();
        }
        encoder.encode_image(image).unwrap();
        bytes
    }

    fn gradient() -> RgbImage {
        RgbImage::from_fn(64, 48, |x, y| Rgb([(x * 4) as u8, (y * 5) as u8, 128]))
    }

    #[test]
    fn sixteen_bits_are_scaled_to_eight() {
        let grey: ImageBuffer<Luma<u16>, Vec<u16>> =
            ImageBuffer::from_raw(3, 1, vec![0, 0x8080, 0xFFFF]).unwrap();
        let frame = decode(&png(&grey)).unwrap();
        assert_eq!(frame.view().format(), PixelFormat::Gray);
        assert_eq!(frame.view().row(0), &[0, 0x80, 255]);
        let colour: ImageBuffer<Rgb<u16>, Vec<u16>> =
            ImageBuffer::from_raw(1, 1, vec![0xFFFF, 0x0101, 0x4040]).unwrap();
        let frame = decode(&png(&colour)).unwrap();
        assert_eq!((frame.view().format(), frame.view().row(0)), (PixelFormat::Rgb, &[255, 1, 0x40][..]));
    }

    #[test]
    fn probing_gives_the_size_of_the_decoded_frame_and_finds_cut_files() {
        let turned = exif_orientation(6);
        for bytes in [jpeg(&gradient(), None), jpeg(&gradient(), Some(turned)), png(&gradient())] {
            let frame = decode(&bytes).unwrap();
            assert_eq!(probe(&bytes), Ok((frame.width(), frame.height())));
            assert!(probe(&bytes[..bytes.len() / 2]).is_err());
        }
        assert_eq!(probe(b""), Err("the file is empty".to_owned()));
    }

    #[test]
    fn tiff_and_webp_are_images_too_and_cut_ones_are_not() {
        for format in [ImageFormat::Tiff, ImageFormat::WebP] {
            let mut bytes = Cursor::new(Vec::new());
            gradient().write_to(&mut bytes, format).unwrap();
            let bytes = bytes.into_inner();
            let frame = decode(&bytes).unwrap();
            assert_eq!((frame.width(), frame.height()), (64, 48), "{format:?}");
            let pixel = gradient().get_pixel(5, 7).0;
            assert_eq!(&frame.view().row(7)[15..18], &pixel[..], "{format:?} is without loss");
            assert_eq!(probe(&bytes), Ok((64, 48)));
            assert!(decode(&bytes[..bytes.len() / 2]).is_err(), "{format:?}");
        }
        let mut bytes = Cursor::new(Vec::new());
        let grey: ImageBuffer<Luma<u16>, Vec<u16>> = ImageBuffer::from_raw(2, 1, vec![0, 0xFFFF]).unwrap();
        grey.write_to(&mut bytes, ImageFormat::Tiff).unwrap();
        let frame = decode(&bytes.into_inner()).unwrap();
        assert_eq!((frame.view().format(), frame.view().row(0)), (PixelFormat::Gray, &[0, 255][..]));
    }

    #[test]
    fn alpha_is_dropped_and_not_blended() {
        let rgba = ImageBuffer::from_pixel(1, 1, Rgba([10u8, 20, 30, 0]));
        assert_eq!(decode(&png(&rgba)).unwrap().view().row(0), &[10, 20, 30]);
        let grey = ImageBuffer::from_pixel(1, 1, LumaA([77u8, 0]));
        let frame = decode(&png(&grey)).unwrap();
        assert_eq!((frame.view().format(), frame.view().row(0)), (PixelFormat::Gray, &[77][..]));
    }

    #[test]
    fn a_jpeg_cut_anywhere_is_an_error() {
        let whole = jpeg(&gradient(), None);
        assert!(decode(&whole).is_ok());
        let half = &whole[..whole.len() / 2];
        assert!(
            upright(half, ImageFormat::Jpeg).is_ok(),
            "the decoder has become strict: jpeg_is_whole can go"
        );
        for kept in [3, 20, whole.len() / 2, whole.len() - 2, whole.len() - 1] {
            assert!(decode(&whole[..kept]).is_err(), "{kept} of {} bytes", whole.len());
        }
    }

    #[test]
    fn the_end_marker_of_a_thumbnail_does_not_hide_a_missing_one() {
        let whole = jpeg(&gradient(), None);
        let thumbnail = [0xFF, 0xE1, 0, 6, 0xFF, END_OF_IMAGE, 0xFF, END_OF_IMAGE];
        let with_thumbnail = [&whole[..2], &thumbnail[..], &whole[2..]].concat();
        assert!(jpeg_is_whole(&with_thumbnail));
        assert!(!jpeg_is_whole(&with_thumbnail[..with_thumbnail.len() - 2]));
    }

    #[test]
    fn bytes_behind_a_whole_jpeg_do_no_harm() {
        let mut bytes = jpeg(&gradient(), None);
        bytes.extend_from_slice(b"trailing");
        assert!(decode(&bytes).is_ok());
    }

    #[test]
    fn a_png_cut_short_is_an_error() {
        let whole = png(&gradient());
        assert!(decode(&whole[..whole.len() / 2]).is_err());
    }

    /// EXIF with the one entry Orientation (0x0112), as short, big-endian.
    fn exif_orientation(value: u8) -> Vec<u8> {
        let mut exif = b"MM\0\x2a\0\0\0\x08".to_vec();
        exif.extend_from_slice(&[0, 1, 0x01, 0x12, 0, 3, 0, 0, 0, 1, 0, value, 0, 0, 0, 0, 0, 0]);
        exif
    }

    #[test]
    fn exif_orientation_turns_the_image_upright() {
        let left_dark = RgbImage::from_fn(32, 16, |x, _| if x < 16 { Rgb([0; 3]) } else { Rgb([255; 3]) });
        let turned = decode(&jpeg(&left_dark, Some(exif_orientation(6)))).unwrap();
        assert_eq!((turned.width(), turned.height()), (16, 32));
        assert!(turned.view().row(2)[24] < 30 && turned.view().row(29)[24] > 225, "a quarter turn clockwise");
        let upside_down = decode(&jpeg(&left_dark, Some(exif_orientation(3)))).unwrap();
        assert!(upside_down.view().row(8)[6] > 225, "half a turn");
    }

    #[test]
    fn a_grey_jpeg_stays_grey() {
        let mut bytes = Vec::new();
        JpegEncoder::new(&mut bytes).encode_image(&GrayImage::from_pixel(8, 8, Luma([99]))).unwrap();
        let frame = decode(&bytes).unwrap();
        assert_eq!((frame.view().format(), frame.view().row(3)), (PixelFormat::Gray, &[99; 8][..]));
    }

    #[test]
    fn what_is_no_image_says_so() {
        assert_eq!(
            decode(b"hello, I am text").unwrap_err(),
            "the file is no JPEG, PNG, BMP, TIFF or WebP image"
        );
        assert_eq!(decode(b"").unwrap_err(), "the file is empty");
    }
}
