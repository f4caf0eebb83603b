//! A record with its place in the dataset.

use switchback_model::system::{Path, Span, System, delayed};

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

    /// The same, beyond what it skips already, without the samples that depend on inputs before the record by a system of this position and linear part, and
    /// without `later` samples more: others are compared with it on equal samples. The border of the first input is not known: it counts as an earlier one.
    #[must_use]
    pub fn behind_earlier_inputs(mut self, system: &System, later: usize) -> Self {
        let known = system.first_known_position(&self.v).unwrap_or(0);
        self.skipped = self.skipped.max(known + system.linear.largest_lag() + later + 1).min(self.v.len());
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
        let run = Self { carrier: Vec::new(), ..self.clone() }.simulate(system);
        let carrier = prediction.iter().zip(run).map(|(p, y)| p - y).collect();
        Self { carrier, ..self.clone() }
    }
}
