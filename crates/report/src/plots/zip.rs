//! Zip plots: do the 95 % intervals hold the truth, and if not, why?
//!
//! Intervals in the order of how far their centre misses the truth, in units of their own half width (I. R. White, Stata Journal 10 (2010);
//! Morris, White and Crowther, Statistics in Medicine 38 (2019), Figure 6, doi 10.1002/sim.8086). Results hold counts by class of that
//! distance, so each line stands for one hundredth of the intervals, and its place within a class is interpolated.

use super::axis::Axis;
use super::canvas::{Canvas, Dash, Towards};
use super::legend::{Entry, Sample};
use super::panel::{Mark, Numbers, Panel};
use super::selection::{CaseSelection, Selection, replicates};
use super::sheet::{Frames, Grid, Sheet};
use super::spread::{ERRORS, Spread, samples_axis};
use super::style::{BAD, GOOD, GREY, INK, OKABE_ITO, Pen, SMALL_RADIUS, TextLook, count, percent};
use switchback_identify::statistics::{CLASS_ENDS, CLASSES, IntervalCounts};
use switchback_study::results::{Cell, Group, Measured, Results};

/// Lines in a diagram.
const LINES: usize = 100;
/// The share of intervals that should hold the truth.
const NOMINAL: f64 = 0.95;
/// How far the horizontal axis goes, half widths of an interval.
const REACH: f64 = 3.6;
/// The least coverage that has a place.
const LEAST: f64 = 0.85;
/// Pixels between marks at the same `N`.
const APART: f64 = 4.0;

/// Draws one figure: columns are methods, the rows zip plots at the smallest and the largest `N` over all parameters, borders, `m` and noise
/// levels, and the coverage against `N`. `None` where results do not hold what it is drawn from.
pub(super) fn figure(case: &CaseSelection<'_>, results: &Results) -> Option<String> {
    case.cells().find(|c| !c.intervals.is_empty())?;
    let samples = case.samples();
    let mut rows = vec![*samples.first()?];
    rows.extend(samples.last().copied().filter(|last| *last > rows[0]));
    let notes = vec![
        format!(
            "Upper rows: every line stands for a hundredth of the intervals of all parameters, border shapes, m and noise levels, by \
             how far its centre misses the truth, both in half widths of the interval. Intervals that are sound miss above the line at {}, \
             as often on either side: a slant is bias, a wide zip are intervals that are too narrow. {}.",
            percent(NOMINAL, 0),
            replicates(case.cells())
        ),
        format!(
            "Lower row: mean coverage of a group of parameters; median over border shapes, m and noise levels, bars from the least to the \
             greatest with {ERRORS} Monte-Carlo standard errors."
        ),
    ];
    let grid = Grid { apart: 58.0, ..Grid::shared(rows.len() + 1, case.methods.len(), 200.0) };
    let mut sheet =
        Sheet::new(format!("{}: coverage of the 95 % intervals", case.title(results)), notes, grid);
    sheet.legend = vec![
        Entry::line(GOOD, "holds the truth"),
        Entry::line(BAD, "misses it"),
        Entry::new(Sample::Arrow(Towards::Right, BAD), "beyond the frame"),
        Entry::new(Sample::Dashes(Pen::data(GREY), Dash::Dashes), "nominal"),
    ];
    let groups = case.groups();
    sheet
        .legend
        .extend(groups.iter().zip(OKABE_ITO.into_iter().skip(2)).map(|(g, c)| Entry::disc(c, g.label())));
    Some(sheet.render(|canvas, frames| {
        for (column, selection) in case.methods.iter().enumerate() {
            for (row, n) in rows.iter().enumerate() {
                let panel = zip(canvas, frames, (row, column), (selection, *n));
                if row == 0 {
                    panel.title(&selection.method.to_string());
                }
                if column == 0 {
                    panel.y_name(&format!("centile, N = {}", count(*n)), 62.0);
                }
                if row + 1 == rows.len() {
                    panel.x_name("half widths");
                }
            }
            coverage(canvas, frames, (rows.len(), column), (selection, &samples, &groups));
        }
    }))
}

/// Counts of the cells of a method at one `N`, all parameters together.
fn pooled(selection: &Selection<'_>, n: usize) -> IntervalCounts {
    let mut all = IntervalCounts::default();
    for intervals in selection.cells.iter().filter(|c| c.samples == n).flat_map(|c| &c.intervals) {
        all.merge(&IntervalCounts { below: intervals.below, above: intervals.above });
    }
    all
}

/// Where the centres of so many lines lie, in half widths from the truth, the nearest first; infinite where no class says how far.
fn centres(counts: &IntervalCounts, lines: usize) -> Vec<f64> {
    let of_class = |k: usize| f64::from(counts.below[k]) + f64::from(counts.above[k]);
    let total: f64 = (0..CLASSES).map(of_class).sum();
    let mut centres = Vec::with_capacity(lines);
    let (mut class, mut before, mut above) = (0, 0.0, 0.5);
    for i in 0..lines {
        let rank = (i as f64 + 0.5) / lines as f64 * total;
        while class + 1 < CLASSES && before + of_class(class) < rank {
            before += of_class(class);
            class += 1;
        }
        let start = if class == 0 { 0.0 } else { CLASS_ENDS[class - 1] };
        let distance = match CLASS_ENDS.get(class) {
            Some(end) => start + (end - start) * (rank - before) / of_class(class).max(1.0),
            None => f64::INFINITY,
        };
        // Sides take turns as often as the class has either.
        above += f64::from(counts.above[class]) / of_class(class).max(1.0);
        let side = if above >= 1.0 { 1.0 } else { -1.0 };
        above -= f64::from(u8::from(above >= 1.0));
        centres.push(side * distance);
    }
    centres
}

