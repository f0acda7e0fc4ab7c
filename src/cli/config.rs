//! `infopart config`: every parameter, documented.

use std::io::Write;

use anyhow::{Context, Result};
use clap::Args;
use infopart::{
    output::{Destination, StandardOutput},
    tracker::Parameters,
};

pub const EXAMPLES: &str = "\
Examples:
  infopart config > my.toml                 then edit it
  infopart track Crossing --config my.toml
  infopart config --preset paper            the values of the paper

Exit codes: 0 success, 2 no such preset or standard output cannot be written";

#[derive(Debug, Args)]
pub struct ConfigArgs {
    /// Whose values to print: `default`, or `paper`
    #[arg(long, value_name = "NAME", default_value = "default")]
    preset: String,
}

pub fn config(args: &ConfigArgs) -> Result<()> {
    let text = Parameters::preset(&args.preset).context("--preset")?.to_documented_toml();
    let mut output = StandardOutput::new();
    writeln!(output, "{}", text.trim_end()).map_err(|error| output.name_error(error))?;
    Ok(output.complete()?)
}
