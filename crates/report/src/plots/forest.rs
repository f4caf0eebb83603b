//! Paired differences, a row a parameter: a forest plot.

use super::against::{Against, Pairs};
use super::axis::Axis;
use super::canvas::{Canvas, Towards};
use super::legend::{Entry, Sample};
use super::panel::{Mark, Panel};
use super::selection::{CaseSelection, thinned};
use super::sheet::{Frames, Grid, Sheet};
use super::spread::ERRORS;
use super::style::{
    FAINT, GREY, INK, OKABE_ITO, PALE, Pen, RADIUS, SMALL_RADIUS, Shape, TextLook, count, plain, tint,
};
use switchback_study::results::{Cell, Comparison, Paired, PairedParameter, Results, Series};

/// More parameters than this are thinned, the ends kept.
const MOST: usize = 14;
/// Height of one side's line, and what a row has beside its lines, pixels.
const LINE: f64 = 9.0;
const BETWEEN: f64 = 8.0;
/// A bias of more than this share of the standard deviation is distinguished from no bias without a scale.
const SMALL_BIAS: f64 = 0.1;

/// The columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Variance,
    SquaredError,
    Bias,
}

impl Column {
    const ALL: [Self; 3] = [Self::Variance, Self::SquaredError, Self::Bias];

    fn name(self) -> &'static str {
        match self {
            Self::Variance => "ratio of variances",
            Self::SquaredError => "ratio of squared errors",
            Self::Bias => "difference of bias [sd]",
        }
    }

    /// Where both sides are equal.
    fn equal(self) -> f64 {
        if self == Self::Bias { 0.0 } else { 1.0 }
    }
}

/// A figure with its interval on shared noise, and that of independent runs.
#[derive(Debug, Clone, Copy)]
struct Reported {
    value: f64,
    paired: (f64, f64),
    unpaired: (f64, f64),
}

impl Reported {
    fn ratio(p: Paired) -> Self {
        Self { value: p.value(), paired: p.interval(ERRORS), unpaired: p.unpaired_interval(ERRORS) }
    }

    /// A difference in units of a standard deviation.
    fn difference(p: Paired, sd: f64) -> Self {
        let around = |error: f64| ((p.value() - ERRORS * error) / sd, (p.value() + ERRORS * error) / sd);
        Self { value: p.value() / sd, paired: around(p.mcse()), unpaired: around(p.unpaired_mcse()) }
    }
}

/// Draws one figure, at the largest noise and `N`, the smallest `m`, and the first border (or method).
pub(super) fn figure(pairs: &Pairs<'_>, case: &CaseSelection<'_>, results: &Results) -> Option<String> {
    let forest = Forest::new(pairs, results)?;
    let title = format!("{}: paired differences of {}", case.title(results), pairs.against.name());
    let lines = forest.chosen.len() as f64 * LINE + BETWEEN;
    let rows = forest.rows.len() + usize::from(!pairs.overall.is_empty());
    let height = lines * rows as f64;
    let grid = Grid { left: 116.0, between: 36.0, ..Grid::new(1, Column::ALL.len(), height) };
    let mut sheet = Sheet::new(title, forest.notes(pairs), grid);
    sheet.legend = forest.legend();
    Some(sheet.render(|canvas, frames| forest.draw(canvas, frames, (pairs, lines))))
}

struct Forest<'r> {
    /// The sides, each with what it is compared with: parameters that the first method lacks are compared with another's.
    chosen: Vec<(String, Vec<&'r Comparison>)>,
    /// Names of the parameters.
    rows: Vec<&'r str>,
    results: &'r Results,
}

impl<'r> Forest<'r> {
    fn new(pairs: &Pairs<'r>, results: &'r Results) -> Option<Self> {
        let noise = pairs.comparisons.iter().map(|c| c.series.noise).max_by(f64::total_cmp)?;
        let points = pairs.comparisons.iter().map(|c| c.series.points).min()?;
        let of_setting = |side: &String| {
            let here =
                || pairs.of_side(side).filter(|c| c.series.noise == noise && c.series.points == points);
            let first = &here().next()?.series;
            Some((side.clone(), here().filter(|c| c.series == *first).collect::<Vec<_>>()))
        };
        let chosen: Vec<_> = pairs.sides.iter().take(OKABE_ITO.len()).filter_map(of_setting).collect();
        // In the order of the cells' parameters.
        let is_compared = |name: &str| {
            let mut parameters = chosen.iter().flat_map(|(_, c)| c.iter().flat_map(|c| &c.parameters));
            parameters.any(|p| p.name == name)
        };
        let here = chosen.iter().flat_map(|(_, c)| c.iter().map(|c| &c.series));
        let cells: Vec<&Series> = here.collect();
        let cells = results.cells.iter().filter(|c| cells.iter().any(|s| s.holds(c)));
        let longest = cells.max_by_key(|c| c.parameters.len())?;
        let names = longest.parameters.iter().map(|p| p.name.as_str());
        let rows: Vec<&str> = names.filter(|name| is_compared(name)).collect();
        let rows = thinned(&rows, MOST);
        (!rows.is_empty()).then_some(Self { chosen, rows, results })
    }

    fn notes(&self, pairs: &Pairs<'_>) -> Vec<String> {
        let first = self.chosen[0].1[0];
        let series = &first.series;
        let same = match pairs.against {
            Against::Methods => series.border.clone(),
            Against::Borders => series.method.to_string(),
        };
        vec![
            format!(
                "Over {} on the same noise: {same}, m = {}, noise {}, N = {}. Left of the line is better in the first two columns; \
                 biases are in standard deviations of the reference.",
                pairs.reference(),
                series.points,
                plain(series.noise),
                count(first.samples)
            ),
            format!(
                "Bars: ± {ERRORS} jackknifed standard errors of the pair. Last row: geometric mean over every parameter, m, noise level and {}.",
                match pairs.against {
                    Against::Methods => "border",
                    Against::Borders => "method",
                }
            ),
        ]
    }

