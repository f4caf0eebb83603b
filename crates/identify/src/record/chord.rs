//! Fits in which the derivatives by most quantities are computed once.

use super::criterion::Criterion;
use super::fit::{Effort, moved};
use super::sensitivities::{Differences, errors, filter_and_project};
use super::stretch::Stretch;
use nalgebra::{DMatrix, DVector};
use switchback_model::system::{Path, Quantity, Scale, System};
use switchback_noise::lanes::{Columns, Products};

/// Directions in which many quantities move the filtered run at one system, used for the systems near it: the chord method.
///
/// ```text
/// J = PD ∂ŷ/∂θ    N × p, all records joined        S = diag ‖J_k‖
/// (JS⁻¹)ᵀJS⁻¹ = VΛVᵀ                               Q = JS⁻¹VΛ^(−½),  QᵀQ = 1
/// ```
///
/// A step of [`Chord::fit`] is that of Levenberg and Marquardt with this `J` and with fresh derivatives by a few other quantities, for which
/// `Q` leaves a system of equations no larger than their number. Huber's function enters by errors that are drawn in (P. J. Huber, *Robust
/// Statistics*, Wiley 1981, section 7.8). C. T. Kelley, *Iterative Methods for Linear and Nonlinear Equations*, SIAM 1995, section 5.4.
#[derive(Debug, Clone)]
pub struct Chord<'a> {
    quantities: Vec<Quantity>,
    /// `Jᵀ`.
    jacobian: Columns,
    /// `Λ`.
    eigenvalues: DVector<f64>,
    /// `S⁻¹VΛ^(−½)`: from coordinates by `Q` to quantities.
    to_quantities: DMatrix<f64>,
    stretches: &'a [Stretch],
    /// Of the system at which derivatives are taken, one a record.
    paths: Vec<Path>,
    criterion: &'a Criterion,
    scale: &'a Scale,
}

/// Eigenvalue `Λ` below which a direction is none that the records show.
const LEAST_EIGENVALUE: f64 = 1e-10;
/// Damping with which a fit begins, and beyond which no step is tried.
const DAMPING: (f64, f64) = (1e-4, 1e6);

/// A system and its filtered error.
struct Point {
    system: System,
    error: DVector<f64>,
    deviance: f64,
}

impl<'a> Chord<'a> {
    /// Derivatives at a system by quantities.
    pub fn of(
        system: &System,
        quantities: &[Quantity],
        stretches: &'a [Stretch],
        (criterion, scale): (&'a Criterion, &'a Scale),
    ) -> Self {
        let paths: Vec<Path> = stretches.iter().map(|s| system.path(&s.v, s.span)).collect();
        let jacobian = columns(system, quantities, None, ((stretches, &paths), (criterion, scale)));
        let information = Products::between(&jacobian, &jacobian);
        // A quantity that no record shows has no size.
        let size = information.diagonal().map(|square| if square > 0.0 { square.sqrt() } else { 1.0 });
        let count = quantities.len();
        let scaled = DMatrix::from_fn(count, count, |i, k| information[(i, k)] / (size[i] * size[k]));
        let eigen = scaled.symmetric_eigen();
        let shown: Vec<usize> = (0..count).filter(|k| eigen.eigenvalues[*k] > LEAST_EIGENVALUE).collect();
        let eigenvalues = DVector::from_fn(shown.len(), |k, _| eigen.eigenvalues[shown[k]]);
        let to_quantities = DMatrix::from_fn(count, shown.len(), |i, k| {
            eigen.eigenvectors[(i, shown[k])] / (eigenvalues[k].sqrt() * size[i])
        });
        let quantities = quantities.to_vec();
        Self { quantities, jacobian, eigenvalues, to_quantities, stretches, paths, criterion, scale }
    }

    /// The system of least deviance near a start, with that deviance: the quantities of the chord and those of `fresh` are free, all others
    /// are fixed.
    pub fn fit(&self, start: &System, fresh: &[Quantity], effort: Effort) -> (System, f64) {
        let mut now = self.point(start.clone());
        let mut damping = DAMPING.0;
        for _ in 0..effort.iterations {
            let equations = self.equations(&now, fresh);
            let before = now.deviance;
            while damping < DAMPING.1 {
                let next = equations
                    .step(&self.eigenvalues, damping)
                    .map(|(along, step)| self.moved(&now.system, (&along, &step), fresh))
                    .filter(|next| next.is_sound(self.scale))
                    .map(|next| self.point(next))
                    .filter(|next| next.deviance < before);
                if let Some(next) = next {
                    now = next;
                    damping = (damping * 0.2).max(1e-9);
                    break;
                }
                damping *= 6.0;
            }
            if before - now.deviance <= effort.tolerance * before {
                break;
            }
        }
        (now.system, now.deviance)
    }

