//! Errors of free runs without the traces of initial states.

use switchback_identify::record::{Criterion, Stretch, filter_and_project};
use switchback_model::system::System;

/// Errors of the free runs, without the traces of initial states.
pub(super) fn errors(system: &System, stretches: &[Stretch]) -> Vec<Vec<f64>> {
    stretches.iter().map(|s| error(s, system).split_off(s.skipped)).collect()
}

/// The record with a carrier that makes the system's run exact but for the traces of an initial state: the source's own is not the machine's.
pub(super) fn carrying_without_initial_state(
    stretch: &Stretch,
    system: &System,
    prediction: &[f64],
) -> Stretch {
    let carrying = stretch.carrying(system, prediction);
    let carrier = without_initial_state(&carrying, system, carrying.carrier.clone());
    Stretch { carrier, ..carrying }
}

/// The error of the free run without the traces of an initial state.
fn error(stretch: &Stretch, system: &System) -> Vec<f64> {
    let error = stretch.simulate(system).iter().zip(&stretch.y).map(|(run, y)| y - run).collect();
    without_initial_state(stretch, system, error)
}

/// A signal of a record without the traces of an initial state; zero where the record skips samples.
fn without_initial_state(stretch: &Stretch, system: &System, signal: Vec<f64>) -> Vec<f64> {
    let mut signal = [signal];
    filter_and_project(system, stretch, &mut signal, &Criterion { filter: Vec::new(), sd: 1.0 });
    let [signal] = signal;
    signal
}

/// The run of a system from the initial state that lies nearest to the record; the record itself where it skips samples.
pub(super) fn run_from_the_state_of(stretch: &Stretch, system: &System) -> Vec<f64> {
    stretch.y.iter().zip(error(stretch, system)).map(|(y, error)| y - error).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_model::reversal::ReversalRule;
    use switchback_model::system::{Borders, LinearPart, Sensor, Span};

    #[test]
    fn the_initial_state_of_another_source_is_not_carried() {
        let system = System {
            borders: Borders::new(&[(-1.0, -2.4), (1.0, 1.6)], &[(-1.0, -1.6), (1.0, 2.4)]).expect("tables"),
            linear: LinearPart::new(&[-0.9], &[0.1], 1).expect("stable").0,
            sensor: Sensor::EXACT,
            terms: Vec::new(),
            rule: ReversalRule::EXACT,
        };
        let v: Vec<f64> = (0..600).map(|t| (0.07 * f64::from(t)).sin()).collect();
        let mut other = system.simulate(&v, Span::alone(v.len()));
        other.iter_mut().enumerate().for_each(|(t, y)| *y += 3.0 * 0.9_f64.powf(t as f64));
        let stretch = Stretch::all(&[(&v, &other)]).remove(0).behind_earlier_inputs(&system, 0);
        let largest = |carrier: &[f64]| carrier.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        assert!(largest(&stretch.carrying(&system, &other).carrier) > 2.0);
        // Traces are followed until a millionth of them is left.
        assert!(largest(&carrying_without_initial_state(&stretch, &system, &other).carrier) < 3e-6);
    }
}
