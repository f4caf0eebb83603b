//! Free runs of a model on its own.

use std::sync::Arc;
use switchback_identify::statistics::Z95;

use switchback_identify::free::fit_percent;
use switchback_model::rig::{Role, Usage};

use super::band::variances;
use super::lasting::{notes, power_of_waves, without_waves};
use super::portable::{PortableModel, Wire};
use crate::records::dataset::{Dataset, ScaledRecord, dimensionless, first_counted, led, warm_up};
use crate::records::motion::{Play, motions};
use crate::records::passes::Passes;
use crate::simulation::simulate::{Begins, Prepared, sensed};

/// A free run over an input, output units.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulated {
    /// One output a sample; the measured ones before `start`.
    pub y: Vec<f64>,
    /// Lower end of the 95 % band for a measured output, a sample each; the measured one before `start`.
    pub low: Vec<f64>,
    /// Upper end.
    pub high: Vec<f64>,
    /// First simulated sample.
    pub start: usize,
    /// `100·(1 − ‖y − ŷ‖ / ‖y − ȳ‖)` over the simulated samples, where there are measured ones.
    pub fit_percent: Option<f64>,
    /// The record of the dataset that the samples are, whose place on the clock the run keeps.
    pub record: Option<String>,
    /// What was assumed, one sentence each.
    pub notes: Vec<String>,
}

/// An input on the model's scales.
struct Input<'a> {
    /// Number of the record among those of the dataset, or the next one.
    number: usize,
    scaled: ScaledRecord,
    /// Samples of rest put before the input.
    before: usize,
    /// The measured output.
    y: Option<&'a [f64]>,
}

impl PortableModel {
    /// Runs on an input. With a measured output of the same length, its samples before the first counted one (twelve after the input
    /// first moves) are the initial state, as in a diagnosis; without, the run begins at rest at the first input.
    ///
    /// Where both are the samples of a record of the dataset, slow changes follow its place on the dataset's clock, and the run is that
    /// of the diagnosis to the last bit. Elsewhere they stay as they were at the end, and [`Simulated::notes`] says so.
    ///
    /// # Panics
    /// If the input is empty, or the output is of another length.
    pub fn simulate(&self, v: &[f64], y: Option<&[f64]>) -> Simulated {
        let record = y.and_then(|y| self.0.clock.find(v, y));
        self.run(v, y, record, true)
    }

    /// The run alone over a record of the dataset, given by its number: without band and figures.
    #[cfg(test)]
    pub(crate) fn outputs(&self, number: usize, v: &[f64], y: &[f64]) -> Vec<f64> {
        assert!(number < self.0.clock.records.len(), "the dataset has no record {number}");
        self.run(v, Some(y), Some(number), false).y
    }

    /// The run over a record of the dataset, given by its number, with its band.
    ///
    /// # Panics
    /// If there is no such record, it is empty, or its input and output differ in length.
    pub fn banded(&self, number: usize, v: &[f64], y: &[f64]) -> Simulated {
        assert!(number < self.0.clock.records.len(), "the dataset has no record {number}");
        self.run(v, Some(y), Some(number), true)
    }

    /// Whether errors of its parameters are known, so that a band holds them.
    pub fn has_covariance(&self) -> bool {
        self.0.covariance.is_some()
    }

