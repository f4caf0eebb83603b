//! Simulation errors without what a record has of its own.
//!
//! ```text
//! r = e − Σ d ψ/A,   d by least squares over the record
//! ```
//!
//! `ψ` are the phase of a wave, the path of a zero, the level: fitted records have coefficients of their own, and those of others are
//! unknown. `k` coefficients follow the noise of `n` independent errors as well; the mean square is raised by what that gains here and
//! would cost elsewhere, `(1 + k/n)/(1 − k/n)` (H. Akaike, "Fitting autoregressive models for prediction", Ann. Inst. Stat. Math. 21, 1969).

use crate::least_squares::normal::Normal;
use crate::likelihood::engine::Fit;
use crate::likelihood::rows::equation_columns;
use crate::records::dataset::Dataset;
use crate::simulation::initial_conditions::with_drift_paths;

/// The simulation errors of some records of a dataset, from their first counted samples, without what each has of its own; unchanged
/// where the model knows of nothing like that, and in fitted records.
pub(crate) fn without_own_paths(
    dataset: &Dataset,
    fit: &Fit,
    numbers: &[usize],
    errors: Vec<Vec<f64>>,
) -> Vec<Vec<f64>> {
    let (augmented, own) = with_drift_paths(dataset, &fit.augmented);
    if own.is_empty() {
        return errors;
    }
    let of_record = |(&number, errors): (&usize, Vec<f64>)| {
        let scaled = &dataset.scaled_records[number];
        let columns = equation_columns(dataset, (number, scaled), &augmented);
        let here = (0..columns.numbers.len()).filter(|&at| own.contains(&columns.numbers[at]));
        let psi: Vec<Vec<f64>> =
            here.map(|at| (scaled.from..scaled.y.len()).map(|t| columns.row(t)[at]).collect()).collect();
        let responses = fit.linear.behind_poles(&psi);
        let independent = errors.len() as f64 * dataset.criterion.share();
        cleared(&errors, &responses, independent).unwrap_or(errors)
    };
    numbers.iter().zip(errors).map(of_record).collect()
}

/// Errors without the best combination of some responses, raised by what these gain by chance; nothing where there are none, or too many.
fn cleared(errors: &[f64], responses: &[Vec<f64>], independent: f64) -> Option<Vec<f64>> {
    let share = responses.len() as f64 / independent;
    if responses.is_empty() || share >= 1.0 {
        return None;
    }
    let row = |t: usize| responses.iter().map(|x| x[t]).collect::<Vec<f64>>();
    let mut normal = Normal::new(responses.len());
    errors.iter().enumerate().for_each(|(t, e)| normal.add(&row(t), *e));
    let taken = normal.factor(1e-9)?.solve(&normal.gradient);
    let raised = ((1.0 + share) / (1.0 - share)).sqrt();
    let left =
        |(t, e): (usize, &f64)| raised * (e - row(t).iter().zip(&taken).map(|(x, d)| x * d).sum::<f64>());
    Some(errors.iter().enumerate().map(left).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::white;

    /// The oracle: the error variance of a regression with `k` coefficients on another draw of its noise, `σ²(1 + k/n)`.
    #[test]
    fn a_wave_is_taken_out_and_its_cost_is_paid_back() {
        let n = 400;
        let wave = |phase: f64| -> Vec<f64> { (0..n).map(|t| (0.3 * f64::from(t) + phase).sin()).collect() };
        let responses = [wave(0.0), wave(1.5)];
        let mut noise = white();
        let (mut sum, draws) = (0.0, 200);
        for _ in 0..draws {
            let errors: Vec<f64> = wave(0.7).iter().map(|x| 3.0 * x + noise()).collect();
            let left = cleared(&errors, &responses, f64::from(n)).expect("two responses");
            sum += left.iter().map(|x| x * x).sum::<f64>() / f64::from(n);
        }
        let expected = 1.0 + 2.0 / f64::from(n);
        assert!((sum / f64::from(draws) - expected).abs() < 0.02, "{}", sum / f64::from(draws));
        assert_eq!(cleared(&[1.0, 2.0], &responses, 2.0), None);
        assert_eq!(cleared(&[1.0, 2.0], &[], 2.0), None);
    }
}
