//! Figures of a diagnosis: where the gap lies, what the outputs do, what the residuals are, how the candidates rank.

mod candidates;
mod outputs;
mod places;
mod residuals;

use super::Figure;
use crate::diagnosis::Report;

/// Every figure of a report.
pub fn figures(report: &Report) -> Vec<Figure> {
    let mut figures = vec![
        Figure { name: "where.svg".to_owned(), svg: places::figure(report) },
        Figure { name: "candidates.svg".to_owned(), svg: candidates::figure(report) },
        Figure { name: "residuals.svg".to_owned(), svg: residuals::figure(report) },
    ];
    for series in &report.diagnosis.series {
        let name = format!("outputs_{}.svg", series.record);
        figures.push(Figure { name, svg: outputs::figure(report, series) });
    }
    figures
}
