//! What a scenario promises of 95 % intervals: how often they hold the truth, and how wide they are.

use crate::results::{Cell, Expectation, Group, Parameter};
use crate::scenario::{Coverage, Width};

/// Parameters whose coverage is averaged.
const CELL_GROUPS: [(&str, &[Group]); 3] =
    [("a", &[Group::A]), ("b", &[Group::B]), ("borders", &[Group::Descending, Group::Ascending])];

/// Whether the coverage lies within its bounds at every `N`, averaged over the parameters of a family.
pub(super) fn coverage(prefix: &str, bounds: Coverage, cells: &[&Cell]) -> Expectation {
    let mut held = !cells.is_empty();
    let mut means = Vec::new();
    let mut least: Option<(f64, String, &Cell)> = None;
    for samples in numbers_of_samples(cells) {
        let here: Vec<&Cell> = cells.iter().copied().filter(|c| c.samples == samples).collect();
        let of = |(name, groups): (&str, &[Group])| {
            let covered: Vec<f64> = here.iter().filter_map(|cell| mean_coverage(cell, groups)).collect();
            held &= covered.len() == here.len();
            for (&share, cell) in covered.iter().zip(&here) {
                if least.as_ref().is_none_or(|(lowest, ..)| share < *lowest) {
                    least = Some((share, name.to_owned(), *cell));
                }
            }
            let mean = covered.iter().sum::<f64>() / covered.len() as f64;
            held &= (bounds.mean.0..=bounds.mean.1).contains(&mean);
            format!("{name} {:.1}", 100.0 * mean)
        };
        means.push(format!("N = {samples}: {}", CELL_GROUPS.map(of).join(", ")));
    }
    let lowest = least.map_or_else(String::new, |(share, name, cell)| {
        held &= share >= bounds.least;
        format!("; least {:.1}: {name}, {}, N = {}", 100.0 * share, cell.series, cell.samples)
    });
    let [low, high, least] = [bounds.mean.0, bounds.mean.1, bounds.least].map(|share| 100.0 * share);
    Expectation {
        what: format!(
            "{prefix}95 % intervals hold the truth in {low} to {high} %, on no curve below {least} %"
        ),
        held,
        detail: format!("{}{lowest}", means.join("; ")),
    }
}

/// Whether the intervals of a case are no wider than allowed beside those of another.
pub(super) fn width(prefix: &str, bound: &Width, cells: &[&Cell], measure: &[&Cell]) -> Expectation {
    let mut held = !cells.is_empty();
    let mut medians = Vec::new();
    for samples in numbers_of_samples(cells) {
        let pairs = cells.iter().filter(|c| c.samples == samples).filter_map(|cell| {
            let alike = |other: &&&Cell| {
                let (x, y) = (&cell.series, &other.series);
                (&x.border, &x.method, x.points, x.noise) == (&y.border, &y.method, y.points, y.noise)
                    && cell.samples == other.samples
            };
            Some((cell, measure.iter().find(alike)?))
        });
        let width = |p: &Parameter| p.model_sd.map(|sd| sd.value());
        let mut ratios: Vec<f64> = pairs
            .flat_map(|(cell, other)| cell.parameters.iter().zip(&other.parameters))
            .filter_map(|(x, y)| Some(width(x)? / width(y)?))
            .collect();
        ratios.sort_by(f64::total_cmp);
        let median = ratios.get(ratios.len() / 2).copied().unwrap_or(f64::INFINITY);
        held &= median <= bound.at_most;
        medians.push(format!("N = {samples}: {median:.2}"));
    }
    Expectation {
        what: format!("{prefix}the median interval is no wider than {} of \"{}\"", bound.at_most, bound.of),
        held,
        detail: medians.join("; "),
    }
}

fn numbers_of_samples(cells: &[&Cell]) -> Vec<usize> {
    let mut samples: Vec<usize> = cells.iter().map(|cell| cell.samples).collect();
    samples.sort_unstable();
    samples.dedup();
    samples
}

/// Over the parameters of the groups; `None` if one has no coverage.
fn mean_coverage(cell: &Cell, groups: &[Group]) -> Option<f64> {
    let of_groups = cell.parameters.iter().filter(|p| groups.contains(&p.group));
    let covered: Vec<f64> = of_groups.map(|p| p.coverage.map(|c| c.value())).collect::<Option<_>>()?;
    (!covered.is_empty()).then(|| covered.iter().sum::<f64>() / covered.len() as f64)
}
