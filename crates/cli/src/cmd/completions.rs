//! `switchback completions SHELL`

use crate::failure::{CommandResult, Outcome};
use clap_complete::Shell;
use switchback_io::output::print;

/// Print what completes verbs, options and their values in a shell.
///
/// Where it goes: `switchback completions bash > ~/.local/share/bash-completion/completions/switchback`,
/// `… zsh > DIR/_switchback` with DIR in $fpath, `… fish > ~/.config/fish/completions/switchback.fish`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// bash, elvish, fish, powershell or zsh
    #[arg(hide_possible_values = true)]
    shell: Shell,
}

/// Prints the script that completes a program.
///
/// # Errors
/// If stdout cannot be written.
pub(crate) fn run(args: &Args, mut program: clap::Command) -> CommandResult {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "switchback", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(Outcome::Done)
}
