//! Requests of the page, as JSON.

use std::time::Duration;

use infopart::annotate::{
    Colour, KeyEntry, Leg, Object, Pass, Passes, Project, VideoInfo, export::Format, import, keys_of,
};
use infopart::sequence::Walker;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::session::{Session, demo_options};

/// What the page may ask.
#[derive(Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case")]
pub enum Request {
    /// Forgets all and begins with this video.
    Video {
        name: String,
        fingerprint: String,
        width: usize,
        height: usize,
        /// What each frame is called; a folder's file names.
        labels: Vec<String>,
        /// Presentation times in seconds since the start; nothing for images.
        times: Vec<Option<f64>>,
    },
    /// The objects as they are now.
    Objects { objects: Vec<ObjectEntry> },
    /// The passes that are not known of the stretches between two frames.
    MissingLegs { object: u32, before: usize, after: usize },
    /// The pass that is to begin.
    Plan { leg: Leg },
    /// The pass under way is over.
    EndPass,
    /// A pass that was tracked another day.
    KnownPass { pass: Pass },
    /// Doubtful places.
    Places,
    /// Tracks in a format; a list of files.
    Export { format: String },
    /// The text of a project file.
    Project,
    /// Objects of a project file or of any other annotation, which become those of the session, with ids from 1.
    OpenFile { name: String, text: String },
    /// Size and length of the demo clip, and where the walker is.
    Demo,
}

/// An object as the page has it.
#[derive(Deserialize)]
pub struct ObjectEntry {
    id: u32,
    name: String,
    class: String,
    colour: Colour,
    keys: Vec<KeyEntry>,
}

impl ObjectEntry {
    fn read(self) -> Result<(u32, Object), String> {
        let Self { id, name, class, colour, keys } = self;
        let keys = keys_of(&keys).map_err(|reason| format!("object {name:?}: {reason}"))?;
        Ok((id, Object { name, class, colour, keys }))
    }
}

impl Request {
    /// Does what is asked.
    ///
    /// # Errors
    /// A sentence for the user.
    pub fn answer(self, session: &mut Session) -> Result<Value, String> {
        let words = |error: serde_json::Error| error.to_string();
        match self {
            Self::Video { name, fingerprint, width, height, labels, times } => {
                let time = |seconds: f64| Duration::try_from_secs_f64(seconds.max(0.0)).unwrap_or_default();
                let times = times.into_iter().map(|seconds| seconds.map(time)).collect();
                let about = VideoInfo {
                    name,
                    frames: labels.len(),
                    width,
                    height,
                    labels,
                    times,
                    first_frame_hash: 0,
                };
                *session = Session::of(about, fingerprint);
                Ok(Value::Null)
            }
            Self::Objects { objects } => {
                session.objects =
                    objects.into_iter().map(ObjectEntry::read).collect::<Result<Vec<_>, _>>()?;
                Ok(Value::Null)
            }
            Self::MissingLegs { object, before, after } => {
                serde_json::to_value(session.missing_legs(object, before, after)?).map_err(words)
            }
            Self::Plan { leg } => session.plan(leg).map(|()| Value::Null),
            Self::EndPass => serde_json::to_value(session.end_pass()?).map_err(words),
            Self::KnownPass { pass } => {
                session.passes.insert(pass);
                Ok(Value::Null)
            }
            Self::Places => {
                let told = |(object, place): (u32, infopart::annotate::Place)| {
                    json!({"object": object, "frame": place.frame, "first": place.first, "last": place.last,
                           "confidence": place.confidence})
                };
                Ok(session.places()?.into_iter().map(told).collect())
            }
            Self::Export { format } => export(session, &format),
            Self::Project => {
                let mut project = Project { tracked_by: session.tracked_by()?, ..Project::default() };
                for (_, object) in &session.objects {
                    project.passes.push(session.passes_of(object));
                    project.objects.push(object.clone());
                }
                project.to_text().map(Value::String).map_err(words)
            }
            Self::OpenFile { name, text } => open_file(session, &name, &text),
            Self::Demo => {
                let options = demo_options();
                let numbers = |rect: infopart::geometry::Rect| [rect.x, rect.y, rect.w, rect.h];
                let walker = Walker::new(demo_options());
                let truth: Vec<_> = walker.ground_truth().into_iter().map(|rect| rect.map(numbers)).collect();
                Ok(
                    json!({"width": options.width, "height": options.height, "frames": options.frames, "truth": truth}),
                )
            }
        }
    }
}

/// Files as pairs of name and text.
fn export(session: &Session, format: &str) -> Result<Value, String> {
    let known = Format::NAMES.iter().find(|(name, _)| *name == format);
    let (_, format) = *known.ok_or_else(|| format!("there is no format {format:?}"))?;
    let files = session.with_tracks(|tracks| match tracks.text(format) {
        Some(text) => vec![(String::new(), text)],
        None => tracks.yolo_files(),
    })?;
    serde_json::to_value(files).map_err(|error| error.to_string())
}

fn open_file(session: &mut Session, name: &str, text: &str) -> Result<Value, String> {
    let mut project = match is_project(text) {
        true => Project::parse(text, name).map_err(|error| error.to_string())?,
        false => {
            let imported = import::read(name, text, &session.about).map_err(|error| error.to_string())?;
            let (objects, passes) = imported.into_iter().unzip();
            Project { objects, passes, tracked_by: session.tracked_by()? }
        }
    };
    for object in &project.objects {
        object
            .check(session.about.frames, session.about.width, session.about.height)
            .map_err(|error| format!("{name}: {error}"))?;
    }
    project.forget_what_others_tracked(session.tracked_by()?);
    let objects: Vec<Value> =
        (1u32..).zip(&project.objects).map(|(id, object)| told_object(id, object)).collect();
    session.objects = (1..).zip(project.objects).collect();
    let passes: Vec<&Pass> = project.passes.iter().flat_map(Passes::iter).collect();
    for &pass in &passes {
        session.passes.replace(pass.clone());
    }
    Ok(json!({"objects": objects, "passes": passes}))
}

/// Also of a project that is cut short, so that it is told.
fn is_project(text: &str) -> bool {
    match serde_json::from_str::<Value>(text) {
        Ok(value) => value.get("objects").is_some() || value.get("version").is_some(),
        Err(_) => text.trim_start().starts_with("{\"version\""),
    }
}

fn told_object(id: u32, object: &Object) -> Value {
    let keys: Vec<Value> = object
        .keys
        .iter()
        .map(|(frame, mark)| match mark.in_frame() {
            Some(rect) => json!({"frame": frame + 1, "box": [rect.x, rect.y, rect.w, rect.h]}),
            None => json!({"frame": frame + 1, "absent": true}),
        })
        .collect();
    json!({"id": id, "name": object.name, "class": object.class, "colour": object.colour, "keys": keys})
}
