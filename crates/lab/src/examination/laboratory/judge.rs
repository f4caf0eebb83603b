//! Diagnosing a rig of the laboratory, and opening its key afterwards.

use super::key::recipe;
use super::place::check;
use crate::examination::case::{Answered, Baseline, Case};
use crate::examination::examiner::Examiner;
use crate::examination::fault::Fault;
use crate::examination::how::How;
use crate::examination::reply::ClosureCheck;
use crate::examination::scenario::Study;
use crate::examination::ticket::Ticket;
use crate::generate::{Key, MadeRig, MakeError, Nature, TrueEffect};
use switchback_diagnose::{Diagnosis, Effect, Model, Settings};

/// Diagnoses what a user's folder would hold, made again from the recipe, less the effect that is taken out of the library for this rig; then
/// compares with the key.
pub(crate) fn judged(
    study: &Study,
    (ticket, key): (&Ticket, &Key),
    examiner: Examiner,
) -> Result<Case, MakeError> {
    let made = recipe(study, ticket)?.again(key)?;
    let withheld = ticket.withheld.and_then(Effect::from_name);
    let settings = Settings::default().without(withheld.as_slice());
    let diagnosis = examiner(&made.rig, Model::Identify, &settings).ok();
    let mut faults = made.key.effects.iter().map(fault);
    Ok(Case {
        id: ticket.id,
        kind: ticket.kind,
        base: ticket.base.to_string(),
        is_measured: false,
        own: Vec::new(),
        fault: faults.next(),
        second: faults.next(),
        refused: None,
        answers: vec![answered(diagnosis.as_ref(), &made)],
    })
}

fn fault(put_in: &TrueEffect) -> Fault {
    Fault {
        effect: put_in.effect,
        law: put_in.law.to_owned(),
        plain: put_in.plain,
        how: How::Made,
        wanted: put_in.wanted,
        size: put_in.size,
        raw: None,
    }
}

fn answered(diagnosis: Option<&Diagnosis>, made: &MadeRig) -> Answered {
    Answered {
        closure: diagnosis.and_then(|d| closure(d, made)),
        baseline: Some(diagnosis.map_or_else(Baseline::default, Baseline::of)),
        places: match diagnosis {
            Some(d) if !made.key.effects.is_empty() => check(&d.where_, &made.rig, &made.truth),
            _ => Vec::new(),
        },
        ..Answered::of(false, diagnosis)
    }
}

/// What really closes is `1 − Σ(ȳ − ŷ_augmented)²/Σ(ȳ − ŷ_nominal)²` over the hold-out records, `ȳ` the output without noise.
fn closure(d: &Diagnosis, made: &MadeRig) -> Option<ClosureCheck> {
    let stated = d.gap.closure?;
    if made.key.effects.iter().all(|e| e.nature == Nature::Noise) {
        return None;
    }
    let (mut before, mut after) = (0.0, 0.0);
    for series in &d.series {
        let truth = made.truth.iter().find(|t| t.record == series.record)?;
        for (t, y) in truth.repeating.iter().enumerate() {
            before += (y - series.nominal.get(t)?).powi(2);
            after += (y - series.augmented.get(t)?).powi(2);
        }
    }
    (before > 0.0).then(|| ClosureCheck {
        estimate: stated.estimate,
        ci90: stated.ci90,
        actual: 1.0 - after / before,
    })
}
