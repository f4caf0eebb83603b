//! Matching measures and judging their differences.

use super::beside::beside;
use crate::results::{Cell, Measured, Parameter, Results, Series};
use statrs::distribution::{ContinuousCDF, Normal};

/// What two result tables have in common, and how far they differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Every measure found in both, in the order of the baseline.
    pub differences: Vec<Difference>,
    /// Cells, parameters and measures of the baseline that the new table lacks.
    pub only_baseline: Vec<String>,
    /// Cells, parameters and measures of the new table that the baseline lacks.
    pub only_new: Vec<String>,
    /// What no noise changes and is not the same: the study, the truth, what theory and bound say, where a border point lies, what was judged; and
    /// what was made of equal measures.
    pub known: Vec<String>,
    /// What differs as it may between two runs of one study: the seed, the number of replicates, what was made of other measures.
    pub runs: Vec<String>,
    /// Largest |z| that chance explains among so many differences.
    pub threshold: f64,
}

/// Where a measure stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// The curve.
    pub series: Series,
    /// `N`.
    pub samples: usize,
    /// `a1`, `F_desc(V3)`, …
    pub parameter: String,
    /// `bias`, `sd`, `mse`, `coverage`, …
    pub measure: &'static str,
}

/// One measure in both tables.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Where it stands.
    pub place: Place,
    /// In the baseline.
    pub baseline: Measured,
    /// In the new table.
    pub new: Measured,
    /// `(new − baseline)/√(MCSE² + MCSE²)`; 0 where both agree to rounding, infinite where both are exact and differ.
    pub z: f64,
}

/// Chance of calling any difference real when all are chance.
const LEVEL: f64 = 0.01;

/// Compares every measure that both tables hold, and all else beside them.
///
/// The threshold is Šidák's: with K differences, `|z| ≤ Φ⁻¹(½ + ½(1 − 0.01)^(1/K))` for all of them with probability
/// at least 99 % if nothing changed and both tables have independent noise. Differences of one cell are correlated, and so are cells that share their noise; the threshold
/// then errs towards calling a change chance.
pub fn compare(baseline: &Results, new: &Results) -> Comparison {
    let (mut differences, mut known) = (Vec::new(), Vec::new());
    let rounding = rounding(baseline, new);
    for cell in &baseline.cells {
        for (parameter, other) in paired_parameters(cell, new) {
            differences.extend(pair(cell, (parameter, other), rounding));
            known.extend(changed(cell, (parameter, other), rounding));
        }
    }
    let (only_baseline, only_new) = (lacking(baseline, new), lacking(new, baseline));
    let threshold = sidak(differences.len());
    let is_same = differences.iter().all(|d: &Difference| d.z == 0.0);
    let beside = beside(baseline, new, (is_same, rounding, threshold));
    known.extend(beside.known);
    Comparison { differences, only_baseline, only_new, known, runs: beside.runs, threshold }
}

impl Comparison {
    /// Differences beyond chance, the largest first.
    pub(crate) fn beyond_chance(&self) -> Vec<&Difference> {
        let mut beyond: Vec<&Difference> =
            self.differences.iter().filter(|d| d.z.abs() > self.threshold).collect();
        beyond.sort_by(|a, b| b.z.abs().total_cmp(&a.z.abs()));
        beyond
    }

    /// Whether the tables hold the same measures, at least one, of the same truth, and no difference is beyond chance.
    pub fn agrees(&self) -> bool {
        self.holds_the_same() && self.beyond_chance().is_empty()
    }

    /// Whether, besides, the runs are the same, and every measure to the last digit.
    pub(crate) fn identical(&self) -> bool {
        self.holds_the_same() && self.runs.is_empty() && self.differences.iter().all(|d| d.baseline == d.new)
    }

    fn holds_the_same(&self) -> bool {
        !self.differences.is_empty()
            && self.only_baseline.is_empty()
            && self.only_new.is_empty()
            && self.known.is_empty()
    }
}

fn find<'r>(results: &'r Results, cell: &Cell) -> Option<&'r Cell> {
    results.cells.iter().find(|c| c.samples == cell.samples && c.series == cell.series)
}

fn name(cell: &Cell) -> String {
    format!("{}, N = {}", cell.series, cell.samples)
}

/// The parameters of a cell that another table has as well, with those of that one.
fn paired_parameters<'r>(
    cell: &'r Cell,
    other: &'r Results,
) -> impl Iterator<Item = (&'r Parameter, &'r Parameter)> {
    let twin = find(other, cell);
    let of = move |p: &'r Parameter| Some((p, twin?.parameters.iter().find(|q| q.name == p.name)?));
    cell.parameters.iter().filter_map(of)
}

