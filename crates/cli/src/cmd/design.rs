//! `switchback design --order 2 --points 8 --interval -40,40 --rate 100 --out DIR` and `switchback design --from RIG --precision P`

use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;
use switchback_io::rig;
use switchback_io::values::{interval, pair, positive, share, whole};
use switchback_model::hysteresis::Interval;
use switchback_study::design::{self, Draft, Options, PlanMethod};

/// Write the experiments that identify a system: inputs to play, and the rig.toml that waits for the outputs.
///
/// With `--from RIG`, show how long to measure: every parameter's standard error against the number of samples, predicted for
/// the system and the noise found on that rig.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Order of the linear part [default with --from: that of the rig].
    #[arg(long, value_name = "N", required_unless_present = "from", value_parser = whole::<u8>(Options::ORDERS))]
    order: Option<u8>,

    /// Levels to visit on each border [default: 8; with --from, those of the rig].
    #[arg(long, value_name = "M", value_parser = whole::<u16>(Options::LEVELS))]
    points: Option<u16>,

    /// Working interval of the input, input units.
    #[arg(long, value_name = "LO,HI", required_unless_present = "from", conflicts_with = "from", allow_hyphen_values = true, value_parser = interval)]
    interval: Option<Interval>,

    /// Samples a second.
    #[arg(long, value_name = "HZ", required_unless_present = "from", conflicts_with = "from", allow_negative_numbers = true, value_parser = positive)]
    rate: Option<f64>,

    /// Plan for the system and the noise of this rig: its designed experiments, or else its free records.
    #[arg(long, value_name = "RIG.toml")]
    from: Option<PathBuf>,

    /// Measure until no border point has a larger standard error, as a share of u_M − u_m: 0.01 or 1%.
    #[arg(long, value_name = "P", conflicts_with_all = ["periods", "duration", "free_only"], allow_negative_numbers = true, value_parser = share)]
    precision: Option<f64>,

    /// Method to predict for.
    #[arg(long, default_value = PlanMethod::Efficient.name(), value_parser = method())]
    method: PlanMethod,

    /// Periods of each pulse experiment [default: 100].
    #[arg(long, value_name = "K", conflicts_with = "duration", value_parser = whole::<u32>(1..=u64::from(u32::MAX)))]
    periods: Option<u32>,

    /// Seconds of all records together, instead of --periods.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = positive)]
    duration: Option<f64>,

    /// Smallest and largest move of the free records, input units [default: 2 % of the interval, all of it].
    #[arg(long, value_name = "MIN,MAX", allow_hyphen_values = true, value_parser = pair)]
    amplitude: Option<[f64; 2]>,

    /// What the actuator can do, input units a second; refuses experiments that need more.
    #[arg(long, value_name = "SPEED", allow_negative_numbers = true, value_parser = positive)]
    max_speed: Option<f64>,

    /// Leave the designed experiments out and write the free records only.
    #[arg(long)]
    free_only: bool,

    /// Seed of the free records.
    #[arg(long, default_value_t = Options::default().seed, value_parser = whole::<u64>(0..=u64::MAX))]
    seed: u64,

    /// Label and unit of the input, as in "travel [mm]" [default: that of the rig].
    #[arg(long, value_name = "LABEL")]
    input: Option<String>,

    /// Label and unit of the output, as in "force [N]" [default: that of the rig].
    #[arg(long, value_name = "LABEL")]
    output: Option<String>,

    /// Name of the rig to be measured [default: that of the folder].
    #[arg(long)]
    name: Option<String>,

    /// Folder for the records and rig.toml.
    #[arg(long, value_name = "DIR", required_unless_present = "from")]
    out: Option<PathBuf>,

    /// Print one JSON object instead of words.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    common: Output,
}

/// Plans, predicts, writes the folder, prints.
///
/// # Errors
/// Experiments that cannot be, a rig that cannot be planned from, or a folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let out = args.out.as_deref();
    let draft = Draft::new(options(args), out)?;
    let folder = args.common.force.claim_if_asked(out, &[rig::RIG_FILE], &draft.inputs())?;
    // What a former plan without `--free-only` left, if nothing was measured into it.
    let folder = folder.map(|folder| folder.clearing(&["descendant.csv", "ascendant.csv"]));
    let report = draft.plan()?;
    if let Some(folder) = folder {
        folder.commit(&design::artefacts(&report.plan))?;
    }
    args.common.quiet.describe_or(args.json, || design::json(&report), || design::words(&report))?;
    Ok(Outcome::Done)
}

/// What is asked for.
fn options(args: &Args) -> Options {
    Options {
        order: args.order,
        points: args.points,
        interval: args.interval,
        rate: args.rate,
        from: args.from.clone(),
        precision: args.precision,
        method: args.method,
        periods: args.periods,
        duration: args.duration,
        amplitude: args.amplitude,
        max_speed: args.max_speed,
        free_only: args.free_only,
        seed: args.seed,
        input: args.input.clone(),
        output: args.output.clone(),
        name: args.name.clone(),
    }
}

fn method() -> impl TypedValueParser<Value = PlanMethod> {
    PossibleValuesParser::new(PlanMethod::ALL.map(PlanMethod::name))
        .map(|name| PlanMethod::from_name(&name).expect("only names of methods are possible values"))
}
