//! Variance ratios on the same noise, against N.

use super::axis::{Axis, plain};
use super::canvas::{Dash, Pen};
use super::legend::{Entry, Sample};
use super::palette::{GREY, OKABE_ITO, tint};
use super::panel::{Mark, Panel};
use super::selection::{distinct, slug};
use super::sheet::{Grid, Sheet};
use super::{Figure, MOST_ROWS};
use crate::results::{Comparison, Group, Paired, Results, Series};
use plotters::style::RGBColor;

/// What stands against what: it decides what a colour and what a row of diagrams is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Against {
    /// Colours are methods, rows borders.
    Methods,
    /// Colours are borders, rows methods.
    Borders,
}

impl Against {
    fn file(self) -> &'static str {
        match self {
            Self::Methods => "paired-methods",
            Self::Borders => "paired-borders",
        }
    }

    fn colour(self, series: &Series) -> String {
        match self {
            Self::Methods => series.method.to_string(),
            Self::Borders => series.border.clone(),
        }
    }

    fn row(self, series: &Series) -> String {
        match self {
            Self::Methods => series.border.clone(),
            Self::Borders => series.method.to_string(),
        }
    }
}

/// The figures of every case: methods, then borders, each where there are several.
pub(super) fn figures(results: &Results) -> Vec<Figure> {
    let comparisons = results.paired.as_ref().map_or(&[][..], |pairing| &pairing.comparisons);
    let cases = distinct(comparisons.iter().map(|c| c.series.case.as_str()));
    let of_case = |case: &str| {
        let name = |against: Against| match cases.len() {
            1 => format!("{}.svg", against.file()),
            _ => format!("{}-{}.svg", against.file(), slug(case)),
        };
        let title = if cases.len() > 1 { format!(", {case}") } else { String::new() };
        [Against::Methods, Against::Borders]
            .into_iter()
            .filter_map(move |against| {
                let shown = Shown::new(against, case, comparisons)?;
                Some(Figure { name: name(against), svg: shown.draw(&title) })
            })
            .collect::<Vec<_>>()
    };
    cases.iter().flat_map(|case| of_case(case)).collect()
}

/// The comparisons of one figure, at the largest noise.
struct Shown<'r> {
    against: Against,
    comparisons: Vec<&'r Comparison>,
    noise: f64,
    /// Name and points `m`.
    rows: Vec<(String, usize)>,
    colours: Vec<String>,
    groups: Vec<Group>,
}

impl<'r> Shown<'r> {
    fn new(against: Against, case: &str, all: &'r [Comparison]) -> Option<Self> {
        let of_kind =
            |c: &&Comparison| c.series.case == case && c.is_of_methods() == (against == Against::Methods);
        let noise = all.iter().filter(of_kind).map(|c| c.series.noise).max_by(f64::total_cmp)?;
        let mut comparisons: Vec<&Comparison> =
            all.iter().filter(of_kind).filter(|c| c.series.noise == noise).collect();
        let row = |c: &&Comparison| (against.row(&c.series), c.series.points);
        let mut rows = distinct(comparisons.iter().map(row));
        if rows.len() > MOST_ROWS {
            let most = rows.iter().map(|r| r.1).max();
            comparisons.retain(|c| Some(c.series.points) == most);
            rows = distinct(comparisons.iter().map(row));
        }
        rows.sort_by_key(|row| row.1);
        rows.sort_by_key(|row| comparisons.iter().position(|c| against.row(&c.series) == row.0));
        let mut colours = distinct(comparisons.iter().map(|c| against.colour(&c.series)));
        colours.truncate(OKABE_ITO.len());
        let has = |g: &Group| comparisons.iter().any(|c| c.groups.iter().any(|entry| entry.group == *g));
        let groups = Group::ALL.into_iter().filter(has).collect();
        Some(Self { against, noise, rows, colours, groups, comparisons })
    }

