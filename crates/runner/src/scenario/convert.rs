//! From what the file says to what can be run; every judgement of a value is made here.

use super::border::WireBorder;
use super::error::Fault;
use super::wire::{
    WireCase, WireExpect, WirePrecision, WireScenario, WireSweep, WireSystem, WireSystemOverride,
};
use super::{
    Border, Case, Check, Coupling, Disturbance, Expect, Labels, Method, Replication, Scenario, Stopping,
    Sweep,
};
use crate::input::closest;
use std::collections::HashSet;
use std::fmt::Display;
use std::hash::Hash;
use std::ops::Range;
use std::sync::Arc;
use switchback_estimator::hysteresis::Interval;
use switchback_estimator::linear::{LinearSystem, is_stable};
use toml::Spanned;

/// Converts a whole file.
pub(super) fn scenario(
    name: String,
    wire: WireScenario,
    borders: Vec<WireBorder>,
    source: serde_json::Value,
) -> Result<Scenario, Fault> {
    study(&wire.study)?;
    let replication = replication(&wire)?;
    let coupling = coupling(wire.coupling.as_ref())?;
    let (borders, sweep_methods) = (selected(borders, &wire.sweep)?, methods(&wire.sweep)?);
    let expect = expect(&wire.expect, &sweep_methods)?;
    let cases = cases(&wire, &borders, &expect, &sweep_methods)?;
    let sweep = sweep(&wire.sweep, sweep_methods, &cases)?;
    let labels = labels(wire.system.get_ref());
    Ok(Scenario {
        name,
        question: wire.question,
        seed: wire.seed,
        replication,
        coupling,
        labels,
        cases,
        sweep,
        source,
    })
}

fn study(kind: &Spanned<String>) -> Result<(), Fault> {
    match kind.get_ref().as_str() {
        "consistency" => Ok(()),
        _ => Err(Fault::new(kind.span(), "not a consistency study", "write study = \"consistency\"")),
    }
}

