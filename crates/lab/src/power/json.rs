//! The power of a rig's records as one JSON object.

use super::words::of_magnitude;
use super::{Context, Draw, Finding, LARGEST, Outcome, Power, SHARE};
use serde_json::{Value, json};
use switchback_io::diagnosis::Units;
use switchback_io::output::stamped;

/// Name and version of the layout.
const SCHEMA: &str = "switchback/power/1";

/// The object that `gap --power --json` prints, with a newline at its end; figures that do not exist are null.
///
/// `power.effects` holds an entry an effect: `outcome` is `from` (nine in ten are found from `size` on), `not_up_to` (up to `size` they are not),
/// `undecided` or `not_injected` (for the `reason`); `ci90` is the interval of the size at which nine in ten are found, null at an end beyond
/// `largest_size`; `found_next` is the probability that the next fault of the largest size that was `reached` is found, `found_at_most` the share found there, with a probability of 0.95. `found` counts, of the faults that were
/// diagnosed, those named and those in a class of at most three effects; `instead` is the commonest answer to the others; `without_fault` how many of
/// the diagnoses without any fault show the effect. `example` is the fault whose size is closest to `size`, in the field's units. `draws` are all, in order.
pub fn json(power: &Power, context: &Context<'_>) -> String {
    let units = Units::of(context.rig());
    let effects: Vec<Value> = power.findings.iter().map(|finding| effect(finding, &units)).collect();
    let reported = power.bare.iter().filter(|reply| !reply.said().is_empty()).count();
    stamped(
        SCHEMA,
        &json!({
            "rig": context.rig().name, "model": context.source().name(),
            "power": {
                "share": SHARE, "largest_size": LARGEST, "seed": power.plan.seed, "draws": power.plan.draws,
                "without_fault": { "diagnoses": power.bare.len(), "with_a_cause": reported },
                "effects": effects,
            },
            "version": env!("CARGO_PKG_VERSION"),
        }),
    )
}

fn effect(finding: &Finding, units: &Units) -> Value {
    let (outcome, size, reason) = match finding.outcome() {
        Outcome::From(size) => ("from", Some(size), None),
        Outcome::NotUpTo(size) => ("not_up_to", Some(size), None),
        Outcome::Undecided => ("undecided", None, None),
        Outcome::NotInjected(reason) => ("not_planted", None, Some(reason)),
    };
    let answers = finding.answers(0.0, f64::INFINITY);
    let is_injected = answers.of > 0;
    let end = |x: f64| (is_injected && x.is_finite()).then_some(x);
    let example = size.and_then(|size| finding.closest_to(size)).map(|fault| {
        let (magnitude, unit) = of_magnitude(units, fault);
        json!({ "size": fault.size, "law": fault.law, "quantity": fault.quantity, "magnitude": magnitude, "unit": unit })
    });
    json!({
        "effect": finding.effect, "outcome": outcome, "size": size, "reason": reason,
        "ci90": finding.conclusion.interval.map(end),
        "found_next": is_injected.then_some(finding.found_next),
        "found_at_most": is_injected.then_some(finding.found_at_most),
        "reached": is_injected.then(|| finding.reached()),
        "found": { "named": answers.named, "class": answers.in_class, "of": answers.of },
        "instead": finding.instead().map(|(answer, count)| json!({ "answer": answer, "count": count })),
        "without_fault": finding.without_fault,
        "example": example,
        "draws": finding.draws.iter().map(draw).collect::<Vec<_>>(),
    })
}

fn draw(draw: &Draw) -> Value {
    match draw {
        Draw::Diagnosed { fault, answer } => json!({
            "law": fault.law, "planting": fault.injection.name(), "wanted_size": fault.wanted, "size": fault.size,
            "raw_size": fault.raw, "magnitude": fault.magnitude, "unit": fault.unit, "found": answer.is_found(),
            "answer": answer.reported(),
        }),
        Draw::Refused(reason) => json!({ "refused": reason }),
    }
}
