//! Methods, and what is expected of them.

use super::check::{distinct, non_empty, unknown};
use crate::scenario::error::Fault;
use crate::scenario::wire::{WireExpect, WireSweep};
use crate::scenario::{Check, Expect, Method};
use toml::Spanned;

pub(super) fn methods(sweep: &WireSweep) -> Result<Vec<Method>, Fault> {
    distinct(non_empty(&sweep.methods)?.iter())?;
    sweep.methods.get_ref().iter().map(method).collect()
}

fn method(name: &Spanned<String>) -> Result<Method, Fault> {
    Method::from_name(name.get_ref()).ok_or_else(|| unknown(name, "method", &Method::ALL.map(Method::name)))
}

pub(super) fn expect(wire: &WireExpect, swept: &[Method]) -> Result<Expect, Fault> {
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
