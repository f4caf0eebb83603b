//! Whether other comparisons agree with a cause that is named, where nobody designed the records.
//!
//! There no likelihood is right: noise colour, poles and outliers gain one step ahead what a fault gains in simulation, and a rule that was
//! tuned on designed experiments names them for certain. So a cause is named only where two other readings of the same records agree:
//!
//! ```text
//! the fitted verdict       the likeliest of its effects
//! simulators               where such were identified anew and the cause moves a simulation: none that harms no held-out record both fits better
//!                          (BIC) and closes more of the gap on held-out records
//! ```
//!
//! A twin of the cause does not contradict it. Otherwise the cause and those put before it are told as rivals.

use crate::diagnosis::{Status, Verdict};
use crate::effect::Effect;
use crate::evidence::{Compared, Comparison, EffectEvidence};

/// The verdict, or one that tells the cause among its [rivals].
pub(crate) fn agreed(
    verdict: Verdict,
    evidence: &[Compared],
    likeliest: Option<Effect>,
    is_no_cause: impl Fn(Effect) -> bool,
) -> Verdict {
    let (Status::Named, &[cause]) = (verdict.status, &verdict.effects[..]) else { return verdict };
    let mut class = rivals(cause, evidence, likeliest, is_no_cause);
    if class.is_empty() {
        return verdict;
    }
    class.insert(0, cause);
    let stage = class.iter().all(|effect| effect.stage() == cause.stage()).then(|| cause.stage());
    Verdict {
        status: Status::Ambiguous,
        effects: Vec::new(),
        class,
        stage: stage.or(verdict.stage),
        calibrated: false,
        corrected_by: None,
        ..verdict
    }
}

/// The effects that other readings put before a cause, two at most. `likeliest` is the first effect of the fitted verdict, `is_no_cause` tells
/// effects that are no candidates.
pub(super) fn rivals(
    cause: Effect,
    evidence: &[Compared],
    likeliest: Option<Effect>,
    is_no_cause: impl Fn(Effect) -> bool,
) -> Vec<Effect> {
    let simulator = simulator_before(cause, evidence, is_no_cause).filter(|_| !cause.moves_no_simulation());
    let likeliest = likeliest.filter(|other| differ(cause, *other));
    let mut rivals: Vec<Effect> = simulator.into_iter().chain(likeliest).collect();
    rivals.dedup();
    rivals
}

/// Whether two effects are neither the same nor twins.
fn differ(cause: Effect, other: Effect) -> bool {
    other != cause && !cause.twins().contains(&other)
}

