//! `switchback design --order 2 --points 8 --interval -40,40 --rate 100 --out DIR` and `switchback design --from RIG --precision P`

use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, positive, whole};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use miette::Diagnostic;
use std::path::{Path, PathBuf};
use switchback_identify::excitation::Dataset;
use switchback_io::rig;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::Rig;
use switchback_study::design::{
    self, DesignError, Forecast, Length, Outlook, Plan, PlanMethod, Report, Request, Truth,
};
use thiserror::Error;

/// Write the experiments that identify a system: inputs to play, and the rig.toml that waits for the outputs.
///
/// With `--from RIG`, show how long to measure: every parameter's standard error against the number of samples, predicted for
/// the system and the noise found on that rig.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    asked: Asked,

    /// Folder for the records and rig.toml.
    #[arg(long, value_name = "DIR", required_unless_present = "from")]
    out: Option<PathBuf>,

    /// Print one JSON object instead of words.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    output: Output,
}

/// The experiments that are asked for.
#[derive(Debug, clap::Args)]
pub struct Asked {
    /// Order of the linear part [default with --from: that of the rig].
    #[arg(long, value_name = "N", required_unless_present = "from", value_parser = whole::<u8>(1..=20))]
    order: Option<u8>,

    /// Levels to visit on each border [default: 8; with --from, those of the rig].
    #[arg(long, value_name = "M", value_parser = whole::<u16>(1..=65_535))]
    points: Option<u16>,

    /// Working interval of the input, input units.
    #[arg(long, value_name = "LO,HI", required_unless_present = "from", conflicts_with = "from", allow_hyphen_values = true, value_parser = working_interval)]
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
    #[arg(long, value_name = "MIN,MAX", allow_hyphen_values = true, value_parser = two_numbers)]
    amplitude: Option<[f64; 2]>,

    /// What the actuator can do, input units a second; refuses experiments that need more.
    #[arg(long, value_name = "SPEED", allow_negative_numbers = true, value_parser = positive)]
    max_speed: Option<f64>,

    /// Leave the designed experiments out and write the free records only.
    #[arg(long)]
    free_only: bool,

    /// Seed of the free records.
    #[arg(long, default_value_t = 1, value_parser = whole::<u64>(0..=u64::MAX))]
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
}

/// A precision was asked for without a rig.
#[derive(Debug, Error, Diagnostic)]
#[error("`--precision` needs `--from RIG.toml`: how long to measure depends on the system and its noise")]
#[diagnostic(help("measure a first plan without it, then `switchback design --from` that rig"))]
pub struct PrecisionOfWhat;

/// Plans, predicts, writes the folder, prints.
///
/// # Errors
/// Experiments that cannot be, a rig that cannot be planned from, or a folder that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let out = args.out.as_deref();
    let source = args.asked.source()?;
    let request = request((&args.asked, out), source.as_ref())?;
    let inputs: Vec<&Path> = source
        .iter()
        .flat_map(|source| &source.files)
        .chain(&args.asked.from)
        .map(PathBuf::as_path)
        .collect();
    let folder = args.output.force.claim_if_asked(out, &[rig::RIG_FILE], &inputs)?;
    // What a former plan without `--free-only` left, if nothing was measured into it.
    let folder = folder.map(|folder| folder.clearing(&["descendant.csv", "ascendant.csv"]));
    let report = report((&args.asked, out), request, source)?;
    if let Some(folder) = folder {
        folder.commit(&design::artefacts(&report.plan))?;
    }
    args.output.quiet.describe_or(args.json, || design::json(&report), || design::words(&report))?;
    Ok(Outcome::Done)
}

/// The plan alone: nothing is printed or written. `out` is the folder that it is meant for.
///
/// # Errors
/// Experiments that cannot be, or a rig that cannot be planned from.
pub fn planned(asked: &Asked, out: Option<&Path>) -> miette::Result<Report> {
    let source = asked.source()?;
    let request = request((asked, out), source.as_ref())?;
    Ok(report((asked, out), request, source)?)
}

fn report(
    (asked, out): (&Asked, Option<&Path>),
    request: Request,
    source: Option<Source>,
) -> Result<Report, DesignError> {
    let (plan, outlook) = match source {
        Some(source) => foresee(asked, request, source.truth)?,
        None => (Plan::new(request, length(asked))?, None),
    };
    Ok(Report { plan, outlook, folder: out.map(|folder| folder.display().to_string()) })
}

