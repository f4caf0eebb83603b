//! Figures, drawn from results alone.
//!
//! A figure's bytes depend on the table's values only. [`Sheet`](sheet::Sheet), [`Panel`](panel::Panel) and
//! [`Axis`](axis::Axis) are the parts every figure is made of, [`style`] is how they look. Of a consistency study there are
//! figures a method (`convergence`, `borders`) and figures of all methods together (`ratios`, `efficiency`, `zip`, `paired`, `forest`).

mod against;
pub(crate) mod axis;
mod bench;
mod borders;
pub(crate) mod canvas;
mod convergence;
mod efficiency;
pub(crate) mod examination;
mod forest;
pub mod gap;
pub mod identify;
#[cfg(test)]
pub(crate) mod inspect;
pub(crate) mod legend;
mod paired;
pub(crate) mod panel;
pub mod power;
mod quantiles;
mod ratios;
pub(crate) mod runs;
mod selection;
pub(crate) mod sheet;
mod spread;
pub(crate) mod style;
mod zip;

use against::{Against, Pairs};
use convergence::Measure;
use rayon::prelude::*;
use selection::{CaseSelection, Selection};
use switchback_study::results::Results;

/// A drawn figure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// File name, `bias-joint.svg`.
    pub name: String,
    /// The SVG.
    pub svg: String,
}

/// Every figure of a consistency study: for each case and method bias and standard deviation against `N`, and the
/// borders where the method estimates them; then all methods of a case together, and methods and borders against each other.
pub(crate) fn consistency(results: &Results) -> Vec<Figure> {
    let of_selection = |selection: &Selection<'_>| of_method(selection, results);
    let of_case = |case: &CaseSelection<'_>| of_case(case, results);
    let single = || selection::selections(results).par_iter().flat_map_iter(of_selection).collect();
    let together = || selection::cases(results).par_iter().flat_map_iter(of_case).collect::<Vec<Figure>>();
    let (mut figures, cases): (Vec<Figure>, _) = rayon::join(single, together);
    figures.extend(cases);
    figures
}

fn of_method(selection: &Selection<'_>, results: &Results) -> Vec<Figure> {
    let mut figures = Vec::new();
    for (what, measure) in [("bias", Measure::Bias), ("sd", Measure::Sd)] {
        let svg = convergence::figure(measure, selection, None, results);
        figures.push(Figure { name: selection.file(what, results), svg });
    }
    if let Some(svg) = borders::figure(selection, results) {
        figures.push(Figure { name: selection.file("borders", results), svg });
    }
    figures
}

fn of_case(case: &CaseSelection<'_>, results: &Results) -> Vec<Figure> {
    let mut figures = vec![Figure { name: case.file("ratios", results), svg: ratios::figure(case, results) }];
    if let Some(svg) = efficiency::figure(case, results) {
        figures.push(Figure { name: case.file("efficiency", results), svg });
    }
    if let Some(svg) = zip::figure(case, results) {
        figures.push(Figure { name: case.file("zip", results), svg });
    }
    for pairs in Against::ALL.into_iter().filter_map(|against| Pairs::of(against, case.case, results)) {
        let file = |what: &str| case.file(&format!("{what}-{}", pairs.against.name()), results);
        figures.push(Figure { name: file("paired"), svg: paired::figure(&pairs, case, results) });
        if let Some(svg) = forest::figure(&pairs, case, results) {
            figures.push(Figure { name: file("forest"), svg });
        }
    }
    figures
}

/// Bias and standard deviation of every case and method that both tables hold, the baseline behind in grey.
pub fn overlays(baseline: &Results, new: &Results) -> Vec<Figure> {
    let old = selection::selections(baseline);
    let mut figures = Vec::new();
    for selection in selection::selections(new) {
        let same = |s: &&selection::Selection<'_>| s.case == selection.case && s.method == selection.method;
        let Some(twin) = old.iter().find(same) else { continue };
        for (what, measure) in [("bias", Measure::Bias), ("sd", Measure::Sd)] {
            let svg = convergence::figure(measure, &selection, Some(twin), new);
            figures.push(Figure { name: selection.file(what, new), svg });
        }
    }
    figures
}

