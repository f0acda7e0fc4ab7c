//! A synthetic sequence: a person walks down a street, and the true boxes are known exactly.
//!
//! It needs no download and is no easy one: the legs swing and show the street between them, the camera pans and
//! shakes, the light sinks to two thirds and comes back, the person grows by a third, posts and bystanders wear the
//! person's colours, and a tree may hide everything for some frames.

use std::{
    fs,
    path::{Path, PathBuf},
};

use image::{ExtendedColorType, ImageEncoder, codecs::jpeg::JpegEncoder};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{FrameSource, SequenceError, SourceFrame};
use crate::{
    frame::{Frame, PixelFormat},
    geometry::{Origin, Rect},
};

mod canvas;
mod figure;
mod motion;
mod scene;

use canvas::Canvas;
use figure::{Clothes, Pose, STRANGER, WALKER};
use motion::{Moment, camera_reach, moments, unit};

/// The least width and height that is rendered, pixels.
const SMALLEST_SIDE: usize = 64;

/// Standard deviation of the noise of a pixel's sample, in 255ths.
const NOISE: f32 = 3.0;

const JPEG_QUALITY: u8 = 92;

/// What comes between the camera and the walker, a little after the middle of the walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Occluder {
    /// Nothing.
    #[default]
    None,
    /// A young tree, less than half as wide as the person.
    YoungTree,
    /// A tree that hides the whole person for about seven frames.
    Tree,
    /// A wall that hides the whole person for about sixty frames.
    Wall,
}

/// Whether the person goes out of sight for a while.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Absence {
    /// Never.
    #[default]
    Never,
    /// After 60 frames the person hurries out at the right side, is away for 40 to 100 frames, and comes in again at the left, nearer
    /// to the camera or farther away.
    Leaves,
    /// After 60 frames the picture shows another street for 30 to 60 frames.
    Cut,
}

/// Somebody who overtakes the person.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Companion {
    /// Nobody.
    #[default]
    Nobody,
    /// Somebody in other clothes.
    Unlike,
    /// Somebody in the same clothes.
    Alike,
}

/// What the synthetic walker looks like.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WalkerOptions {
    /// Width of a frame in pixels, at least 64 (less is taken as 64). Default 320.
    pub width: usize,
    /// Height of a frame in pixels, at least 64 (less is taken as 64). Default 240.
    pub height: usize,
    /// Number of frames. The walk takes 150, or all if there are more. Default 150.
    pub frames: usize,
    /// Everything random comes from it; the same seed gives the same pixels. Default 1.
    pub seed: u64,
    /// What passes in front of the person. Default: nothing.
    pub occluder: Occluder,
    /// Whether the person goes out of sight. Default: never.
    pub absence: Absence,
    /// Who overtakes the person. Default: nobody.
    pub companion: Companion,
}

impl Default for WalkerOptions {
    fn default() -> Self {
        Self {
            width: 320,
            height: 240,
            frames: 150,
            seed: 1,
            occluder: Occluder::None,
            absence: Absence::Never,
            companion: Companion::Nobody,
        }
    }
}

/// Renders the walking person frame by frame, and knows where the person is.
#[derive(Debug, Clone)]
pub struct Walker {
    options: WalkerOptions,
    street: Canvas,
    /// What the picture shows meanwhile, if it is cut.
    elsewhere: Option<Canvas>,
    moments: Vec<Moment>,
    next: usize,
}

impl Walker {
    /// Builds the street; frames are rendered when they are asked for.
    pub fn new(options: WalkerOptions) -> Self {
        let (width, height) = (options.width.max(SMALLEST_SIDE), options.height.max(SMALLEST_SIDE));
        let options = WalkerOptions { width, height, ..options };
        let (right, shake) = camera_reach(&options);
        let (wide, high) = (width + right.ceil() as usize + 2, height + shake.ceil() as usize + 2);
        let mut rng = ChaCha8Rng::seed_from_u64(options.seed);
        let mut street = || scene::street(wide, high, unit(&options) as f32, &mut rng);
        let here = street();
        let elsewhere = (options.absence == Absence::Cut).then(&mut street);
        Self { moments: moments(&options), street: here, elsewhere, options, next: 0 }
    }

    /// The person's box in each frame, in frame coordinates: as high as the person standing upright, and as wide as a
    /// usual step, which the feet of a wide one leave a little. Given behind trees and walls too; `None` where the person is away.
    pub fn ground_truth(&self) -> Vec<Option<Rect>> {
        self.moments.iter().map(|moment| (!moment.is_away).then(|| moment.box_in_frame())).collect()
    }

    /// The frame at `index`, `None` if there is no such frame. Frames can be had in any order.
    pub fn frame(&self, index: usize) -> Option<Frame> {
        let (width, height) = (self.options.width, self.options.height);
        (index < self.moments.len())
            .then(|| self.rgb(index))
            .and_then(|pixels| Frame::new(pixels, width, height, PixelFormat::Rgb).ok())
    }

