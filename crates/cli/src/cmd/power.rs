//! `switchback gap … --power`

use crate::failure::{CommandResult, Outcome};
use crate::options::{Force, Quiet, Threads};
use crate::progress::Meter;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use switchback_diagnose::Settings;
use switchback_io::diagnosis::GivenModel;
use switchback_io::output::note;
use switchback_io::rig::{self, Loaded};
use switchback_io::values::whole;
use switchback_lab::generate::EFFECTS;
use switchback_lab::power::{self, Context, Plan, PowerError, Request};
use switchback_report::power::artefacts;

/// What `--power` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct PowerArgs {
    /// Instead of a diagnosis: put known faults of every effect into these records, diagnose each, and show from which size on nine in ten are
    /// found. Takes about ten minutes on two cores for a few thousand samples.
    #[arg(long, help_heading = "Power")]
    pub(crate) power: bool,

    /// Put in only these effects [default: all, but those of --without]
    #[arg(long, value_name = "EFFECT,…", value_delimiter = ',', value_parser = effect(), hide_possible_values = true, requires = "power", help_heading = "Power")]
    effects: Vec<&'static str>,

    /// Faults an effect, on average: an effect that is settled earlier leaves its draws to the others.
    #[arg(long, value_name = "N", default_value_t = Request::default().draws, value_parser = whole::<usize>(Request::DRAWS), requires = "power", help_heading = "Power")]
    draws: usize,

    /// Laws, parameters and noise are drawn from this.
    #[arg(long, value_name = "SEED", default_value_t = Request::default().seed, value_parser = whole::<u64>(0..=u64::MAX), requires = "power", help_heading = "Power")]
    seed: u64,
}

fn effect() -> impl TypedValueParser<Value = &'static str> {
    PossibleValuesParser::new(EFFECTS)
        .map(|name| EFFECTS.into_iter().find(|known| *known == name).expect("only these are possible values"))
}

/// The rest of the command line that matters.
pub(super) struct Order<'a> {
    /// File of the model to diagnose.
    pub(super) model: Option<&'a Path>,
    /// How each rig is diagnosed.
    pub(super) settings: Settings,
    pub(super) out: Option<&'a PathBuf>,
    pub(super) json: bool,
    pub(super) options: (Threads, Quiet, Force),
}

/// What the folder gets.
const FILES: [&str; 4] = ["power.json", "power.csv", "power.txt", "power.svg"];

/// Measures, prints, and writes the folder if one was asked for.
///
/// # Errors
/// Records or a model that no power can be measured with, or a folder that cannot be written.
pub(super) fn run(
    args: &PowerArgs,
    order: Order<'_>,
    (data, loaded): (&rig::Request, &Loaded),
) -> CommandResult {
    let (threads, quiet, force) = order.options;
    let request = Request { effects: args.effects.clone(), draws: args.draws, seed: args.seed };
    let plan = request.plan(&order.settings)?;
    let folder = force.claim_if_asked(order.out.map(PathBuf::as_path), &FILES, &data.inputs(&loaded.plan))?;
    let model = order.model.map(GivenModel::read).transpose()?;
    let name = data.place().display().to_string();
    let meter = Meter::counting("diagnoses", quiet);
    let (context, power) = threads.install(|| {
        let context = Context::new(&loaded.rig, model, order.settings, &name)?;
        let clock = Instant::now();
        let power = power::measure(&context, &plan, &meter, || announce(&plan, clock.elapsed(), quiet))?;
        Ok::<_, PowerError>((context, power))
    })??;
    meter.finish();
    if let Some(folder) = folder {
        folder.commit(&artefacts(&power, &context))?;
    }
    quiet.describe_or(order.json, || power::json(&power, &context), || power::words(&power, &context))?;
    Ok(Outcome::Done)
}

/// A diagnosis of records with a fault takes about so many times as long as one of those without: there is a cause to be looked at, and pairs.
const WITH_FAULT: f64 = 2.0;

/// How long it will take, on stderr: the only words that depend on the clock.
fn announce(plan: &Plan, first: Duration, quiet: Quiet) {
    if quiet.quiet {
        return;
    }
    let seconds = first.as_secs_f64();
    let all = seconds * (plan.draws as f64 + WITH_FAULT * plan.budget() as f64);
    let reported = if all < 90.0 { format!("{all:.0} s") } else { format!("{:.0} min", all / 60.0) };
    note(&format!(
        "{} diagnoses at most; the first took {seconds:.1} s, with a fault they take longer: about {reported} in all (less with `--draws` or `--effects`)\n",
        plan.diagnoses()
    ));
}
