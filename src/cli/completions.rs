//! `infopart completions`: what shells and `man` know of the program.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};

use anyhow::Result;
use clap::{Args, CommandFactory, ValueEnum};
use clap_complete::Shell;
use infopart::program::BadInput;

use super::Cli;

pub const EXAMPLES: &str = "\
Examples:
  infopart completions bash > ~/.local/share/bash-completion/completions/infopart
  infopart completions zsh > ~/.zfunc/_infopart
  infopart completions --out completions        a file for each shell
  infopart completions --man man                man pages: infopart.1, infopart-track.1 and so on

Exit codes: 0 success, 2 no such shell, or a file that cannot be written";

#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
pub struct CompletionsArgs {
    /// The shell whose completions go to standard output
    shell: Option<Shell>,
    /// Write the completions of every shell into a folder
    #[arg(long, value_name = "DIR", conflicts_with = "shell")]
    out: Option<PathBuf>,
    /// Write man pages into a folder
    #[arg(long, value_name = "DIR", conflicts_with = "shell")]
    man: Option<PathBuf>,
}

pub fn completions(args: &CompletionsArgs) -> Result<()> {
    let mut command = Cli::command();
    if let Some(shell) = args.shell {
        let mut text = Vec::new();
        clap_complete::generate(shell, &mut command, "infopart", &mut text);
        // A reader that has seen enough is no failure.
        let _ = io::stdout().write_all(&text);
    }
    if let Some(folder) = &args.out {
        make(folder)?;
        for shell in Shell::value_variants() {
            clap_complete::generate_to(*shell, &mut command, "infopart", folder)
                .map_err(|error| unwritten(folder, &error))?;
        }
    }
    if let Some(folder) = &args.man {
        make(folder)?;
        clap_mangen::generate_to(command, folder).map_err(|error| unwritten(folder, &error))?;
    }
    Ok(())
}

fn make(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).map_err(|error| unwritten(folder, &error).into())
}

fn unwritten(folder: &Path, error: &io::Error) -> BadInput {
    BadInput(format!("{}: cannot be written: {error}; choose another folder", folder.display()))
}
