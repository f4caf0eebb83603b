//! What an earlier measurement says of the system, to plan the next one with.

use super::DesignError;
use std::path::Path;
use switchback_identify::Estimate;
use switchback_io::identification::{self, EstimatedSystem, Identification, Method};
use switchback_model::hysteresis::{Interval, SwitchedHysteresis, Table, TablePoint};
use switchback_model::linear::LinearSystem;
use switchback_model::rig::{Rig, Usage};

/// A system identified from a rig, taken for the true one while planning.
#[derive(Debug, Clone)]
pub struct Truth {
    /// The rig's name.
    pub rig: String,
    /// The method that identified it.
    pub method: Method,
    /// The linear part.
    pub system: LinearSystem,
    /// Both borders, straight between the points estimated.
    pub hysteresis: SwitchedHysteresis,
    /// Standard deviation of the equation error, output units.
    pub noise_sd: f64,
    /// Points of the border that has most.
    pub points: usize,
    /// What to know before trusting the plan, one sentence each.
    pub notes: Vec<String>,
}

impl Truth {
    /// Identifies the rig by the best method that its records allow. `file` is what messages call it.
    ///
    /// # Errors
    /// [`DesignError`] if it cannot be identified, or the system is unstable or otherwise none to plan for.
    pub fn of(rig: &Rig, file: &Path) -> Result<Self, DesignError> {
        let method = identification::default_method(rig);
        let found = identification::identify(rig, method).map_err(|error| error.in_file(file))?;
        let refused = |reason: String| DesignError::NoSystem { rig: file.display().to_string(), reason };
        let Identification { estimate, flags, .. } = &found;
        let mut notes: Vec<String> = flags.iter().map(|flag| flag.text.clone()).collect();
        let interval = interval(rig).map_err(|error| refused(error.to_string()))?;
        let known = EstimatedSystem::new(estimate, interval).map_err(|reason| refused(reason.to_owned()))?;
        let [descending, ascending] = completed(known.borders(), interval, estimate, &mut notes);
        let borders =
            Table::new(table(ascending), table(descending)).map_err(|error| refused(error.to_string()))?;
        let hysteresis = SwitchedHysteresis::new(interval, Box::new(borders))
            .map_err(|error| refused(error.to_string()))?;
        let system = linear_part(estimate, &mut notes).map_err(|error| refused(error.to_string()))?;
        Ok(Self {
            rig: rig.name.clone(),
            method,
            system,
            noise_sd: equation_noise(rig, &found).unwrap_or(estimate.noise_sd),
            points: estimate.descending.len().max(estimate.ascending.len()),
            hysteresis,
            notes,
        })
    }
}

/// Standard deviation of the equation error `ξ` where the method shows another one: `free` minimises the error `r` of its simulation, and
/// reports that. What it leaves in the equation is `ξ = A(q⁻¹) r`.
fn equation_noise(rig: &Rig, found: &Identification) -> Option<f64> {
    let estimate = &found.estimate;
    if found.method != Method::Free {
        return None;
    }
    let (mut energy, mut rows) = (0.0, 0.0);
    let runs = rig.records.iter().zip(&found.runs).filter(|(record, _)| record.usage == Usage::Fit);
    for (record, run) in runs.filter_map(|(record, run)| Some((record, run.as_ref()?))) {
        let r: Vec<f64> = record.record.y().iter().zip(&run.simulated).map(|(y, z)| y - z).collect();
        for t in run.start + estimate.a.len()..r.len() {
            let past: f64 = estimate.a.iter().enumerate().map(|(i, a)| a * r[t - 1 - i]).sum();
            energy += (r[t] + past).powi(2);
            rows += 1.0;
        }
    }
    let parameters =
        [estimate.a.len(), estimate.b.len(), estimate.descending.len(), estimate.ascending.len()];
    let freedom = rows - parameters.iter().sum::<usize>() as f64;
    (freedom > 0.0).then(|| (energy / freedom).sqrt())
}

/// The interval declared, or the range of the fit records.
fn interval(rig: &Rig) -> Result<Interval, switchback_model::hysteresis::IntervalError> {
    let v = || rig.fit_records().flat_map(|record| record.record.v()).copied();
    let range = || Interval::new(v().fold(f64::INFINITY, f64::min), v().fold(f64::NEG_INFINITY, f64::max));
    rig.interval.map_or_else(range, Ok)
}

/// `(v, F)` of both borders by increasing `v`. Where one experiment is missing, its border is known at one point only; the other,
/// turned by half a turn about the middle of the loop, takes its place.
fn completed(
    borders: [&[(f64, f64)]; 2],
    interval: Interval,
    estimate: &Estimate,
    notes: &mut Vec<String>,
) -> [Vec<(f64, f64)>; 2] {
    let middle = (estimate.y_low + estimate.y_high) / estimate.gain;
    let turned = |border: &[(f64, f64)]| -> Vec<(f64, f64)> {
        border.iter().rev().map(|(v, f)| (interval.low() + interval.high() - v, middle - f)).collect()
    };
    let mut borders = borders.map(<[_]>::to_vec);
    for (missing, known, name) in [(0, 1, "descending"), (1, 0, "ascending")] {
        if borders[missing].len() == 1 && borders[known].len() > 1 {
            borders[missing] = turned(&borders[known]);
            notes.push(format!(
                "the rig does not show its {name} border; the plan takes the other one, turned by half a turn"
            ));
        }
    }
    borders
}

fn table(border: Vec<(f64, f64)>) -> Vec<TablePoint> {
    border.into_iter().map(|(v, u)| TablePoint { v, u }).collect()
}

/// A delay becomes leading zeros of `B`, so that the order covers it; what is faster than one sample is taken as one sample late.
fn linear_part(
    estimate: &Estimate,
    notes: &mut Vec<String>,
) -> Result<LinearSystem, switchback_model::linear::SystemError> {
    let delay = usize::try_from(estimate.delay).unwrap_or(0);
    let order = estimate.a.len().max(delay + estimate.b.len());
    let mut a = estimate.a.clone();
    let mut b = vec![0.0; delay];
    b.extend(&estimate.b);
    a.resize(order, 0.0);
    b.resize(order, 0.0);
    if order > estimate.a.len() {
        notes.push(format!(
            "the experiments are planned for order {order}, which covers the {} of the model identified",
            if delay > 0 { "delay" } else { "longer numerator" }
        ));
    }
    if estimate.delay < 0 {
        notes.push(format!(
            "the model identified answers {} early for a pulse experiment, which knows no answer within the same sample: record y \
             that much later, or identify by `--method free`",
            match -estimate.delay {
                1 => "1 sample".to_owned(),
                early => format!("{early} samples"),
            }
        ));
    }
    LinearSystem::new(a, b)
}
