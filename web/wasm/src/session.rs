//! What the page works on: a video, its objects, and what was tracked for them.

use infopart::{
    annotate::{
        Annotated, Direction, Leg, Mark, Object, OngoingPass, Pass, Passes, Place, Sides, Stretch, VideoInfo,
        doubtful_places, export::Tracks, known_track, stretches,
    },
    frame::{FrameView, PixelFormat},
    sequence::{Occluder, Walker, WalkerOptions},
    tracker::{CheckedParameters, InfoPart, Parameters},
};

/// A video, and what is annotated in it.
pub struct Session {
    /// The video.
    pub about: VideoInfo,
    /// What tells this video from others, as the page says it.
    pub fingerprint: String,
    /// Id and object, in the order of the page.
    pub objects: Vec<(u32, Object)>,
    /// What was tracked. A pass follows from its first box alone, so it does not matter for which object that was; those that no object
    /// needs any more are kept, since undo may bring one back.
    pub passes: Passes,
    planned: Option<Leg>,
    ongoing: Option<OngoingPass>,
    demo: Option<Walker>,
}

impl Default for Session {
    fn default() -> Self {
        let about = VideoInfo {
            name: String::new(),
            frames: 0,
            width: 0,
            height: 0,
            labels: Vec::new(),
            times: Vec::new(),
            first_frame_hash: 0,
        };
        Self {
            about,
            fingerprint: String::new(),
            objects: Vec::new(),
            passes: Passes::default(),
            planned: None,
            ongoing: None,
            demo: None,
        }
    }
}

/// The walker of the demo clip.
pub fn demo_options() -> WalkerOptions {
    WalkerOptions {
        width: 480,
        height: 320,
        frames: 180,
        occluder: Occluder::Tree,
        ..WalkerOptions::default()
    }
}

impl Session {
    /// A session that begins with this video.
    pub fn of(about: VideoInfo, fingerprint: String) -> Self {
        Self { about, fingerprint, ..Self::default() }
    }

    /// The object with this id.
    ///
    /// # Errors
    /// If there is none.
    pub fn object(&self, id: u32) -> Result<&Object, String> {
        let found = self.objects.iter().find(|(known, _)| *known == id);
        found.map(|(_, object)| object).ok_or_else(|| format!("there is no object {id}"))
    }

    /// The object's box in each frame, as far as it is known.
    ///
    /// # Errors
    /// If there is no such object.
    pub fn track(&self, id: u32) -> Result<Vec<Option<Annotated>>, String> {
        Ok(known_track(self.object(id)?, self.about.frames, Sides::Both, &self.passes))
    }

    /// Six numbers a frame, as the page draws them.
    pub fn rows(&self, id: u32) -> Result<Vec<f64>, String> {
        let object = self.object(id)?;
        let absent = |frame: usize| {
            let last = object.keys.range(..=frame).next_back();
            matches!(last, Some((_, Mark::Absent)))
        };
        let row = |(frame, found): (usize, &Option<Annotated>)| match found {
            Some(found) => {
                let rect = found.box_in_frame;
                [rect.x, rect.y, rect.w, rect.h, found.confidence, if found.is_key { 1.0 } else { 2.0 }]
            }
            None => [0.0, 0.0, 0.0, 0.0, 0.0, if absent(frame) { 3.0 } else { 0.0 }],
        };
        Ok(self.track(id)?.iter().enumerate().flat_map(row).collect())
    }

    /// The passes that are needed and not known of the stretches that have frames between `before` and `after`, in the order in which
    /// they are to be tracked.
    pub fn missing_legs(&self, id: u32, before: usize, after: usize) -> Result<Vec<Leg>, String> {
        let object = self.object(id)?;
        object
            .check(self.about.frames, self.about.width, self.about.height)
            .map_err(|error| error.to_string())?;
        let is_missing = |leg: &Leg| self.passes.known(leg).len() < leg.count;
        let ends = |leg: &Leg| match leg.direction {
            Direction::Forward => (leg.from, leg.from + leg.count),
            Direction::Backward => (leg.from - leg.count, leg.from),
        };
        let touches = |leg: &Leg| {
            let (first, last) = ends(leg);
            first < after && last > before
        };
        let legs = stretches(object, self.about.frames, Sides::Both);
        Ok(legs.iter().flat_map(Stretch::legs).filter(touches).filter(is_missing).collect())
    }