/// The best simulator identified anew with another effect that fits better and closes more of the gap on held-out records, if there is one.
fn simulator_before(
    cause: Effect,
    evidence: &[Compared],
    is_no_cause: impl Fn(Effect) -> bool,
) -> Option<Effect> {
    let says = evidence.iter().find(|says| says.comparison == Comparison::Simulation)?;
    let reached = |says: &EffectEvidence| (says.delta_bic.max(0.0), says.closure.unwrap_or_default());
    let (gain, closure) = says.of(cause).filter(|says| !says.harms).map_or((0.0, 0.0), reached);
    // The best in penalised deviance comes first.
    let better = says.effects.iter().find(|other| {
        let (of_other, closes) = reached(other);
        let counts = !other.harms && !is_no_cause(other.effect) && differ(cause, other.effect);
        counts && of_other > gain && closes > closure
    });
    better.map(|other| other.effect)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verdict::decide::naming_nothing;
    use crate::verdict::fitted::examples::{compared, says};

    fn named(cause: Effect) -> Verdict {
        let effects = vec![cause];
        Verdict { effects, ..naming_nothing(Status::Named, Some(cause.stage()), 0.95) }
    }

    /// Simulators of which one harms a held-out record, in the order of their gains, with what they close.
    fn simulators(order: [(Effect, f64); 2]) -> Vec<Compared> {
        let harming =
            EffectEvidence { harms: true, closure: Some(0.99), ..says(Effect::SensorDrift, 900.0, 0.5, 5.0) };
        let one = |(effect, closure), gain| EffectEvidence {
            closure: Some(closure),
            ..says(effect, gain, 0.5, 5.0)
        };
        vec![compared(Comparison::Simulation, vec![harming, one(order[0], 80.0), one(order[1], 20.0)])]
    }

    #[test]
    fn what_all_put_first_is_named() {
        let evidence = simulators([(Effect::Creep, 0.5), (Effect::SensorSaturation, 0.6)]);
        let verdict = agreed(named(Effect::Creep), &evidence, Some(Effect::Creep), |_| false);
        assert_eq!(verdict, named(Effect::Creep));
        // A twin does not contradict, and without simulators the fitted verdict decides.
        let verdict = agreed(named(Effect::Creep), &evidence, Some(Effect::RateDependence), |_| false);
        assert_eq!(verdict, named(Effect::Creep));
        assert_eq!(agreed(named(Effect::Creep), &[], Some(Effect::Creep), |_| false), named(Effect::Creep));
    }

    #[test]
    fn what_either_contradicts_is_told_among_its_rivals() {
        let evidence = simulators([(Effect::SensorSaturation, 0.6), (Effect::Creep, 0.5)]);
        let of = |likeliest| agreed(named(Effect::Creep), &evidence, Some(likeliest), |_| false);
        let rivals = of(Effect::Creep);
        assert_eq!(rivals.status, Status::Ambiguous);
        assert_eq!(rivals.class, [Effect::Creep, Effect::SensorSaturation]);
        assert!(rivals.effects.is_empty() && !rivals.calibrated);
        assert_eq!(of(Effect::SensorSaturation).class, [Effect::Creep, Effect::SensorSaturation]);
        assert_eq!(of(Effect::Resonance).class, [Effect::Creep, Effect::SensorSaturation, Effect::Resonance]);
        let fitted = agreed(named(Effect::Creep), &[], Some(Effect::Resonance), |_| false);
        assert_eq!(fitted.class, [Effect::Creep, Effect::Resonance]);
    }

    #[test]
    fn what_fits_better_and_closes_less_does_not_contradict() {
        let evidence = simulators([(Effect::SensorSaturation, 0.1), (Effect::Creep, 0.5)]);
        assert_eq!(
            agreed(named(Effect::Creep), &evidence, Some(Effect::Creep), |_| false),
            named(Effect::Creep)
        );
        // What has no simulator is behind any that closes something.
        let verdict = agreed(named(Effect::GainDrift), &evidence, Some(Effect::GainDrift), |_| false);
        assert_eq!(verdict.class, [Effect::GainDrift, Effect::SensorSaturation]);
    }

    #[test]
    fn simulators_say_nothing_of_what_moves_none_and_of_what_is_no_cause() {
        let evidence = simulators([(Effect::SensorSaturation, 0.6), (Effect::Creep, 0.5)]);
        let noise = agreed(named(Effect::Outliers), &evidence, Some(Effect::Outliers), |_| false);
        assert_eq!(noise, named(Effect::Outliers));
        let left_out = |effect| effect == Effect::SensorSaturation;
        let verdict = agreed(named(Effect::Creep), &evidence, Some(Effect::Creep), left_out);
        assert_eq!(verdict, named(Effect::Creep));
    }

    #[test]
    fn only_a_single_cause_is_asked_about() {
        let evidence = simulators([(Effect::SensorSaturation, 0.6), (Effect::Creep, 0.5)]);
        let none = naming_nothing(Status::None, None, 0.8);
        assert_eq!(agreed(none.clone(), &evidence, Some(Effect::Resonance), |_| false), none);
        let both = Verdict { effects: vec![Effect::Creep, Effect::Backlash], ..named(Effect::Creep) };
        assert_eq!(agreed(both.clone(), &evidence, Some(Effect::Resonance), |_| false), both);
    }
}
