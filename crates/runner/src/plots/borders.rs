//! True against estimated borders.

use super::axis::{Axis, plain};
use super::canvas::Pen;
use super::legend::{Entry, Sample};
use super::palette::{OKABE_ITO, tint};
use super::panel::{Mark, Panel};
use super::selection::Selection;
use super::sheet::{Grid, Sheet};
use crate::results::{BorderCurve, Cell, Group, Results};
use plotters::style::RGBColor;

/// Ascending in vermillion, descending in blue.
const COLOURS: [(Group, RGBColor); 2] = [(Group::Ascending, OKABE_ITO[1]), (Group::Descending, OKABE_ITO[0])];
const COLUMNS: usize = 3;

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
    let sheet = Sheet {
        title: format!("{}: true and estimated borders", selection.title(results)),
        notes: vec![format!(
            "F in the normalisation u_M − u_m = 1, m = {points} points, noise {}; mean of the estimates ± 2 of their \
             standard deviations, {}.",
            plain(noise),
            selection.replicates()
        )],
        legend: legend(selection, &borders, points, noise),
        grid: Grid {
            columns,
            rows: borders.len().div_ceil(columns),
            height: 300.0,
            left: 78.0,
            between: 62.0,
            above: 84.0,
        },
    };
    Some(sheet.render(|canvas, frames| {
        for (i, border) in borders.iter().enumerate() {
            let curve = selection.curve(border, points, noise);
            let truth = results.curves.iter().find(|c| c.case == selection.case && c.border == *border);
            let corner = frames.corner(i / columns, i % columns);
            let panel = Panel::new(canvas, corner, frames.size(), axes(&curve, truth));
            panel.title(border);
            panel.x_name(&results.labels.input);
            if i % columns == 0 {
                panel.y_name("F", 58.0);
            }
            contents(&panel, &curve, truth);
        }
    }))
}

fn legend(selection: &Selection<'_>, borders: &[&str], points: usize, noise: f64) -> Vec<Entry> {
    let mut entries: Vec<Entry> = COLOURS
        .iter()
        .map(|(group, colour)| {
            Entry::new(Sample::Line(Pen::new(*colour, 1.5)), format!("true {}", group.label()))
        })
        .collect();
    let curve = borders.first().map_or_else(Vec::new, |b| selection.curve(b, points, noise));
    if let (Some(first), Some(last)) = (curve.first(), curve.last()) {
        let colour = COLOURS[1].1;
        if first.samples < last.samples {
            let wide = Sample::Bar(Pen::new(tint(colour, 0.4), 4.0));
            entries.push(Entry::new(wide, format!("estimates, N = {}", first.samples)));
        }
        let disc = Sample::Disc(Pen::new(colour, 1.5), true);
        entries.push(Entry::new(disc, format!("estimates, N = {}", last.samples)));
    }
    entries
}

/// An estimated point: position, mean, and two standard deviations.
fn estimates(cell: &Cell, group: Group) -> Vec<(f64, f64, f64)> {
    cell.parameters
        .iter()
        .filter(|p| p.group == group)
        .filter_map(|p| Some((p.v?, p.mean_estimate?, p.sd.map_or(0.0, |sd| 2.0 * sd.value()))))
        .collect()
}

/// The truth and the estimates at the largest `N` set the scale. Bars of the smallest `N` widen it by half its height to
/// either side at most; beyond, they leave the frame.
fn axes(curve: &[&Cell], truth: Option<&BorderCurve>) -> (Axis, Axis) {
    let points = truth.map_or(&[][..], |t| &t.points);
    let all = |cell: Option<&&Cell>| -> Vec<(f64, f64, f64)> {
        cell.map_or_else(Vec::new, |c| COLOURS.iter().flat_map(|(g, _)| estimates(c, *g)).collect())
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

fn contents(panel: &Panel<'_, '_>, curve: &[&Cell], truth: Option<&BorderCurve>) {
    let (first, last) = (curve.first(), curve.last());
    for (group, colour) in COLOURS {
        if let Some(cell) = first.filter(|f| last.is_some_and(|l| l.samples > f.samples)) {
            let faint = Mark { pen: Pen::new(tint(colour, 0.4), 4.0), radius: 0.0, filled: true, aside: 0.0 };
            for (v, mean, reach) in estimates(cell, group) {
                panel.mark(v, mean, (mean - reach, mean + reach), faint);
            }
        }
    }
    for (group, colour) in COLOURS {
        if let Some(truth) = truth {
            let value = |p: &crate::results::CurvePoint| match group {
                Group::Ascending => (p.v, p.ascending),
                _ => (p.v, p.descending),
            };
            let line: Vec<(f64, f64)> = truth.points.iter().map(value).collect();
            panel.line(&line, Pen::new(colour, 1.5));
        }
        if let Some(cell) = last {
            let mark = Mark { pen: Pen::new(colour, 1.5), radius: 4.0, filled: true, aside: 0.0 };
            for (v, mean, reach) in estimates(cell, group) {
                panel.mark(v, mean, (mean - reach, mean + reach), mark);
            }
        }
    }
}
