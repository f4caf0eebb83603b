//! Refinement: the parameters that minimise the error of a free run.

use super::initial_state::{InitialState, own_information, without_last};
use super::problem::{Parameters, Segment, Start, Structure};
use super::rank_one::solve_symmetric;
use nalgebra::{DMatrix, DMatrixView, DVector};
use switchback_model::linear::is_stable;
use switchback_model::noise_model::whitened;

/// How hard a refinement tries.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    pub(super) iterations: usize,
    /// Relative decrease of the cost below which a step counts as the last.
    pub(super) tolerance: f64,
}

impl Effort {
    /// Enough to show which start is best.
    pub(super) const TRIAL: Self = Self { iterations: 4, tolerance: 1e-3 };
    /// Enough to rank structures.
    pub(super) const SEARCH: Self = Self { iterations: 12, tolerance: 1e-3 };
    /// For the fit that is reported. Most end by the tolerance, after a few steps; along a coefficient that the records hardly show, later steps
    /// than these move the fit by less than a hundredth of its standard error.
    pub(super) const FINAL: Self = Self { iterations: 40, tolerance: 1e-12 };
    /// For one of many fits to simulated noise, from a start nearby: what is left is, of 10⁵ samples, a tenth of a standard error.
    pub(super) const REPEATED: Self = Self { iterations: 12, tolerance: 1e-7 };
}

/// The free run over a stretch from the outputs before it.
pub(super) fn free_run(structure: Structure, theta: &Parameters, segment: &Segment) -> Vec<f64> {
    Simulated::of(structure, theta, segment, &[]).run
}

/// A free run and the errors that it leaves.
struct Simulated {
    /// The outputs before the stretch, oldest first, from which the run starts.
    before: Vec<f64>,
    /// One output a sample of the stretch.
    run: Vec<f64>,
    /// Errors `D(y − ŷ)` from sample `first` on: that of the stretch, or that of its fitted start.
    errors: Vec<f64>,
    first: usize,
}

impl Simulated {
    fn of(structure: Structure, theta: &Parameters, segment: &Segment, whitening: &[f64]) -> Self {
        let order = theta.a.len();
        let driven = driven(structure, theta, segment);
        let mut before = segment.y[segment.from - order..segment.from].to_vec();
        let mut run = run_from(&theta.a, &before, &driven);
        let errors = |run: &[f64]| -> Vec<f64> {
            run.iter().zip(&segment.y[segment.from..segment.to]).map(|(p, y)| y - p).collect()
        };
        match segment.start {
            Start::Measured => {
                let errors = whitened(errors(&run), whitening);
                Self { before, run, errors, first: segment.from }
            }
            Start::Fitted => {
                let state = InitialState::of(&theta.a, errors(&run), whitening);
                before.iter_mut().zip(&state.deviation).for_each(|(y, d)| *y += d);
                run.iter_mut().zip(&state.response).for_each(|(y, d)| *y += d);
                Self { before, run, errors: state.errors, first: segment.from - order }
            }
        }
    }
}

/// `1/A` of a signal, after the outputs before it.
fn run_from(a: &[f64], before: &[f64], driven: &[f64]) -> Vec<f64> {
    let mut y = Vec::with_capacity(before.len() + driven.len());
    y.extend_from_slice(before);
    y.extend_from_slice(driven);
    for t in before.len()..y.len() {
        let (past, now) = y.split_at_mut(t);
        for (a, past) in a.iter().zip(past.iter().rev()) {
            now[0] -= a * past;
        }
    }
    y.split_off(before.len())
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
        let simulated = Simulated::of(structure, theta, s, whitening);
        simulated.errors.iter().zip(simulated.first..).map(|(e, t)| s.weight(t) * (e * e)).sum()
    };
    segments.iter().map(square).sum()
}

/// Gauss–Newton quantities of the free-run error `ε = D(y − ŷ)`: `H = ΣJᵀJ`, `g = ΣJᵀε`, over parameters a, b, f, c, with `J = D ∂ŷ/∂θ`.
#[derive(Debug, Clone)]
pub(super) struct Linearised {
    pub(super) information: DMatrix<f64>,
    pub(super) gradient: DVector<f64>,
    pub(super) cost: f64,
    /// `g` over each batch of consecutive samples, for standard errors that allow for coloured residuals.
    pub(super) batches: Vec<DVector<f64>>,
}

