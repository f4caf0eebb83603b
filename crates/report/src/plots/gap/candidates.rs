//! The candidates' ranking.

use crate::plots::canvas::{Canvas, Towards};
use crate::plots::legend::{Entry, Sample};
use crate::plots::sheet::{Frames, Grid, Sheet};
use crate::plots::style::{FAINT, GREY, INK, MARGIN, OKABE_ITO, PALE, Pen, TextLook, count, tint};
use plotters::style::RGBColor;
use switchback_diagnose::Candidate;
use switchback_diagnose::Status;
use switchback_io::diagnosis::{Report, closed_percent};

/// Height of a candidate's row, half the height of its bars, and length of an arrow, pixels.
const ROW: f64 = 24.0;
const HALF_BAR: f64 = 8.0;
const ARROW: f64 = 9.0;
const COLUMNS: [&str; 3] = ["probability", "evidence: drop of the BIC", "closure"];
/// Room for a bar's figure right of it, pixels.
const FIGURE: f64 = 74.0;

/// A row a candidate, best first: its probability, its evidence, and how far it closes the gap alone.
pub(super) fn figure(report: &Report) -> String {
    let diagnosis = &report.diagnosis;
    let rows = rows(report);
    let is_named = diagnosis.verdict.status == Status::Named;
    let entry = |rank: Rank, name: &str| Entry::patch(rank.colour(), name);
    let mut legend = vec![entry(Rank::Chosen, if is_named { "named" } else { "in the verdict" })];
    if diagnosis.verdict.corrected_by.is_some() {
        legend.push(entry(Rank::Corrects, "corrects the law of the one named"));
    }
    legend.push(entry(Rank::Other, "other candidates"));
    legend.push(Entry::new(Sample::Arrow(Towards::Left, INK), "goes on beyond the bar's ground"));
    let notes = vec![
        "Evidence is the drop of the Bayesian information criterion from the nominal model to the augmented one, on a square-root scale."
            .to_owned(),
        "A probability is not in proportion to the evidence: it compares candidates. One far behind the best has next to none, however \
         much it improves on the nominal model; what the best leaves unexplained and the held-out records count, too."
            .to_owned(),
        "Closure is on the records judged; left of the line the effect makes the gap larger there; unstable: with it the model's free \
         run leaves every range."
            .to_owned(),
    ];
    let height = ROW * rows.len() as f64;
    let grid =
        Grid { left: 190.0, between: 22.0, above: 38.0, below: 14.0, ..Grid::new(1, COLUMNS.len(), height) };
    let mut sheet = Sheet::new(format!("{}: what explains the gap", report.rig.name), notes, grid);
    sheet.legend = legend;
    let strongest = rows.iter().filter_map(|row| row.evidence).fold(1.0, |a, b| f64::max(a, b.abs()));
    let grounds = [
        Ground { low: 0.0 },
        Ground { low: if rows.iter().any(|r| r.evidence.is_some_and(|e| e < 0.0)) { -0.25 } else { 0.0 } },
        Ground { low: if rows.iter().any(|r| r.closure.is_some_and(|c| c < 0.0)) { -1.0 } else { 0.0 } },
    ];
    sheet.render(|canvas, frames| {
        for (i, row) in rows.iter().enumerate() {
            row.draw(canvas, frames, (i, strongest), &grounds);
        }
        for (column, title) in COLUMNS.into_iter().enumerate() {
            let (x, y) = frames.corner(0, column);
            canvas.text(title, (x, y - 16.0), TextLook::heading());
            if grounds[column].low < 0.0 {
                let zero = x + grounds[column].place(0.0) * (frames.size().0 - FIGURE);
                canvas.line(&[(zero, y), (zero, y + height)], Pen::hair(GREY));
            }
        }
    })
}

/// What a verdict makes of a candidate.
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
            Self::Corrects => tint(OKABE_ITO[0], PALE),
            Self::Other => tint(GREY, 0.5),
        }
    }
}

/// The scale of a column's bars: from `low` to 1.
struct Ground {
    low: f64,
}

impl Ground {
    /// 0 at the left end, 1 at the right.
    fn place(&self, share: f64) -> f64 {
        (share - self.low) / (1.0 - self.low)
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
    fn draw(
        &self,
        canvas: &Canvas,
        frames: &Frames,
        (index, strongest): (usize, f64),
        grounds: &[Ground; 3],
    ) {
        let middle = frames.corner(0, 0).1 + ROW * (index as f64 + 0.5);
        let name = if self.rank == Rank::Chosen { TextLook::heading() } else { TextLook::label() };
        let left = frames.corner(0, 0).0 - 10.0;
        canvas.text(&name.fitted(&self.name, left - MARGIN), (left, middle), name.end());
        let evidence = self.evidence.map(|e| ((e.abs() / strongest).sqrt().copysign(e), whole(e)));
        let closure = match self.closure {
            _ if self.unstable => Some((0.0, "unstable".to_owned())),
            closure => closure.map(|c| (c, format!("{} %", closed_percent(100.0 * c)))),
        };
        let probability = Some((self.probability, format!("{:.3}", self.probability)));
        for ((column, bar), ground) in [probability, evidence, closure].into_iter().enumerate().zip(grounds) {
            let Some((share, text)) = bar else { continue };
            let left = frames.corner(0, column).0;
            let width = frames.size().0 - FIGURE;
            let x = |share: f64| left + ground.place(share.clamp(ground.low, 1.0)) * width;
            canvas.fill((left, middle - HALF_BAR), (left + width, middle + HALF_BAR), tint(FAINT, 0.6));
            let (from, to) = (x(share.min(0.0)), x(share.max(0.0)));
            canvas.fill((from, middle - HALF_BAR), (to, middle + HALF_BAR), self.rank.colour());
            if share < ground.low {
                canvas.arrow((left, middle), Towards::Left, ARROW, INK);
            } else if share > 1.0 {
                canvas.arrow((left + width, middle), Towards::Right, ARROW, INK);
            }
            canvas.text(&text, (left + width + FIGURE - 4.0, middle), TextLook::number().end());
        }
    }
}

/// To the unit, `16,210`.
fn whole(x: f64) -> String {
    let digits = count(x.abs().round() as usize);
    if x <= -0.5 { format!("-{digits}") } else { digits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_shares_have_a_place_left_of_zero() {
        let ground = Ground { low: -1.0 };
        assert_eq!((ground.place(-1.0), ground.place(0.0), ground.place(1.0)), (0.0, 0.5, 1.0));
        assert_eq!(
            (whole(16_210.4), whole(-0.4), whole(-35.2)),
            ("16,210".to_owned(), "0".to_owned(), "-35".to_owned())
        );
    }
}
