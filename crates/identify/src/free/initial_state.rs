//! The state in which a stretch begins, fitted with all of its samples.

use super::rank_one::solve_symmetric;
use nalgebra::{DMatrix, DVector};
use switchback_model::noise_model::whitened;

/// Outputs before a stretch that are parameters of their own.
///
/// A free run that starts from `n` measured outputs carries their noise on, for as long as the poles ring. Where stretches are short the error of the start
/// then outweighs that of the model, and a larger order wins because it averages over more outputs. So the outputs `x` before the stretch are
/// estimated, and those measured count as samples like all others:
///
/// ```text
/// min_δ Σ_{t ≥ from−n} (D(q⁻¹)(ε(t) − Φ(t)δ))²,   x = y + δ,   A(q⁻¹) Φ(t) = 0 for t ≥ from,   Φ = I before
/// ```
///
/// with `ε` the errors of the run from the measured outputs, 0 before the stretch. It is the initial state's part of a separable least-squares problem
/// (G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973), doi 10.1137/0710036).
pub(super) struct InitialState {
    /// `δ`, oldest first.
    pub(super) deviation: Vec<f64>,
    /// `Φ(t)δ` over the samples of the stretch, as far as it is not negligible.
    pub(super) response: Vec<f64>,
    /// The errors that are left, filtered by `D`, from the first of the outputs before the stretch on.
    pub(super) errors: Vec<f64>,
}

impl InitialState {
    /// Of a stable `A`, from the errors of a stretch without filter.
    pub(super) fn of(a: &[f64], errors: Vec<f64>, whitening: &[f64]) -> Self {
        let n = a.len();
        let mut errors = whitened([vec![0.0; n], errors].concat(), whitening);
        let free: Vec<Vec<f64>> = (0..n).map(|j| free_response(a, j, errors.len())).collect();
        let filtered = |x: &Vec<f64>| {
            let mut x = x.clone();
            x.resize((x.len() + whitening.len()).min(errors.len()), 0.0);
            whitened(x, whitening)
        };
        let responses: Vec<Vec<f64>> = free.iter().map(filtered).collect();
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let products = DMatrix::from_fn(n, n, |i, j| dot(&responses[i], &responses[j]));
        let right = DVector::from_fn(n, |i, _| dot(&responses[i], &errors));
        let deviation = solve_symmetric(&products, &right, 1e-12).unwrap_or_else(|| DVector::zeros(n));
        let mut response = vec![0.0; free.iter().map(Vec::len).max().unwrap_or(0)];
        for ((free, filtered), deviation) in free.iter().zip(&responses).zip(deviation.iter()) {
            response.iter_mut().zip(free).for_each(|(sum, x)| *sum += deviation * x);
            errors.iter_mut().zip(filtered).for_each(|(e, x)| *e -= deviation * x);
        }
        let deviation = deviation.as_slice().to_vec();
        Self { deviation, response: response.split_off(n), errors }
    }
}

/// A response below this moves no error by more than the noise of an output, times this.
const NEGLIGIBLE: f64 = 1e-8;

/// `Φ_j`: the response of `1/A` to a unit output at the `j`-th of `n` samples and none at the others, until it is [`NEGLIGIBLE`].
fn free_response(a: &[f64], j: usize, samples: usize) -> Vec<f64> {
    let n = a.len();
    let mut x = vec![0.0_f64; n];
    x[j] = 1.0;
    while x.len() < samples && x[x.len() - n..].iter().any(|x| x.abs() > NEGLIGIBLE) {
        x.push(-a.iter().zip(x.iter().rev()).map(|(a, x)| a * x).sum::<f64>());
    }
    x
}

/// `Σ(DΦ)(DΦ)ᵀ` over the samples before the stretch: of a pulse at each of them in turn.
pub(super) fn own_information(n: usize, whitening: &[f64]) -> DMatrix<f64> {
    let pulse = |j: usize| {
        let mut x = vec![0.0; n];
        x[j] = 1.0;
        DVector::from_vec(whitened(x, whitening))
    };
    let pulses: Vec<DVector<f64>> = (0..n).map(pulse).collect();
    DMatrix::from_fn(n, n, |i, j| pulses[i].dot(&pulses[j]))
}

/// The information on the first parameters of a symmetric matrix where the last `n` are estimated with them: `H − H_φ H_φφ⁻¹ H_φᵀ`.
pub(super) fn without_last(information: DMatrix<f64>, n: usize) -> DMatrix<f64> {
    if n == 0 {
        return information;
    }
    let p = information.nrows() - n;
    let own = information.view((p, p), (n, n)).clone_owned();
    let cross = information.view((0, p), (p, n));
    let mut rest = information.view((0, 0), (p, p)).clone_owned();
    if let Some(factor) = own.cholesky() {
        rest -= cross * factor.solve(&cross.transpose());
    }
    rest
}
