//! From judged rigs to examples that a verdict is fitted to.

use crate::examination::{Answered, Case, Kind, Reply};
use switchback_diagnose::fitted::{Example, Holds};
use switchback_diagnose::{Effect, Status, Verdict};

/// Where an answer is: the case and the answer by their position.
pub(super) type Place = (usize, usize);

/// What belongs to the model of records that nobody designed.
const NO_CAUSE: Effect = Effect::ColouredNoise;

/// Every answer that a fitted verdict could have given, with its place.
pub(super) fn examples(cases: &[Case]) -> Vec<(Place, Example)> {
    let of_case = |(k, case): (usize, &Case)| -> Vec<(Place, Example)> {
        let answers = case.answers.iter().enumerate();
        answers.filter_map(|(j, answer)| Some(((k, j), example(case, answer)?))).collect()
    };
    cases.iter().enumerate().flat_map(of_case).collect()
}

/// The example of an answer; none where rules show two causes, or nothing was diagnosed.
fn example(case: &Case, answer: &Answered) -> Option<Example> {
    let by_rules = answer.rules();
    if answer.evidence.compared.is_empty() || by_rules.effects.len() > 1 {
        return None;
    }
    let base = if case.is_measured { case.base.clone() } else { format!("made {}", case.base) };
    let law = case.fault.as_ref().map(|fault| format!("{}: {}", fault.effect, fault.law));
    let holds = holds(case);
    Some(Example {
        base,
        law,
        evidence: answer.evidence.compared.clone(),
        excluded: vec![NO_CAUSE],
        rules: (
            reported(by_rules)?,
            Effect::from_name(by_rules.top.0).map(|effect| (effect, by_rules.top.1)),
        ),
        by_rules: given_by(by_rules, &holds),
        holds,
    })
}

/// The verdict that a reply shows; none where there was none.
fn reported(reply: &Reply) -> Option<Verdict> {
    let status = Status::ALL.into_iter().find(|status| status.name() == reply.status)?;
    let known = |names: &[&str]| names.iter().filter_map(|name| Effect::from_name(name)).collect();
    Some(Verdict {
        status,
        effects: known(&reply.effects),
        class: known(&reply.class),
        stage: None,
        probability: reply.probability,
        calibrated: false,
        corrected_by: None,
        refit: None,
        held_out_error_ratio: None,
    })
}

/// What holds of a rig. What a measured base shows by itself nobody knows; a fault too small to be asked for may as well be none.
fn holds(case: &Case) -> Holds {
    let own = case.own.iter();
    let mut holds =
        Holds { effects: own.filter_map(|name| Effect::from_name(name)).collect(), ..Holds::default() };
    match (case.kind, &case.fault) {
        (Kind::Injected, Some(fault)) => {
            holds.effects.extend(Effect::from_name(fault.effect));
            holds.none = !fault.is_observable();
        }
        (Kind::Outside, Some(fault)) => {
            holds.none_of_these = true;
            holds.none = !fault.is_observable();
        }
        (Kind::Bare, _) if case.is_measured => {}
        _ => holds.none = true,
    }
    holds
}

/// Probability that a reply gives to what holds: what it claims, or its part of the rest.
fn given_by(reply: &Reply, holds: &Holds) -> f64 {
    let p = reply.probability;
    let known = |names: &[&str]| names.iter().any(|name| holds.effects.iter().any(|e| e.name() == *name));
    let right = match reply.status {
        "named" => known(&reply.effects),
        "class" | "ambiguous" => known(&reply.class),
        "none" | "refit" => holds.none,
        "unexplained" => holds.none_of_these,
        _ => return 0.0,
    };
    let claimed = reply.effects.len().max(reply.class.len()).max(1) as f64;
    let others = Effect::ALL.len() as f64 + 2.0 - claimed;
    if right { p / claimed } else { (1.0 - p) / others }
}
