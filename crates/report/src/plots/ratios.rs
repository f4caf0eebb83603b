//! Standard deviation and bias as ratios, all methods of a case on the same axes.

use super::axis::Axis;
use super::canvas::{Dash, Towards};
use super::legend::{Entry, Sample};
use super::panel::{Mark, Panel};
use super::selection::{CaseSelection, Selection, replicates};
use super::sheet::{Grid, Sheet};
use super::spread::{ERRORS, Spread, samples_axis};
use super::style::{GREY, INK, OKABE_ITO, Pen, SMALL_RADIUS};
use switchback_study::results::{
    Cell, Group, Measured, Parameter, Results, root_mean_square, root_mean_square_exact,
};

/// Pixels between marks at the same `N`.
const APART: f64 = 5.0;

/// A row of diagrams.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Row {
    /// Standard deviation over that of theory.
    Sd,
    /// Bias over the standard deviation.
    Bias,
}

impl Row {
    const ALL: [Self; 2] = [Self::Sd, Self::Bias];

    fn name(self) -> &'static str {
        match self {
            Self::Sd => "sd over theory",
            Self::Bias => "|bias| over sd",
        }
    }

    /// The ratio of root mean squares over a group.
    fn of(self, cell: &Cell, group: Group) -> Option<Measured> {
        let (figure, scale) = match self {
            Self::Sd => (
                root_mean_square(cell, group, |p| p.theory_sd.and(p.best_sd()))?,
                root_mean_square_exact(cell, group, |p| p.best_sd().and(p.theory_sd))?,
            ),
            Self::Bias => (
                root_mean_square(cell, group, Parameter::best_bias)?,
                root_mean_square(cell, group, Parameter::best_sd)?.value(),
            ),
        };
        Measured::new(figure.value() / scale, figure.mcse() / scale)
    }
}

/// Draws one figure: columns are parameter groups, colours methods.
pub(super) fn figure(case: &CaseSelection<'_>, results: &Results) -> String {
    let groups = case.groups();
    let without: Vec<String> = case
        .methods
        .iter()
        .filter(|s| !s.cells.iter().any(|c| c.parameters.iter().any(|p| p.theory_sd.is_some())))
        .map(|s| s.method.to_string())
        .collect();
    let mut notes = vec![format!(
        "sd over theory: 1 where the scatter is what theory says. |bias| over sd: a consistent estimate's bias vanishes against its \
         scatter, as 1/√N; that of an inconsistent one grows as √N. Root mean squares over a group; median over border shapes, m and \
         noise levels; bars: from the least to the greatest, with {ERRORS} Monte-Carlo standard errors; {}.",
        replicates(case.cells())
    )];
    if !without.is_empty() {
        notes.push(format!("No theory, as its assumptions do not hold: {}.", without.join(", ")));
    }
    let title = format!("{}: standard deviation and bias as ratios", case.title(results));
    let has = |row: &Row| case.cells().any(|c| groups.iter().any(|g| row.of(c, *g).is_some()));
    let rows: Vec<Row> = Row::ALL.into_iter().filter(has).collect();
    let grid = Grid { apart: 20.0, ..Grid::shared(rows.len(), groups.len(), 230.0) };
    let mut sheet = Sheet::new(title, notes, grid);
    if rows.is_empty() {
        return sheet.empty("No cell of this case has a parameter.");
    }
    let colours = case.methods.iter().zip(OKABE_ITO);
    sheet.legend = colours.map(|(s, colour)| Entry::disc(colour, s.method.to_string())).collect();
    sheet.legend.push(Entry::new(Sample::Arrow(Towards::Down, INK), "the bar includes zero"));
    sheet.render(|canvas, frames| {
        for (r, row) in rows.iter().copied().enumerate() {
            let axes = axes(case, &groups, row);
            for (column, &group) in groups.iter().enumerate() {
                let panel = frames.inner_panel(canvas, (r, column), axes);
                if r == 0 {
                    panel.title(group.label());
                }
                if r + 1 == rows.len() {
                    panel.x_name("samples N");
                }
                if column == 0 {
                    panel.y_name(row.name(), 62.0);
                }
                contents(&panel, case, group, row);
            }
        }
    })
}

fn curve(selection: &Selection<'_>, samples: &[usize], group: Group, row: Row) -> Vec<(f64, Spread)> {
    let at = |n: &usize| {
        let cells = selection.cells.iter().filter(|c| c.samples == *n);
        Some((*n as f64, Spread::of_measured(cells.filter_map(|c| row.of(c, group)))?))
    };
    samples.iter().filter_map(at).collect()
}

fn axes(case: &CaseSelection<'_>, groups: &[Group], row: Row) -> (Axis, Axis) {
    let samples = case.samples();
    let curves = case.methods.iter().flat_map(|s| groups.iter().flat_map(|g| curve(s, &samples, *g, row)));
    let values = curves.flat_map(|(_, s)| match row {
        Row::Sd => [s.ends.0, s.ends.1],
        // A bar that reaches zero has no lower end.
        Row::Bias => [if s.ends.0 > 0.0 { s.ends.0 } else { s.middle }, s.ends.1],
    });
    let y = match row {
        Row::Sd => Axis::linear(values.chain([0.95, 1.05])),
        Row::Bias => Axis::logarithmic(values.chain([1.0])),
    };
    (samples_axis(samples, case.methods.len()), y)
}

fn contents(panel: &Panel<'_>, case: &CaseSelection<'_>, group: Group, row: Row) {
    panel.level(1.0, Some(Dash::Dashes), Pen::data(GREY));
    let samples = case.samples();
    let middle = (case.methods.len() - 1) as f64 / 2.0;
    let mut is_empty = true;
    for (k, (selection, colour)) in case.methods.iter().zip(OKABE_ITO).enumerate() {
        let mark = Mark { aside: APART * (k as f64 - middle), ..Mark::disc(Pen::data(colour), SMALL_RADIUS) };
        for (n, spread) in curve(selection, &samples, group, row) {
            is_empty = false;
            let ends = if row == Row::Bias { spread.positive_ends() } else { spread.ends };
            panel.mark(n, spread.middle, ends, mark);
        }
    }
    if is_empty {
        panel.remark("no method has this");
    }
}
