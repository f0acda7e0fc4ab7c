//! The tracker's parameters: a preset, over it the keys of --config, over these the flags.

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};
use clap::Args;
use infopart::{
    geometry::Region,
    program::BadInput,
    tracker::{
        CheckedParameters, Parameters, SearchExtent,
        colour::{CheckedColourParameters, ColourParameters},
    },
};

use super::values::parse_count;

#[derive(Debug, Clone, Args)]
pub struct ParameterArgs {
    /// What to track of the box: `part` (the upper 5/8), `whole`, or the upper fraction, such as 0.5 or 5/8
    /// [default: part]
    #[arg(long, value_name = "part|whole|FRACTION")]
    region: Option<Region>,
    /// Where a target that was lost is looked for: `off` (nowhere else), `near` (in the window where it was lost), or `frame`
    /// (everywhere) [default: the preset's]
    #[arg(long, value_name = "off|near|frame")]
    search: Option<SearchExtent>,
    /// The parameters to start from: `default`, or `paper`
    #[arg(long, value_name = "NAME", default_value = "default")]
    pub preset: String,
    /// How many particles; time grows with them [default: the preset's]
    #[arg(long, value_name = "N", value_parser = parse_count)]
    particles: Option<usize>,
    /// The seed of all randomness: one seed gives the same boxes on any number of threads [default: 1]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Parameters to use instead of the preset's; `infopart config` prints all of them
    #[arg(long, value_name = "FILE.toml")]
    config: Option<PathBuf>,
}

impl ParameterArgs {
    /// With the seed of a variable of the environment, if it is set and --seed is not given.
    pub fn with_seed_of(&self, variable: &str) -> Result<Self> {
        let Some(value) = std::env::var_os(variable).filter(|_| self.seed.is_none()) else {
            return Ok(self.clone());
        };
        let seed = value.to_str().and_then(|text| text.parse().ok()).ok_or_else(|| {
            BadInput(format!(
                "{variable} is {}; set it to a whole number from 0 on, or unset it",
                value.display()
            ))
        })?;
        Ok(Self { seed: Some(seed), ..self.clone() })
    }

    /// Flags over the file over the preset, checked.
    pub fn resolve(&self) -> Result<CheckedParameters> {
        let preset = Parameters::preset(&self.preset).context("--preset")?;
        let mut parameters = self.over_from_file(preset)?;
        parameters.region = self.region.unwrap_or(parameters.region);
        parameters.particles = self.particles.unwrap_or(parameters.particles);
        parameters.seed = self.seed.unwrap_or(parameters.seed);
        parameters.search = self.search.unwrap_or(parameters.search);
        let from = match &self.config {
            Some(path) => format!("parameters of {} and the flags", path.display()),
            None => "parameters from the flags".to_owned(),
        };
        parameters.check().context(from)
    }

    /// The colour tracker's: flags over the file over its defaults, checked.
    pub fn resolve_colour(&self) -> Result<CheckedColourParameters> {
        let foreign = [
            ("--region", self.region.is_some()),
            ("--search", self.search.is_some()),
            ("--preset", self.preset != "default"),
        ];
        if let Some((flag, _)) = foreign.iter().find(|(_, given)| *given) {
            return Err(BadInput(format!("{flag} is InfoPart's; leave it out with --tracker colour")).into());
        }
        let mut parameters = match &self.config {
            Some(path) => ColourParameters::from_toml(&read(path)?)
                .with_context(|| format!("--config {} (for --tracker colour)", path.display()))?,
            None => ColourParameters::default(),
        };
        parameters.particles = self.particles.unwrap_or(parameters.particles);
        parameters.seed = self.seed.unwrap_or(parameters.seed);
        parameters.check().context("parameters of the colour tracker")
    }

    fn over_from_file(&self, base: Parameters) -> Result<Parameters> {
        let Some(path) = &self.config else { return Ok(base) };
        let text = read(path)?;
        Parameters::from_toml(&text, base).with_context(|| format!("--config {}", path.display()))
    }
}

fn read(path: &Path) -> Result<String> {
    let text = fs::read_to_string(path).map_err(|error| {
        BadInput(format!(
            "--config {}: {error}; give a TOML text file (`infopart config` prints one)",
            path.display()
        ))
    })?;
    Ok(text)
}