/// Rows of the Jacobian gathered before they are squared: enough for a matrix product to pay, few enough for the cache.
pub(super) const BATCH: usize = 128;

/// Linearises the free run without a noise model.
#[cfg(test)]
pub(super) fn linearise(structure: Structure, theta: &Parameters, segments: &[Segment]) -> Linearised {
    linearise_whitened(structure, theta, segments, &[])
}

/// Linearises the free run, filtered by `D` and weighted.
pub(super) fn linearise_whitened(
    structure: Structure,
    theta: &Parameters,
    segments: &[Segment],
    whitening: &[f64],
) -> Linearised {
    let p = theta.a.len() + theta.b.len() + theta.f.len() + 1;
    let mut sums = Linearised {
        information: DMatrix::zeros(p, p),
        gradient: DVector::zeros(p),
        cost: 0.0,
        batches: Vec::new(),
    };
    for segment in segments {
        let free = segment.fitted_outputs(structure);
        let mut own = DMatrix::zeros(p + free, p + free);
        let simulated = Simulated::of(structure, theta, segment, whitening);
        if free > 0 {
            own.view_mut((p, p), (free, free)).copy_from(&own_information(free, whitening));
            sums.cost += simulated.errors[..free].iter().map(|e| e * e).sum::<f64>();
        }
        each_batch_of(&simulated, (structure, theta), segment, whitening, |t, batch, error| {
            let gradient = if segment.weights.is_some() {
                let mut heavy = batch.clone_owned();
                for (s, mut column) in heavy.column_iter_mut().enumerate() {
                    column *= segment.weight(t + s);
                }
                own.gemm(1.0, &heavy, &batch.transpose(), 1.0);
                sums.cost += (0..error.len()).map(|s| segment.weight(t + s) * error[s].powi(2)).sum::<f64>();
                heavy * error
            } else {
                own.gemm(1.0, &batch, &batch.transpose(), 1.0);
                sums.cost += error.norm_squared();
                batch * error
            };
            let gradient = gradient.rows(0, p).clone_owned();
            sums.gradient += &gradient;
            sums.batches.push(gradient);
        });
        sums.information += without_last(own, free);
    }
    sums
}