fn zip<'c>(
    canvas: &'c Canvas,
    frames: &Frames,
    (row, column): (usize, usize),
    (selection, n): (&Selection<'_>, usize),
) -> Panel<'c> {
    let axes = (Axis::between(-REACH, REACH), Axis::percent(0.0, 1.0));
    let place = (frames.corner(row, column), frames.size());
    let panel = Panel::with_numbers(canvas, place, axes, Numbers { x: true, y: column == 0 });
    let counts = pooled(selection, n);
    let total: u64 = counts.below.iter().chain(&counts.above).map(|c| u64::from(*c)).sum();
    if total == 0 {
        panel.remark("no estimate");
        return panel;
    }
    for (i, centre) in centres(&counts, LINES).into_iter().enumerate() {
        let colour = if centre.abs() <= 1.0 { GOOD } else { BAD };
        let y = (i as f64 + 0.5) / LINES as f64;
        let mark = Mark::bar(Pen::hair(colour));
        if centre.abs() < REACH + 1.0 {
            panel.line(&[(centre - 1.0, y), (centre + 1.0, y)], mark.pen);
        } else if i % 4 == 0 {
            // Every fourth of those that are out of sight, or arrows cover each other.
            panel.point(centre.signum() * 2.0 * REACH, y, mark);
        }
    }
    panel.upright(0.0, None, Pen::hair(INK));
    panel.level(NOMINAL, Some(Dash::Dashes), Pen::hair(GREY));
    let within: u64 = (0..4).map(|k| u64::from(counts.below[k]) + u64::from(counts.above[k])).sum();
    let look = TextLook::number().bold().end();
    panel.text(&percent(within as f64 / total as f64, 1), (REACH, 0.0), (-14.0, -10.0), look);
    panel
}

/// Mean coverage over a group.
fn mean_coverage(cell: &Cell, group: Group) -> Option<Measured> {
    let of_group = cell.parameters.iter().filter(|p| p.group == group).filter_map(|p| p.coverage);
    let figures: Vec<Measured> = of_group.collect();
    let mean = |f: fn(&Measured) -> f64| figures.iter().map(f).sum::<f64>() / figures.len() as f64;
    // Errors are added as if they always agreed, as they may: an upper bound.
    Measured::new(mean(Measured::value), mean(Measured::mcse))
}

fn coverage(
    canvas: &Canvas,
    frames: &Frames,
    (row, column): (usize, usize),
    (selection, samples, groups): (&Selection<'_>, &[usize], &[Group]),
) {
    let axes = (samples_axis(samples.iter().copied(), groups.len()), Axis::percent(LEAST, 1.0));
    let place = (frames.corner(row, column), frames.size());
    let panel = Panel::with_numbers(canvas, place, axes, Numbers { x: true, y: column == 0 });
    panel.level(NOMINAL, Some(Dash::Dashes), Pen::hair(GREY));
    let middle = (groups.len() - 1) as f64 / 2.0;
    for (k, (group, colour)) in groups.iter().zip(OKABE_ITO.into_iter().skip(2)).enumerate() {
        let mark = Mark { aside: APART * (k as f64 - middle), ..Mark::disc(Pen::data(colour), SMALL_RADIUS) };
        for n in samples {
            let cells = selection.cells.iter().filter(|c| c.samples == *n);
            if let Some(spread) = Spread::of_measured(cells.filter_map(|c| mean_coverage(c, *group))) {
                panel.mark(*n as f64, spread.middle, spread.ends, mark);
            }
        }
    }
    panel.x_name("samples N");
    if column == 0 {
        panel.y_name("coverage", 62.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_stand_where_their_hundredths_are() {
        // Half of the estimates within a quarter of a half width, evenly on both sides; the other half far above.
        let mut counts = IntervalCounts::default();
        (counts.below[0], counts.above[0], counts.above[CLASSES - 1]) = (25, 25, 50);
        let centres = centres(&counts, 100);
        assert_eq!(centres.iter().filter(|c| c.abs() <= 0.25).count(), 50);
        assert_eq!(centres.iter().filter(|c| **c < 0.0).count(), 25);
        assert!(centres[50..].iter().all(|c| *c == f64::INFINITY));
        assert!(centres[..50].windows(2).all(|pair| pair[0].abs() < pair[1].abs()));
        assert!((centres[24].abs() - 0.1225).abs() < 1e-12);
    }

    #[test]
    fn shares_of_lines_that_hold_the_truth_are_the_coverage() {
        let mut counts = IntervalCounts::default();
        counts.below[3] = 470;
        counts.above[2] = 480;
        counts.above[4] = 50;
        let held = centres(&counts, 100).iter().filter(|c| c.abs() <= 1.0).count();
        assert_eq!(held, 95);
    }

    #[test]
    fn nothing_counted_draws_nothing() {
        assert!(centres(&IntervalCounts::default(), 3).iter().all(|c| c.is_finite()));
    }
}
