//! A job of a tracker that is a command.

use std::{
    path::PathBuf,
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

use infopart::sequence::otb_images;

use super::{
    ExternalTracker,
    session::{Session, Trouble},
};
use crate::runner::{Job, JobFailure, Recording};

/// Runs a job to its end, or until `stop` is true.
///
/// # Errors
/// A failure says what is wrong and what to do.
pub(crate) fn record(
    job: &Job,
    tracker: &ExternalTracker,
    stop: &AtomicBool,
) -> Result<Recording, JobFailure> {
    let images = images_of(job).map_err(JobFailure::Failed)?;
    let called_off = || stop.load(Ordering::Relaxed);
    converse(job, tracker, &images, &called_off).map_err(|trouble| match trouble {
        Trouble::CalledOff => JobFailure::Stopped,
        Trouble::Broken(reason) => JobFailure::Failed(format!("`{}`: {reason}", tracker.command)),
    })
}

fn converse(
    job: &Job,
    tracker: &ExternalTracker,
    images: &[PathBuf],
    called_off: &dyn Fn() -> bool,
) -> Result<Recording, Trouble> {
    let mut session = Session::start(&tracker.command, &tracker.options, job.seed, called_off)?;
    session.introduction()?;
    let origin = job.folder.origin;
    let first_box = origin.to_frame(job.segment.first_box);
    let mut rows = vec![job.segment.first_box];
    let (mut round_trips, mut own) = (Vec::with_capacity(images.len()), Vec::with_capacity(images.len()));
    for (number, image) in images.iter().enumerate() {
        let since = Instant::now();
        let state = if number == 0 {
            session.initialize(image, first_box)
        } else {
            session.frame(image, &format!("at frame {}", job.first_frame() + number))
        }?;
        round_trips.push(since.elapsed().as_secs_f64());
        own.extend(state.own_seconds);
        // The first row is the box given, whatever the answer.
        if number > 0 {
            rows.push(origin.from_frame(state.box_in_frame));
        }
    }
    session.quit();
    let tells = own.len() == images.len();
    Ok(Recording {
        confidences: Vec::new(),
        origin,
        rows,
        seconds: if tells { own } else { round_trips.clone() },
        round_trips: Some(round_trips),
    })
}

/// The files of a job's frames, absolute.
fn images_of(job: &Job) -> Result<Vec<PathBuf>, String> {
    let folder = &job.folder.path;
    let rows = job.frames + job.segment.start;
    let images = otb_images(folder, rows).map_err(|error| error.to_string())?.covered;
    let wanted = images.iter().skip(job.first_frame() - 1).take(job.frames);
    let paths: Vec<PathBuf> =
        wanted.map(|path| std::path::absolute(path).unwrap_or_else(|_| path.clone())).collect();
    if paths.len() < job.frames {
        return Err(format!(
            "the folder has only {} of the {} frames that its ground truth has rows for; run `otb_eval check {}`",
            paths.len(),
            job.frames,
            folder.display()
        ));
    }
    Ok(paths)
}