fn replication(wire: &WireScenario) -> Result<Replication, Fault> {
    let replicates = *wire.replicates.get_ref();
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

fn labels(system: &WireSystem) -> Labels {
    Labels {
        input: system.input.clone().unwrap_or_else(|| "input v".to_owned()),
        output: system.output.clone().unwrap_or_else(|| "output y".to_owned()),
    }
}

/// The borders of the sweep, in its order; all of them where it does not choose.
fn selected(borders: Vec<WireBorder>, sweep: &WireSweep) -> Result<Vec<WireBorder>, Fault> {
    distinct(borders.iter().map(|b| &b.name))?;
    let Some(chosen) = &sweep.borders else { return Ok(borders) };
    distinct(non_empty(chosen)?.iter())?;
    let mut rest = borders;
    let mut taken = Vec::new();
    for name in chosen.get_ref() {
        match rest.iter().position(|b| b.name == *name) {
            Some(i) => taken.push(rest.swap_remove(i)),
            None => {
                let names: Vec<&str> = rest.iter().map(|b| b.name.get_ref().as_str()).collect();
                return Err(unknown(name, "border", &names));
            }
        }
    }
    Ok(taken)
}

fn methods(sweep: &WireSweep) -> Result<Vec<Method>, Fault> {
    distinct(non_empty(&sweep.methods)?.iter())?;
    sweep.methods.get_ref().iter().map(method).collect()
}

fn method(name: &Spanned<String>) -> Result<Method, Fault> {
    Method::from_name(name.get_ref()).ok_or_else(|| unknown(name, "method", &Method::ALL.map(Method::name)))
}

fn expect(wire: &WireExpect, swept: &[Method]) -> Result<Expect, Fault> {
    let in_sweep = |name: &Spanned<String>| {
        let method = method(name)?;
        if swept.contains(&method) {
            Ok(method)
        } else {
            let remedy = "add it to sweep.methods, or expect nothing of it";
            Err(Fault::new(name.span(), "the sweep does not run this method", remedy))
        }
    };
    let check = |name: &Spanned<String>| {
        Check::from_name(name.get_ref()).ok_or_else(|| unknown(name, "check", &Check::ALL.map(Check::name)))
    };
    distinct(wire.consistent.iter().chain(&wire.inconsistent))?;
    distinct(wire.within_error.iter())?;
    Ok(Expect {
        consistent: wire.consistent.iter().map(in_sweep).collect::<Result<_, _>>()?,
        inconsistent: wire.inconsistent.iter().map(in_sweep).collect::<Result<_, _>>()?,
        within_error: wire.within_error.iter().map(check).collect::<Result<_, _>>()?,
    })
}

fn cases(
    wire: &WireScenario,
    borders: &[WireBorder],
    default: &Expect,
    swept: &[Method],
) -> Result<Vec<Case>, Fault> {
    distinct(wire.case.iter().map(|c| &c.name))?;
    let base = &wire.system;
    if wire.case.is_empty() {
        let system = system(base, None)?;
        let n = system.order();
        return Ok(vec![Case {
            name: "all assumptions hold".to_owned(),
            borders: hystereses(borders, base, None)?,
            disturbance: Disturbance::White,
            order: n,
            spacing: n.max(2),
            expect: default.clone(),
            system,
        }]);
    }
    wire.case
        .iter()
        .map(|case| {
            let change = case.system.as_ref();
            let system = system(base, change)?;
            let order = order(case, system.order())?;
            Ok(Case {
                name: case.name.get_ref().clone(),
                borders: hystereses(borders, base, change)?,
                disturbance: disturbance(case)?,
                order,
                spacing: spacing(case, system.order().max(order))?,
                expect: case.expect.as_ref().map_or_else(|| Ok(default.clone()), |e| expect(e, swept))?,
                system,
            })
        })
        .collect()
}

/// The base system with a case's changes.
fn system(
    base: &Spanned<WireSystem>,
    change: Option<&Spanned<WireSystemOverride>>,
) -> Result<LinearSystem, Fault> {
    let overriding = change.map(Spanned::get_ref);
    let a = overriding.and_then(|c| c.a.as_ref()).unwrap_or(&base.get_ref().a);
    let b = overriding.and_then(|c| c.b.as_ref()).unwrap_or(&base.get_ref().b);
    LinearSystem::new(a.get_ref().clone(), b.get_ref().clone()).map_err(|error| {
        let span = change.map_or_else(|| a.span(), Spanned::span);
        Fault::new(
            span,
            error.to_string(),
            "change a or b so that A is stable, B(1) ≠ 0 and both are coprime",
        )
    })
}

/// Every border on the case's interval.
fn hystereses(
    borders: &[WireBorder],
    base: &Spanned<WireSystem>,
    change: Option<&Spanned<WireSystemOverride>>,
) -> Result<Vec<Border>, Fault> {
    let wire = change.and_then(|c| c.get_ref().interval.as_ref()).unwrap_or(&base.get_ref().interval);
    let (low, high) = *wire.get_ref();
    let interval = Interval::new(low, high)
        .map_err(|e| Fault::new(wire.span(), e.to_string(), "write interval = [h_m, h_M] with h_m < h_M"))?;
    borders
        .iter()
        .map(|border| {
            let hysteresis = Arc::new(border.on(interval)?);
            Ok(Border { name: border.name.get_ref().clone(), hysteresis })
        })
        .collect()
}

fn disturbance(case: &WireCase) -> Result<Disturbance, Fault> {
    let Some(wire) = &case.disturbance else { return Ok(Disturbance::White) };
    let d = wire.get_ref();
    match d.kind.get_ref().as_str() {
        "coloured" => coloured(wire.span(), d.ar.as_ref(), d.ma.as_ref()),
        kind @ ("white" | "output") => match d.ar.as_ref().or(d.ma.as_ref()) {
            Some(extra) => Err(Fault::new(
                extra.span(),
                format!("{kind} noise has no colouring filter"),
                "remove it, or write kind = \"coloured\"",
            )),
            None if kind == "white" => Ok(Disturbance::White),
            None => Ok(Disturbance::Output),
        },
        _ => Err(unknown(&d.kind, "disturbance", &["white", "coloured", "output"])),
    }
}

fn coloured(
    span: Range<usize>,
    ar: Option<&Spanned<Vec<f64>>>,
    ma: Option<&Spanned<Vec<f64>>>,
) -> Result<Disturbance, Fault> {
    let list = |x: Option<&Spanned<Vec<f64>>>| x.map_or_else(Vec::new, |v| v.get_ref().clone());
    let (ar_values, ma_values) = (list(ar), list(ma));
    for part in [ar, ma].into_iter().flatten() {
        if part.get_ref().iter().any(|x| !x.is_finite()) {
            return Err(Fault::new(part.span(), "every coefficient must be finite", "write plain numbers"));
        }
    }
    if ar_values.iter().chain(&ma_values).all(|&x| x == 0.0) {
        let remedy = "give ar = [d1, …] or ma = [m1, …], or write kind = \"white\"";
        return Err(Fault::new(span, "coloured noise without a colouring filter", remedy));
    }
    if !ar_values.is_empty() && !is_stable(&ar_values) {
        let at = ar.map_or(span, Spanned::span);
        let remedy = "bring every root of q^k + d1 q^(k−1) + … inside the unit circle";
        return Err(Fault::new(at, "the colouring filter is unstable", remedy));
    }
    Ok(Disturbance::Coloured { ar: ar_values, ma: ma_values })
}

fn order(case: &WireCase, true_order: usize) -> Result<usize, Fault> {
    match &case.order {
        None => Ok(true_order),
        Some(order) if *order.get_ref() >= 1 => Ok(*order.get_ref()),
        Some(order) => Err(Fault::new(order.span(), "an order is at least 1", "write 1 or more")),
    }
}

/// Pulses `max(n, 2)` apart, with the larger of the true and the assumed order, unless the case breaks that on purpose.
fn spacing(case: &WireCase, order: usize) -> Result<usize, Fault> {
    match &case.spacing {
        None => Ok(order.max(2)),
        Some(spacing) if *spacing.get_ref() >= 1 => Ok(*spacing.get_ref()),
        Some(spacing) => {
            Err(Fault::new(spacing.span(), "pulses cannot coincide", "write 1 or more; max(n, 2) is safe"))
        }
    }
}

fn sweep(wire: &WireSweep, methods: Vec<Method>, cases: &[Case]) -> Result<Sweep, Fault> {
    let points: Vec<usize> = non_empty(&wire.points)?
        .iter()
        .map(|m| match *m.get_ref() {
            0 => Err(Fault::new(m.span(), "an experiment visits at least one point", "write 1 or more")),
            count => Ok(count),
        })
        .collect::<Result<_, _>>()?;
    distinct(wire.points.get_ref().iter())?;
    let noise: Vec<f64> = non_empty(&wire.noise)?.iter().map(positive).collect::<Result<_, _>>()?;
    if let Some(i) = (1..noise.len()).find(|&i| noise[..i].contains(&noise[i])) {
        return Err(Fault::new(wire.noise.get_ref()[i].span(), "given twice", "remove one of them"));
    }
    Ok(Sweep { noise, samples: samples(wire, &points, cases)?, points, methods })
}

/// Record lengths: ascending, and none shorter than a period of any experiment.
fn samples(wire: &WireSweep, points: &[usize], cases: &[Case]) -> Result<Vec<usize>, Fault> {
    let most_points = points.iter().copied().max().unwrap_or(1);
    let longest = cases.iter().max_by_key(|c| c.period(most_points));
    let mut previous = 0;
    for n in non_empty(&wire.samples)? {
        if *n.get_ref() <= previous {
            let why = format!("does not exceed the entry before it, {previous}");
            return Err(Fault::new(n.span(), why, "list the record lengths in ascending order, each once"));
        }
        if let Some(case) = longest.filter(|c| *n.get_ref() < c.period(most_points)) {
            let period = case.period(most_points);
            let why = format!(
                "shorter than a period: m = {most_points} points, {} samples apart, take T = s(m + 3) = {period} samples",
                case.spacing
            );
            return Err(Fault::new(n.span(), why, format!("write {period} or more, or lower sweep.points")));
        }
        previous = *n.get_ref();
    }
    Ok(wire.samples.get_ref().iter().map(|n| *n.get_ref()).collect())
}

fn positive(x: &Spanned<f64>) -> Result<f64, Fault> {
    let value = *x.get_ref();
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Fault::new(x.span(), "must be positive and finite", "write a number above 0"))
    }
}

fn non_empty<T>(list: &Spanned<Vec<T>>) -> Result<&[T], Fault> {
    match list.get_ref().as_slice() {
        [] => Err(Fault::new(list.span(), "the list is empty", "give at least one entry")),
        items => Ok(items),
    }
}

fn distinct<'a, T: Eq + Hash + Display + 'a>(
    items: impl Iterator<Item = &'a Spanned<T>>,
) -> Result<(), Fault> {
    let mut seen = HashSet::new();
    for item in items {
        if !seen.insert(item.get_ref()) {
            return Err(Fault::new(item.span(), "given twice", "remove or rename one of them"));
        }
    }
    Ok(())
}

fn unknown(name: &Spanned<String>, what: &str, valid: &[&str]) -> Fault {
    let guess = closest(name.get_ref(), valid.iter().copied());
    let guess = guess.map_or_else(String::new, |g| format!("did you mean \"{g}\"? "));
    Fault::new(name.span(), format!("no such {what}"), format!("{guess}valid: {}", valid.join(", ")))
}
