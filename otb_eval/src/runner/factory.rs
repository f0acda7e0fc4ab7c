//! Who makes trackers. The runner knows a tracker only by its factory, which makes one in this process or names a command.

use std::sync::atomic::AtomicBool;

use infopart::{
    geometry::Region,
    tracker::{
        InfoPart, ParameterError, Parameters, Tracker,
        colour::{ColourParameters, ColourTracker},
    },
};
use serde::Serialize;
use serde_json::Value;
use thiserror::Error;

use super::{Job, JobFailure, Recording};

/// Names that [`named_factory`] knows: InfoPart's default, the same on the whole body, the method as printed, and the
/// colour-histogram particle filter.
pub const NAMES: [&str; 4] = ["infopart", "whole-body", "paper", "colour"];

/// Makes trackers of one kind.
pub trait TrackerFactory: Send + Sync {
    /// The name in tables and result folders.
    fn name(&self) -> &str;

    /// Everything that decides the tracker's boxes but for the seed, as JSON with a fixed order of keys.
    fn parameters(&self) -> Value;

    /// The program that tracks, with its version.
    fn program(&self) -> String;

    /// Called once before a run, ahead of [`parameters`](Self::parameters) and [`program`](Self::program).
    ///
    /// # Errors
    /// [`FactoryError`] if no job of the tracker can be done.
    fn prepare(&mut self) -> Result<(), FactoryError> {
        Ok(())
    }

    /// Seeds that are worth running: 1 to this number; `None` if all are.
    fn most_seeds(&self) -> Option<u64> {
        None
    }

    /// A new tracker whose randomness comes from `seed` alone. It works in the rayon pool that it is called from.
    ///
    /// # Errors
    /// [`FactoryError`] if the tracker cannot be made.
    fn create(&self, seed: u64) -> Result<Made, FactoryError>;
}

/// A tracker that was made.
pub enum Made {
    /// One in this process, which is handed pixels.
    Here(Box<dyn Tracker>),
    /// One elsewhere, which does jobs by itself.
    Elsewhere(Box<dyn Recorder>),
}

/// What does jobs by itself, such as a command that is handed the paths of images.
pub trait Recorder {
    /// Does a job to its end, or until `stop` is true.
    ///
    /// # Errors
    /// A failure says what is wrong and what to do.
    fn record(&self, job: &Job, stop: &AtomicBool) -> Result<Recording, JobFailure>;
}

/// A tracker that cannot be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FactoryError {
    /// No tracker of that name.
    #[error("there is no tracker `{name}`; choose from: {}; or give one of your own with --config {name}=FILE.toml or --tracker {name}='COMMAND'", NAMES.join(", "))]
    Unknown {
        /// The name as given.
        name: String,
    },
    /// A program that cannot be spoken to.
    #[error("tracker {name}: `{command}`: {reason}; none of its jobs is run")]
    External {
        /// The tracker.
        name: String,
        /// The line that starts it.
        command: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Parameters out of their range.
    #[error("tracker {name}: {source}")]
    Parameters {
        /// The tracker.
        name: String,
        /// Which parameter, and what it may be.
        source: ParameterError,
    },
}

/// Parameters that a tracker of this program starts from.
pub trait TrackerParameters: Clone + Send + Sync + Serialize + 'static {
    /// Takes the seed of all randomness.
    fn set_seed(&mut self, seed: u64);

    /// Checks the parameters and makes a tracker of them.
    ///
    /// # Errors
    /// [`ParameterError`] for the first value that is out of its range.
    fn start(self) -> Result<Box<dyn Tracker>, ParameterError>;
}

impl TrackerParameters for Parameters {
    fn set_seed(&mut self, seed: u64) {
        self.seed = seed;
    }

    fn start(self) -> Result<Box<dyn Tracker>, ParameterError> {
        Ok(Box::new(InfoPart::new(self.check()?)))
    }
}

impl TrackerParameters for ColourParameters {
    fn set_seed(&mut self, seed: u64) {
        self.seed = seed;
    }

    fn start(self) -> Result<Box<dyn Tracker>, ParameterError> {
        Ok(Box::new(ColourTracker::new(self.check()?)))
    }
}

/// A tracker of this program with some parameters, under a name.
#[derive(Debug, Clone)]
pub struct OwnFactory<P> {
    name: String,
    parameters: P,
}

/// InfoPart with some parameters.
pub type InfoPartFactory = OwnFactory<Parameters>;

/// The colour-histogram particle filter with some parameters.
pub type ColourFactory = OwnFactory<ColourParameters>;

impl<P: TrackerParameters> OwnFactory<P> {
    /// The tracker with these parameters, of which the seed does not matter.
    ///
    /// # Errors
    /// [`FactoryError::Parameters`].
    pub fn new(name: impl Into<String>, parameters: P) -> Result<Self, FactoryError> {
        let factory = Self { name: name.into(), parameters };
        factory.create(1).map(|_| factory)
    }
}

impl<P: TrackerParameters> TrackerFactory for OwnFactory<P> {
    fn name(&self) -> &str {
        &self.name
    }

    fn parameters(&self) -> Value {
        let mut parameters = serde_json::to_value(&self.parameters).unwrap_or_default();
        if let Some(object) = parameters.as_object_mut() {
            object.remove("seed");
        }
        parameters
    }

    fn program(&self) -> String {
        format!("infopart {}", infopart::VERSION)
    }

    fn create(&self, seed: u64) -> Result<Made, FactoryError> {
        let mut parameters = self.parameters.clone();
        parameters.set_seed(seed);
        parameters
            .start()
            .map(Made::Here)
            .map_err(|source| FactoryError::Parameters { name: self.name.clone(), source })
    }
}

/// The factory of that name.
///
/// # Errors
/// [`FactoryError::Unknown`].
pub fn named_factory(name: &str) -> Result<Box<dyn TrackerFactory>, FactoryError> {
    let preset = |preset| {
        Parameters::preset(preset)
            .map_err(|source| FactoryError::Parameters { name: name.to_owned(), source })
    };
    let parameters = match name {
        "infopart" => Parameters::default(),
        "whole-body" => {
            let mut parameters = Parameters::default();
            parameters.region = Region::Whole;
            parameters
        }
        "paper" => preset("paper")?,
        "colour" => return Ok(Box::new(ColourFactory::new(name, ColourParameters::default())?)),
        _ => return Err(FactoryError::Unknown { name: name.to_owned() }),
    };
    Ok(Box::new(InfoPartFactory::new(name, parameters)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_known_and_others_are_refused_with_a_list() {
        for name in NAMES {
            assert_eq!(named_factory(name).unwrap().name(), name);
        }
        let message = named_factory("kcf").map(|_| ()).unwrap_err().to_string();
        assert!(
            message.contains("`kcf`") && message.contains("infopart, whole-body, paper, colour"),
            "{message}"
        );
    }

    #[test]
    fn parameters_are_told_without_the_seed() {
        let mut parameters = Parameters::default();
        parameters.seed = 7;
        let seven = InfoPartFactory::new("a", parameters).unwrap().parameters();
        assert_eq!(seven, named_factory("infopart").unwrap().parameters());
        assert!(seven.get("seed").is_none() && seven["particles"].is_number());
        assert_ne!(seven, named_factory("whole-body").unwrap().parameters());
        let colour = named_factory("colour").unwrap();
        assert!(colour.parameters().get("seed").is_none());
        assert!(matches!(colour.create(3).unwrap(), Made::Here(tracker) if tracker.name() == "colour"));
    }
}
