//! True against estimated borders.

use super::axis::Axis;
use super::legend::{Entry, Sample};
use super::panel::{Mark, Panel};
use super::selection::Selection;
use super::sheet::{Grid, Sheet};
use super::spread::ERRORS;
use super::style::{ASCENDING, DESCENDING, PALE, Pen, RADIUS, count, plain, tint};
use plotters::style::RGBColor;
use switchback_study::results::{BorderCurve, Cell, CurvePoint, Group, Parameter, Results};

/// The borders, and how far the bars of each stand beside their place, pixels, so that neither hides the other.
const BORDERS: [(Group, RGBColor, f64); 2] =
    [(Group::Ascending, ASCENDING, 3.0), (Group::Descending, DESCENDING, -3.0)];
const COLUMNS: usize = 2;

/// Draws one figure: a diagram a border shape, at the largest noise and `m`, for the smallest and largest `N`.
///
/// `None` for a method that estimates no border.
pub(super) fn figure(selection: &Selection<'_>, results: &Results) -> Option<String> {
    let sees_borders = |g: &Group| matches!(g, Group::Descending | Group::Ascending);
    if !selection.groups().iter().any(sees_borders) {
        return None;
    }
    let points = selection.points().last().copied()?;
    let noise = selection.noises().last().copied()?;
    let borders = selection.borders();
    let columns = borders.len().min(COLUMNS);
    let mut sheet = Sheet::new(
        format!("{}: true and estimated borders", selection.title(results)),
        vec![format!(
            "F in units of u_M − u_m, m = {points} points, noise {}; mean of the estimates ± {ERRORS} of their standard \
             deviations, {}.",
            plain(noise),
            selection.replicates()
        )],
        Grid::new(borders.len().div_ceil(columns), columns, 300.0),
    );
    sheet.legend = legend(selection, &borders, points, noise);
    Some(sheet.render(|canvas, frames| {
        for (i, border) in borders.iter().enumerate() {
            let curve = selection.curve(border, points, noise);
            let truth = results.curves.iter().find(|c| c.case == selection.case && c.border == *border);
            let panel = frames.panel(canvas, (i / columns, i % columns), axes(&curve, truth));
            panel.title(border);
            panel.x_name(&results.labels.input);
            if i % columns == 0 {
                panel.y_name("F", 54.0);
            }
            contents(&panel, &curve, truth);
        }
    }))
}

fn legend(selection: &Selection<'_>, borders: &[&str], points: usize, noise: f64) -> Vec<Entry> {
    let line =
        |(group, colour, _): (Group, RGBColor, f64)| Entry::line(colour, format!("true {}", group.label()));
    let mut entries: Vec<Entry> = BORDERS.into_iter().map(line).collect();
    let curve = borders.first().map_or_else(Vec::new, |b| selection.curve(b, points, noise));
    let seen = |(group, ..): &(Group, RGBColor, f64)| selection.groups().contains(group);
    for (group, colour, _) in BORDERS.into_iter().filter(seen) {
        let name = group.label().split(' ').next().unwrap_or_default();
        if let Some(last) = curve.last() {
            entries.push(Entry::disc(colour, format!("{name}, N = {}", count(last.samples))));
        }
        if let Some(first) = curve.first().filter(|_| curve.len() > 1) {
            let bar = Sample::Bar(Pen::data(tint(colour, PALE)));
            entries.push(Entry::new(bar, format!("{name}, N = {}", count(first.samples))));
        }
    }
    entries
}

/// An estimated point: position, mean, and two standard deviations.
fn estimates(cell: &Cell, group: Group) -> Vec<(f64, f64, f64)> {
    cell.parameters
        .iter()
        .filter(|p| p.group == group)
        .filter_map(|p| {
            Some((p.v?, mean(p)?, p.sd.or(p.sd_controlled).map_or(0.0, |sd| ERRORS * sd.value())))
        })
        .collect()
}

/// The mean estimate; a condensed table shows it by the bias.
fn mean(parameter: &Parameter) -> Option<f64> {
    parameter.mean_estimate.or_else(|| Some(parameter.truth + parameter.best_bias()?.value()))
}

/// The truth and the estimates at the largest `N` set the scale. Bars of the smallest `N` widen it by half its height to
/// either side at most; beyond, they leave the frame and end in an arrow.
fn axes(curve: &[&Cell], truth: Option<&BorderCurve>) -> (Axis, Axis) {
    let points = truth.map_or(&[][..], |t| &t.points);
    let all = |cell: Option<&&Cell>| -> Vec<(f64, f64, f64)> {
        cell.map_or_else(Vec::new, |c| BORDERS.iter().flat_map(|(g, ..)| estimates(c, *g)).collect())
    };
    let (first, last) = (all(curve.first()), all(curve.last()));
    let ends = |e: &(f64, f64, f64)| [e.1 - e.2, e.1 + e.2];
    let x = points.iter().map(|p| p.v).chain(last.iter().map(|e| e.0));
    let tight = Axis::linear(
        points.iter().flat_map(|p| [p.descending, p.ascending]).chain(last.iter().flat_map(ends)),
    );
    let half = (tight.high() - tight.low()) / 2.0;
    let wide = first.iter().flat_map(ends).map(|y| y.clamp(tight.low() - half, tight.high() + half));
    (Axis::linear(x), Axis::linear(wide.chain([tight.low(), tight.high()])))
}

fn contents(panel: &Panel<'_>, curve: &[&Cell], truth: Option<&BorderCurve>) {
    let (first, last) = (curve.first(), curve.last());
    for (group, colour, aside) in BORDERS {
        if let Some(cell) = first.filter(|f| last.is_some_and(|l| l.samples > f.samples)) {
            let faint = Mark { aside, ..Mark::bar(Pen::data(tint(colour, PALE))) };
            for (v, mean, reach) in estimates(cell, group) {
                panel.mark(v, mean, (mean - reach, mean + reach), faint);
            }
        }
    }
    for (group, colour, _) in BORDERS {
        if let Some(truth) = truth {
            let value = |p: &CurvePoint| match group {
                Group::Ascending => (p.v, p.ascending),
                _ => (p.v, p.descending),
            };
            let line: Vec<(f64, f64)> = truth.points.iter().map(value).collect();
            panel.line(&line, Pen::data(colour));
        }
        if let Some(cell) = last {
            let mark = Mark::disc(Pen::data(colour), RADIUS);
            for (v, mean, reach) in estimates(cell, group) {
                panel.mark(v, mean, (mean - reach, mean + reach), mark);
            }
        }
    }
}