/// Cells, parameters and measures of one table that the other lacks; a condensed one has fewer measures by design.
fn lacking(one: &Results, other: &Results) -> Vec<String> {
    let mut names = Vec::new();
    for cell in &one.cells {
        let Some(twin) = find(other, cell) else {
            names.push(name(cell));
            continue;
        };
        let has = |p: &&Parameter| twin.parameters.iter().any(|q| q.name == p.name);
        let missing = cell.parameters.iter().filter(|p| !has(p));
        names.extend(missing.map(|p| format!("{}: {}", name(cell), p.name)));
        for (p, q) in paired_parameters(cell, other).filter(|_| other.digits.is_none()) {
            let lost = MEASURES.iter().filter(|(_, get)| get(p).is_some() && get(q).is_none());
            names.extend(lost.map(|(measure, _)| format!("{}: {measure} of {}", name(cell), p.name)));
        }
    }
    names
}

type Known = fn(&Parameter) -> Option<f64>;

const KNOWN: [(&str, Known); 5] = [
    ("truth", |p| Some(p.truth)),
    ("position", |p| p.v),
    ("bias by theory", |p| p.theory_bias),
    ("standard deviation by theory", |p| p.theory_sd),
    ("bound of the standard deviation", |p| p.bound_sd),
];

/// What is known of a parameter without any noise and is not the same.
fn changed(cell: &Cell, (baseline, new): (&Parameter, &Parameter), rounding: f64) -> Vec<String> {
    let differs = |(what, get): (&str, Known)| {
        let reported = |x: Option<f64>| x.map_or_else(|| "none".to_owned(), |x| x.to_string());
        let (one, other) = (get(baseline), get(new));
        let is_same = match (one, other) {
            (Some(one), Some(other)) => is_rounding(one, other, rounding),
            (one, other) => one == other,
        };
        let (place, name) = (name(cell), &baseline.name);
        (!is_same).then(|| format!("{place}: {what} of {name}, {} → {}", reported(one), reported(other)))
    };
    KNOWN.into_iter().filter_map(differs).collect()
}

type Getter = fn(&Parameter) -> Option<Measured>;

const MEASURES: [(&str, Getter); 10] = [
    ("bias", |p| p.bias),
    ("bias_controlled", |p| p.bias_controlled),
    ("sd", |p| p.sd),
    ("sd_controlled", |p| p.sd_controlled),
    ("mse", |p| p.mse),
    ("coverage", |p| p.coverage),
    ("coverage_controlled", |p| p.coverage_controlled),
    ("interval_score", |p| p.interval_score),
    ("coverage_bias_eliminated", |p| p.coverage_bias_eliminated),
    ("model_sd", |p| p.model_sd),
];

fn pair(cell: &Cell, (baseline, new): (&Parameter, &Parameter), rounding: f64) -> Vec<Difference> {
    MEASURES
        .into_iter()
        .filter_map(|(measure, get)| {
            let (baseline_figure, new_figure) = (get(baseline)?, get(new)?);
            let place = Place {
                series: cell.series.clone(),
                samples: cell.samples,
                parameter: baseline.name.clone(),
                measure,
            };
            let z = distance(baseline_figure, new_figure, rounding);
            Some(Difference { place, baseline: baseline_figure, new: new_figure, z })
        })
        .collect()
}

/// Figures closer than this share of themselves are the same number, summed in another order or on another machine. It
/// matters where a figure hardly varies, so that its own error is lost in rounding.
const ROUNDING: f64 = 1e-8;

/// The share of themselves that two tables' equal figures may differ by: more where one has figures of few digits.
fn rounding(baseline: &Results, new: &Results) -> f64 {
    let half_a_digit = |digits: u32| 5.0 * 10f64.powi(-(digits as i32));
    let digits = [baseline.digits, new.digits].into_iter().flatten();
    digits.map(half_a_digit).fold(ROUNDING, f64::max)
}

fn distance(baseline: Measured, new: Measured, rounding: f64) -> f64 {
    if is_rounding(baseline.value(), new.value(), rounding) {
        return 0.0;
    }
    (new.value() - baseline.value()) / baseline.mcse().hypot(new.mcse())
}

fn is_rounding(one: f64, other: f64, rounding: f64) -> bool {
    (other - one).abs() <= rounding * one.abs().max(other.abs())
}

