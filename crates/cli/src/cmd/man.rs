//! `switchback man [--out DIR]`

use crate::failure::{CommandResult, Outcome};
use crate::options::Force;
use clap::Command;
use clap_mangen::Man;
use miette::IntoDiagnostic;
use std::path::PathBuf;
use switchback_io::output::{Artefacts, print};

/// Print the manual page, or write one for every verb.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Write switchback.1, switchback-gap.1, … into this folder instead, as `man1` below a folder of $MANPATH
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    force: Force,
}

/// Prints a program's page or writes all of them.
///
/// # Errors
/// A folder that cannot be written.
pub(crate) fn run(args: &Args, program: Command) -> CommandResult {
    // `help` explains itself.
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let Some(out) = &args.out else {
        print(&page(program)?.1)?;
        return Ok(Outcome::Done);
    };
    let folder = args.force.claim(out, &["switchback*.1"])?;
    let mut pages = Artefacts::default();
    let verbs: Vec<Command> = program.get_subcommands().filter(|verb| !verb.is_hide_set()).cloned().collect();
    for command in verbs.into_iter().chain([program]) {
        let (name, text) = page(command)?;
        pages.add(name, text);
    }
    folder.commit(&pages)?;
    Ok(Outcome::Done)
}

/// A manual page's file name and text.
fn page(command: Command) -> miette::Result<(String, String)> {
    let page = Man::new(command);
    let mut text = Vec::new();
    page.render(&mut text).into_diagnostic()?;
    Ok((page.get_filename(), String::from_utf8_lossy(&text).into_owned()))
}
