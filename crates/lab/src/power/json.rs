//! The power of a rig's records as one JSON object. Keys stand in the order of the alphabet.

use super::words::of_magnitude;
use super::{Context, Draw, Finding, LARGEST, Outcome, Power, SHARE};
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use switchback_diagnose::Effect;
use switchback_io::diagnosis::{Source, Units};
use switchback_io::output::{stamped, stamped_schema};

/// Name and version of the layout.
const SCHEMA: &str = "switchback/power/1";

/// Which faults records would have shown: `gap --power --json`, `power.json`. Figures that do not exist are null.
#[derive(Serialize, JsonSchema)]
struct PowerFile<'a> {
    /// What is diagnosed.
    #[schemars(with = "Source")]
    model: &'static str,
    /// What was found.
    power: Found<'a>,
    /// The rig's name.
    rig: &'a str,
    /// Version of Switchback that wrote it.
    version: &'static str,
}

/// What was found.
#[derive(Serialize, JsonSchema)]
struct Found<'a> {
    /// Faults an effect, on average.
    draws: usize,
    /// An entry an effect.
    effects: Vec<EffectPower<'a>>,
    /// Largest size put in.
    #[schemars(extend("exclusiveMinimum" = 0))]
    largest_size: f64,
    /// Seed.
    seed: u64,
    /// Share of the faults that must be found.
    #[schemars(range(min = 0, max = 1))]
    share: f64,
    /// Without fault.
    without_fault: WithoutFault,
}

/// Diagnoses of the records as they are.
#[derive(Serialize, JsonSchema)]
struct WithoutFault {
    /// Diagnoses without fault.
    diagnoses: usize,
    /// Those that reported a cause.
    with_a_cause: usize,
}

/// What is known of an effect.
#[derive(Serialize, JsonSchema)]
struct EffectPower<'a> {
    /// Interval of the size at which the share is found; null at an end beyond `largest_size`.
    ci90: [Option<f64>; 2],
    /// All draws, in order.
    draws: Vec<DrawFile<'a>>,
    /// The effect.
    #[schemars(with = "Effect")]
    effect: &'static str,
    /// The fault whose size is closest to `size`, in the rig's units.
    example: Option<Example>,
    /// Faults that were named, and in a class or shortlist of at most three effects.
    found: Counts,
    /// Share found there, with a probability of 0.95.
    #[schemars(range(min = 0, max = 1))]
    found_at_most: Option<f64>,
    /// Probability that the next fault of the largest size reached is found.
    #[schemars(range(min = 0, max = 1))]
    found_next: Option<f64>,
    /// The commonest other answer.
    instead: Option<Instead<'a>>,
    /// `from`: nine in ten are found from `size` on; `not_up_to`: up to `size` they are not; `undecided`; `not_injected`, for the `reason`.
    #[schemars(extend("enum" = ["from", "not_up_to", "undecided", "not_planted"]))]
    outcome: &'static str,
    /// Largest size reached.
    reached: Option<f64>,
    /// Why it was not planted.
    reason: Option<String>,
    /// See `outcome`.
    #[schemars(range(min = 0))]
    size: Option<f64>,
    /// Diagnoses without fault that show the effect.
    without_fault: usize,
}

/// A fault in the rig's units.
#[derive(Serialize, JsonSchema)]
struct Example {
    /// Its law.
    law: &'static str,
    /// Its magnitude.
    magnitude: f64,
    /// What the magnitude is, where its unit does not say it.
    quantity: Option<&'static str>,
    /// Its size.
    size: f64,
    /// Unit of the magnitude.
    unit: String,
}

/// Faults that were diagnosed.
#[derive(Serialize, JsonSchema)]
struct Counts {
    /// Those in a class or a shortlist.
    class: usize,
    /// Those named.
    named: usize,
    /// All.
    of: usize,
}

/// An answer that does not find the fault.
#[derive(Serialize, JsonSchema)]
struct Instead<'a> {
    /// In a few words.
    answer: &'a str,
    /// How often it was given.
    count: usize,
}

/// A fault that was put in, or why it was not.
#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
enum DrawFile<'a> {
    /// It was diagnosed.
    Diagnosed {
        /// What the diagnosis says.
        answer: &'a str,
        /// Whether that finds the fault.
        found: bool,
        /// The fault's law.
        law: &'static str,
        /// Its magnitude.
        magnitude: f64,
        /// How it came in.
        injection: &'static str,
        /// What a model given beforehand misses.
        #[schemars(range(min = 0))]
        raw_size: f64,
        /// What survives identification anew, over the residual.
        #[schemars(range(min = 0))]
        size: f64,
        /// Unit of the magnitude.
        unit: &'static str,
        /// Size asked for.
        #[schemars(range(min = 0))]
        wanted_size: f64,
    },
    /// It could not be put in.
    Refused {
        /// Why.
        refused: &'a str,
    },
}

/// The JSON Schema of [`json`].
pub fn schema() -> Schema {
    stamped_schema::<PowerFile<'_>>(SCHEMA)
}

/// The object that `gap --power --json` prints, with a newline at its end.
pub fn json(power: &Power, context: &Context<'_>) -> String {
    let units = Units::of(context.rig());
    let reported = power.bare.iter().filter(|reply| !reply.listed().is_empty()).count();
    let found = Found {
        draws: power.plan.draws,
        effects: power.findings.iter().map(|finding| effect(finding, &units)).collect(),
        largest_size: LARGEST,
        seed: power.plan.seed,
        share: SHARE,
        without_fault: WithoutFault { diagnoses: power.bare.len(), with_a_cause: reported },
    };
    let page = PowerFile {
        model: context.source().name(),
        power: found,
        rig: &context.rig().name,
        version: env!("CARGO_PKG_VERSION"),
    };
    stamped(SCHEMA, &page)
}

fn effect<'a>(finding: &'a Finding, units: &Units) -> EffectPower<'a> {
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
        Example { law: fault.law, magnitude, quantity: fault.quantity, size: fault.size, unit }
    });
    EffectPower {
        ci90: finding.conclusion.interval.map(end),
        draws: finding.draws.iter().map(draw).collect(),
        effect: finding.effect,
        example,
        found: Counts { class: answers.in_class, named: answers.named, of: answers.of },
        found_at_most: is_injected.then_some(finding.found_at_most),
        found_next: is_injected.then_some(finding.found_next),
        instead: finding.instead().map(|(answer, count)| Instead { answer, count }),
        outcome,
        reached: is_injected.then(|| finding.reached()),
        reason,
        size,
        without_fault: finding.without_fault,
    }
}

fn draw(draw: &Draw) -> DrawFile<'_> {
    match draw {
        Draw::Diagnosed { fault, answer } => DrawFile::Diagnosed {
            answer: answer.reported(),
            found: answer.is_found(),
            law: fault.law,
            magnitude: fault.magnitude,
            injection: fault.injection.name(),
            raw_size: fault.raw,
            size: fault.size,
            unit: fault.unit,
            wanted_size: fault.wanted,
        },
        Draw::Refused(reason) => DrawFile::Refused { refused: reason },
    }
}