    /// Says which pass [`begin_pass`](Self::begin_pass) starts.
    pub fn plan(&mut self, leg: Leg) -> Result<(), String> {
        if leg.from >= self.about.frames {
            return Err(format!("there is no frame {}", leg.from + 1));
        }
        self.planned = Some(leg);
        Ok(())
    }

    fn view<'a>(&self, pixels: &'a [u8]) -> Result<FrameView<'a>, String> {
        let (width, height) = (self.about.width, self.about.height);
        FrameView::new(pixels, width, height, 4 * width, PixelFormat::Rgba).map_err(|error| error.to_string())
    }

    /// Starts the planned pass on its key frame.
    pub fn begin_pass(&mut self, pixels: &[u8]) -> Result<(), String> {
        let leg = self.planned.take().ok_or("no pass was planned")?;
        let tracker = Box::new(InfoPart::new(parameters()?));
        let pass =
            OngoingPass::begin(&leg, self.view(pixels)?, tracker).map_err(|error| error.to_string())?;
        self.ongoing = Some(pass);
        Ok(())
    }

    /// Tracks into the next frame of the pass.
    pub fn see(&mut self, pixels: &[u8]) -> Result<[f64; 5], String> {
        let view = self.view(pixels)?;
        let pass = self.ongoing.as_mut().ok_or("no pass is under way")?;
        pass.see(view).map(Into::into).map_err(|error| error.to_string())
    }

    /// Remembers the pass under way, as far as it came, and hands it to the page, which saves it.
    pub fn end_pass(&mut self) -> Result<Pass, String> {
        let pass = self.ongoing.take().ok_or("no pass is under way")?.into_pass();
        if !pass.sightings.is_empty() {
            self.passes.insert(pass.clone());
        }
        Ok(pass)
    }

    /// Doubtful places of every object, with its id; the most doubtful first.
    pub fn places(&self) -> Result<Vec<(u32, Place)>, String> {
        let mut places = Vec::new();
        for (id, _) in &self.objects {
            places.extend(doubtful_places(&self.track(*id)?).into_iter().map(|place| (*id, place)));
        }
        places.sort_by(|(_, a), (_, b)| a.confidence.total_cmp(&b.confidence).then(a.frame.cmp(&b.frame)));
        Ok(places)
    }

    /// The passes that an object's track is made of, as far as they are known.
    pub fn passes_of(&self, object: &Object) -> Passes {
        let mut passes = Passes::default();
        for leg in stretches(object, self.about.frames, Sides::Both).iter().flat_map(Stretch::legs) {
            let sightings = self.passes.known(&leg).to_vec();
            if !sightings.is_empty() {
                let Leg { from, start, direction, .. } = leg;
                passes.insert(Pass { from, start, direction, sightings });
            }
        }
        passes
    }

    /// Runs something on all tracks.
    pub fn with_tracks<T>(&self, use_them: impl FnOnce(Tracks<'_>) -> T) -> Result<T, String> {
        let objects: Vec<Object> = self.objects.iter().map(|(_, object)| object.clone()).collect();
        let tracks = self.objects.iter().map(|(id, _)| self.track(*id)).collect::<Result<Vec<_>, _>>()?;
        Ok(use_them(Tracks { about: &self.about, objects: &objects, tracks: &tracks }))
    }

    /// What passes follow from beside the key frames, for project files.
    pub fn tracked_by(&self) -> Result<String, String> {
        let VideoInfo { frames, width, height, .. } = self.about;
        let parameters = serde_json::to_string(&*parameters()?).map_err(|error| error.to_string())?;
        let (version, video) = (infopart::VERSION, &self.fingerprint);
        Ok(format!(
            "infopart {version} in a browser; {frames} frames of {width}x{height}, {video}; {parameters}"
        ))
    }

    /// A frame of the demo clip.
    pub fn demo_frame(&mut self, index: usize) -> Result<Vec<u8>, String> {
        let walker = self.demo.get_or_insert_with(|| Walker::new(demo_options()));
        let frame = walker.frame(index).ok_or("the demo clip has no such frame")?;
        let view = frame.view();
        let rgb = (0..view.height()).flat_map(|y| view.row(y).chunks_exact(3));
        Ok(rgb.flat_map(|pixel| [pixel[0], pixel[1], pixel[2], 255]).collect())
    }
}

fn parameters() -> Result<CheckedParameters, String> {
    Parameters::default().check().map_err(|error| error.to_string())
}