    fn draw(&self, title: &str) -> String {
        let what = match self.against {
            Against::Methods => "methods",
            Against::Borders => "borders",
        };
        let sheet = Sheet {
            title: format!("Variance ratios of {what} on the same noise{title}"),
            notes: self.notes(),
            legend: self.legend(),
            grid: Grid {
                columns: self.groups.len(),
                rows: self.rows.len(),
                height: 190.0,
                left: 112.0,
                between: 62.0,
                above: 42.0,
            },
        };
        sheet.render(|canvas, frames| {
            for (column, &group) in self.groups.iter().enumerate() {
                let axes = self.axes(group);
                for (r, row) in self.rows.iter().enumerate() {
                    let panel = Panel::new(canvas, frames.corner(r, column), frames.size(), axes);
                    if r == 0 {
                        panel.title(group.label());
                    }
                    if r + 1 == self.rows.len() {
                        panel.x_name("samples N");
                    }
                    if column == 0 {
                        frames.name_row(canvas, r, (&row.0, row.1));
                    }
                    self.contents(&panel, row, group, axes.0);
                }
            }
        })
    }

    fn notes(&self) -> Vec<String> {
        let over = distinct(self.comparisons.iter().map(|c| self.against.colour(&c.over)));
        vec![
            format!(
                "Variance of the estimates over that of {} (the first of the sweep that has the parameter), noise {}; \
                 geometric mean over the group.",
                over.join(" or "),
                plain(self.noise)
            ),
            "Bars: ± 2 jackknifed standard errors of the pair; faint bars: what independent runs of as many replicates would leave."
                .to_owned(),
        ]
    }

    fn legend(&self) -> Vec<Entry> {
        let entry = |(name, colour): (&String, &RGBColor)| {
            Entry::new(Sample::Disc(Pen::new(*colour, 1.5), true), name.as_str())
        };
        let equal = Entry::new(Sample::Dashes(Pen::new(GREY, 1.5), Dash::Dashes), "equal");
        self.colours.iter().zip(&OKABE_ITO).map(entry).chain([equal]).collect()
    }

    /// The figures of one colour in one diagram.
    fn points(&self, (name, m): &(String, usize), colour: &str, group: Group) -> Vec<(f64, Paired)> {
        let mine = |c: &&&Comparison| {
            let series = &c.series;
            self.against.row(series) == *name && series.points == *m && self.against.colour(series) == colour
        };
        let of_group = |c: &&'r Comparison| c.groups.iter().filter(move |g| g.group == group);
        self.comparisons
            .iter()
            .filter(mine)
            .flat_map(of_group)
            .map(|g| (g.samples as f64, g.variance_ratio))
            .collect()
    }

    fn axes(&self, group: Group) -> (Axis, Axis) {
        let groups = || self.comparisons.iter().flat_map(|c| &c.groups).filter(|g| g.group == group);
        let ends = groups().flat_map(|g| {
            let (low, high) = g.variance_ratio.unpaired_interval(2.0);
            [low, high]
        });
        (Axis::logarithmic(groups().map(|g| g.samples as f64)), Axis::logarithmic(ends.chain([1.0])))
    }

    fn contents(&self, panel: &Panel<'_, '_>, row: &(String, usize), group: Group, x: Axis) {
        panel.dashes(&[(x.low(), 1.0), (x.high(), 1.0)], Dash::Dashes, Pen::new(GREY, 1.5));
        let middle = (self.colours.len() - 1) as f64 / 2.0;
        for (k, (name, &colour)) in self.colours.iter().zip(&OKABE_ITO).enumerate() {
            let aside = 4.5 * (k as f64 - middle);
            let wide = Mark { pen: Pen::new(tint(colour, 0.35), 4.0), radius: 0.0, filled: true, aside };
            let mark = Mark { pen: Pen::new(colour, 1.5), radius: 2.5, filled: true, aside };
            for (n, ratio) in self.points(row, name, group) {
                panel.mark(n, ratio.value(), ratio.unpaired_interval(2.0), wide);
                panel.mark(n, ratio.value(), ratio.interval(2.0), mark);
            }
        }
    }
}
