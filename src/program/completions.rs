//! `PROGRAM completions`: what shells and `man` know of a program.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};

use clap::{Args, Command, ValueEnum};
use clap_complete::Shell;

use super::BadInput;

/// The flags of the subcommand `completions`.
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

/// Does what the flags ask, for the program whose command line this is.
///
/// # Errors
/// [`BadInput`] for a folder that cannot be written to.
pub fn completions(mut command: Command, args: &CompletionsArgs) -> Result<(), BadInput> {
    let name = command.get_name().to_owned();
    if let Some(shell) = args.shell {
        let mut text = Vec::new();
        clap_complete::generate(shell, &mut command, &name, &mut text);
        // A reader that has seen enough is no failure.
        let _ = io::stdout().write_all(&text);
    }
    if let Some(folder) = &args.out {
        make(folder)?;
        for shell in Shell::value_variants() {
            clap_complete::generate_to(*shell, &mut command, &name, folder)
                .map_err(|error| unwritten(folder, &error))?;
        }
    }
    if let Some(folder) = &args.man {
        make(folder)?;
        clap_mangen::generate_to(command, folder).map_err(|error| unwritten(folder, &error))?;
    }
    Ok(())
}

/// What the help of the subcommand shows.
pub fn completions_examples(program: &str) -> String {
    format!(
        "\
Examples:
  {program} completions bash > ~/.local/share/bash-completion/completions/{program}
  {program} completions zsh > ~/.zfunc/_{program}
  {program} completions --out completions        a file for each shell
  {program} completions --man man                man pages: {program}.1 and one for each command

Exit codes: 0 success, 2 no such shell, or a file that cannot be written"
    )
}

fn make(folder: &Path) -> Result<(), BadInput> {
    fs::create_dir_all(folder).map_err(|error| unwritten(folder, &error))
}

fn unwritten(folder: &Path, error: &io::Error) -> BadInput {
    BadInput(format!("{}: cannot be written: {error}; choose another folder", folder.display()))
}
