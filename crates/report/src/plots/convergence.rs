//! Bias and standard deviation against N.

use super::axis::Axis;
use super::canvas::{Dash, Towards};
use super::legend::{Entry, Sample};
use super::panel::{Mark, Panel};
use super::selection::{Selection, distinct, listed, thinned};
use super::sheet::{Grid, Sheet};
use super::spread::{ERRORS, Spread, samples_axis};
use super::style::{GREY, INK, OKABE_ITO, PALE, Pen, SMALL_RADIUS, Shape, plain, tint};
use plotters::style::RGBColor;
use switchback_study::results::{
    Cell, Group, Measured, Parameter, Results, root_mean_square, root_mean_square_exact,
};

/// Which of the two figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Measure {
    /// `|bias|` against `N`.
    Bias,
    /// Standard deviation against `N`.
    Sd,
}

impl Measure {
    fn name(self) -> &'static str {
        match self {
            Self::Bias => "|bias|",
            Self::Sd => "standard deviation",
        }
    }

    fn title(self) -> &'static str {
        match self {
            Self::Bias => "bias of the estimates against N",
            Self::Sd => "standard deviation of the estimates against N",
        }
    }
}

/// More numbers of points `m` than this are not distinguished beside several noise levels, and beside one or two.
const MOST_POINTS: (usize, usize) = (3, 4);
/// Height of a diagram, and how far apart marks of different `m` stand, pixels.
const HEIGHT: f64 = 400.0;
const APART: f64 = 4.5;

/// What a figure draws: a diagram a group of parameters, a colour a noise level, a shape an `m`, a mark all borders.
struct Design {
    measure: Measure,
    groups: Vec<Group>,
    noises: Vec<f64>,
    points: Vec<usize>,
}

/// Draws one figure. The same part of a `baseline` is drawn behind, in grey.
pub(super) fn figure(
    measure: Measure,
    selection: &Selection<'_>,
    baseline: Option<&Selection<'_>>,
    results: &Results,
) -> String {
    let noises = thinned(&selection.noises(), OKABE_ITO.len());
    let most = if noises.len() > 2 { MOST_POINTS.0 } else { MOST_POINTS.1 };
    let points = thinned(&selection.points(), most);
    let design = Design { measure, groups: selection.groups(), noises, points };
    let and = if baseline.is_some() { ", over the baseline" } else { "" };
    let mut sheet = Sheet::new(
        format!("{}: {}{and}", selection.title(results), measure.title()),
        design.notes(selection),
        Grid::shared(1, design.groups.len(), HEIGHT),
    );
    if design.groups.is_empty() {
        return sheet.empty("No cell of this method has a parameter.");
    }
    sheet.legend = design.legend(selection, baseline.is_some());
    let axes = design.axes([Some(selection), baseline]);
    sheet.render(|canvas, frames| {
        for (column, &group) in design.groups.iter().enumerate() {
            let panel = frames.inner_panel(canvas, (0, column), axes);
            panel.title(group.label());
            panel.x_name("samples N");
            if column == 0 {
                panel.y_name(measure.name(), 62.0);
            }
            if let Some(baseline) = baseline {
                design.each(baseline, group, |curve| curve.draw_behind(&panel, measure));
            }
            match measure {
                Measure::Bias => {
                    design.each(selection, group, |curve| curve.draw_floor(&panel));
                    design.each(selection, group, |curve| curve.draw_theory(&panel));
                    design.each(selection, group, |curve| curve.draw_bias(&panel));
                }
                Measure::Sd => {
                    design.each(selection, group, |curve| curve.draw_limits(&panel));
                    design.each(selection, group, |curve| curve.draw_sd(&panel));
                }
            }
        }
    })
}

impl Design {
    fn notes(&self, selection: &Selection<'_>) -> Vec<String> {
        let borders = selection.borders().len();
        let over =
            if borders > 1 { format!("median over {borders} border shapes") } else { "marks".to_owned() };
        let reach = if borders > 1 { "from the least to the greatest, with" } else { "±" };
        let mut notes = vec![format!(
            "Root mean square of the {} over the parameters of a group: {over}; bars: {reach} {ERRORS} Monte-Carlo standard \
             errors; {}. Borders in units of u_M − u_m.",
            self.measure.name(),
            selection.replicates()
        )];
        if self.points.len() < selection.points().len() {
            notes.push(format!("Shown for m = {}; every other m is in table.csv.", listed(&self.points)));
        }
        notes
    }

