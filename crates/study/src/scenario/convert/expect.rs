//! Methods, and what is expected of them.

use super::check::{distinct, non_empty, unknown};
use super::foreign;
use crate::MethodName;
use crate::scenario::error::Fault;
use crate::scenario::wire::{WireCoverage, WireExpect, WireSweep, WireWidth};
use crate::scenario::{Check, Coverage, Expect, ForeignMethod, Width};
use switchback_identify::Method;
use switchback_io::input::TwoNumbers;
use toml::Spanned;

/// Our methods of the sweep. Those of others run in any case, whether they are listed or not.
pub(super) fn methods(sweep: &WireSweep, foreign: &[ForeignMethod]) -> Result<Vec<Method>, Fault> {
    if foreign.is_empty() {
        non_empty(&sweep.methods)?;
    }
    distinct(sweep.methods.get_ref().iter())?;
    let own = foreign::all(&Method::ALL, foreign);
    let names = sweep.methods.get_ref().iter().map(|name| method(name, &own));
    let own = |name| match name {
        Ok(MethodName::Own(method)) => Some(Ok(method)),
        Ok(MethodName::Foreign(_)) => None,
        Err(fault) => Some(Err(fault)),
    };
    names.filter_map(own).collect()
}

/// The method of that name among those that there are.
fn method(name: &Spanned<String>, all: &[MethodName]) -> Result<MethodName, Fault> {
    let found = all.iter().find(|method| method.name() == name.get_ref());
    let names: Vec<&str> = all.iter().map(MethodName::name).collect();
    found.cloned().ok_or_else(|| unknown(name, "method", &names))
}

pub(super) fn expect(wire: &WireExpect, swept: &[MethodName]) -> Result<Expect, Fault> {
    let mut known: Vec<MethodName> = Method::ALL.into_iter().map(MethodName::Own).collect();
    known.extend(swept.iter().filter(|method| method.is_foreign()).cloned());
    let in_sweep = |name: &Spanned<String>| {
        let method = method(name, &known)?;
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
        coverage: wire.coverage.as_ref().map(coverage).transpose()?,
        width: wire.width.as_ref().map(width).transpose()?,
    })
}

fn coverage(wire: &Spanned<WireCoverage>) -> Result<Coverage, Fault> {
    let WireCoverage { mean: TwoNumbers(mean), least } = *wire.get_ref();
    let is_share = |x: &f64| (0.0..=1.0).contains(x);
    let fault = |message: &'static str| {
        let remedy = "write shares, as in coverage = { mean = [0.9, 0.98], least = 0.85 }";
        Err(Fault::new(wire.span(), message, remedy))
    };
    if ![mean[0], mean[1], least].iter().all(is_share) {
        return fault("coverage lies between 0 and 1");
    }
    if mean[0] > mean[1] {
        return fault("the range of the mean coverage begins above its end");
    }
    Ok(Coverage { mean: mean.into(), least })
}

fn width(wire: &Spanned<WireWidth>) -> Result<Width, Fault> {
    let WireWidth { of, at_most } = wire.get_ref();
    if at_most.is_finite() && *at_most > 0.0 {
        Ok(Width { of: of.get_ref().clone(), at_most: *at_most })
    } else {
        Err(Fault::new(
            wire.span(),
            "at_most must be positive and finite",
            "write a ratio, as in at_most = 2.0",
        ))
    }
}
