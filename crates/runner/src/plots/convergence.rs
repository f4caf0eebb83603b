//! Bias and standard deviation against N.

use super::MOST_ROWS;
use super::axis::{Axis, plain};
use super::canvas::{Dash, Pen};
use super::legend::{Entry, Sample};
use super::palette::{GREY, INK, OKABE_ITO, tint};
use super::panel::{Mark, Panel};
use super::selection::{Selection, thinned};
use super::sheet::{Grid, Sheet};
use crate::results::{Cell, Group, Measured, Parameter, Results, root_mean_square, root_mean_square_exact};
use plotters::style::RGBColor;

/// Which of the two figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Measure {
    /// `|bias|` against `N`.
    Bias,
    /// Standard deviation against `N`.
    Sd,
}

const THEORY_WIDTH: f64 = 1.6;

/// One row of the figure.
struct Row<'r> {
    border: &'r str,
    points: usize,
}

/// Draws one figure: rows are border shapes (and `m`), columns parameter groups, colours noise levels.
///
/// The same part of a `baseline` is drawn behind, in grey.
pub(super) fn figure(
    measure: Measure,
    selection: &Selection<'_>,
    baseline: Option<&Selection<'_>>,
    results: &Results,
) -> String {
    let rows = rows(selection);
    let groups = selection.groups();
    let noises = thinned(&selection.noises(), OKABE_ITO.len());
    let sheet = Sheet {
        title: title(measure, selection, results, baseline.is_some()),
        notes: notes(measure, selection, &rows),
        legend: legend(measure, &noises, selection, baseline.is_some()),
        grid: Grid {
            columns: groups.len().max(1),
            rows: rows.len(),
            height: 190.0,
            left: 112.0,
            between: 62.0,
            above: 42.0,
        },
    };
    sheet.render(|canvas, frames| {
        for (column, &group) in groups.iter().enumerate() {
            let axes = axes(measure, &shown(&rows, [Some(selection), baseline]), group);
            for (r, row) in rows.iter().enumerate() {
                let panel = Panel::new(canvas, frames.corner(r, column), frames.size(), axes);
                if r == 0 {
                    panel.title(group.label());
                }
                if r + 1 == rows.len() {
                    panel.x_name("samples N");
                }
                if column == 0 {
                    frames.name_row(canvas, r, (row.border, row.points));
                }
                for (k, &noise) in noises.iter().enumerate() {
                    let cells = selection.curve(row.border, row.points, noise);
                    let aside = if noises.len() == 1 {
                        5.0
                    } else {
                        5.0 * (k as f64 - (noises.len() - 1) as f64 / 2.0)
                    };
                    if let Some(baseline) = baseline {
                        let cells = baseline.curve(row.border, row.points, noise);
                        Curve { cells, group, colour: GREY, aside: -6.0, radius: 3.0 }
                            .draw_behind(&panel, measure);
                    }
                    let radius = 3.5 + 1.2 * (noises.len() - 1 - k) as f64;
                    let curve = Curve { cells, group, colour: OKABE_ITO[k], aside, radius };
                    match measure {
                        Measure::Bias => curve.draw_bias(&panel),
                        Measure::Sd => curve.draw_sd(&panel),
                    }
                }
            }
        }
    })
}

fn rows<'r>(selection: &Selection<'r>) -> Vec<Row<'r>> {
    let (borders, mut points) = (selection.borders(), selection.points());
    if borders.len() * points.len() > MOST_ROWS {
        points = points.split_off(points.len() - 1);
    }
    borders.iter().flat_map(|&border| points.iter().map(move |&points| Row { border, points })).collect()
}

fn title(measure: Measure, selection: &Selection<'_>, results: &Results, over_baseline: bool) -> String {
    let what = match measure {
        Measure::Bias => "bias of the estimates against N",
        Measure::Sd => "standard deviation of the estimates against N",
    };
    let and = if over_baseline { ", over the baseline" } else { "" };
    format!("{}: {what}{and}", selection.title(results))
}

