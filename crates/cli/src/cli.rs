//! The command line.
//!
//! A verb is one file in [`crate::cmd`] with its `Args` and `run`; to add one, add its variant to [`Verb`] and its arm to
//! [`Cli::run`].

use crate::cmd;
use crate::failure::CommandResult;
use clap::error::{ContextKind, ContextValue};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use miette::Diagnostic;
use std::ffi::OsString;
use std::path::Path;
use switchback_io::input::closest;
use thiserror::Error;

/// Identify switched-hysteresis systems, benchmark their estimators' consistency, diagnose the sim-to-real gap.
///
/// Exit codes: 0 done; 1 an expectation, comparison or self-test failed; 2 bad input, nothing written; 3 stopped, what was finished
/// is kept.
#[derive(Debug, Parser)]
#[command(
    version,
    arg_required_else_help = true,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    verb: Option<Verb>,

    #[command(flatten)]
    study: cmd::study::Args,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Bench(cmd::bench::Args),
    Compare(cmd::compare::Args),
    Completions(cmd::completions::Args),
    Design(cmd::design::Args),
    Export(cmd::export::Args),
    #[command(hide = true)]
    FmuHost(cmd::fmu_host::Args),
    Gap(Box<cmd::gap::Args>),
    Identify(cmd::identify::Args),
    Init(cmd::init::Args),
    Launch(cmd::launch::Args),
    Man(cmd::man::Args),
    Merge(cmd::merge::Args),
    #[command(hide = true)]
    Method(cmd::method::Args),
    #[command(hide = true)]
    MethodHost(cmd::method_host::Args),
    Plant(cmd::plant::Args),
    Replay(cmd::replay::Args),
    Report(cmd::report::Args),
    Rig(cmd::rig::Args),
    #[command(hide = true)]
    Schemas(cmd::schemas::Args),
    Selftest(cmd::selftest::Args),
    Simulate(cmd::simulate::Args),
    Train(cmd::train::Args),
}

/// Runs what the words of a command line ask for, the program's own name first. Help, version and what cannot be understood
/// end the process here.
///
/// # Errors
/// The report of an input that could not be used.
pub(crate) fn run(words: Vec<OsString>) -> CommandResult {
    if let Some(word) = words.get(1).and_then(|word| word.to_str()) {
        refuse_misspelt_verb(word)?;
    }
    let parsed = command().try_get_matches_from(words).and_then(|matches| Cli::from_arg_matches(&matches));
    parsed.unwrap_or_else(|error| without_tip(error).exit()).run()
}

/// No verb takes a value that looks like an option, so that "to pass it as a value, use `--`" leads nowhere.
fn without_tip(mut error: clap::Error) -> clap::Error {
    let tips = error.get(ContextKind::Suggested);
    if matches!(tips, Some(ContextValue::StyledStrs(tips)) if tips.iter().any(|tip| tip.to_string().contains(" as a value, use ")))
    {
        error.remove(ContextKind::Suggested);
    }
    error
}

/// The command line as clap reads it.
fn command() -> clap::Command {
    Cli::command().mut_args(valued).mut_subcommands(|verb| verb.mut_args(valued))
}

/// `-1` is a value wherever one is expected, so that its own parser says what is wrong with it.
fn valued(argument: clap::Arg) -> clap::Arg {
    let takes_value = argument.get_action().takes_values() && argument.get_long().is_some();
    if takes_value { argument.allow_negative_numbers(true) } else { argument }
}

/// The first word is neither a verb nor a file.
#[derive(Debug, Error, Diagnostic)]
#[error("`{word}` is no verb, and no scenario file has that name")]
#[diagnostic(help("{help}"))]
struct NoVerb {
    word: String,
    help: String,
}

/// A misspelt verb would be taken for the name of a scenario file. What looks like a path is one.
fn refuse_misspelt_verb(word: &str) -> Result<(), NoVerb> {
    let cli = Cli::command();
    let names = |verb: &clap::Command| verb.get_name() == word;
    let may_be_right = word.starts_with('-') || word.contains(['.', '/', '\\']) || word == "help";
    if may_be_right || cli.get_subcommands().any(names) || word.is_empty() || Path::new(word).exists() {
        return Ok(());
    }
    let reported = cli.get_subcommands().filter(|verb| !verb.is_hide_set());
    let verbs: Vec<&str> = reported.map(clap::Command::get_name).chain(["help"]).collect();
    let help = match closest(word, verbs.iter().copied()) {
        Some(verb) => format!("did you mean `switchback {verb}`?"),
        None => format!("the verbs are {}; a scenario is named by its path", verbs.join(", ")),
    };
    Err(NoVerb { word: word.to_owned(), help })
}

impl Cli {
    /// Runs what was asked for.
    ///
    /// # Errors
    /// The report of an input that could not be used.
    pub(crate) fn run(self) -> CommandResult {
        match self.verb {
            Some(Verb::Bench(args)) => cmd::bench::run(&args),
            Some(Verb::Compare(args)) => cmd::compare::run(&args),
            Some(Verb::Completions(args)) => cmd::completions::run(&args, Self::command()),
            Some(Verb::Design(args)) => cmd::design::run(&args),
            Some(Verb::FmuHost(args)) => cmd::fmu_host::run(&args),
            Some(Verb::Export(args)) => cmd::export::run(&args),
            Some(Verb::Gap(args)) => cmd::gap::run(&args),
            Some(Verb::Identify(args)) => cmd::identify::run(&args),
            Some(Verb::Init(args)) => cmd::init::run(&args),
            Some(Verb::Launch(args)) => cmd::launch::run(&args),
            Some(Verb::Man(args)) => cmd::man::run(&args, Self::command()),
            Some(Verb::Merge(args)) => cmd::merge::run(&args),
            Some(Verb::Method(args)) => cmd::method::run(&args),
            Some(Verb::MethodHost(args)) => cmd::method_host::run(&args),
            Some(Verb::Plant(args)) => cmd::plant::run(&args),
            Some(Verb::Replay(args)) => cmd::replay::run(&args),
            Some(Verb::Report(args)) => cmd::report::run(&args),
            Some(Verb::Rig(args)) => cmd::rig::run(&args),
            Some(Verb::Schemas(args)) => cmd::schemas::run(&args),
            Some(Verb::Selftest(args)) => cmd::selftest::run(&args),
            Some(Verb::Simulate(args)) => cmd::simulate::run(&args),
            Some(Verb::Train(args)) => cmd::train::run(&args),
            None => cmd::study::run(&self.study),
        }
    }
}
