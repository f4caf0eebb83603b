//! Refinement: the parameters that minimise the error of a free run.

use super::problem::{Parameters, Segment, Structure};
use super::rank_one::solve_symmetric;
use nalgebra::{DMatrix, DVector};
use switchback_model::linear::{is_stable, recurse};
use switchback_model::noise_model::whitened;
use switchback_noise::lanes::{Columns, Lagged, Products};

/// How hard a refinement tries.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    pub(super) iterations: usize,
    /// Relative decrease of the cost below which a step counts as the last.
    pub(super) tolerance: f64,
    /// Gauss–Newton steps taken beyond that: the sum of squares no longer shows what they gain, but the parameters do.
    pub(super) polish: usize,
}

impl Effort {
    /// Enough to show which start is best.
    pub(super) const TRIAL: Self = Self { iterations: 4, tolerance: 1e-3, polish: 0 };
    /// Enough to rank structures.
    pub(super) const SEARCH: Self = Self { iterations: 12, tolerance: 1e-3, polish: 0 };
    /// For the fit that is reported. Most end by the tolerance, after a few steps; along a coefficient that the records hardly show, later steps
    /// than these move the fit by less than a hundredth of its standard error.
    pub(super) const FINAL: Self = Self { iterations: 40, tolerance: 1e-12, polish: 2 };
    /// For one of many fits to simulated noise, from a start nearby: what is left is, of 10⁵ samples, a tenth of a standard error.
    pub(super) const REPEATED: Self = Self { iterations: 12, tolerance: 1e-7, polish: 0 };
}

/// The free run over a stretch: measured outputs before it, simulated ones from there on.
pub(super) fn free_run(structure: Structure, theta: &Parameters, segment: &Segment) -> Vec<f64> {
    let order = theta.a.len();
    let mut y = Vec::with_capacity(order + segment.len());
    y.extend_from_slice(&segment.y[segment.from - order..segment.from]);
    y.extend(driven(structure, theta, segment));
    recurse(&theta.a, &mut y);
    y.split_off(order)
}

/// `B(q⁻¹)u + c` over a stretch.
fn driven(structure: Structure, theta: &Parameters, segment: &Segment) -> Vec<f64> {
    // Of a long record only what the stretch answers to.
    let first = segment.from - structure.memory();
    let u = segment.cells.values(first..segment.to + structure.ahead(), &theta.f);
    let mut driven = vec![theta.c; segment.len()];
    for (i, b) in theta.b.iter().enumerate() {
        let lagged = &u[structure.input(segment.from, i) - first..];
        driven.iter_mut().zip(lagged).for_each(|(x, u)| *x += b * u);
    }
    driven
}

/// The free-run errors `y − ŷ` over a stretch.
pub(super) fn free_run_errors(structure: Structure, theta: &Parameters, segment: &Segment) -> Vec<f64> {
    let run = free_run(structure, theta, segment);
    run.iter().zip(&segment.y[segment.from..segment.to]).map(|(p, y)| y - p).collect()
}

/// Sum of squared free-run errors; infinite for an unstable `A`.
pub(super) fn cost(structure: Structure, theta: &Parameters, segments: &[Segment]) -> f64 {
    whitened_cost(structure, theta, segments, &[])
}

/// Sum of squared free-run errors, filtered by `D` and weighted; infinite for an unstable `A`.
pub(super) fn whitened_cost(
    structure: Structure,
    theta: &Parameters,
    segments: &[Segment],
    whitening: &[f64],
) -> f64 {
    if !is_stable(&theta.a) {
        return f64::INFINITY;
    }
    let square = |s: &Segment| -> f64 {
        let errors = whitened(free_run_errors(structure, theta, s), whitening);
        let counted = errors.iter().zip(s.from..).skip(s.counted_from - s.from);
        counted.map(|(e, t)| s.weight(t) * (e * e)).sum()
    };
    segments.iter().map(square).sum()
}

/// Gauss–Newton quantities of the free-run error `ε = D(y − ŷ)`: `H = ΣJᵀJ`, `g = ΣJᵀε`, over parameters a, b, f, c, with `J = D ∂ŷ/∂θ`.
#[derive(Debug, Clone)]
pub(super) struct Linearised {
    pub(super) information: DMatrix<f64>,
    pub(super) gradient: DVector<f64>,
    /// `g` over each batch of consecutive samples, for standard errors that allow for coloured residuals.
    pub(super) batches: Vec<DVector<f64>>,
}

/// Rows of the Jacobian gathered before they are squared: enough for a matrix product to pay, few enough for the cache.
pub(super) const BATCH: usize = 128;