fn notes(measure: Measure, selection: &Selection<'_>, rows: &[Row<'_>]) -> Vec<String> {
    let what = match measure {
        Measure::Bias => "|bias|",
        Measure::Sd => "standard deviation",
    };
    let mut notes = vec![format!(
        "Root mean square of the {what} over the parameters of each group; {}; bars: ± 2 Monte-Carlo standard errors.",
        selection.replicates()
    )];
    if rows.len() < selection.borders().len() * selection.points().len() {
        let largest = rows.first().map_or(0, |r| r.points);
        notes.push(format!("Shown for m = {largest}; every other m is in table.csv."));
    }
    notes
}

fn legend(measure: Measure, noises: &[f64], selection: &Selection<'_>, over_baseline: bool) -> Vec<Entry> {
    let mut entries: Vec<Entry> = noises
        .iter()
        .zip(&OKABE_ITO)
        .map(|(&noise, &colour)| {
            Entry::new(Sample::Disc(Pen::new(colour, 1.5), true), format!("noise {}", plain(noise)))
        })
        .collect();
    if over_baseline {
        entries.push(Entry::new(Sample::Disc(Pen::new(GREY, 1.5), true), "grey, left of it: the baseline"));
    }
    let has = |f: fn(&Parameter) -> bool| selection.cells.iter().any(|c| c.parameters.iter().any(f));
    match measure {
        Measure::Bias => {
            let hollow = Sample::Disc(Pen::new(INK, 1.5), false);
            entries.push(Entry::new(hollow, "hollow: not told from zero (below 2 MCSE)"));
            let slope = Sample::Dashes(Pen::new(GREY, 1.5), Dash::Dots);
            entries.push(Entry::new(slope, "law 1/N through the first resolved point"));
            if has(|p| p.bias_controlled.is_some()) {
                let faint = Sample::Bar(Pen::new(tint(INK, 0.35), 1.5));
                entries.push(Entry::new(faint, "behind: the same without control variate"));
            }
        }
        Measure::Sd => {
            if has(|p| p.theory_sd.is_some()) {
                entries.push(Entry::new(Sample::Line(Pen::new(INK, THEORY_WIDTH)), "asymptotic theory"));
            }
            if has(|p| p.bound_sd.is_some()) {
                let dashes = Sample::Dashes(Pen::new(INK, THEORY_WIDTH), Dash::Dashes);
                entries.push(Entry::new(dashes, "Cramér–Rao bound"));
            }
        }
    }
    entries
}

/// The cells that the figure draws.
fn shown<'r>(rows: &[Row<'_>], selections: [Option<&Selection<'r>>; 2]) -> Vec<&'r Cell> {
    let drawn = |c: &&Cell| rows.iter().any(|r| r.border == c.series.border && r.points == c.series.points);
    selections.into_iter().flatten().flat_map(|s| s.cells.iter().copied()).filter(drawn).collect()
}

/// Axes that all rows of a column share, so that they can be compared.
fn axes(measure: Measure, shown: &[&Cell], group: Group) -> (Axis, Axis) {
    let measured = |f: fn(&Parameter) -> Option<Measured>| {
        shown
            .iter()
            .filter_map(move |c| root_mean_square(c, group, f))
            .flat_map(|m| [m.value(), m.value() + 2.0 * m.mcse()])
            .collect::<Vec<f64>>()
    };
    let exact = |f: fn(&Parameter) -> Option<f64>| {
        shown.iter().filter_map(move |c| root_mean_square_exact(c, group, f)).collect::<Vec<f64>>()
    };
    let values = match measure {
        Measure::Bias => [measured(|p| p.bias), measured(|p| p.bias_controlled)].concat(),
        Measure::Sd => [measured(Parameter::best_sd), exact(|p| p.theory_sd), exact(|p| p.bound_sd)].concat(),
    };
    (Axis::logarithmic(shown.iter().map(|c| c.samples as f64)), Axis::logarithmic(values))
}

/// The cells of one noise level in one diagram.
struct Curve<'r> {
    cells: Vec<&'r Cell>,
    group: Group,
    colour: RGBColor,
    /// How far marks stand beside their place where they would cover others, pixels.
    aside: f64,
    /// Of the discs, pixels; what is drawn later is smaller, so that equal values show as rings.
    radius: f64,
}

