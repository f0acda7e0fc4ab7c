//! `infopart config`: every parameter, documented.

use std::io::Write;

use anyhow::{Context, Result};
use clap::Args;
use infopart::{
    output::{Destination, StandardOutput},
    tracker::Parameters,
};

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
