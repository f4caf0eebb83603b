//! Are the Monte-Carlo errors of a study what repeating the study shows?
//!
//! The same study of `R` replicates is run `K` times, each with noise of its own. Of each measure `x` with the error `e` that it is reported with, the
//! variance of its `K` values is held against the mean of `e²`:
//!
//! ```text
//! Q = Σ_k (x_k − x̄)²/(K−1) / (Σ_k e_k²/K)         E[Q] ≈ ρ = Var(x)/E[e²]
//! Var(Q/ρ) ≈ D/K,   D = Var((x−μ)²/Var(x) − e²/E[e²])
//! ```
//!
//! The range of `Q/ρ` is that of `χ²_f/f` with the same variance, `f = 2K/D` (Satterthwaite, Biometrics Bulletin 2, 1946). With `ν = R − 1`:
//!
//! - bias, mean squared error, coverage, model sd: means of `R` independent values of whatever law. `D = 2 + 2/ν` exactly, because the excess
//!   kurtosis `κ` enters the variances of `x²` and of `e²` with `κ/R` each and their covariance with `κ/R`. `ρ = 1`; `R/ν` for the coverage,
//!   whose error has the divisor `R`.
//! - sd and relative error of the model sd: `ρ` and `D` from the moments of `s ~ σ√(χ²_ν/ν)` and of `1/s`. Estimates are normal to `O(1/N)`.

use super::chance::Tail;
use super::figure::Figure;
use super::small_study::SmallStudy;
use statrs::function::gamma::ln_gamma;
use switchback_study::results::{Measured, Parameter, Results};
use switchback_study::scenario::Engine;

/// `R`: few, so that errors that are right for many replicates only would show.
const REPLICATES: usize = 50;
/// `K`: the variance of a measure is known to `√(2/K)`, six per cent, so that an error reported by a third too small or too large shows.
const STUDIES: u64 = 600;

/// A measure, how to read it off a parameter, and what is known of its error.
struct Measure {
    name: &'static str,
    of: fn(&Parameter) -> Option<Measured>,
    /// `ρ`.
    ratio: f64,
    /// `D`.
    spread: f64,
}

/// Repeats the study.
pub(super) fn figures(seed: u64) -> miette::Result<Vec<Figure>> {
    let methods = &["paper-descendant", "efficient"];
    let one = |k| {
        let seed = (seed << 20) + 1 + k;
        SmallStudy { seed, replicates: REPLICATES, samples: 1_000, methods, engine: Engine::Superposed }.run()
    };
    Ok(judge(&(0..STUDIES).map(one).collect::<miette::Result<Vec<_>>>()?))
}

fn judge(studies: &[Results]) -> Vec<Figure> {
    let measures = measures();
    let first = &studies[0];
    let parameters: usize = first.cells.iter().map(|cell| cell.parameters.len()).sum();
    let tail = Tail::of(measures.len() * parameters);
    let mut figures = Vec::new();
    for (c, cell) in first.cells.iter().enumerate() {
        for (p, parameter) in cell.parameters.iter().enumerate() {
            for measure in &measures {
                let values: Vec<Option<Measured>> =
                    studies.iter().map(|s| (measure.of)(&s.cells[c].parameters[p])).collect();
                let what = format!("{}: {} of {}", cell.series.method, measure.name, parameter.name);
                figures.push(measure.figure(what, &values, tail));
            }
        }
    }
    figures
}

impl Measure {
    fn figure(&self, what: String, values: &[Option<Measured>], tail: Tail) -> Figure {
        let k = values.len() as f64;
        let of = |read: fn(Measured) -> f64| values.iter().map(move |m| m.map_or(f64::NAN, read));
        let mean = of(|m| m.value()).sum::<f64>() / k;
        let variance = of(|m| m.value()).map(|x| (x - mean).powi(2)).sum::<f64>() / (k - 1.0);
        let reported = of(|m| m.mcse()).map(|e| e * e).sum::<f64>() / k;
        let (low, high) = tail.variance_ratio(2.0 * k / self.spread);
        // Reported as standard deviations: so errors are thought of.
        let [expected, low, high] = [self.ratio, self.ratio * low, self.ratio * high].map(f64::sqrt);
        let what = format!("{what}: spread over error");
        Figure::within(what, (variance / reported).sqrt(), expected, (low, high))
    }
}

fn measures() -> [Measure; 6] {
    let nu = (REPLICATES - 1) as f64;
    let of_mean = 2.0 + 2.0 / nu;
    // E[(χ²_ν/ν)^(p/2)].
    let chi = |p: f64| (ln_gamma((nu + p) / 2.0) - ln_gamma(nu / 2.0) + p / 2.0 * (2.0 / nu).ln()).exp();
    let (sd_ratio, sd_spread) = of_power([1.0, 2.0, 3.0, 4.0].map(chi), nu);
    let (inverse_ratio, inverse_spread) = of_power([-1.0, -2.0, -3.0, -4.0].map(chi), nu);
    let mean = |name, of, ratio| Measure { name, of, ratio, spread: of_mean };
    [
        mean("bias", |p| p.bias, 1.0),
        mean("mean squared error", |p| p.mse, 1.0),
        mean("coverage", |p| p.coverage, (nu + 1.0) / nu),
        mean("model sd", |p| p.model_sd, 1.0),
        Measure { name: "sd", of: |p| p.sd, ratio: sd_ratio, spread: sd_spread },
        Measure {
            name: "error of the model sd",
            of: |p| p.model_sd_relative_error,
            ratio: inverse_ratio,
            spread: inverse_spread,
        },
    ]
}

