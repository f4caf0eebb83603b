//! Which effects count as one class: confounded effects whose signatures nearly coincide.
//!
//! The table is independent of the diagnosis' own on purpose: an examination that took its classes from the examined would call right
//! whatever that confuses.

/// Pairs of effects that leave nearly the same trace. Right class: the answer is the true effect or its confounded effect.
///
/// The first five are the confounded effects that a trial with 18 effects measured (cosines of signatures 0.73 to 0.96, or the border
/// table absorbing one into the other). The others differ only in an exponent, in a corner, in who sees the shock, in whether a zero moves
/// within records or between them, or in how fast a gain or a loop changes.
const CONFOUNDED_EFFECTS: [(&str, &str); 13] = [
    ("input_delay", "extra_pole"),
    ("border_wear", "gain_drift"),
    ("rate_dependence", "creep"),
    ("coloured_noise", "output_noise"),
    ("backlash", "gradual_transition"),
    ("extra_pole", "resonance"),
    ("input_delay", "resonance"),
    ("rate_dependence", "stribeck"),
    ("sensor_saturation", "sensor_nonlinearity"),
    ("outliers", "input_noise"),
    ("sensor_drift", "record_offset"),
    ("gain_drift", "step_change"),
    ("border_wear", "step_change"),
];

/// Whether two effects are the same or confounded effects.
pub(crate) fn same_class(one: &str, other: &str) -> bool {
    one == other || CONFOUNDED_EFFECTS.iter().any(|&(a, b)| (a, b) == (one, other) || (b, a) == (one, other))
}

/// The effect with all its confounded effects.
#[cfg(test)]
pub(crate) fn class_of(effect: &str) -> Vec<&'static str> {
    crate::generate::EFFECTS.into_iter().filter(|other| same_class(effect, other)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::EFFECTS;
    use switchback_diagnose::Effect;

    #[test]
    fn confounded_effects_are_known_effects_and_the_relation_is_symmetric() {
        for (a, b) in CONFOUNDED_EFFECTS {
            assert!(EFFECTS.contains(&a) && EFFECTS.contains(&b));
            assert!(same_class(a, b) && same_class(b, a));
        }
        assert_eq!(class_of("sensor_drift"), ["sensor_drift", "record_offset"]);
        assert_eq!(class_of("periodic_disturbance"), ["periodic_disturbance"]);
    }

    /// To the examination the one for the other is a wrong answer.
    #[test]
    fn the_diagnosis_takes_two_pairs_more_for_confounded_effects() {
        let lists = |one: Effect, other: Effect| one.confounded_effects().contains(&other);
        let pairs = Effect::ALL
            .into_iter()
            .enumerate()
            .flat_map(|(k, one)| Effect::ALL.into_iter().skip(k + 1).map(move |other| (one, other)));
        let differ = pairs.filter(|(one, other)| {
            let known = lists(*one, *other) || lists(*other, *one);
            known != same_class(one.name(), other.name())
        });
        let differ: Vec<(&str, &str)> = differ.map(|(one, other)| (one.name(), other.name())).collect();
        assert_eq!(differ, [("input_noise", "coloured_noise"), ("creep", "extra_pole")]);
    }
}
