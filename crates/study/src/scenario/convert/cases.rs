//! Cases: the base system with each case's changes.

use super::check::{at_most, distinct, in_one_line, unknown};
use super::expect::expect;
use crate::MethodName;
use crate::scenario::border::WireBorder;
use crate::scenario::error::Fault;
use crate::scenario::wire::{WireCase, WireScenario, WireSystem, WireSystemOverride};
use crate::scenario::{Border, Case, Disturbance, Expect, Fit, Knots};
use std::ops::Range;
use std::sync::Arc;
use switchback_io::input::TwoNumbers;
use switchback_model::hysteresis::Interval;
use switchback_model::linear::{LinearSystem, is_stable};
use toml::Spanned;

pub(super) fn cases(
    wire: &WireScenario,
    borders: &[WireBorder],
    default: &Expect,
    swept: &[MethodName],
) -> Result<Vec<Case>, Fault> {
    distinct(wire.case.iter().map(|c| &c.name))?;
    wire.case.iter().try_for_each(|c| in_one_line(&c.name))?;
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
            knots: Knots::Given,
            fit: Fit::Equation,
            expect: default.clone(),
            system,
        }]);
    }
    let names: Vec<&str> = wire.case.iter().map(|c| c.name.get_ref().as_str()).collect();
    let expectations = wire.case.iter().filter_map(|c| c.expect.as_ref()).chain([&wire.expect]);
    for width in expectations.filter_map(|e| e.width.as_ref()) {
        let of = &width.get_ref().of;
        if !names.contains(&of.get_ref().as_str()) {
            return Err(unknown(of, "case", &names));
        }
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
                knots: knots(case)?,
                fit: fit(case)?,
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
    let TwoNumbers([low, high]) = *wire.get_ref();
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

/// Of a rig no more can be asked for either: beyond them coefficients drown in rounding errors.
const MOST_LAGS: usize = 20;

/// Longer than any transient.
const MOST_SPACING: usize = 1_000_000;

fn order(case: &WireCase, true_order: usize) -> Result<usize, Fault> {
    match &case.order {
        None => Ok(true_order),
        Some(order) if *order.get_ref() >= 1 => at_most(order, MOST_LAGS, "coefficients"),
        Some(order) => Err(Fault::new(order.span(), "an order is at least 1", "write 1 or more")),
    }
}

/// Pulses `max(n, 2)` apart, with the larger of the true and the assumed order, unless the case breaks that on purpose.
fn spacing(case: &WireCase, order: usize) -> Result<usize, Fault> {
    match &case.spacing {
        None => Ok(order.max(2)),
        Some(spacing) if *spacing.get_ref() >= 1 => at_most(spacing, MOST_SPACING, "samples between pulses"),
        Some(spacing) => {
            Err(Fault::new(spacing.span(), "pulses cannot coincide", "write 1 or more; max(n, 2) is safe"))
        }
    }
}

fn knots(case: &WireCase) -> Result<Knots, Fault> {
    let Some(name) = &case.knots else { return Ok(Knots::Given) };
    Knots::from_name(name.get_ref())
        .ok_or_else(|| unknown(name, "choice of knots", &Knots::ALL.map(Knots::name)))
}

fn fit(case: &WireCase) -> Result<Fit, Fault> {
    let Some(name) = &case.fit else { return Ok(Fit::Equation) };
    let fit = Fit::from_name(name.get_ref())
        .ok_or_else(|| unknown(name, "kind of fit", &Fit::ALL.map(Fit::name)))?;
    if fit != Fit::Equation && knots(case)? == Knots::Known {
        return Err(Fault::new(
            name.span(),
            "the grid that holds the true borders is known for fits of the equation error alone",
            "leave out knots, or write knots = \"refined\"",
        ));
    }
    Ok(fit)
}