    fn moved(
        &self,
        system: &System,
        (along, step): (&DVector<f64>, &DVector<f64>),
        fresh: &[Quantity],
    ) -> System {
        let system = moved(system, &self.quantities, &(&self.to_quantities * along));
        moved(&system, fresh, step)
    }

    fn point(&self, system: System) -> Point {
        let mut error = Vec::new();
        for (stretch, path) in self.stretches.iter().zip(&self.paths) {
            let mut own = [errors(stretch, &stretch.simulate_beside(&system, path))];
            filter_and_project(&system, stretch, &mut own, self.criterion);
            error.append(&mut own[0]);
        }
        let deviance: f64 = error.iter().map(|e| self.criterion.loss(*e)).sum();
        let deviance = if deviance.is_finite() { deviance } else { f64::INFINITY };
        Point { system, error: DVector::from_vec(error), deviance }
    }

    fn equations(&self, point: &Point, fresh: &[Quantity]) -> Equations {
        let error = point.error.map(|e| self.criterion.drawn_in(e));
        let with = ((self.stretches, &self.paths[..]), (self.criterion, self.scale));
        let joint = columns(&point.system, fresh, Some(&error), with);
        let (own, count) = (Products::between(&joint, &joint), fresh.len());
        let across = self.to_quantities.tr_mul(&Products::between(&self.jacobian, &joint));
        Equations {
            along: across.column(count).into_owned(),
            across: across.columns(0, count).into_owned(),
            information: own.view((0, 0), (count, count)).into_owned(),
            gradient: own.view((0, count), (count, 1)).column(0).into_owned(),
        }
    }
}

