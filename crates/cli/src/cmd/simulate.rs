//! `switchback simulate MODEL.json INPUT.csv`

use super::data_args::between;
use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use std::path::PathBuf;
use switchback_io::model;
use switchback_io::output::{note, print};
use switchback_io::rig::{Between, ColumnNames};
use switchback_report::simulation::{Request, Simulation};

/// Run a model on a new input, with a 95 % band: `identify --out` and `gap --out` write such models.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// model.json of `identify --out`, or nominal.json or augmented.json of `gap --out`.
    model: PathBuf,

    /// The input to play: CSV in any dialect, one column at least. With a measured output beside it the run begins where the record does,
    /// and the fit is reported; where that is missing at the beginning, the run begins at rest.
    #[arg(value_name = "INPUT.csv")]
    file: PathBuf,

    /// Column of the input, by name or number [default: guessed from the header]
    #[arg(long, value_name = "COLUMN")]
    input: Option<String>,

    /// Column of the measured output, if there is one; `none` to leave it out and begin at rest.
    #[arg(long, value_name = "COLUMN")]
    output: Option<String>,

    /// Column of the time; `none` for rows that are even whatever it says [default: guessed; without one, a row is a sample]
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,

    /// Bring the rows to the model's sample time: on straight lines, or the last value held [default where it stands alone: linear]
    #[arg(long, value_name = "HOW", num_args = 0..=1, default_missing_value = "linear", value_parser = between())]
    resample: Option<Between>,

    /// Write the columns t,v,y,y_low,y_high, t as it stands in the input's file, into this file instead of printing them.
    #[arg(long, value_name = "CSV")]
    out: Option<PathBuf>,

    /// Print one JSON object instead: the fit figure, the share within the band, warnings and notes.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    options: Output,
}

/// Reads both, runs, writes or prints.
///
/// # Errors
/// A file that is no model or no input, an input that cannot be run, or an output that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let file = model::read(&args.model)?;
    let place = args.file.as_path();
    let input = request(args).read((&file, &args.model))?;
    let target = args.options.force.claim_file(args.out.as_deref(), &[place, &args.model])?;
    let simulation = Simulation::new(file, input, place)?;
    match target {
        Some(file) => {
            file.commit(simulation.csv())?;
            args.options.quiet.describe_or(args.json, || simulation.json(), || simulation.words())?;
        }
        None if args.json => print(&simulation.json())?,
        None => {
            if !args.options.quiet.quiet {
                note(&simulation.words());
            }
            print(&simulation.csv())?;
        }
    }
    Ok(Outcome::Done)
}

/// The input that is asked for.
fn request(args: &Args) -> Request {
    let Args { file, input, output, time, resample, .. } = args;
    let columns = ColumnNames { time: time.clone(), input: input.clone(), output: output.clone() };
    Request { file: file.clone(), columns, resample: *resample }
}
