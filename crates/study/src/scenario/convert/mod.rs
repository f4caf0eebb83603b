//! From what the file says to what can be run; every judgement of a value is made here.

mod cases;
mod check;
mod expect;
mod foreign;
mod sweep;

use super::border::WireBorder;
use super::error::Fault;
use super::wire::{WirePrecision, WireScenario, WireSystem};
use super::{Coupling, Engine, Labels, Replication, Scenario, Stopping};
use cases::cases;
use check::{at_most, positive, unknown};
use expect::{expect, methods};
use sweep::{selected, sweep};
use toml::Spanned;

/// Converts a whole file.
pub(in crate::scenario) fn scenario(
    name: String,
    wire: WireScenario,
    borders: Vec<WireBorder>,
    source: serde_json::Value,
) -> Result<Scenario, Fault> {
    let replication = replication(&wire)?;
    let coupling = coupling(wire.coupling.as_ref())?;
    let engine = engine(wire.engine.as_ref())?;
    let (borders, foreign) = (selected(borders, &wire.sweep)?, foreign::foreign(&wire.method)?);
    let sweep_methods = methods(&wire.sweep, &foreign)?;
    let swept = foreign::all(&sweep_methods, &foreign);
    let expect = expect(&wire.expect, &swept)?;
    let cases = cases(&wire, &borders, &expect, &swept)?;
    let sweep = sweep(&wire.sweep, sweep_methods, &cases)?;
    let labels = labels(wire.system.get_ref());
    Ok(Scenario {
        name,
        question: wire.question,
        seed: wire.seed,
        replication,
        coupling,
        engine,
        labels,
        cases,
        sweep,
        foreign,
        source,
    })
}

/// Their numbers are of 32 bits, and the error of no figure asks for so many.
const MOST_REPLICATES: usize = 1_000_000_000;

fn replication(wire: &WireScenario) -> Result<Replication, Fault> {
    let replicates = at_most(&wire.replicates, MOST_REPLICATES, "replicates")?;
    if let Some(max) = &wire.max_replicates {
        at_most(max, MOST_REPLICATES, "replicates")?;
    }
    if replicates < 2 {
        let why = "a standard deviation needs at least two replicates";
        return Err(Fault::new(
            wire.replicates.span(),
            why,
            "write 2 or more; 500 resolves a coverage to 1 %",
        ));
    }
    let stopping = match (&wire.precision, &wire.max_replicates) {
        (None, None) => None,
        (Some(precision), Some(max)) if *max.get_ref() >= replicates => {
            Some(stopping(precision, *max.get_ref())?)
        }
        (Some(_), Some(max)) => {
            let why = format!("below replicates = {replicates}");
            return Err(Fault::new(max.span(), why, "raise max_replicates, or lower replicates"));
        }
        (Some(precision), None) => {
            let why = "a precision needs a limit on the replicates it may cost";
            return Err(Fault::new(precision.span(), why, "add max_replicates = …"));
        }
        (None, Some(max)) => {
            let why = "without a precision nothing goes beyond `replicates`";
            return Err(Fault::new(max.span(), why, "add precision = { … }, or remove max_replicates"));
        }
    };
    Ok(Replication { replicates, stopping })
}

fn stopping(precision: &Spanned<WirePrecision>, max_replicates: usize) -> Result<Stopping, Fault> {
    let wire = precision.get_ref();
    if wire.bias_mcse.is_none() && wire.sd_relative_mcse.is_none() {
        let remedy = "write precision = { bias_mcse = …, sd_relative_mcse = … } with one or both";
        return Err(Fault::new(precision.span(), "this precision asks for nothing", remedy));
    }
    let checked = |x: &Option<Spanned<f64>>| x.as_ref().map(positive).transpose();
    Ok(Stopping {
        bias_mcse: checked(&wire.bias_mcse)?,
        sd_relative_mcse: checked(&wire.sd_relative_mcse)?,
        max_replicates,
    })
}

fn coupling(wire: Option<&Spanned<String>>) -> Result<Coupling, Fault> {
    let Some(name) = wire else { return Ok(Coupling::Shared) };
    match name.get_ref().as_str() {
        "shared" => Ok(Coupling::Shared),
        "independent" => Ok(Coupling::Independent),
        _ => Err(unknown(name, "coupling", &["shared", "independent"])),
    }
}

fn engine(wire: Option<&Spanned<String>>) -> Result<Engine, Fault> {
    let Some(name) = wire else { return Ok(Engine::Superposed) };
    Engine::from_name(name.get_ref()).ok_or_else(|| unknown(name, "engine", &Engine::ALL.map(Engine::name)))
}

/// A label stands on one line.
fn label(given: Option<&str>, default: &str) -> String {
    given.unwrap_or(default).replace(['\n', '\r'], " ")
}

fn labels(system: &WireSystem) -> Labels {
    Labels {
        input: label(system.input.as_deref(), "input v"),
        output: label(system.output.as_deref(), "output y"),
    }
}
