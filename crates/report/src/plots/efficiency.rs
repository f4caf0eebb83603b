//! Variance over the Cramér–Rao bound, all methods on one axis.

use super::axis::Axis;
use super::canvas::{Canvas, Dash};
use super::legend::{Entry, Sample};
use super::panel::{Mark, Panel};
use super::selection::{CaseSelection, distinct, replicates, thinned};
use super::sheet::{Frames, Grid, Sheet};
use super::spread::{ERRORS, Spread};
use super::style::{
    FAINT, GREY, MARGIN, OKABE_ITO, Pen, SMALL_RADIUS, Shape, TextLook, count, rounded, tint,
};
use switchback_study::MethodName;
use switchback_study::results::{Group, Measured, Results, Series, Summary};

/// Height of a method's row and of the heading of a group, pixels.
const ROW: f64 = 30.0;
/// Room for the median right of the frame, pixels.
const MEDIAN: f64 = 60.0;

/// A row: a method in a group of parameters, with what each of its curves reaches at the largest `N`.
struct Row<'r> {
    group: Group,
    method: String,
    figures: Vec<(&'r Series, Measured)>,
}

/// Draws one figure: a row a method in each group of parameters, a mark a curve (border, `m`, noise) at the largest `N`.
///
/// `None` where no method has a bound.
pub(super) fn figure(case: &CaseSelection<'_>, results: &Results) -> Option<String> {
    let rows = rows(case, results);
    if rows.is_empty() {
        return None;
    }
    let methods = |has: bool| -> Vec<String> {
        let names = case.methods.iter().map(|s| s.method.to_string());
        names.filter(|name| rows.iter().any(|r| r.method == *name) == has).collect()
    };
    let mut notes = vec![format!(
        "Mean over a group of parameters of the variance over its Cramér–Rao bound, N = {}; a mark a border, m and noise level, \
         bars ± {ERRORS} jackknifed standard errors; right: the median. {}.",
        count(case.samples().last().copied().unwrap_or(0)),
        replicates(case.cells())
    )];
    let (without, points) = (methods(false), points(&rows));
    if !without.is_empty() {
        notes.push(format!("Without a bound, as they are biased: {}.", without.join(", ")));
    }
    let grid = Grid { left: 300.0, ..Grid::new(1, 1, ROW * rows.len() as f64) };
    let mut sheet =
        Sheet::new(format!("{}: variance over the Cramér–Rao bound", case.title(results)), notes, grid);
    sheet.legend = points
        .iter()
        .zip(OKABE_ITO)
        .zip(Shape::ALL.into_iter().cycle())
        .map(|((m, colour), shape)| {
            Entry::new(Sample::Mark(shape, Pen::data(colour), true), format!("m = {m}"))
        })
        .chain([Entry::new(Sample::Dashes(Pen::data(GREY), Dash::Dashes), "the bound")])
        .collect();
    Some(sheet.render(|canvas, frames| draw(canvas, frames, &rows, &points)))
}

fn rows<'r>(case: &CaseSelection<'_>, results: &'r Results) -> Vec<Row<'r>> {
    let of = |group: Group, method: &MethodName| {
        let mine =
            |s: &&Summary| s.series.case == case.case && s.series.method == *method && s.group == group;
        let figure = |s: &'r Summary| Some((&s.series, s.variance_over_bound?));
        let figures: Vec<_> = results.summaries.iter().filter(mine).filter_map(figure).collect();
        (!figures.is_empty()).then(|| Row { group, method: method.to_string(), figures })
    };
    let groups = case.groups();
    groups.into_iter().flat_map(|g| case.methods.iter().filter_map(move |s| of(g, s.method))).collect()
}

fn points(rows: &[Row<'_>]) -> Vec<usize> {
    let mut points = distinct(rows.iter().flat_map(|r| r.figures.iter().map(|(s, _)| s.points)));
    points.sort_unstable();
    thinned(&points, OKABE_ITO.len())
}

fn draw(canvas: &Canvas, frames: &Frames, rows: &[Row<'_>], points: &[usize]) {
    let ((left, top), (width, height)) = (frames.corner(0, 0), frames.size());
    let size = (width - MEDIAN, height);
    let ends = rows.iter().flat_map(|r| &r.figures).flat_map(|(_, m)| {
        let reach = ERRORS * m.mcse();
        [m.value() - reach, m.value() + reach]
    });
    let x = Axis::logarithmic(ends.chain([1.0]));
    let mut shaded = true;
    for (i, row) in rows.iter().enumerate() {
        let middle = top + ROW * (i as f64 + 0.5);
        if i == 0 || rows[i - 1].group != row.group {
            shaded = !shaded;
            canvas.text(row.group.label(), (MARGIN, middle), TextLook::heading());
        }
        if shaded {
            canvas.fill((left, middle - ROW / 2.0), (left + size.0, middle + ROW / 2.0), tint(FAINT, 0.5));
        }
        canvas.text(&row.method, (left - 10.0, middle), TextLook::label().end());
        if let Some(spread) = Spread::of_measured(row.figures.iter().map(|(_, m)| *m)) {
            let text = if spread.middle < 100.0 {
                format!("{:.2}", spread.middle)
            } else {
                rounded(spread.middle, 3)
            };
            canvas.text(&text, (left + width, middle), TextLook::number().end());
        }
    }
    let panel = Panel::new(canvas, (left, top), size, (x, Axis::rows(rows.len() as f64)));
    panel.x_name("variance over bound");
    panel.upright(1.0, Some(Dash::Dashes), Pen::data(GREY));
    for (i, row) in rows.iter().enumerate() {
        marks(&panel, i, row, points);
    }
}

fn marks(panel: &Panel<'_>, i: usize, row: &Row<'_>, points: &[usize]) {
    let looks = points.iter().zip(OKABE_ITO).zip(Shape::ALL.into_iter().cycle());
    for (k, ((m, colour), shape)) in looks.enumerate() {
        let figures: Vec<_> = row.figures.iter().filter(|(s, _)| s.points == *m).collect();
        for (j, (_, figure)) in figures.iter().enumerate() {
            // Spread over the row, so that neighbours are seen.
            let place = (k as f64 + (j as f64 + 0.5) / figures.len() as f64) / points.len() as f64;
            let aside = (ROW - 6.0) * (place - 0.5);
            let reach = ERRORS * figure.mcse();
            let ends = ((figure.value() - reach).max(f64::MIN_POSITIVE), figure.value() + reach);
            let mark = Mark { shape, aside, ..Mark::disc(Pen::hair(colour), SMALL_RADIUS) };
            panel.level_mark(ends, figure.value(), i as f64 + 0.5, mark);
        }
    }
}
