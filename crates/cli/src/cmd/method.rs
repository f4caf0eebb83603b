//! `switchback method NAME`

use crate::failure::{CommandResult, Outcome};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use miette::IntoDiagnostic;
use switchback_identify::Method;
use switchback_versions::{OwnMethod, answer_requests};

/// Answer a study's requests by one of our methods, as the command of a `[[method]]` does.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Which one.
    #[arg(value_parser = PossibleValuesParser::new(OwnMethod::ALL.map(Method::name)).map(method))]
    name: OwnMethod,
}

/// Answers until nothing more is asked.
///
/// # Errors
/// A line that is no request.
pub(crate) fn run(args: &Args) -> CommandResult {
    answer_requests(&args.name).into_diagnostic()?;
    Ok(Outcome::Done)
}

/// The method of a name that is one of them.
fn method(name: String) -> OwnMethod {
    Method::from_name(&name).and_then(OwnMethod::new).expect("only names of methods are possible values")
}