/// Visits the filtered Jacobian `D ∂ŷ/∂θ`, a column a sample, and the filtered error, batch by batch; the visitor receives the first sample.
/// The Jacobian follows the same recursion as `ŷ` itself:
///
/// ```text
/// A(q⁻¹) ∂ŷ/∂aᵢ = −ŷ(t−i),   A ∂ŷ/∂bᵢ = u(t−d−i),   A ∂ŷ/∂f_k = B φ_k(t),   A ∂ŷ/∂c = 1
/// ```
///
/// from rest, since the outputs before the stretch are given; where they are fitted, rows for them follow the parameters'.
pub(super) fn each_batch(
    structure: Structure,
    theta: &Parameters,
    segment: &Segment,
    whitening: &[f64],
    visit: impl FnMut(usize, DMatrixView<'_, f64>, &DVector<f64>),
) {
    let simulated = Simulated::of(structure, theta, segment, whitening);
    each_batch_of(&simulated, (structure, theta), segment, whitening, visit);
}

/// [`each_batch`] along a free run.
fn each_batch_of(
    Simulated { before, run, errors, first }: &Simulated,
    (structure, theta): (Structure, &Parameters),
    segment: &Segment,
    whitening: &[f64],
    mut visit: impl FnMut(usize, DMatrixView<'_, f64>, &DVector<f64>),
) {
    let (n, nb, m) = (theta.a.len(), theta.b.len(), theta.f.len());
    let c = n + nb + m;
    let fitted = segment.fitted_outputs(structure);
    let p = c + 1 + fitted;
    // Samples that later ones answer to.
    let past_kept = n.max(whitening.len());
    let before =
        |t: usize| t.checked_sub(segment.from).map_or_else(|| before[t + n - segment.from], |t| run[t]);
    // Column t of the batch is ∂ŷ(t)/∂θ; the first columns are carried over from the batch before.
    let mut rows = DMatrix::<f64>::zeros(p, past_kept + BATCH);
    for j in 0..fitted {
        rows[(c + 1 + j, past_kept - n + j)] = 1.0;
    }
    let mut filtered = DMatrix::<f64>::zeros(p, if whitening.is_empty() { 0 } else { BATCH });
    let mut t = segment.from;
    while t < segment.to {
        let count = BATCH.min(segment.to - t);
        let error = DVector::from_column_slice(&errors[t - first..t - first + count]);
        for s in 0..count {
            let now = t + s;
            let (past, present) = rows.as_mut_slice().split_at_mut(p * (past_kept + s));
            let earlier = |i: usize| &past[p * (past_kept + s - 1 - i)..p * (past_kept + s - i)];
            let present = &mut present[..p];
            present.fill(0.0);
            for (i, a) in theta.a.iter().enumerate() {
                for (now, before) in present.iter_mut().zip(earlier(i)) {
                    *now -= a * before;
                }
                present[i] -= before(now - 1 - i);
            }
            for (i, b) in theta.b.iter().enumerate() {
                let cell = segment.cells.at(structure.input(now, i));
                present[n + i] += cell.value(&theta.f);
                for (k, x) in cell.features() {
                    present[n + nb + k] += b * x;
                }
            }
            present[c] += 1.0;
            if !whitening.is_empty() {
                let out = &mut filtered.as_mut_slice()[p * s..p * (s + 1)];
                out.copy_from_slice(present);
                for (i, d) in whitening.iter().enumerate() {
                    for (out, before) in out.iter_mut().zip(earlier(i)) {
                        *out += d * before;
                    }
                }
            }
        }
        let batch =
            if whitening.is_empty() { rows.columns(past_kept, count) } else { filtered.columns(0, count) };
        visit(t, batch.as_view(), &error);
        for i in 0..past_kept {
            let column = rows.column(count + i).clone_owned();
            rows.set_column(i, &column);
        }
        t += count;
    }
}

/// When to stop, and how much to prefer smooth curves where the data say nothing.
#[derive(Debug, Clone, Copy)]
pub(super) struct Refinement<'a> {
    pub(super) effort: Effort,
    /// Sizes of the curves, whose second differences the penalty sums.
    pub(super) curves: &'a [usize],
    /// Weight of the penalty, as a fraction of the output's energy.
    pub(super) smoothness: f64,
    /// Coefficients of `D`, which makes the free-run errors white; none where they are white already.
    pub(super) whitening: &'a [f64],
    /// Squared errors that no parameter changes: the scatter of what weighted samples stand for.
    pub(super) constant: f64,
}

impl Refinement<'_> {
    /// Levenberg–Marquardt from a start with a stable `A`; steps that would leave the stable region are not taken.
    ///
    /// K. Levenberg 1944; D. Marquardt, SIAM J. Appl. Math. 11 (1963), doi 10.1137/0111030.
    pub(super) fn run(&self, structure: Structure, start: Parameters, segments: &[Segment]) -> Parameters {
        let mut theta = start.balanced();
        let energy = output_energy(segments);
        let offset = theta.a.len() + theta.b.len();
        let penalty = penalty(self.curves, theta.f.len()) * (self.smoothness * energy);
        let penalised = |theta: &Parameters| {
            let f = DVector::from_column_slice(&theta.f);
            let cost = whitened_cost(structure, theta, segments, self.whitening);
            cost + self.constant + f.dot(&(&penalty * &f))
        };
        let mut now = penalised(&theta);
        let mut damping = 1e-3;
        for _ in 0..self.effort.iterations {
            let mut model = linearise_whitened(structure, &theta, segments, self.whitening);
            let f = DVector::from_column_slice(&theta.f);
            let mut block = model.information.view_mut((offset, offset), penalty.shape());
            block += &penalty;
            let mut pull = model.gradient.rows_mut(offset, f.len());
            pull -= &penalty * f;
            let before = now;
            while damping < 1e12 {
                let next = solve_symmetric(&model.information, &model.gradient, damping + 1e-13);
                let next = next.map(|step| theta.moved(step.as_slice()));
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
        theta.balanced()
    }
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
