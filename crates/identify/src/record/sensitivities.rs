//! The filtered error of a system and its derivatives by quantities, free of the traces of initial states.

use super::criterion::Criterion;
use super::stretch::Stretch;
use nalgebra::{DMatrix, DVector};
use switchback_model::linear::initial_state_responses;
use switchback_model::system::{Path, Quantity, Scale, System};
use switchback_noise::lanes::{Columns, Products};

/// `H = ΣwJᵀJ`, `g = ΣwJᵀe` and `Σρ(e)`, with `e = PD(y − ŷ)`, `J = PD ∂ŷ/∂θ` and `P` the projection off the initial states, in units of the filtered error's
/// standard deviation.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivities {
    /// `H`: the inverse of the covariance of the estimate.
    pub information: DMatrix<f64>,
    /// `g`.
    pub gradient: DVector<f64>,
    /// `Σρ(e)`.
    pub deviance: f64,
    /// `g` in each of consecutive blocks of samples.
    pub blocks: Vec<DVector<f64>>,
}

/// Blocks of a dataset over which a gradient is compared with itself.
const BLOCKS: usize = 24;

impl Sensitivities {
    /// At a system; derivatives by forward differences, which are exact for quantities in which the run is linear.
    pub fn of(
        system: &System,
        quantities: &[Quantity],
        stretches: &[Stretch],
        (criterion, scale): (&Criterion, &Scale),
    ) -> Self {
        let count = quantities.len();
        let differences = Differences::of(system, quantities, scale);
        let mut sums = Self::zero(count);
        for stretch in stretches {
            let path = system.path(&stretch.v, stretch.span);
            let run = stretch.respond(system, &path);
            let columns = differences.columns(stretch, &path, &run);
            sums.add(system, stretch, (&run, columns), criterion);
        }
        sums
    }

    fn zero(count: usize) -> Self {
        let (information, gradient) = (DMatrix::zeros(count, count), DVector::zeros(count));
        Self { information, gradient, deviance: 0.0, blocks: Vec::new() }
    }

    /// With given derivatives, one list a record and in it one column a quantity.
    pub fn with_columns(
        system: &System,
        columns: Vec<Vec<Vec<f64>>>,
        stretches: &[Stretch],
        criterion: &Criterion,
    ) -> Self {
        let count = columns.first().map_or(0, Vec::len);
        let mut sums = Self::zero(count);
        for (stretch, columns) in stretches.iter().zip(columns) {
            let run = stretch.simulate(system);
            sums.add(system, stretch, (&run, columns), criterion);
        }
        sums
    }

    /// `Σρ(e)` alone.
    pub fn deviance(system: &System, stretches: &[Stretch], criterion: &Criterion) -> f64 {
        let of = |stretch: &Stretch| {
            let run = stretch.simulate(system);
            let mut error = vec![errors(stretch, &run)];
            filter_and_project(system, stretch, &mut error, criterion);
            error[0].iter().map(|e| criterion.loss(*e)).sum::<f64>()
        };
        let sum: f64 = stretches.iter().map(of).sum();
        if sum.is_finite() { sum } else { f64::INFINITY }
    }

    fn add(
        &mut self,
        system: &System,
        stretch: &Stretch,
        (run, columns): (&[f64], Vec<Vec<f64>>),
        criterion: &Criterion,
    ) {
        let mut all = columns;
        all.push(errors(stretch, run));
        filter_and_project(system, stretch, &mut all, criterion);
        let error = all.pop().expect("the error is the last");
        let count = all.len();
        let weights: Vec<f64> =
            error.iter().map(|e| criterion.weight(*e) / (criterion.sd * criterion.sd)).collect();
        self.deviance += error.iter().map(|e| criterion.loss(*e)).sum::<f64>();
        let length = (stretch.span.total / BLOCKS).max(1);
        let mut products = Products::zeros(count);
        let mut rows = Columns::zeros(count, BATCH);
        let mut from = 0;
        while from < error.len() {
            // Blocks of the dataset: the first of a record goes on where the last record ended.
            let to = error.len().min(from + length - (stretch.span.before + from) % length);
            let mut gradient = DVector::zeros(count);
            for first in (from..to).step_by(BATCH) {
                let weights = &weights[first..to.min(first + BATCH)];
                for t in 0..weights.len() {
                    rows.column_mut(t).iter_mut().zip(&all).for_each(|(x, column)| *x = column[first + t]);
                }
                products.add(&rows, 0, weights);
                let right = DVector::from_fn(weights.len(), |t, _| weights[t] * error[first + t]);
                gradient.gemv(1.0, &rows.view(0, weights.len()), &right, 1.0);
            }
            self.gradient += &gradient;
            match self.blocks.last_mut() {
                Some(last) if from == 0 && !stretch.span.before.is_multiple_of(length) => *last += gradient,
                _ => self.blocks.push(gradient),
            }
            from = to;
        }
        self.information += products.matrix();
    }
}