    fn legend(&self, selection: &Selection<'_>, over_baseline: bool) -> Vec<Entry> {
        let noise =
            |(&noise, &colour): (&f64, &RGBColor)| Entry::patch(colour, format!("noise {}", plain(noise)));
        let mut entries: Vec<Entry> = self.noises.iter().zip(&OKABE_ITO).map(noise).collect();
        let shape = |(&m, shape): (&usize, Shape)| {
            Entry::new(Sample::Mark(shape, Pen::data(INK), true), format!("m = {m}"))
        };
        entries.extend(self.points.iter().zip(Shape::ALL).map(shape));
        if over_baseline {
            entries.push(Entry::disc(GREY, "grey, left of it: the baseline"));
        }
        let has = |f: fn(&Parameter) -> bool| selection.cells.iter().any(|c| c.parameters.iter().any(f));
        match self.measure {
            Measure::Bias => {
                let hollow = Sample::Mark(Shape::Disc, Pen::data(INK), false);
                entries.push(Entry::new(hollow, "hollow: not distinguished from zero"));
                entries.push(Entry::new(Sample::Arrow(Towards::Down, INK), "the bar includes zero"));
                if has(|p| p.theory_bias.is_some()) {
                    let broad = Sample::Line(Pen::broad(tint(INK, PALE)));
                    entries.push(Entry::new(broad, "theory"));
                } else {
                    let slope = Sample::Dashes(Pen::data(GREY), Dash::Dots);
                    entries
                        .push(Entry::new(slope, "law 1/N through the first point distinguished from zero"));
                }
                if has(|p| p.bias_controlled.is_some()) {
                    let floor = Sample::Dashes(Pen::data(tint(INK, PALE)), Dash::Dashes);
                    entries.push(Entry::new(
                        floor,
                        "least bias distinguished from zero without control variate",
                    ));
                }
            }
            Measure::Sd => {
                if has(|p| p.theory_sd.is_some()) {
                    entries.push(Entry::line(INK, "theory"));
                }
                if has(|p| p.bound_sd.is_some()) {
                    let broad = Sample::Line(Pen::broad(tint(INK, PALE)));
                    entries.push(Entry::new(broad, "Cramér–Rao bound"));
                }
                if has(|p| p.theory_sd.is_some() && p.bound_sd.is_some()) {
                    let both = Sample::Upon(Pen::data(INK), Pen::broad(tint(INK, PALE)));
                    entries.push(Entry::new(both, "both coincide"));
                }
            }
        }
        entries
    }

    /// Axes that all diagrams share, so that they can be compared.
    fn axes(&self, selections: [Option<&Selection<'_>>; 2]) -> (Axis, Axis) {
        let mut values = Vec::new();
        for (group, selection) in
            self.groups.iter().flat_map(|g| selections.into_iter().flatten().map(move |s| (*g, s)))
        {
            self.each(selection, group, |curve| values.extend(curve.values(self.measure)));
        }
        let samples = selections.into_iter().flatten().flat_map(|s| s.cells.iter().map(|c| c.samples));
        (samples_axis(samples, self.points.len()), Axis::logarithmic(values))
    }

    /// Does something with the curve of every noise level and `m`.
    fn each(&self, selection: &Selection<'_>, group: Group, mut act: impl FnMut(&Curve<'_>)) {
        let middle = (self.points.len() - 1) as f64 / 2.0;
        for (&noise, &colour) in self.noises.iter().zip(&OKABE_ITO) {
            for (j, (&points, shape)) in self.points.iter().zip(Shape::ALL).enumerate() {
                let cells: Vec<&Cell> = selection
                    .cells
                    .iter()
                    .copied()
                    .filter(|c| c.series.noise == noise && c.series.points == points)
                    .collect();
                let is_largest = j + 1 == self.points.len();
                act(&Curve { cells, group, colour, shape, is_largest, aside: APART * (j as f64 - middle) });
            }
        }
    }
}

/// The cells of one noise level and `m` in one diagram: all borders, all `N`.
struct Curve<'r> {
    cells: Vec<&'r Cell>,
    group: Group,
    colour: RGBColor,
    shape: Shape,
    /// Whether no `m` is larger.
    is_largest: bool,
    /// How far marks stand beside their place, pixels.
    aside: f64,
}

impl<'r> Curve<'r> {
    /// The limit of a plain study: twice the Monte-Carlo error of the bias without control variate, at the largest `m`.
    fn draw_floor(&self, panel: &Panel<'_>) {
        panel.dashes(&self.floor(), Dash::Dashes, Pen::data(tint(self.colour, PALE)));
    }

    fn floor(&self) -> Vec<(f64, f64)> {
        let is_drawn = self.is_largest && self.is_controlled();
        if is_drawn { self.exact(|p| p.bias.map(|b| ERRORS * b.mcse())) } else { Vec::new() }
    }

    /// Broadly behind the marks, so that both show where they agree.
    fn draw_theory(&self, panel: &Panel<'_>) {
        panel.line(&self.exact(|p| p.theory_bias), Pen::broad(tint(self.colour, PALE)));
    }

