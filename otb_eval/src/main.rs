//! The `otb_eval` program.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
