//! Figures, drawn from results alone.
//!
//! A figure's bytes depend on the table's values only. [`Sheet`](sheet::Sheet), [`Panel`](panel::Panel) and
//! [`Axis`](axis::Axis) are the parts every figure is made of; `convergence` and `borders` are the figures of a
//! consistency study.

pub mod axis;
pub mod blind;
mod borders;
pub mod canvas;
mod convergence;
pub mod field;
pub mod gap;
pub mod identify;
pub mod legend;
mod paired;
pub mod palette;
pub mod panel;
pub mod power;
mod selection;
pub mod sheet;

pub(crate) use identify::series::{thinned, worst_window};

use crate::results::Results;
use convergence::Measure;
use rayon::prelude::*;
use selection::Selection;

/// More rows of diagrams than this would not be looked at; beyond it only the largest `m` is drawn.
const MOST_ROWS: usize = 8;

/// A drawn figure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// File name, `bias-joint.svg`.
    pub name: String,
    /// The SVG.
    pub svg: String,
}

/// Every figure of a consistency study: for each case and method bias and standard deviation against `N`, and the
/// borders where the method estimates them; then methods and borders against each other.
pub fn consistency(results: &Results) -> Vec<Figure> {
    let of_selection = |selection: &Selection<'_>| {
        let mut figures = Vec::new();
        for (what, measure) in [("bias", Measure::Bias), ("sd", Measure::Sd)] {
            let svg = convergence::figure(measure, selection, None, results);
            figures.push(Figure { name: selection.file(what, results), svg });
        }
        if let Some(svg) = borders::figure(selection, results) {
            figures.push(Figure { name: selection.file("borders", results), svg });
        }
        figures
    };
    let single = || selection::selections(results).par_iter().flat_map_iter(of_selection).collect();
    let (mut figures, paired): (Vec<Figure>, _) = rayon::join(single, || paired::figures(results));
    figures.extend(paired);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::synthetic;

    #[test]
    fn every_method_gets_its_figures_and_they_repeat_byte_for_byte() {
        let results = synthetic::results();
        let figures = consistency(&results);
        let names: Vec<&str> = figures.iter().map(|f| f.name.as_str()).collect();
        assert_eq!(
            names[..3],
            ["bias-paper-descendant.svg", "sd-paper-descendant.svg", "borders-paper-descendant.svg"]
        );
        assert_eq!(names[9..], ["paired-methods.svg", "paired-borders.svg"]);
        assert_eq!(figures, consistency(&results));
    }

    #[test]
    fn a_figure_names_what_it_shows() {
        let results = synthetic::results();
        for figure in consistency(&results) {
            assert!(figure.svg.starts_with("<svg width=\"1200\""), "{}", figure.name);
            assert!(figure.svg.contains("deflection [mm]") || !figure.name.starts_with("borders"));
        }
    }

    #[test]
    fn overlays_show_what_both_tables_hold() {
        let baseline = synthetic::results();
        let mut new = baseline.clone();
        new.cells.retain(|c| c.series.method != crate::scenario::Method::Memoryless);
        let figures = overlays(&baseline, &new);
        assert_eq!(figures.len(), 4);
        assert!(figures.iter().all(|f| f.svg.contains("the baseline")));
    }
}