/// `Qᵀe`, `QᵀC`, `CᵀC` and `Cᵀe`, with `C` the fresh derivatives.
struct Equations {
    along: DVector<f64>,
    across: DMatrix<f64>,
    information: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl Equations {
    /// The damped step along `Q` and of the fresh quantities, with `W = Λ(Λ + λ)⁻¹`:
    ///
    /// ```text
    /// (CᵀC + λ diag CᵀC − CᵀQWQᵀC) δ = Cᵀe − CᵀQWQᵀe,    z = W(Qᵀe − QᵀCδ)
    /// ```
    fn step(&self, eigenvalues: &DVector<f64>, damping: f64) -> Option<(DVector<f64>, DVector<f64>)> {
        let weights = eigenvalues.map(|value| value / (value + damping));
        let weighted = DMatrix::from_fn(self.across.nrows(), self.across.ncols(), |i, k| {
            weights[i] * self.across[(i, k)]
        });
        let mut left = &self.information - self.across.tr_mul(&weighted);
        for k in 0..left.nrows() {
            left[(k, k)] += (damping + 1e-12) * self.information[(k, k)] + f64::MIN_POSITIVE;
        }
        let right = &self.gradient - weighted.tr_mul(&self.along);
        let size = DVector::from_fn(left.nrows(), |k, _| left[(k, k)].max(f64::MIN_POSITIVE).sqrt());
        let scaled = DMatrix::from_fn(left.nrows(), left.nrows(), |i, k| left[(i, k)] / (size[i] * size[k]));
        let step = scaled.cholesky()?.solve(&right.component_div(&size)).component_div(&size);
        let along = (&self.along - &self.across * &step).component_mul(&weights);
        step.iter().chain(along.iter()).all(|x| x.is_finite()).then_some((along, step))
    }
}

/// Records with the paths of a known system, and how errors count.
type Judged<'a> = ((&'a [Stretch], &'a [Path]), (&'a Criterion, &'a Scale));

/// Filtered and projected derivatives, a row a quantity, all records joined; behind them a row of errors where these are given.
fn columns(
    system: &System,
    quantities: &[Quantity],
    error: Option<&DVector<f64>>,
    ((stretches, paths), (criterion, scale)): Judged<'_>,
) -> Columns {
    let differences = Differences::of(system, quantities, scale);
    let samples = stretches.iter().map(|s| s.v.len()).sum();
    let count = quantities.len();
    let mut out = Columns::zeros(count + usize::from(error.is_some()), samples);
    let mut from = 0;
    for (stretch, known) in stretches.iter().zip(paths) {
        let path = system.path_beside(&stretch.v, stretch.span, known);
        let run = stretch.respond(system, &path);
        let mut own = differences.columns(stretch, &path, &run);
        filter_and_project(system, stretch, &mut own, criterion);
        for t in 0..stretch.v.len() {
            out.column_mut(from + t).iter_mut().zip(&own).for_each(|(x, column)| *x = column[t]);
        }
        from += stretch.v.len();
    }
    if let Some(error) = error {
        error.iter().enumerate().for_each(|(t, e)| out.column_mut(t)[count] = *e);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::fit;
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;
    use switchback_model::reversal::ReversalRule;
    use switchback_model::system::{Borders, LAWS, LinearPart, Sensor, Span, Term};

    fn machine(name: &str, values: &[f64]) -> System {
        let low: Vec<(f64, f64)> = [-1.1, -0.4, 0.2, 1.1].map(|v| (v, 2.0 * v + 0.3 * v * v - 0.4)).into();
        let high: Vec<(f64, f64)> = low.iter().map(|(v, u)| (*v, u + 0.8)).collect();
        let law = LAWS.into_iter().find(|law| law.name() == name).expect("a law");
        System {
            borders: Borders::new(&low, &high).expect("knots that rise"),
            linear: LinearPart::new(&[-0.8], &[0.2], 1).expect("stable").0,
            sensor: Sensor::EXACT,
            terms: vec![Term { law, values: values.to_vec() }],
            rule: ReversalRule::EXACT,
        }
    }

    fn input() -> Vec<f64> {
        (0..1500).map(f64::from).map(|t| 0.6 * (0.11 * t).sin() + 0.4 * (0.017 * t).cos()).collect()
    }

    /// Deviances that the full method and the chord, its knots fixed to it, reach from a system on a record of another one.
    fn deviances(truth: &System, begin: &System) -> [f64; 2] {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let v = input();
        let mut y = truth.simulate(&v, Span::alone(v.len()));
        y.iter_mut().for_each(|y| *y += 0.02 * rng.sample::<f64, _>(StandardNormal));
        let stretches = Stretch::all(&[(&v, &y)]);
        let scale = Scale::of(&begin.linear, begin.rule, &[(&v, &y)]);
        let criterion = Criterion { filter: vec![-0.3], sd: 0.02 };
        let all = Quantity::coordinates(begin);
        let (knots, fresh): (Vec<Quantity>, Vec<Quantity>) =
            all.iter().partition(|q| matches!(q, Quantity::Knot(_)));
        let (_, slow) = fit(begin, &all, &stretches, (&criterion, &scale), Effort::FINAL);
        let chord = Chord::of(begin, &knots, &stretches, (&criterion, &scale));
        let (_, fast) = chord.fit(begin, &fresh, Effort::FINAL);
        [slow, fast]
    }

    /// Where the deviance is smooth, fresh derivatives at each iteration find the same minimum: of the one that a superfluous parameter takes
    /// from the deviance, the derivatives at the start leave less than a tenth.
    #[test]
    fn both_methods_end_at_one_minimum() {
        for (name, truth, start) in [
            ("late", &[0.3, 60.0][..], &[0.2, 40.0][..]),
            ("viscous", &[1.5], &[0.5]),
            ("late", &[0.1, 30.0], &[0.1, 60.0]),
        ] {
            let [slow, fast] = deviances(&machine(name, truth), &machine(name, start));
            assert!((fast - slow).abs() < 0.1, "{name} {truth:?}: {fast} {slow}");
            assert!(slow < 1.2 * input().len() as f64, "{name} {truth:?}: {slow}");
        }
    }

    /// The deviance jumps with the reversals that a play moves, so that a fit ends near its start: sizes are searched by trials.
    #[test]
    fn a_play_is_fitted_from_a_size_near_it() {
        for play in [0.02, 0.1, 0.3] {
            let truth = machine("play", &[play]);
            for deviance in deviances(&truth, &truth) {
                assert!(deviance < 1.1 * input().len() as f64, "{play}: {deviance}");
            }
        }
    }
}