    fn legend(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = self
            .chosen
            .iter()
            .zip(OKABE_ITO)
            .map(|((side, _), colour)| Entry::disc(colour, side.as_str()))
            .collect();
        entries
            .push(Entry::new(Sample::Line(Pen::broad(tint(INK, PALE))), "what independent runs would leave"));
        entries.push(Entry::new(Sample::Arrow(Towards::Right, INK), "beyond the frame"));
        entries
    }

    fn draw(&self, canvas: &Canvas, frames: &Frames, (pairs, lines): (&Pairs<'_>, f64)) {
        let (size, rows) = (frames.size(), self.rows.len());
        for (c, column) in Column::ALL.into_iter().enumerate() {
            let corner = frames.corner(0, c);
            for row in (0..=rows).step_by(2).filter(|row| lines * (*row as f64 + 1.0) <= size.1 + 0.5) {
                let top = corner.1 + lines * row as f64;
                canvas.fill((corner.0, top), (corner.0 + size.0, top + lines), tint(FAINT, 0.5));
            }
            let axes = (self.axis(column, pairs), Axis::rows(size.1 / lines));
            let panel = Panel::new(canvas, corner, size, axes);
            panel.title(column.name());
            panel.upright(column.equal(), None, Pen::hair(GREY));
            let middle = (self.chosen.len() - 1) as f64 / 2.0;
            for (k, ((side, comparisons), colour)) in self.chosen.iter().zip(OKABE_ITO).enumerate() {
                let aside = LINE * (k as f64 - middle);
                for (row, name) in self.rows.iter().enumerate() {
                    let reported = comparisons.iter().find_map(|c| {
                        let parameter = c.parameters.iter().find(|p| p.name == *name)?;
                        self.reported(column, c, parameter)
                    });
                    let mark = Mark { aside, ..Mark::disc(Pen::data(colour), SMALL_RADIUS) };
                    draw_reported(&panel, row, reported, mark);
                }
                let all = pairs.overall.iter().find(|o| o.subject.to_string() == *side);
                let reported = all.and_then(|o| match column {
                    Column::Variance => Some(Reported::ratio(o.variance_ratio)),
                    Column::SquaredError => Some(Reported::ratio(o.mse_ratio)),
                    Column::Bias => None,
                });
                let diamond = Mark { shape: Shape::Diamond, aside, ..Mark::disc(Pen::data(colour), RADIUS) };
                draw_reported(&panel, rows, reported, diamond);
            }
        }
        let (left, top) = frames.corner(0, 0);
        let all = (!pairs.overall.is_empty()).then_some("all");
        for (row, name) in self.rows.iter().copied().chain(all).enumerate() {
            let look = if row == rows { TextLook::label().bold() } else { TextLook::label() };
            canvas.text(name, (left - 10.0, top + lines * (row as f64 + 0.5)), look.end());
        }
    }

    /// What a parameter's comparison says in a column.
    fn reported(
        &self,
        column: Column,
        comparison: &Comparison,
        parameter: &PairedParameter,
    ) -> Option<Reported> {
        match column {
            Column::Variance => Some(Reported::ratio(parameter.variance_ratio)),
            Column::SquaredError => Some(Reported::ratio(parameter.mse_ratio)),
            Column::Bias => {
                let is_reference = |c: &&Cell| comparison.over.holds(c) && c.samples == comparison.samples;
                let cell = self.results.cells.iter().find(is_reference)?;
                let sd = cell.find(&parameter.name)?.best_sd()?.value();
                (sd > 0.0).then(|| Reported::difference(parameter.bias_difference, sd))
            }
        }
    }

    /// Ratios all have a place; of biases those that are small have, the others are beyond.
    fn axis(&self, column: Column, pairs: &Pairs<'_>) -> Axis {
        let comparisons = self.chosen.iter().flat_map(|(_, comparisons)| comparisons);
        let reported: Vec<Reported> = comparisons
            .flat_map(|c| c.parameters.iter().filter_map(|p| self.reported(column, c, p)).collect::<Vec<_>>())
            .collect();
        match column {
            Column::Bias => {
                let small = reported.iter().filter(|t| t.value.abs() < SMALL_BIAS);
                let reach = small.flat_map(|t| [t.unpaired.0.abs(), t.unpaired.1.abs()]).fold(0.0, f64::max);
                let reach = if reach > 0.0 { reach } else { SMALL_BIAS };
                Axis::linear([-reach, reach])
            }
            _ => {
                let overall = pairs.overall.iter().map(|o| match column {
                    Column::Variance => o.variance_ratio.value(),
                    _ => o.mse_ratio.value(),
                });
                let ends = reported.iter().flat_map(|t| [t.unpaired.0, t.unpaired.1]);
                Axis::logarithmic(ends.chain(overall).chain([1.0]))
            }
        }
    }
}

fn draw_reported(panel: &Panel<'_>, row: usize, reported: Option<Reported>, mark: Mark) {
    let Some(reported) = reported else { return };
    let y = row as f64 + 0.5;
    let behind = Mark { pen: Pen::broad(tint(mark.pen.colour, PALE)), radius: 0.0, ..mark };
    panel.level_mark(reported.unpaired, reported.value, y, behind);
    panel.level_mark(reported.paired, reported.value, y, mark);
}