/// Linearises the free run, filtered by `D` and weighted.
pub(super) fn linearise_whitened(
    structure: Structure,
    theta: &Parameters,
    segments: &[Segment],
    whitening: &[f64],
) -> Linearised {
    let p = theta.a.len() + theta.b.len() + theta.f.len() + 1;
    let (mut products, mut gradient, mut batches) = (Products::zeros(p), DVector::zeros(p), Vec::new());
    for segment in segments {
        each_batch(structure, theta, segment, whitening, |t, (columns, first), error| {
            let skipped = segment.counted_from.saturating_sub(t);
            if skipped >= error.len() {
                return;
            }
            let (first, count) = (first + skipped, error.len() - skipped);
            let weights: Vec<f64> = (0..count).map(|s| segment.weight(t + skipped + s)).collect();
            let weighted = DVector::from_fn(count, |s, _| weights[s] * error[skipped + s]);
            products.add(columns, first, &weights);
            let own = columns.view(first, count) * weighted;
            gradient += &own;
            batches.push(own);
        });
    }
    Linearised { information: products.matrix(), gradient, batches }
}

/// Visits the filtered Jacobian `D ∂ŷ/∂θ`, a column a sample, and the filtered error, batch by batch; the visitor receives the first sample, and the
/// matrix with the first of as many columns as there are errors.
/// The Jacobian follows the same recursion as `ŷ` itself:
///
/// ```text
/// A(q⁻¹) ∂ŷ/∂aᵢ = −ŷ(t−i),   A ∂ŷ/∂bᵢ = u(t−d−i),   A ∂ŷ/∂f_k = B φ_k(t),   A ∂ŷ/∂c = 1
/// ```
///
/// from rest, since the outputs before the stretch are given.
pub(super) fn each_batch(
    structure: Structure,
    theta: &Parameters,
    segment: &Segment,
    whitening: &[f64],
    mut visit: impl FnMut(usize, (&Columns, usize), &DVector<f64>),
) {
    let (n, nb, m) = (theta.a.len(), theta.b.len(), theta.f.len());
    let p = n + nb + m + 1;
    // Samples that later ones answer to.
    let past_kept = n.max(whitening.len());
    let run = free_run(structure, theta, segment);
    let before = |t: usize| if t < segment.from { segment.y[t] } else { run[t - segment.from] };
    let errors = run.iter().zip(&segment.y[segment.from..segment.to]).map(|(p, y)| y - p).collect();
    let errors = whitened(errors, whitening);
    let first_input = segment.from - structure.memory();
    let u = segment.cells.values(first_input..segment.to + structure.ahead(), &theta.f);
    let recursion: Vec<f64> = theta.a.iter().map(|a| -a).collect();
    // Column t of the batch is ∂ŷ(t)/∂θ; the first columns are carried over from the batch before.
    let mut rows = Columns::zeros(p, past_kept + BATCH);
    let mut filtered = Columns::zeros(p, if whitening.is_empty() { 0 } else { BATCH });
    let mut t = segment.from;
    while t < segment.to {
        let count = BATCH.min(segment.to - t);
        let error = DVector::from_column_slice(&errors[t - segment.from..t - segment.from + count]);
        for s in 0..count {
            let now = t + s;
            let present = rows.column_mut(past_kept + s);
            present.fill(0.0);
            for i in 0..n {
                present[i] = -before(now - 1 - i);
            }
            for (i, b) in theta.b.iter().enumerate() {
                let input = structure.input(now, i);
                present[n + i] = u[input - first_input];
                segment.cells.add_features(input, *b, &mut present[n + nb..p - 1]);
            }
            present[p - 1] = 1.0;
        }
        Lagged { coefficients: &recursion, first: past_kept, count }.recurse(&mut rows);
        let batch = if whitening.is_empty() {
            (&rows, past_kept)
        } else {
            Lagged { coefficients: whitening, first: past_kept, count }.filter(&rows, &mut filtered);
            (&filtered, 0)
        };
        visit(t, batch, &error);
        rows.carry_over(count, past_kept);
        t += count;
    }
}

/// Weight of the penalty on rough curves, as a fraction of the output's energy: decides only what the data leave open.
pub(super) const SMOOTHNESS: f64 = 1e-8;

/// When to stop, and how errors are filtered.
#[derive(Debug, Clone, Copy)]
pub(super) struct Refinement<'a> {
    pub(super) effort: Effort,
    /// Sizes of the curves, whose second differences the penalty sums.
    pub(super) curves: &'a [usize],
    /// Coefficients of `D`, which makes the free-run errors white; none where they are white already.
    pub(super) whitening: &'a [f64],
    /// Squared errors that no parameter changes: the scatter of what weighted samples stand for.
    pub(super) constant: f64,
}