    fn run(&self, v: &[f64], y: Option<&[f64]>, record: Option<usize>, with_band: bool) -> Simulated {
        assert!(!v.is_empty() && y.is_none_or(|y| y.len() == v.len()), "one output a sample");
        let model = &self.0;
        let input = model.input(v, y, record);
        let dataset = model.dataset(&input);
        let is_new = record.is_none();
        let linear =
            if is_new { without_waves(&model.linear, &model.augmented) } else { model.linear.clone() };
        let begins = match y {
            Some(_) => Begins::Measured { variance: model.variance },
            None => Begins::Rest,
        };
        let prepared =
            |augmented| Prepared::new(&dataset, (&model.grid, augmented), input.number, &input.scaled);
        let fitted = prepared(&model.augmented);
        let x = fitted.run(&linear, begins);
        let y_run = fitted.read(&input.scaled, &x);
        let from = input.scaled.from;
        let half = if with_band {
            let waves = if is_new { power_of_waves(&model.linear, &model.augmented) } else { 0.0 };
            let noise = model.output_noise + waves;
            let moved = |j: usize| prepared(&model.moved[j].augmented).run(&linear, begins);
            let errors = variances(model, &linear, |p| fitted.run(p, begins), moved);
            let errors = errors.filter(|e| e.len() == x.len()).unwrap_or_else(|| vec![0.0; x.len()]);
            errors.iter().map(|error| Z95 * (error + noise).sqrt()).collect()
        } else {
            vec![0.0; x.len()]
        };
        let end = |sign: f64| -> Vec<f64> {
            let ends = (from..x.len()).map(|t| sensed(&model.augmented, x[t] + sign * half[t]));
            y_run[..from].iter().copied().chain(ends).collect()
        };
        let physical = |y: &[f64]| -> Vec<f64> {
            y[input.before..].iter().map(|y| model.scales.y_mean + model.scales.y_scale * y).collect()
        };
        Simulated {
            low: physical(&end(-1.0)),
            high: physical(&end(1.0)),
            fit_percent: (input.y.is_some() && from < y_run.len())
                .then(|| fit_percent(&input.scaled.y[from..], &y_run[from..])),
            y: physical(&y_run),
            start: from - input.before,
            record: record.map(|number| model.clock.records[number].name.clone()),
            notes: if is_new { notes(&model.augmented) } else { Vec::new() },
        }
    }
}

impl Wire {
    /// The input as the model sees it, on the place of a record of the dataset or after all of them.
    fn input<'a>(&self, v: &[f64], y: Option<&'a [f64]>, record: Option<usize>) -> Input<'a> {
        let s = self.scales;
        let warm_up = warm_up(self.linear.a.len());
        let before = if y.is_some() { 0 } else { warm_up };
        let mut scaled = dimensionless(v, s.v_low, s.v_width);
        scaled.splice(0..0, vec![scaled[0]; before]);
        let from = if y.is_some() { first_counted(&scaled, warm_up) } else { before };
        let measured = y.map_or_else(|| vec![0.0; scaled.len()], |y| dimensionless(y, s.y_mean, s.y_scale));
        scaled = led(&scaled, self.lead);
        let placed = record.map(|number| &self.clock.records[number]);
        let scaled = ScaledRecord {
            name: placed.map_or_else(|| "input".to_owned(), |placed| placed.name.clone()),
            role: Role::Free,
            usage: if placed.is_some_and(|placed| placed.fit) { Usage::Fit } else { Usage::Holdout },
            y: measured.into(),
            clock: placed.map_or(self.clock.total, |placed| placed.clock),
            before: placed.map_or(self.clock.records.len(), |placed| placed.before),
            travelled: placed.map_or(self.clock.travel, |placed| placed.travelled),
            period: None,
            from,
            moves: motions(&scaled, Play::default(), self.rule).into(),
            v: scaled.into(),
            standing: placed.is_none(),
        };
        Input { number: record.unwrap_or(self.clock.records.len()), scaled, before, y }
    }

    /// The dataset with this input in its place and empty records elsewhere: no run looks at another record.
    fn dataset(&self, input: &Input<'_>) -> Dataset {
        let empty = |placed: &super::place::Placed| ScaledRecord {
            name: placed.name.clone(),
            role: Role::Free,
            usage: if placed.fit { Usage::Fit } else { Usage::Holdout },
            v: Vec::new().into(),
            y: Vec::new().into(),
            clock: placed.clock,
            before: placed.before,
            travelled: placed.travelled,
            period: None,
            from: 0,
            moves: Arc::default(),
            standing: false,
        };
        let mut scaled_records: Vec<ScaledRecord> = self.clock.records.iter().map(empty).collect();
        match scaled_records.get_mut(input.number) {
            Some(scaled) => *scaled = input.scaled.clone(),
            None => scaled_records.push(input.scaled.clone()),
        }
        Dataset {
            passes: Passes::default(),
            // Runs count in samples.
            sample_time: 1.0,
            scaled_records,
            v_low: self.scales.v_low,
            v_width: self.scales.v_width,
            y_mean: self.scales.y_mean,
            y_scale: self.scales.y_scale,
            levels: Vec::new(),
            total: self.clock.total,
            travel: self.clock.travel,
            rule: self.rule,
            criterion: self.criterion,
            known_borders: None,
            lead: self.lead,
        }
    }
}