/// Samples whose derivatives are multiplied at once.
const BATCH: usize = 128;

/// A system moved by small steps of some quantities.
pub(super) struct Differences<'a>(Vec<(&'a Quantity, System, f64)>);

impl<'a> Differences<'a> {
    pub(super) fn of(system: &System, quantities: &'a [Quantity], scale: &Scale) -> Self {
        let moved = |q: &'a Quantity| {
            let step = q.step(system, scale);
            (q, q.set(system, q.value(system) + step), step)
        };
        Self(quantities.iter().map(moved).collect())
    }

    /// Derivatives of the run on a record by each quantity, not filtered.
    pub(super) fn columns(&self, stretch: &Stretch, path: &Path, run: &[f64]) -> Vec<Vec<f64>> {
        let column = |(quantity, moved, step): &(&Quantity, System, f64)| {
            let other = if quantity.moves_the_path() {
                stretch.simulate_beside(moved, path)
            } else {
                stretch.respond(moved, path)
            };
            other.iter().zip(run).map(|(o, r)| (o - r) / step).collect()
        };
        self.0.iter().map(column).collect()
    }
}

/// Errors that are no numbers count as enormous ones.
pub(super) fn errors(stretch: &Stretch, run: &[f64]) -> Vec<f64> {
    stretch.y.iter().zip(run).map(|(y, r)| if r.is_finite() { y - r } else { 1e150 }).collect()
}

/// Filters signals of a record, zero where it skips samples, and removes the traces that initial states, and the border before the first move, could leave.
pub fn filter_and_project(
    system: &System,
    stretch: &Stretch,
    signals: &mut [Vec<f64>],
    criterion: &Criterion,
) {
    let mut traces = initial_state_responses(system.linear.a(), stretch.v.len() - stretch.skipped);
    traces.extend(
        system.response_to_the_first_border(&stretch.v).map(|mut all| all.split_off(stretch.skipped)),
    );
    let basis = orthonormal(traces, criterion);
    for signal in signals {
        let mut rest = criterion.filtered(signal.split_off(stretch.skipped));
        for direction in &basis {
            let share: f64 = direction.iter().zip(&rest).map(|(d, x)| d * x).sum();
            rest.iter_mut().zip(direction).for_each(|(x, d)| *x -= share * d);
        }
        signal.fill(0.0);
        signal.append(&mut rest);
    }
}

/// An orthonormal basis of filtered signals.
fn orthonormal(signals: Vec<Vec<f64>>, criterion: &Criterion) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for x in signals {
        let mut x = criterion.filtered(x);
        let before = norm(&x);
        for _ in 0..2 {
            for other in &basis {
                let share: f64 = other.iter().zip(&x).map(|(o, x)| o * x).sum();
                x.iter_mut().zip(other).for_each(|(x, o)| *x -= share * o);
            }
        }
        let after = norm(&x);
        if after > 1e-6 * before {
            x.iter_mut().for_each(|x| *x /= after);
            basis.push(x);
        }
    }
    basis
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_model::reversal::ReversalRule;
    use switchback_model::system::{Borders, LinearPart, Sensor, Span};

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
            let behind = stretch.behind_earlier_inputs(&system, 0);
            assert_eq!(behind.skipped, 8);
            assert!(deviance(behind.clone()) < 1e-12, "{from} {}", deviance(behind));
        }
    }
}