/// `ρ` and `D` of a positive measure `x` that is reported with the error `x/√(2ν)`, from its moments.
fn of_power([m1, m2, m3, m4]: [f64; 4], nu: f64) -> (f64, f64) {
    let variance = m2 - m1 * m1;
    // (x−m₁)²/variance − x²/m₂ = αx² + βx + γ, of mean zero.
    let (alpha, beta, gamma) = (1.0 / variance - 1.0 / m2, -2.0 * m1 / variance, m1 * m1 / variance);
    let spread = alpha * alpha * m4
        + 2.0 * alpha * beta * m3
        + (beta * beta + 2.0 * alpha * gamma) * m2
        + 2.0 * beta * gamma * m1
        + gamma * gamma;
    (variance / (m2 / (2.0 * nu)), spread)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::selftest::tests::{all_hold, some_fail};
    use std::sync::OnceLock;

    fn studies() -> &'static [Results] {
        static RUN: OnceLock<Vec<Results>> = OnceLock::new();
        RUN.get_or_init(|| {
            let one = |seed| {
                let methods = &["efficient"];
                SmallStudy {
                    seed,
                    replicates: REPLICATES,
                    samples: 1_000,
                    methods,
                    engine: Engine::Superposed,
                }
                .run()
                .expect("a study")
            };
            (1..=STUDIES).map(one).collect()
        })
    }

    /// The studies with the errors of one measure changed.
    fn reported(change: impl Fn(&mut Parameter)) -> Vec<Figure> {
        let mut studies = studies().to_vec();
        studies.iter_mut().flat_map(|s| &mut s.cells).flat_map(|c| &mut c.parameters).for_each(change);
        judge(&studies)
    }

    fn with_error(measured: &mut Option<Measured>, error: impl Fn(Measured) -> f64) {
        *measured = measured.and_then(|m| Measured::new(m.value(), error(m)));
    }

    #[test]
    fn the_formulas_hold() {
        all_hold(&reported(|_| ()));
    }

    #[test]
    fn an_error_without_the_two_shows() {
        let root_two = |m: Measured| m.mcse() * 2.0_f64.sqrt();
        some_fail(&reported(|p| with_error(&mut p.sd, root_two)), "efficient: sd of a1: spread over error");
    }

    #[test]
    fn the_error_of_a_single_replicate_shows() {
        let of_one = |m: Measured| m.mcse() * (REPLICATES as f64).sqrt();
        some_fail(&reported(|p| with_error(&mut p.bias, of_one)), "efficient: bias of b2: spread over error");
    }

    #[test]
    fn the_error_of_a_nominal_coverage_of_one_half_shows() {
        let of_half = |_| 0.5 / (REPLICATES as f64).sqrt();
        some_fail(
            &reported(|p| with_error(&mut p.coverage, of_half)),
            "efficient: coverage of a1: spread over error",
        );
    }

    #[test]
    fn a_squared_error_that_is_reported_as_if_it_were_normal_shows() {
        // The variance of e² taken as (E[e²])², half of what it is.
        let normal = |m: Measured| m.value() / (REPLICATES as f64).sqrt();
        some_fail(
            &reported(|p| with_error(&mut p.mse, normal)),
            "efficient: mean squared error of a1: spread over error",
        );
    }

    #[test]
    fn studies_that_share_their_noise_show() {
        let one = studies()[0].clone();
        some_fail(&judge(&vec![one; STUDIES as usize]), "efficient: bias of a1: spread over error");
    }

    /// `D` of a mean by simulation: of a squared normal, where the kurtosis is largest.
    #[test]
    fn the_spread_of_a_mean_does_not_depend_on_the_law() {
        use switchback_noise::{StreamId, white_samples};
        let (r, k) = (10, 40_000);
        let x: Vec<f64> = white_samples(StreamId { seed: 1, experiment: 0, replicate: 0 }, r * k)
            .iter()
            .map(|x| x * x - 1.0)
            .collect();
        let squares: Vec<f64> = x
            .chunks(r)
            .map(|x| {
                let mean = x.iter().sum::<f64>() / r as f64;
                let s2 = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (r - 1) as f64;
                ((mean * mean) * r as f64 / 2.0 - s2 / 2.0).powi(2)
            })
            .collect();
        let found = squares.iter().sum::<f64>() / k as f64;
        let error = (squares.iter().map(|d| (d - found).powi(2)).sum::<f64>() / (k * k) as f64).sqrt();
        let expected = 2.0 + 2.0 / (r - 1) as f64;
        assert!((found - expected).abs() < 5.0 * error, "{found} ± {error} instead of {expected}");
    }
}