    fn draw_bias(&self, panel: &Panel<'_>) {
        let marks = self.pooled(Parameter::best_bias);
        let reported = |n: f64| self.at(n).all(|cell| self.is_distinguished_from_zero(cell));
        let law = !self.has(|p| p.theory_bias.is_some());
        if let Some((n0, first)) = marks.iter().find(|(n, _)| law && reported(*n)) {
            let last = marks.last().map_or(*n0, |(n, _)| *n);
            let law = [(*n0, first.middle), (last, first.middle * n0 / last)];
            panel.dashes(&law, Dash::Dots, Pen::data(tint(self.colour, 0.7)));
        }
        for (n, bias) in marks {
            panel.mark(n, bias.middle, bias.positive_ends(), Mark { filled: reported(n), ..self.mark() });
        }
    }

    /// The bound broadly behind, theory upon it.
    fn draw_limits(&self, panel: &Panel<'_>) {
        panel.line(&self.exact(|p| p.bound_sd), Pen::broad(tint(self.colour, PALE)));
        panel.line(&self.exact(|p| p.theory_sd), Pen::hair(self.colour));
    }

    fn draw_sd(&self, panel: &Panel<'_>) {
        for (n, sd) in self.pooled(Parameter::best_sd) {
            panel.mark(n, sd.middle, sd.positive_ends(), self.mark());
        }
    }

    /// The marks alone, in grey and further to the left.
    fn draw_behind(&self, panel: &Panel<'_>, measure: Measure) {
        let marks = match measure {
            Measure::Bias => self.pooled(Parameter::best_bias),
            Measure::Sd => self.pooled(Parameter::best_sd),
        };
        let mark = Mark { pen: Pen::data(GREY), aside: self.aside - 2.0 * APART, ..self.mark() };
        for (n, figure) in marks {
            panel.mark(n, figure.middle, figure.positive_ends(), mark);
        }
    }

    fn mark(&self) -> Mark {
        Mark {
            shape: self.shape,
            aside: self.aside,
            ..Mark::disc(Pen::data(self.colour), SMALL_RADIUS + 0.7)
        }
    }

    /// Whether a pooled bias exceeds twice what it would show if the true one were zero.
    fn is_distinguished_from_zero(&self, cell: &Cell) -> bool {
        let floor =
            root_mean_square_exact(cell, self.group, |p| p.best_bias().map(|b| b.mcse())).unwrap_or(0.0);
        root_mean_square(cell, self.group, Parameter::best_bias).is_some_and(|b| b.value() >= ERRORS * floor)
    }

    fn is_controlled(&self) -> bool {
        self.has(|p| p.bias_controlled.is_some())
    }

    /// Whether any parameter that is drawn does.
    fn has(&self, does: impl Fn(&Parameter) -> bool) -> bool {
        let of_group = |p: &Parameter| p.group == self.group && does(p);
        self.cells.iter().any(|cell| cell.parameters.iter().any(of_group))
    }

    /// All that the curve draws.
    fn values(&self, measure: Measure) -> Vec<f64> {
        let (marks, lines) = match measure {
            Measure::Bias => {
                (self.pooled(Parameter::best_bias), [self.floor(), self.exact(|p| p.theory_bias)].concat())
            }
            Measure::Sd => (
                self.pooled(Parameter::best_sd),
                [self.exact(|p| p.theory_sd), self.exact(|p| p.bound_sd)].concat(),
            ),
        };
        // The axis is set by the marks and the upper ends: a bar that reaches zero has no lower one.
        let marks = marks.into_iter().flat_map(|(_, s)| [s.middle, s.ends.1]);
        marks.chain(lines.into_iter().map(|(_, y)| y)).collect()
    }

    fn samples(&self) -> Vec<usize> {
        let mut samples = distinct(self.cells.iter().map(|c| c.samples));
        samples.sort_unstable();
        samples
    }

    /// The cells of all borders at one `N`.
    fn at(&self, n: f64) -> impl Iterator<Item = &'r Cell> {
        self.cells.iter().copied().filter(move |c| c.samples as f64 == n)
    }

    fn pooled(&self, measure: impl Fn(&Parameter) -> Option<Measured>) -> Vec<(f64, Spread)> {
        let figures = |n: f64| self.at(n).filter_map(|c| root_mean_square(c, self.group, &measure));
        let spread = |n: usize| Some((n as f64, Spread::of_measured(figures(n as f64))?));
        self.samples().into_iter().filter_map(spread).collect()
    }

    /// The median over the borders of what is known exactly.
    fn exact(&self, measure: impl Fn(&Parameter) -> Option<f64>) -> Vec<(f64, f64)> {
        let measured = |p: &Parameter| measure(p).and_then(|x| Measured::new(x, 0.0));
        self.pooled(measured).into_iter().map(|(n, spread)| (n, spread.middle)).collect()
    }
}
