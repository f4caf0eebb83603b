//! Do both engines give the same estimates?
//!
//! The fast engine superposes the sums of one noise record for every cell and solves normal equations; the slow one simulates every cell sample by
//! sample and solves dense least squares by QR. They share the noise and nothing else, so that they agree to rounding. The limit of the difference
//! of two mean estimates is a millionth of the standard deviation of one estimate: rounding is far below, and whatever is below changes no
//! figure that a study shows. Counts of covering intervals must be the same, for an interval's end is as near as that to the truth in one of a
//! million replicates.

use super::figure::Figure;
use super::small_study::SmallStudy;
use switchback_study::results::Results;
use switchback_study::scenario::Engine;

/// Of a standard deviation: the difference that is allowed.
const SHARE: f64 = 1e-6;

/// Runs one study on both.
pub(super) fn figures(seed: u64) -> miette::Result<Vec<Figure>> {
    let methods = &["paper-descendant", "paper-ascendant", "joint", "efficient"];
    let on = |engine| SmallStudy { seed, replicates: 48, samples: 1_000, methods, engine }.run();
    Ok(compare(&on(Engine::Superposed)?, &on(Engine::Direct)?))
}

fn compare(superposed: &Results, direct: &Results) -> Vec<Figure> {
    let mut figures = Vec::new();
    for (fast, slow) in superposed.cells.iter().zip(&direct.cells) {
        let method = &fast.series.method;
        let (mut apart, mut counted_apart) = (0.0_f64, 0.0_f64);
        for (p, q) in fast.parameters.iter().zip(&slow.parameters) {
            let value = |x: Option<f64>| x.unwrap_or(f64::NAN);
            let sd = value(p.sd.map(|sd| sd.value()));
            let difference = (value(p.mean_estimate) - value(q.mean_estimate)).abs() / sd;
            apart = largest(apart, difference);
            let covered = |x: Option<switchback_study::results::Measured>| {
                value(x.map(|c| c.value() * fast.replicates as f64))
            };
            counted_apart = largest(counted_apart, (covered(p.coverage) - covered(q.coverage)).abs());
        }
        figures.push(Figure::at_most(format!("{method}: estimates apart, in sd"), apart, SHARE));
        // Half of a count: shares are stored as such.
        figures.push(Figure::at_most(format!("{method}: covering intervals apart"), counted_apart, 0.5));
    }
    let cells = |results: &Results| results.cells.len().to_string();
    figures.push(Figure::word("cells of both engines", cells(direct), cells(superposed)));
    figures
}

/// The larger, and no number if one of them is none.
fn largest(x: f64, y: f64) -> f64 {
    if x.is_nan() || y.is_nan() { f64::NAN } else { x.max(y) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::selftest::tests::{all_hold, some_fail};

    fn small(seed: u64, samples: usize) -> Results {
        let methods = &["paper-descendant", "efficient"];
        SmallStudy { seed, replicates: 16, samples, methods, engine: Engine::Superposed }
            .run()
            .expect("a study")
    }

    #[test]
    fn both_engines_agree() {
        all_hold(&figures(5).expect("studies"));
    }

    #[test]
    fn another_noise_and_a_sample_more_show() {
        some_fail(&compare(&small(1, 1_000), &small(2, 1_000)), "efficient: estimates apart, in sd");
        some_fail(&compare(&small(1, 1_000), &small(1, 1_001)), "efficient: estimates apart, in sd");
    }

    #[test]
    fn an_interval_that_is_wider_shows() {
        let right = small(1, 1_000);
        let mut wrong = right.clone();
        let coverage = &mut wrong.cells[1].parameters[2].coverage;
        *coverage = switchback_study::results::Measured::new(0.5, 0.1);
        some_fail(&compare(&right, &wrong), "efficient: covering intervals apart");
    }
}