impl Curve<'_> {
    fn draw_bias(&self, panel: &Panel<'_, '_>) {
        let controlled = self.pooled(|p| p.bias_controlled);
        let plain = self.pooled(|p| p.bias);
        let front = if controlled.is_empty() { &plain } else { &controlled };
        if !controlled.is_empty() {
            let pen = Pen::new(tint(self.colour, 0.3), 1.5);
            for (n, bias) in &plain {
                panel.mark(
                    *n,
                    bias.value(),
                    bar(bias),
                    Mark { pen, radius: 2.5, filled: true, aside: self.aside },
                );
            }
        }
        if let Some((n0, b0)) = front.iter().find(|(n, b)| self.resolved(*n, b)) {
            let last = self.cells.last().map_or(*n0, |c| c.samples as f64);
            let law = [(*n0, b0.value()), (last, b0.value() * n0 / last)];
            panel.dashes(&law, Dash::Dots, Pen::new(self.colour, 1.5));
        }
        for (n, bias) in front {
            let filled = self.resolved(*n, bias);
            let aside = if filled { 0.0 } else { self.aside };
            let mark = Mark { pen: Pen::new(self.colour, 1.5), radius: self.radius, filled, aside };
            panel.mark(*n, bias.value(), bar(bias), mark);
        }
    }

    fn draw_sd(&self, panel: &Panel<'_, '_>) {
        let pen = Pen::new(tint(self.colour, 0.75), THEORY_WIDTH);
        panel.line(&self.exact(|p| p.theory_sd), pen);
        panel.dashes(&self.exact(|p| p.bound_sd), Dash::Dashes, pen);
        for (n, sd) in self.pooled(Parameter::best_sd) {
            let mark =
                Mark { pen: Pen::new(self.colour, 1.5), radius: self.radius, filled: true, aside: 0.0 };
            panel.mark(n, sd.value(), bar(&sd), mark);
        }
    }

    /// The figures alone, smaller and beside their place.
    fn draw_behind(&self, panel: &Panel<'_, '_>, measure: Measure) {
        let figures = match measure {
            Measure::Bias => self.pooled(Parameter::best_bias),
            Measure::Sd => self.pooled(Parameter::best_sd),
        };
        let mark =
            Mark { pen: Pen::new(self.colour, 1.2), radius: self.radius, filled: true, aside: self.aside };
        for (n, figure) in figures {
            panel.mark(n, figure.value(), bar(&figure), mark);
        }
    }

    /// Whether a pooled bias exceeds twice what it would show if the true one were zero.
    fn resolved(&self, n: f64, bias: &Measured) -> bool {
        let floor = self.cells.iter().find(|c| c.samples as f64 == n).and_then(|cell| {
            let controlled =
                cell.parameters.iter().any(|p| p.group == self.group && p.bias_controlled.is_some());
            root_mean_square_exact(cell, self.group, |p| {
                let bias = if controlled { p.bias_controlled } else { p.bias };
                bias.map(|b| b.mcse())
            })
        });
        bias.value() >= 2.0 * floor.unwrap_or(bias.mcse())
    }

    fn pooled(&self, measure: impl Fn(&Parameter) -> Option<Measured>) -> Vec<(f64, Measured)> {
        let at = |c: &&Cell| Some((c.samples as f64, root_mean_square(c, self.group, &measure)?));
        self.cells.iter().filter_map(at).collect()
    }

    fn exact(&self, measure: impl Fn(&Parameter) -> Option<f64>) -> Vec<(f64, f64)> {
        let at = |c: &&Cell| Some((c.samples as f64, root_mean_square_exact(c, self.group, &measure)?));
        self.cells.iter().filter_map(at).collect()
    }
}

/// Two Monte-Carlo standard errors to either side; down to the frame where zero lies within.
fn bar(m: &Measured) -> (f64, f64) {
    let low = m.value() - 2.0 * m.mcse();
    (if low > 0.0 { low } else { f64::MIN_POSITIVE }, m.value() + 2.0 * m.mcse())
}
