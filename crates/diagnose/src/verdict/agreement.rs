//! Whether other comparisons agree with a cause that is named, where nobody designed the records.
//!
//! There no likelihood is right: noise colour, poles and outliers gain one step ahead what a fault gains in simulation, and a rule that was
//! tuned on designed experiments names them for certain. So a cause of theirs counts only where two other readings of the same records agree:
//!
//! ```text
//! the fitted verdict       the likeliest of its effects
//! simulators               where such were identified anew and the cause moves a simulation: none that degrades no held-out record both fits better
//!                          (BIC) and closes more of the gap on held-out records
//! ```
//!
//! A confounded effect of the cause does not contradict it. How often such a cause is the right one is counted when the verdict is fitted.

use crate::comparison::{Compared, Comparison, EffectEvidence};
use crate::effect::Effect;

/// Whether no other reading puts another effect before a cause. `likeliest` is the first effect of the fitted verdict, `is_no_cause` shows
/// effects that are no candidates.
pub(super) fn agrees(
    cause: Effect,
    evidence: &[Compared],
    likeliest: Option<Effect>,
    is_no_cause: impl Fn(Effect) -> bool,
) -> bool {
    let by_simulators =
        || cause.moves_no_simulation() || simulator_before(cause, evidence, is_no_cause).is_none();
    likeliest.is_none_or(|other| !differ(cause, other)) && by_simulators()
}

/// Whether two effects are neither the same nor confounded effects.
fn differ(cause: Effect, other: Effect) -> bool {
    other != cause && !cause.confounded_effects().contains(&other)
}

/// The best simulator identified anew with another effect that fits better and closes more of the gap on held-out records than those with the
/// cause or a confounded effect of it, if there is one.
fn simulator_before(
    cause: Effect,
    evidence: &[Compared],
    is_no_cause: impl Fn(Effect) -> bool,
) -> Option<Effect> {
    let says = evidence.iter().find(|says| says.comparison == Comparison::Simulation)?;
    let reached = |says: &EffectEvidence| (says.delta_bic.max(0.0), says.closure.unwrap_or_default());
    let of_cause = says
        .effects
        .iter()
        .filter(|says| !says.degrades_validation && !differ(cause, says.effect))
        .map(reached);
    let (gain, closure) = of_cause.fold((0.0_f64, 0.0_f64), |best, of| (best.0.max(of.0), best.1.max(of.1)));
    // The best in penalised deviance comes first.
    let better = says.effects.iter().find(|other| {
        let (of_other, closes) = reached(other);
        let counts = !other.degrades_validation && !is_no_cause(other.effect) && differ(cause, other.effect);
        counts && of_other > gain && closes > closure
    });
    better.map(|other| other.effect)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verdict::fitted::examples::{compared, says};

    /// Simulators of which one degrades a held-out record, in the order of their gains, with what they close.
    fn simulators(order: [(Effect, f64); 2]) -> Vec<Compared> {
        let harming = EffectEvidence {
            degrades_validation: true,
            closure: Some(0.99),
            ..says(Effect::SensorDrift, 900.0, 0.5, 5.0)
        };
        let one = |(effect, closure), gain| EffectEvidence {
            closure: Some(closure),
            ..says(effect, gain, 0.5, 5.0)
        };
        vec![compared(Comparison::Simulation, vec![harming, one(order[0], 80.0), one(order[1], 20.0)])]
    }

    #[test]
    fn all_readings_must_put_it_first_or_a_confounded_of_it() {
        let evidence = simulators([(Effect::Creep, 0.5), (Effect::SensorSaturation, 0.6)]);
        let agrees =
            |evidence: &[Compared], likeliest| agrees(Effect::Creep, evidence, Some(likeliest), |_| false);
        assert!(agrees(&evidence, Effect::Creep) && agrees(&evidence, Effect::RateDependence));
        assert!(!agrees(&evidence, Effect::Resonance) && !agrees(&[], Effect::Resonance));
        // Without simulators the fitted verdict decides.
        assert!(agrees(&[], Effect::Creep));
        let other = simulators([(Effect::SensorSaturation, 0.6), (Effect::Creep, 0.5)]);
        assert!(!agrees(&other, Effect::Creep));
    }

    #[test]
    fn a_simulator_must_fit_better_and_close_more() {
        let agrees = |evidence: &[Compared], cause| agrees(cause, evidence, Some(cause), |_| false);
        let closes_less = simulators([(Effect::SensorSaturation, 0.1), (Effect::Creep, 0.5)]);
        assert!(agrees(&closes_less, Effect::Creep));
        // A confounded effect stands for it.
        assert!(agrees(
            &simulators([(Effect::Creep, 0.5), (Effect::Resonance, 0.4)]),
            Effect::RateDependence
        ));
        // What has no simulator is behind any that closes something.
        assert!(!agrees(&closes_less, Effect::GainDrift));
    }

    #[test]
    fn simulators_say_nothing_of_what_moves_none_and_of_what_is_no_cause() {
        let evidence = simulators([(Effect::SensorSaturation, 0.6), (Effect::Creep, 0.5)]);
        assert!(agrees(Effect::Outliers, &evidence, Some(Effect::Outliers), |_| false));
        let left_out = |effect| effect == Effect::SensorSaturation;
        assert!(agrees(Effect::Creep, &evidence, Some(Effect::Creep), left_out));
    }
}