impl Asked {
    /// The rig to plan from, where one is given.
    fn source(&self) -> miette::Result<Option<Source>> {
        // Clap does not ask for an argument that conflicts with one given, as --from does with --interval.
        if self.precision.is_some() && self.from.is_none() {
            return Err(PrecisionOfWhat.into());
        }
        Ok(self.from.as_deref().map(|file| Source::read(self, file)).transpose()?)
    }
}

/// The rig to plan from, and what it says of the system.
struct Source {
    rig: Rig,
    truth: Truth,
    /// The rig's records.
    files: Vec<PathBuf>,
}

impl Source {
    fn read(args: &Asked, file: &Path) -> Result<Self, DesignError> {
        let rig::Loaded { mut rig, plan, .. } = rig::load(file)?;
        let files = plan.records.into_iter().map(|record| record.path).collect();
        rig.order = args.order.map(usize::from).or(rig.order);
        let truth = Truth::of(&rig, file)?;
        Ok(Self { rig, truth, files })
    }
}

/// What is asked for, completed from the rig.
fn request((args, out): (&Asked, Option<&Path>), source: Option<&Source>) -> Result<Request, miette::Report> {
    let known = source.map(|s| (s.truth.hysteresis.interval(), s.rig.sample_time, s.truth.system.order()));
    let given = args.interval.zip(args.rate).zip(args.order);
    let (interval, sample_time, order) = known
        .or(given.map(|((interval, rate), order)| (interval, 1.0 / rate, usize::from(order))))
        .ok_or_else(|| miette::miette!("give --order, --interval and --rate, or --from RIG.toml"))?;
    let label = |given: &Option<String>, of_rig: fn(&Rig) -> &str, default: &str| {
        given.clone().unwrap_or_else(|| source.map_or(default, |s| of_rig(&s.rig)).to_owned())
    };
    let folder = out.and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
    Ok(Request {
        name: args.name.clone().or(folder).unwrap_or_else(|| "planned".to_owned()),
        order,
        points: args.points.map(usize::from).or(source.map(|s| s.truth.points)).unwrap_or(8),
        interval,
        sample_time,
        labels: [
            label(&args.input, |rig| &rig.input_label, "input v"),
            label(&args.output, |rig| &rig.output_label, "output y"),
        ],
        amplitude: args.amplitude,
        max_speed: args.max_speed,
        free_only: args.free_only,
        seed: args.seed,
    })
}

/// Where no length is given, the default one.
fn length(args: &Asked) -> Length {
    match (args.duration, args.periods) {
        (Some(seconds), _) => Length::Duration(seconds),
        (None, Some(periods)) => Length::Periods(periods as usize),
        (None, None) => Length::Periods(design::DEFAULT_PERIODS),
    }
}

/// The plan, as long as the precision wanted needs, and what is predicted of it.
fn foresee(args: &Asked, request: Request, truth: Truth) -> Result<(Plan, Option<Outlook>), DesignError> {
    let sketch = Dataset::new(request.interval, request.order, request.points, Dataset::FEWEST_PERIODS)?;
    let forecast = Forecast::new(&truth, sketch.pulses(), args.method)?;
    let length = args.precision.map_or_else(|| length(args), |p| Length::Periods(forecast.periods_for(p)));
    let plan = Plan::new(request, length)?;
    Ok((plan, Some(Outlook { truth, forecast, wanted: args.precision })))
}

fn two_numbers(text: &str) -> Result<[f64; 2], String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|part| part.trim().parse().map_err(|_| format!("`{}` is no number", part.trim())))
        .collect::<Result<_, _>>()?;
    <[f64; 2]>::try_from(numbers)
        .map_err(|_| "give two numbers with a comma between them, as in -40,40".to_owned())
}

fn working_interval(text: &str) -> Result<Interval, String> {
    let [low, high] = two_numbers(text)?;
    Interval::new(low, high).map_err(|error| error.to_string())
}

/// `0.01`, `1%` or `1 %`.
fn share(text: &str) -> Result<f64, String> {
    match text.strip_suffix('%') {
        Some(percent) => positive(percent.trim()).map(|number| number / 100.0),
        None => positive(text),
    }
}

fn method() -> impl TypedValueParser<Value = PlanMethod> {
    PossibleValuesParser::new(PlanMethod::ALL.map(PlanMethod::name))
        .map(|name| PlanMethod::from_name(&name).expect("only names of methods are possible values"))
}
