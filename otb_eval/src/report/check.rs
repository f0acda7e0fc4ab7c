//! Whether a report's lists fit one another.

use super::{Report, ReportError};

impl Report {
    pub(super) fn check(&self) -> Result<(), ReportError> {
        self.check_scores()?;
        self.check_trackers()?;
        self.check_pictures()
    }

    /// One value for each tracker or metric.
    fn check_scores(&self) -> Result<(), ReportError> {
        let of_trackers =
            |place: String, given: usize| same_length(place, given, self.trackers.len(), "trackers");
        for table in &self.overall {
            for row in &table.rows {
                let place = format!("a row of table `{}`", table.title);
                same_length(place, row.scores.len(), table.metrics.len(), "metrics")?;
            }
        }
        for table in &self.sequences {
            for row in &table.rows {
                of_trackers(format!("`{}` in table `{}`", row.sequence, table.metric), row.scores.len())?;
            }
        }
        for chart in &self.attributes {
            for row in &chart.attributes {
                of_trackers(format!("`{}` in chart `{}`", row.attribute, chart.title), row.scores.len())?;
            }
        }
        for timeline in &self.timelines {
            let place = || format!("the timeline of `{}`", timeline.sequence);
            of_trackers(place(), timeline.overlaps.len())?;
            of_trackers(place(), timeline.errors.len())?;
        }
        for strip in &self.strips {
            for frame in &strip.frames {
                of_trackers(format!("frame {} of `{}`", frame.number, strip.sequence), frame.boxes.len())?;
            }
        }
        Ok(())
    }

    /// No tracker that is not in the list.
    fn check_trackers(&self) -> Result<(), ReportError> {
        let known = |place: &str, tracker: usize| {
            if tracker < self.trackers.len() {
                return Ok(());
            }
            Err(ReportError::Tracker { place: place.into(), tracker, trackers: self.trackers.len() })
        };
        for table in &self.overall {
            table.rows.iter().try_for_each(|row| known(&format!("table `{}`", table.title), row.tracker))?;
        }
        for plot in self.plots.iter().flat_map(|group| &group.plots) {
            plot.curves.iter().try_for_each(|curve| known(&format!("plot `{}`", plot.title), curve.style))?;
        }
        Ok(())
    }

    fn check_pictures(&self) -> Result<(), ReportError> {
        for strip in &self.strips {
            for frame in &strip.frames {
                let is_jpeg = frame.jpeg.starts_with(&[0xff, 0xd8, 0xff]);
                if !is_jpeg || frame.width == 0 || frame.height == 0 {
                    return Err(ReportError::Picture {
                        sequence: strip.sequence.clone(),
                        number: frame.number,
                    });
                }
            }
        }
        Ok(())
    }
}

fn same_length(place: String, given: usize, expected: usize, what: &'static str) -> Result<(), ReportError> {
    if given == expected { Ok(()) } else { Err(ReportError::Length { place, given, expected, what }) }
}