    /// Whether a wall or a tree hides the person's whole box in the frame at `index`.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn is_hidden(&self, index: usize) -> bool {
        let moment = &self.moments[index];
        let target = moment.box_in_frame();
        moment.occluder.is_some_and(|(left, right)| left <= target.x && target.right() <= right)
    }

    /// The file name of the frame with this number, counted from 1, in `img/`.
    pub fn image_name(number: usize) -> String {
        format!("{number:04}.jpg")
    }

    /// Writes all frames as `img/0001.jpg`, ... and the boxes, counted from 1, as `groundtruth_rect.txt` into `folder`,
    /// which is made if need be. Frames that a longer run left there are removed: pictures that go on with the
    /// numbers, whoever made them.
    ///
    /// # Errors
    /// [`SequenceError::Write`], naming the file or folder that cannot be written.
    pub fn write_otb_folder(&self, folder: &Path) -> Result<(), SequenceError> {
        let images = folder.join("img");
        fs::create_dir_all(&images)
            .map_err(|source| SequenceError::Write { path: images.clone(), source })?;
        for index in 0..self.moments.len() {
            write_file(&image_path(&images, index), &self.jpeg(index)?)?;
        }
        remove_later_frames(&images, self.moments.len())?;
        write_file(&folder.join("groundtruth_rect.txt"), self.rows().as_bytes())
    }

    fn rows(&self) -> String {
        let row = |found: Option<Rect>| match found.map(|target| Origin::One.from_frame(target)) {
            Some(Rect { x, y, w, h }) => format!("{x},{y},{w},{h}\n"),
            None => "NaN,NaN,NaN,NaN\n".to_owned(),
        };
        self.ground_truth().into_iter().map(row).collect()
    }

    fn jpeg(&self, index: usize) -> Result<Vec<u8>, SequenceError> {
        let mut bytes = Vec::new();
        let (width, height) = (self.options.width as u32, self.options.height as u32);
        JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY)
            .write_image(&self.rgb(index), width, height, ExtendedColorType::Rgb8)
            .map_err(|error| SequenceError::Write {
                path: label(index).into(),
                source: std::io::Error::other(error),
            })?;
        Ok(bytes)
    }

    /// The pixels of the frame at `index`, row by row.
    fn rgb(&self, index: usize) -> Vec<u8> {
        let moment = &self.moments[index];
        let camera = (moment.camera.0 as f32, moment.camera.1 as f32);
        let elsewhere = self.elsewhere.as_ref().filter(|_| moment.is_away);
        let street = elsewhere.unwrap_or(&self.street);
        let mut canvas = street.window(camera, self.options.width, self.options.height);
        let mut draw = |foot: (f64, f64), clothes: &Clothes| {
            let foot = (foot.0 as f32, foot.1 as f32);
            let pose = Pose { foot, height: moment.height as f32, phase: moment.phase as f32, swing: 1.0 };
            figure::draw(&mut canvas, &pose, clothes);
        };
        if elsewhere.is_none() {
            match self.options.companion {
                Companion::Nobody => {}
                Companion::Unlike => draw(moment.companion, &STRANGER),
                Companion::Alike => draw(moment.companion, &WALKER),
            }
        }
        if !moment.is_away {
            draw(moment.foot, &WALKER);
        }
        if let Some((left, right)) = moment.occluder {
            let unit = unit(&self.options) as f32;
            scene::trunk(&mut canvas, (left as f32, right as f32), unit, self.options.seed);
        }
        self.exposed(&canvas, moment.gain as f32, index)
    }

    /// What the camera makes of the light: its gain, and noise that is each frame's own.
    fn exposed(&self, canvas: &Canvas, gain: f32, index: usize) -> Vec<u8> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.options.seed);
        rng.set_stream(1 + index as u64);
        let mut random = vec![0; canvas.pixels.len() * 6];
        rng.fill_bytes(&mut random);
        let samples = canvas.pixels.iter().flatten().zip(random.chunks_exact(2));
        // The sum of two random bytes has mean 255 and standard deviation 104.5.
        let noisy = |(&value, pair): (&f32, &[u8])| {
            let noise = (f32::from(pair[0]) + f32::from(pair[1]) - 255.0) * (NOISE / 104.5);
            (gain * value + noise + 0.5).clamp(0.0, 255.0) as u8
        };
        samples.map(noisy).collect()
    }
}

impl FrameSource for Walker {
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, SequenceError> {
        if self.next >= self.moments.len() {
            return Ok(None);
        }
        let index = self.next;
        let (width, height) = (self.options.width, self.options.height);
        let frame = Frame::new(self.rgb(index), width, height, PixelFormat::Rgb).map_err(|error| {
            SequenceError::BadImage { path: label(index).into(), reason: error.to_string() }
        })?;
        self.next += 1;
        Ok(Some(SourceFrame { frame, number: index + 1, label: label(index), time: None }))
    }

    fn remaining(&self) -> Option<usize> {
        Some(self.moments.len() - self.next)
    }
}

fn label(index: usize) -> String {
    Walker::image_name(index + 1)
}

fn image_path(images: &Path, index: usize) -> PathBuf {
    images.join(label(index))
}

fn write_file(path: &Path, bytes: &[u8]) -> Result<(), SequenceError> {
    fs::write(path, bytes).map_err(|source| SequenceError::Write { path: path.to_owned(), source })
}

fn remove_later_frames(images: &Path, frames: usize) -> Result<(), SequenceError> {
    let later = (frames..).map(|index| image_path(images, index)).take_while(|path| path.exists());
    for path in later {
        fs::remove_file(&path).map_err(|source| SequenceError::Write { path, source })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