impl<'a> Refinement<'a> {
    /// Of errors as they are, on curves of these sizes.
    pub(super) fn new(effort: Effort, curves: &'a [usize]) -> Self {
        Self { effort, curves, whitening: &[], constant: 0.0 }
    }

    /// Levenberg–Marquardt from a start with a stable `A`; steps that would leave the stable region are not taken.
    ///
    /// K. Levenberg 1944; D. Marquardt, SIAM J. Appl. Math. 11 (1963), doi 10.1137/0111030.
    pub(super) fn run(&self, structure: Structure, start: Parameters, segments: &[Segment]) -> Parameters {
        let mut theta = start.balanced();
        let energy = output_energy(segments);
        let offset = theta.a.len() + theta.b.len();
        let penalty = penalty(self.curves, theta.f.len()) * (SMOOTHNESS * energy);
        let penalised = |theta: &Parameters| {
            let f = DVector::from_column_slice(&theta.f);
            let cost = whitened_cost(structure, theta, segments, self.whitening);
            cost + self.constant + f.dot(&(&penalty * &f))
        };
        let mut now = penalised(&theta);
        let normal = |theta: &Parameters| {
            let mut model = linearise_whitened(structure, theta, segments, self.whitening);
            let f = DVector::from_column_slice(&theta.f);
            let mut block = model.information.view_mut((offset, offset), penalty.shape());
            block += &penalty;
            let mut pull = model.gradient.rows_mut(offset, f.len());
            pull -= &penalty * f;
            fix_gauge(&mut model.information, theta);
            model
        };
        let moved = |theta: &Parameters, model: &Linearised, damping: f64| {
            let step = solve_symmetric(&model.information, &model.gradient, damping + 1e-13);
            step.map(|step| theta.moved(step.as_slice()))
        };
        let mut damping = 1e-3;
        for _ in 0..self.effort.iterations {
            let model = normal(&theta);
            let before = now;
            while damping < 1e12 {
                let next = moved(&theta, &model, damping);
                let cost = next.as_ref().map_or(f64::INFINITY, &penalised);
                match next {
                    Some(next) if cost < now => {
                        theta = next;
                        now = cost;
                        damping = (damping * 0.1).max(1e-12);
                        break;
                    }
                    _ => damping *= 8.0,
                }
            }
            if before - now <= self.effort.tolerance * before {
                break;
            }
        }
        for _ in 0..self.effort.polish {
            let next = moved(&theta, &normal(&theta), 0.0);
            match next.filter(|next| penalised(next) <= now * (1.0 + 1e-9)) {
                Some(next) => theta = next,
                None => break,
            }
        }
        theta.balanced()
    }
}

/// Weight of the gauge in the information, relative to its largest entry: above rounding, and below what would damp other directions.
const GAUGE: f64 = 1e-6;

/// Keeps steps off the scale that `b` and `f` share: no error changes along `(b, −f)`, and rounding alone would choose a step there.
pub(super) fn fix_gauge(information: &mut DMatrix<f64>, theta: &Parameters) {
    let zero = |x: &[f64]| vec![0.0; x.len()];
    let shrunk = theta.f.iter().map(|f| -f).collect();
    let gauge = DVector::from_vec([zero(&theta.a), theta.b.clone(), shrunk, vec![0.0]].concat());
    let weight = GAUGE * information.diagonal().max() / gauge.norm_squared().max(f64::MIN_POSITIVE);
    information.ger(weight, &gauge, &gauge, 1.0);
}

/// `P` of the penalty `fᵀPf`: squared second differences of every curve.
pub(super) fn penalty(curves: &[usize], width: usize) -> DMatrix<f64> {
    let mut penalty = DMatrix::zeros(width, width);
    let mut first = 0;
    for &size in curves {
        for k in first + 1..(first + size).saturating_sub(1) {
            // Knot k has feature k − 1; knot 0 is the reference, always 0.
            let stencil = [(k - 1, 1.0), (k, -2.0), (k + 1, 1.0)];
            for (p, x) in stencil.iter().filter(|(p, _)| *p > 0) {
                for (q, z) in stencil.iter().filter(|(q, _)| *q > 0) {
                    penalty[(p - 1, q - 1)] += x * z;
                }
            }
        }
        first += size;
    }
    penalty
}

/// Energy of the outputs about their mean.
pub(super) fn output_energy(segments: &[Segment]) -> f64 {
    let values = || segments.iter().flat_map(|s| (s.from..s.to).map(|t| (s.weight(t), s.y[t])));
    let count: f64 = values().map(|(w, _)| w).sum();
    let mean = values().map(|(w, y)| w * y).sum::<f64>() / count.max(1.0);
    values().map(|(w, y)| w * ((y - mean) * (y - mean))).sum()
}
