//! A record with its place in the dataset.

use super::criterion::Criterion;
use super::sensitivities::filter_and_project;
use switchback_model::system::{LinearPart, Path, Span, System, delayed};

/// A record that is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// The input.
    pub v: Vec<f64>,
    /// The output.
    pub y: Vec<f64>,
    /// The part of another source's prediction that a system leaves open, added before the sensor; empty where there is none.
    pub carrier: Vec<f64>,
    /// Its place in the dataset.
    pub span: Span,
    /// Samples at its beginning that are not compared: they depend on inputs before the record.
    pub skipped: usize,
}

impl Stretch {
    /// Records one after the other, given as `(v, y)`.
    pub fn all(records: &[(&[f64], &[f64])]) -> Vec<Self> {
        let total = records.iter().map(|(v, _)| v.len()).sum();
        let mut before = 0;
        let stretch = |(record, (v, y)): (usize, &(&[f64], &[f64]))| {
            let span = Span { record, before, total };
            before += v.len();
            Self { v: v.to_vec(), y: y.to_vec(), carrier: Vec::new(), span, skipped: 0 }
        };
        records.iter().enumerate().map(stretch).collect()
    }

    /// The same without the samples that depend on inputs before the record, by a linear part as long as this one and `later` samples later: systems are
    /// compared on equal samples.
    ///
    /// The first input counts as one before it: the border on which that lies is not known.
    #[must_use]
    pub fn behind_earlier_inputs(mut self, linear: &LinearPart, later: usize) -> Self {
        self.skipped = (linear.largest_lag() + later + 1).min(self.v.len());
        self
    }

    /// The output of a system along its path on this record, the carrier added.
    pub fn respond(&self, system: &System, path: &Path) -> Vec<f64> {
        if self.carrier.is_empty() {
            return system.respond(path, &[]);
        }
        if system.linear.delay == 0.0 {
            return system.respond(path, &self.carrier);
        }
        system.respond(path, &delayed(&self.carrier, system.linear.delay))
    }

    /// The free run of a system.
    pub fn simulate(&self, system: &System) -> Vec<f64> {
        self.respond(system, &system.path(&self.v, self.span))
    }

    /// The free run of a system where the path of another one on this record is known.
    pub fn simulate_beside(&self, system: &System, known: &Path) -> Vec<f64> {
        self.respond(system, &system.path_beside(&self.v, self.span, known))
    }

    /// Makes the system's run exact for this record, of which `prediction` is the run of another source.
    #[must_use]
    pub fn carrying(&self, system: &System, prediction: &[f64]) -> Self {
        let carrier = self.difference(system, prediction);
        Self { carrier, ..self.clone() }
    }

    /// The same but for the traces of an initial state: that of the other source is no other system's.
    #[must_use]
    pub fn carrying_without_initial_state(&self, system: &System, prediction: &[f64]) -> Self {
        let mut carrier = [self.difference(system, prediction)];
        filter_and_project(system, self, &mut carrier, &Criterion { filter: Vec::new(), sd: 1.0 });
        let [carrier] = carrier;
        Self { carrier, ..self.clone() }
    }

    /// The prediction beside the free run of a system.
    fn difference(&self, system: &System, prediction: &[f64]) -> Vec<f64> {
        let run = Self { carrier: Vec::new(), ..self.clone() }.simulate(system);
        prediction.iter().zip(run).map(|(p, y)| p - y).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::sensitivities::Sensitivities;
    use super::*;
    use switchback_model::reversal::ReversalRule;
    use switchback_model::system::{Borders, Sensor};

    /// The end of a record is compared as well as the whole of it: what inputs before it did is seen in its first samples alone.
    #[test]
    fn inputs_before_a_record_cost_nothing() {
        let system = System {
            borders: Borders::new(&[(-1.0, -2.4), (1.0, 1.6)], &[(-1.0, -1.6), (1.0, 2.4)]).expect("tables"),
            linear: LinearPart::new(&[-1.2, 0.5], &[0.2, 0.1], 6).expect("stable").0,
            sensor: Sensor::EXACT,
            terms: Vec::new(),
            rule: ReversalRule::EXACT,
        };
        let v: Vec<f64> = (0..600).map(|t| (0.07 * f64::from(t)).sin()).collect();
        let y = system.simulate(&v, Span::alone(v.len()));
        let criterion = Criterion { filter: vec![-0.3], sd: 0.01 };
        for from in [0, 200, 201, 310, 404] {
            let stretch = Stretch::all(&[(&v[from..], &y[from..])]).remove(0);
            let deviance = |stretch| Sensitivities::deviance(&system, &[stretch], &criterion);
            let whole = deviance(stretch.clone());
            assert!(from == 0 || whole > 10.0, "{from} {whole}");
            let behind = stretch.behind_earlier_inputs(&system.linear, 0);
            assert_eq!(behind.skipped, 8);
            assert!(deviance(behind.clone()) < 1e-16, "{from} {}", deviance(behind));
        }
    }

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
        other.iter_mut().enumerate().for_each(|(t, y)| *y += 3.0 * libm::pow(0.9, t as f64));
        let stretch = Stretch::all(&[(&v, &other)]).remove(0).behind_earlier_inputs(&system.linear, 0);
        let largest = |carrier: &[f64]| carrier.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        assert!(largest(&stretch.carrying(&system, &other).carrier) > 2.0);
        assert!(largest(&stretch.carrying_without_initial_state(&system, &other).carrier) < 1e-9);
    }
}
