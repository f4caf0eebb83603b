//! The candidates' ranking.

use crate::diagnosis::{Report, closed_percent};
use crate::plots::canvas::{Canvas, Pen, TextLook};
use crate::plots::legend::{Entry, Sample};
use crate::plots::palette::{FAINT, GREY, OKABE_ITO, tint};
use crate::plots::sheet::{Frames, Grid, Sheet};
use plotters::style::RGBColor;
use switchback_gap::{Candidate, Status};

/// Height of a candidate's row, pixels.
const ROW: f64 = 24.0;
const COLUMNS: usize = 3;
/// Room for a bar's figure right of it, pixels.
const FIGURE: f64 = 70.0;

/// A row an explanation, best first: its probability, its evidence, and how far it closes the gap alone.
pub(super) fn figure(report: &Report) -> String {
    let diagnosis = &report.diagnosis;
    let rows = rows(report);
    let is_named = diagnosis.verdict.status == Status::Named;
    let entry = |rank: Rank, name: &str| Entry::new(Sample::Line(Pen::new(rank.colour(), 10.0)), name);
    let mut legend = vec![entry(Rank::Chosen, if is_named { "named" } else { "in the verdict" })];
    if diagnosis.verdict.corrected_by.is_some() {
        legend.push(entry(Rank::Corrects, "corrects the law of the one named"));
    }
    legend.push(entry(Rank::Other, "other candidates"));
    let sheet = Sheet {
        title: format!("{}: what explains the gap", report.rig.name),
        notes: vec![
            "Evidence is the drop of the Bayesian information criterion from the nominal model to the augmented one, on a square-root scale.".to_owned(),
            "Closure is on the records judged; unstable: with this effect the model's free run leaves every range.".to_owned(),
        ],
        legend,
        grid: Grid {
            columns: COLUMNS,
            rows: 1,
            height: ROW * rows.len() as f64,
            left: 190.0,
            between: 24.0,
            above: 40.0,
        },
    };
    let strongest = rows.iter().filter_map(|row| row.evidence).fold(1.0, f64::max);
    sheet.render(|canvas, frames| {
        for (i, row) in rows.iter().enumerate() {
            row.draw(canvas, frames, i, strongest);
        }
        for (column, title) in ["probability", "evidence: drop of the BIC", "closure"].into_iter().enumerate()
        {
            let (x, y) = frames.corner(0, column);
            canvas.text(title, (x, y - 16.0), TextLook::new(16.0).bold());
        }
    })
}

/// What the verdict makes of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rank {
    Chosen,
    Corrects,
    Other,
}

impl Rank {
    fn colour(self) -> RGBColor {
        match self {
            Self::Chosen => OKABE_ITO[0],
            Self::Corrects => tint(OKABE_ITO[0], 0.5),
            Self::Other => tint(GREY, 0.5),
        }
    }
}

struct Row {
    name: String,
    rank: Rank,
    probability: f64,
    evidence: Option<f64>,
    closure: Option<f64>,
    unstable: bool,
}

fn rows(report: &Report) -> Vec<Row> {
    let diagnosis = &report.diagnosis;
    let verdict = &diagnosis.verdict;
    let rank = |c: &Candidate| match c.effect {
        effect if verdict.effects.contains(&effect) || verdict.class.contains(&effect) => Rank::Chosen,
        effect if verdict.corrected_by == Some(effect) => Rank::Corrects,
        _ => Rank::Other,
    };
    let candidate = |c: &Candidate| Row {
        name: c.effect.to_string(),
        rank: rank(c),
        probability: c.probability,
        evidence: Some(c.delta_bic),
        closure: c.closure,
        unstable: c.unstable,
    };
    let rest = |name: &str, status: Status, probability: f64| Row {
        name: name.to_owned(),
        rank: if verdict.status == status { Rank::Chosen } else { Rank::Other },
        probability,
        evidence: None,
        closure: None,
        unstable: false,
    };
    let mut rows: Vec<Row> = diagnosis.candidates.iter().map(candidate).collect();
    rows.push(rest("none of these", Status::Unexplained, diagnosis.probability_unexplained));
    rows.push(rest("nothing is missing", Status::None, diagnosis.probability_none));
    rows
}

impl Row {
    fn draw(&self, canvas: &Canvas<'_>, frames: &Frames, index: usize, strongest: f64) {
        let colour = self.rank.colour();
        let middle = frames.corner(0, 0).1 + ROW * (index as f64 + 0.5);
        let look = TextLook::new(15.0);
        let name = if self.rank == Rank::Chosen { look.bold() } else { look };
        canvas.text(&self.name, (frames.corner(0, 0).0 - 10.0, middle), name.end());
        let evidence = self.evidence.map(|e| ((e.max(0.0) / strongest).sqrt(), whole(e)));
        let closure = match self.closure {
            _ if self.unstable => Some((0.0, "unstable".to_owned())),
            closure => closure.map(|c| (c.clamp(0.0, 1.0), format!("{} %", closed_percent(100.0 * c)))),
        };
        let probability = Some((self.probability.clamp(0.0, 1.0), format!("{:.3}", self.probability)));
        for (column, bar) in [probability, evidence, closure].into_iter().enumerate() {
            let Some((share, text)) = bar else { continue };
            let left = frames.corner(0, column).0;
            let width = frames.size().0 - FIGURE;
            canvas.fill((left, middle - 8.0), (left + width, middle + 8.0), tint(FAINT, 0.6));
            canvas.fill((left, middle - 8.0), (left + share * width, middle + 8.0), colour);
            canvas.text(&text, (left + width + FIGURE - 6.0, middle), look.end());
        }
    }
}

fn whole(x: f64) -> String {
    // Adding zero turns the −0 of rounding into 0.
    format!("{}", x.round() + 0.0).replace('-', "−")
}