/// Šidák's threshold for `count` differences; infinite for none.
fn sidak(count: usize) -> f64 {
    if count == 0 {
        return f64::INFINITY;
    }
    // 1 − (1 − level)^(1/count), without cancellation.
    let each = -f64::exp_m1(f64::ln_1p(-LEVEL) / count as f64);
    -Normal::standard().inverse_cdf(each / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::synthetic;

    #[test]
    fn identical_tables_differ_nowhere() {
        let results = synthetic::results();
        let comparison = compare(&results, &results);
        assert!(comparison.identical() && comparison.agrees());
        assert!(comparison.differences.iter().all(|d| d.z == 0.0));
    }

    #[test]
    fn a_shift_of_ten_errors_is_found_where_it_is() {
        let baseline = synthetic::results();
        let mut new = baseline.clone();
        let sd = &mut new.cells[3].parameters[1].sd;
        *sd = sd.and_then(|m| Measured::new(m.value() + 20.0 * m.mcse(), m.mcse()));
        let comparison = compare(&baseline, &new);
        let beyond = comparison.beyond_chance();
        assert_eq!(beyond.len(), 1);
        assert_eq!((beyond[0].place.parameter.as_str(), beyond[0].place.measure), ("a2", "sd"));
        assert!((beyond[0].z - 20.0 / 2f64.sqrt()).abs() < 0.01);
        assert!(!comparison.agrees());
    }

    #[test]
    fn cells_without_a_twin_are_listed_on_their_side() {
        let baseline = synthetic::results();
        let mut new = baseline.clone();
        new.cells.remove(0);
        new.cells[0].parameters.remove(0);
        let comparison = compare(&baseline, &new);
        assert_eq!((comparison.only_baseline.len(), comparison.only_new.len()), (2, 0));
        let reverse = compare(&new, &baseline);
        assert_eq!((reverse.only_baseline.len(), reverse.only_new.len()), (0, 2));
    }

    #[test]
    fn measures_that_are_gone_are_missed() {
        let baseline = synthetic::results();
        let mut new = baseline.clone();
        new.cells[2].parameters[0].coverage = None;
        let comparison = compare(&baseline, &new);
        assert_eq!((comparison.only_baseline.len(), comparison.only_new.len()), (1, 0));
        assert!(comparison.only_baseline[0].ends_with(": coverage of a1"), "{:?}", comparison.only_baseline);
        assert!(!comparison.agrees() && !comparison.identical());
        // Where both lost everything nothing was compared.
        for p in new.cells.iter_mut().flat_map(|cell| &mut cell.parameters) {
            (p.bias, p.bias_controlled, p.sd, p.sd_controlled) = (None, None, None, None);
            (p.mse, p.coverage, p.coverage_controlled, p.model_sd) = (None, None, None, None);
        }
        let comparison = compare(&new, &new);
        assert!(!comparison.agrees() && !comparison.identical());
    }

    #[test]
    fn another_truth_is_another_study() {
        let baseline = synthetic::results();
        let shifted = |change: fn(&mut Parameter)| {
            let mut new = baseline.clone();
            change(&mut new.cells[1].parameters[0]);
            let comparison = compare(&baseline, &new);
            assert!(!comparison.agrees() && !comparison.identical());
            comparison.known
        };
        let known = shifted(|p| p.truth += 5.0);
        assert_eq!(known.len(), 1);
        assert!(known[0].contains(": truth of a1, "), "{known:?}");
        assert_eq!(shifted(|p| p.theory_sd = p.theory_sd.map(|sd| 1.1 * sd)).len(), 1);
        assert_eq!(shifted(|p| p.bound_sd = None).len(), 1);
    }

    #[test]
    fn exact_figures_that_differ_are_beyond_any_chance() {
        let exact = |x| Measured::new(x, 0.0).expect("finite");
        assert_eq!(distance(exact(1.0), exact(1.0), ROUNDING), 0.0);
        assert_eq!(distance(exact(1.0), exact(1.0 + 1e-10), ROUNDING), 0.0);
        assert_eq!(distance(exact(1.0), exact(2.0), ROUNDING), f64::INFINITY);
    }

    #[test]
    fn the_threshold_grows_with_the_number_of_differences() {
        assert!((sidak(1) - 2.575_829).abs() < 1e-5);
        assert!(sidak(100_000) > sidak(1_000) && sidak(100_000) < 6.0);
    }
}