/// An axis' name with a unit: the label's own, or a word where it names none.
pub(crate) fn labelled(label: &str, otherwise: &str) -> String {
    match switchback_io::identification::unit(label) {
        "" => format!("{label} [{otherwise}]"),
        _ => label.to_owned(),
    }
}

pub use bench::history;
pub use quantiles::quantiles;

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_study::results::synthetic;

    #[test]
    fn no_axis_is_without_a_unit() {
        assert_eq!(labelled("force [kN]", "output units"), "force [kN]");
        assert_eq!(labelled("y", "output units"), "y [output units]");
    }

    #[test]
    fn every_method_gets_its_figures_and_they_repeat_byte_for_byte() {
        let results = synthetic::results();
        let figures = consistency(&results);
        let names: Vec<&str> = figures.iter().map(|f| f.name.as_str()).collect();
        assert_eq!(
            names[..3],
            ["bias-paper-descendant.svg", "sd-paper-descendant.svg", "borders-paper-descendant.svg"]
        );
        assert_eq!(
            names[9..],
            [
                "ratios.svg",
                "efficiency.svg",
                "zip.svg",
                "paired-methods.svg",
                "forest-methods.svg",
                "paired-borders.svg",
                "forest-borders.svg"
            ]
        );
        assert_eq!(figures, consistency(&results));
    }

    #[test]
    fn everything_is_on_the_page_in_one_style() {
        let figures = consistency(&synthetic::results());
        for figure in figures {
            inspect::check(&figure.svg).unwrap_or_else(|fault| panic!("{}: {fault}", figure.name));
        }
    }

    #[test]
    fn a_figure_names_what_it_shows() {
        let results = synthetic::results();
        for figure in consistency(&results) {
            assert!(figure.svg.starts_with("<svg width=\"960\""), "{}", figure.name);
            assert!(figure.svg.contains("deflection [mm]") || !figure.name.starts_with("borders"));
        }
    }

    #[test]
    fn one_mark_stands_for_all_borders() {
        let results = synthetic::results();
        let circles = |figures: &[Figure]| {
            let bias = figures.iter().find(|f| f.name == "bias-joint.svg").expect("a figure of the bias");
            bias.svg.matches("<circle cx").count()
        };
        let mut one_border = results.clone();
        one_border.cells.retain(|c| c.series.border == "constant stiffness");
        assert_eq!(circles(&consistency(&results)), circles(&consistency(&one_border)));
    }

    #[test]
    fn a_table_without_cells_gives_figures_that_say_so_or_none() {
        let mut results = synthetic::results();
        for cell in &mut results.cells {
            cell.parameters.clear();
            cell.intervals.clear();
        }
        results.summaries.clear();
        results.paired = None;
        let figures = consistency(&results);
        assert!(figures.iter().all(|f| f.svg.contains("has a parameter")), "{figures:?}");
        assert_eq!(figures.len(), 3 * 2 + 1);
        for figure in figures {
            inspect::check(&figure.svg).unwrap_or_else(|fault| panic!("{}: {fault}", figure.name));
        }
        results.cells.clear();
        assert!(consistency(&results).is_empty());
    }

    #[test]
    fn the_twin_of_the_variance_ratio_is_the_ratio_of_squared_errors() {
        let figures = consistency(&synthetic::results());
        let paired = figures.iter().find(|f| f.name == "paired-methods.svg").expect("methods are compared");
        assert!(paired.svg.contains("ratio of variance") && paired.svg.contains("ratio of squared error"));
    }

    #[test]
    fn overlays_show_what_both_tables_hold() {
        let baseline = synthetic::results();
        let mut new = baseline.clone();
        new.cells.retain(|c| c.series.method != switchback_identify::Method::Memoryless);
        let figures = overlays(&baseline, &new);
        assert_eq!(figures.len(), 4);
        assert!(figures.iter().all(|f| f.svg.contains("the baseline")));
    }
}
