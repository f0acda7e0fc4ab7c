//! A job of a tracker that is a command.

use std::{
    path::PathBuf,
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

use super::{
    ExternalTracker,
    session::{Session, Trouble},
};
use crate::{
    dataset::FrameFiles,
    runner::{Conversation, Job, JobFailure, Recorder, Recording},
    words::{of_sequence, without_flags},
};

impl Recorder for ExternalTracker {
    fn record(&self, job: &Job, stop: &AtomicBool) -> Result<Recording, JobFailure> {
        let images = images_of(job).map_err(JobFailure::Failed)?;
        let called_off = || stop.load(Ordering::Relaxed);
        converse(job, self, &images, &called_off).map_err(|trouble| match trouble {
            Trouble::CalledOff => JobFailure::Stopped,
            Trouble::Broken(reason) => JobFailure::Failed(format!("`{}`: {reason}", self.command)),
        })
    }
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
    let (mut confidences, mut lost_frames) = (Vec::with_capacity(images.len()), 0);
    for (number, image) in images.iter().enumerate() {
        let since = Instant::now();
        let state = if number == 0 {
            session.initialize(image, first_box)
        } else {
            session.frame(image, &format!("at frame {}", job.first_frame() + number))
        }?;
        round_trips.push(since.elapsed().as_secs_f64());
        own.extend(state.own_seconds);
        lost_frames += usize::from(state.is_lost);
        // The first box is given; many trackers do not say how sure they are of it.
        confidences.extend(state.confidence.or((number == 0).then_some(1.0)));
        // The first row is the box given, whatever the answer.
        if number > 0 {
            rows.push(origin.from_frame(state.box_in_frame));
        }
    }
    session.quit();
    let tells = own.len() == images.len();
    if confidences.len() < images.len() || images.len() == 1 {
        confidences.clear();
    }
    Ok(Recording {
        confidences,
        origin,
        rows,
        seconds: if tells { own } else { round_trips.clone() },
        external: Some(Conversation { round_trips, lost_frames }),
    })
}

/// The files of a job's frames, absolute.
fn images_of(job: &Job) -> Result<Vec<PathBuf>, String> {
    // Counted from the file's first row, those among them that the benchmark leaves out.
    let rows = job.first_frame() - 1 + job.frames;
    let files = job.folder.files(rows).map_err(|error| without_flags(&of_sequence(&error)))?;
    let images = match files {
        FrameFiles::Images { covered, .. } => covered,
        FrameFiles::Video(video) => {
            return Err(format!(
                "its frames are in a video, and a tracker in another process is given files of images; write them beside \
                 its ground truth: ffmpeg -i '{}' '{}/%05d.png'",
                video.display(),
                job.folder.path.display()
            ));
        }
    };
    let wanted = images.iter().skip(job.first_frame() - 1).take(job.frames);
    let paths: Vec<PathBuf> =
        wanted.map(|path| std::path::absolute(path).unwrap_or_else(|_| path.clone())).collect();
    if paths.len() < job.frames {
        return Err(format!(
            "the folder has only {} of the {} frames that its ground truth has rows for; run `otb_eval check {}`",
            paths.len(),
            job.frames,
            job.folder.path.display()
        ));
    }
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runner::job::tests::job;

    #[test]
    fn frames_in_a_video_are_refused_with_the_way_to_images() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("gt.txt"), "2,3,6,8\n2,3,6,8\n").unwrap();
        std::fs::write(folder.path().join("david.mpg"), "").unwrap();
        let mut job = job(None);
        (job.folder.path, job.folder.target) = (folder.path().to_owned(), None);
        let message = images_of(&job).unwrap_err();
        assert!(message.contains("in a video") && message.contains("david.mpg' '"), "{message}");
    }
}
