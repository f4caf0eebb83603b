//! Do 95 % intervals hold the truth in 95 % of the replicates?
//!
//! Replicates are independent, so that the number of intervals of one parameter that hold the truth is binomial. The intervals take the normal
//! quantile and forget the bias, of order `1/N`; at `N = 100 000` both move the share by some `10⁻⁵`, a hundredth of what chance leaves.

use super::chance::Tail;
use super::figure::Figure;
use super::small_study::SmallStudy;
use switchback_study::results::Results;
use switchback_study::scenario::Engine;

/// Nominal.
const LEVEL: f64 = 0.95;

/// Counts them in one study.
pub(super) fn figures(seed: u64) -> miette::Result<Vec<Figure>> {
    let methods = &["paper-descendant", "paper-ascendant", "joint", "efficient"];
    let study = SmallStudy { seed, replicates: 2_000, samples: 100_000, methods, engine: Engine::Superposed };
    Ok(judge(&study.run()?))
}

fn judge(results: &Results) -> Vec<Figure> {
    let parameters = || results.cells.iter().flat_map(|cell| cell.parameters.iter().map(move |p| (cell, p)));
    let tail = Tail::of(parameters().count());
    parameters()
        .map(|(cell, p)| {
            let range = tail.share(cell.replicates as u64, LEVEL);
            let found = p.coverage.map_or(f64::NAN, |c| c.value());
            Figure::within(format!("{}: coverage of {}", cell.series.method, p.name), found, LEVEL, range)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::selftest::tests::{all_hold, some_fail};

    #[test]
    fn the_intervals_hold_the_truth_as_often_as_they_say() {
        all_hold(&figures(11).expect("a study"));
    }

    /// What is wrong with the model is not in its standard errors.
    #[test]
    fn the_intervals_of_a_wrong_model_show() {
        let methods = &["memoryless"];
        let wrong =
            SmallStudy { seed: 1, replicates: 100, samples: 10_000, methods, engine: Engine::Superposed };
        some_fail(&judge(&wrong.run().expect("a study")), "memoryless: coverage of a1");
    }

    #[test]
    fn intervals_a_fifth_too_short_show() {
        use statrs::distribution::{ContinuousCDF, Normal};
        let methods = &["efficient"];
        let study =
            SmallStudy { seed: 1, replicates: 2_000, samples: 1_000, methods, engine: Engine::Superposed };
        let mut results = study.run().expect("a study");
        let short = 1.0 - 2.0 * Normal::standard().sf(0.8 * 1.96);
        for p in &mut results.cells[0].parameters {
            p.coverage = switchback_study::results::Measured::new(short, 0.005);
        }
        some_fail(&judge(&results), "efficient: coverage of a1");
    }
}
