//! The laws: one file an effect.

mod backlash;
mod border_wear;
mod creep;
mod extra_pole;
mod gain_drift;
mod gradual_transition;
mod inertia;
mod position_ripple;
mod rate_dependence;
mod record_offset;
mod regularised_friction;
mod resonance;
mod sensor_drift;
mod sensor_nonlinearity;
mod sensor_saturation;
mod step_change;
mod stribeck;

use super::law::Law;

/// The laws of machines, those of one effect beside each other.
pub const LAWS: [&dyn Law; 23] = [
    &backlash::Play,
    &gradual_transition::Relaxing,
    &gradual_transition::Elastic,
    &rate_dependence::Viscous,
    &rate_dependence::Root,
    &stribeck::Falling,
    &creep::Late,
    &creep::SinceReversal,
    &creep::AtRest,
    &inertia::Mass,
    &position_ripple::Ripple,
    &border_wear::Wear,
    &step_change::OfWidth,
    &step_change::OfGain,
    &extra_pole::Lag,
    &resonance::Parallel,
    &gain_drift::Straight,
    &sensor_drift::Straight,
    &record_offset::OfOneRecord,
    &sensor_nonlinearity::Square,
    &sensor_nonlinearity::Cube,
    &sensor_saturation::Above,
    &sensor_saturation::Below,
];

/// Laws that stand for a numerical remedy in simulators: nothing looks for them in a machine.
const NUMERICAL: [&dyn Law; 3] =
    [&regularised_friction::Clamped, &regularised_friction::Hyperbolic, &regularised_friction::Arctangent];

/// Laws of machines and of simulators.
pub fn every_law() -> impl Iterator<Item = &'static dyn Law> {
    LAWS.into_iter().chain(NUMERICAL)
}

#[cfg(test)]
mod tests {
    use super::every_law;
    use crate::reversal::ReversalRule;
    use crate::system::{Borders, LinearPart, Scale, Sensor, Span, System, Term};

    /// At strength zero no law changes anything, and from each start every law changes something.
    #[test]
    fn strength_zero_is_no_effect() {
        let points = [(-1.1, -2.0), (0.0, 0.3), (1.1, 2.0)];
        let lifted = points.map(|(v, u)| (v, u + 0.6));
        let system = System {
            borders: Borders::new(&points, &lifted).unwrap(),
            linear: LinearPart::new(&[-0.8], &[0.2], 1).unwrap().0,
            sensor: Sensor::EXACT,
            terms: Vec::new(),
            rule: ReversalRule::EXACT,
        };
        let input = |t: i32| (0.07 * f64::from(t)).sin() * (0.6 + 0.4 * (0.011 * f64::from(t)).cos());
        let v: Vec<f64> =
            (0..900).map(|t| if t % 100 < 20 { input(t - t % 100) } else { input(t) }).collect();
        let span = Span { record: 1, before: 300, total: 1500 };
        let bare = system.simulate(&v, span);
        let scale = Scale { records: 2, ..Scale::of(&system.linear, system.rule, &[(&v, &bare)]) };
        for law in every_law() {
            let mut noticed = false;
            for values in law.starts(&scale) {
                assert_eq!(values.len(), law.parameters().len(), "{law:?}");
                let term = Term { law, values };
                let with = |term: Term| System { terms: vec![term], ..system.clone() }.simulate(&v, span);
                assert_eq!(with(term.at_rest()), bare, "{law:?}");
                noticed |= with(term) != bare;
            }
            assert!(noticed, "{law:?}");
        }
    }
}
