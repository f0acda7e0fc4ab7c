//! `infopart config`: every parameter, documented.

use std::io::Write;

use anyhow::{Context, Result};
use clap::Args;
use infopart::{
    output::{Destination, StandardOutput},
    program::BadInput,
    tracker::{Parameters, colour::ColourParameters},
};

use super::values::TrackerName;

pub const EXAMPLES: &str = "\
Examples:
  infopart config > my.toml                 then edit it
  infopart track Crossing --config my.toml
  infopart config --preset paper            the values of the paper
  infopart config --tracker colour          the colour tracker's keys

Exit codes: 0 success, 2 no such preset or standard output cannot be written";

#[derive(Debug, Args)]
pub struct ConfigArgs {
    /// Whose values to print: `default`, or `paper`
    #[arg(long, value_name = "NAME", default_value = "default")]
    preset: String,
    /// Whose parameters: InfoPart's, or those of the colour-histogram particle filter
    #[arg(long, value_name = "infopart|colour", default_value = "infopart")]
    tracker: TrackerName,
}

pub fn config(args: &ConfigArgs) -> Result<()> {
    let text = match args.tracker {
        TrackerName::Infopart => Parameters::preset(&args.preset).context("--preset")?.to_documented_toml(),
        TrackerName::Colour if args.preset == "default" => ColourParameters::default().to_toml(),
        TrackerName::Colour => {
            let message = "--preset: the colour tracker has one set of values; leave --preset out";
            return Err(BadInput(message.to_owned()).into());
        }
    };
    let mut output = StandardOutput::new();
    writeln!(output, "{}", text.trim_end()).map_err(|error| output.name_error(error))?;
    Ok(output.complete()?)
}
