//! What came out at each version of an estimator, a row a version.

use super::axis::Axis;
use super::canvas::Towards;
use super::legend::{Entry as LegendEntry, Sample};
use super::panel::{Mark, Panel};
use super::sheet::{Grid, Sheet};
use super::style::{BAD, GOOD, GREY, INK, MARGIN, PALE, Pen, RADIUS, TextLook, count, tint};
use switchback_versions::{Entry, Measure, Verdict};

/// The newest entries that are drawn.
const MOST: usize = 40;
/// Height of a row, and half the height of a limit in it, pixels.
const ROW: f64 = 22.0;
const HALF_LIMIT: f64 = 8.0;
/// Room for labels, pixels.
const LABELS: f64 = 150.0;
/// Standard errors of a bar to either side.
const ERRORS: f64 = 2.0;

/// A row an entry, a diagram a measure: the difference that comes nearest to its limit, with its error and that limit.
pub fn history(entries: &[&Entry]) -> String {
    let shown = &entries[entries.len().saturating_sub(MOST)..];
    let Some(last) = shown.last() else {
        return Sheet::new("Versions of an estimator", Vec::new(), Grid::new(1, 1, 0.0))
            .empty("The history is empty.");
    };
    let mut sheet = Sheet::new(
        format!("{}: {} against {}", last.scenario, last.new, last.baseline),
        vec![format!(
            "Of each measure the difference that comes nearest to its limit, ± {ERRORS} standard errors; {} replicates of each cell at the last. Newest below.",
            count(last.replicates as usize)
        )],
        Grid { left: LABELS, between: 30.0, ..Grid::new(1, Measure::ALL.len(), ROW * shown.len() as f64) },
    );
    sheet.legend = vec![
        LegendEntry::disc(GOOD, "no alarm"),
        LegendEntry::disc(BAD, "an alarm: worse beyond its limit"),
        LegendEntry::new(Sample::Line(Pen::hair(INK)), "limit"),
        LegendEntry::new(Sample::Arrow(Towards::Right, GREY), "beyond the frame"),
    ];
    sheet.render(|canvas, frames| {
        let (left, top) = frames.corner(0, 0);
        for (row, entry) in shown.iter().enumerate() {
            let look = TextLook::number().end();
            let label = look.fitted(entry.label.as_str(), LABELS - MARGIN - 10.0);
            canvas.text(&label, (left - 10.0, top + ROW * (row as f64 + 0.5)), look);
        }
        for (column, measure) in Measure::ALL.into_iter().enumerate() {
            let axes = (axis(shown, measure), Axis::rows(shown.len() as f64));
            let panel = frames.panel(canvas, (0, column), axes);
            panel.x_name(name(measure));
            panel.upright(0.0, None, Pen::hair(GREY));
            for (row, entry) in shown.iter().enumerate() {
                draw(&panel, (row, axes.0), entry, measure);
            }
        }
    })
}

fn name(measure: Measure) -> &'static str {
    match measure {
        Measure::Bias => "bias [sd]",
        Measure::Sd => "standard deviation [%]",
        Measure::Failures => "failures [% of replicates]",
    }
}

/// A figure in the unit of its diagram: of a logarithm of a ratio, the ratio less one in per cent.
fn scaled(measure: Measure, x: f64) -> f64 {
    match measure {
        Measure::Bias => x,
        Measure::Sd => 100.0 * x.exp_m1(),
        Measure::Failures => 100.0 * x,
    }
}

/// Wide enough for all limits and their like; a difference far beyond has an arrow.
fn axis(entries: &[&Entry], measure: Measure) -> Axis {
    let of = |entry: &&Entry| {
        let largest = entry.largest(measure);
        let reach = largest.value.map(f64::abs).zip(largest.se).map(|(value, se)| value + ERRORS * se);
        let limit = largest.limit.unwrap_or(0.0);
        limit.max(reach.unwrap_or(0.0).min(4.0 * limit))
    };
    let reach = scaled(measure, entries.iter().map(of).fold(0.0, f64::max));
    let reach = if reach > 0.0 { reach } else { 1.0 };
    Axis::linear([-1.05 * reach, 1.05 * reach])
}

fn draw(panel: &Panel<'_>, (row, axis): (usize, Axis), entry: &Entry, measure: Measure) {
    let (largest, middle) = (entry.largest(measure), row as f64 + 0.5);
    let half = HALF_LIMIT / ROW;
    for limit in largest.limit.into_iter().flat_map(|limit| [-limit, limit]) {
        let x = scaled(measure, limit);
        panel.line(&[(x, middle - half), (x, middle + half)], Pen::hair(INK));
    }
    let colour = if largest.verdict == Verdict::Worse { BAD } else { GOOD };
    match largest.value.zip(largest.se) {
        Some((value, se)) => {
            let at = |errors: f64| scaled(measure, value + errors * se);
            panel.level_mark(
                (at(-ERRORS), at(ERRORS)),
                at(0.0),
                middle,
                Mark::disc(Pen::data(colour), RADIUS),
            );
        }
        None => panel.text(
            "no number",
            (axis.low(), middle),
            (8.0, 0.0),
            TextLook::number().colour(tint(colour, 1.0 - PALE)),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::super::inspect;
    use super::*;
    use switchback_versions::Largest;

    fn entry(label: &str, value: Option<f64>, verdict: Verdict) -> Entry {
        let largest =
            |value| Largest { value, se: Some(0.01), limit: Some(0.05), at: String::new(), verdict };
        Entry {
            label: label.parse().expect("a label"),
            scenario: "study".to_owned(),
            baseline: "old".to_owned(),
            baseline_version: "1".to_owned(),
            new: "new".to_owned(),
            new_version: "2".to_owned(),
            seed: 1,
            replicates: 400,
            verdict,
            bias: largest(value),
            sd: largest(Some(0.0)),
            failures: largest(value.map(|x| -x)),
        }
    }

    #[test]
    fn every_version_has_its_row_and_an_alarm_its_colour() {
        let quiet: Vec<Entry> = (0..60)
            .map(|k| entry(&format!("commit {k}"), Some(0.001 * f64::from(k)), Verdict::Equivalent))
            .collect();
        let all: Vec<&Entry> = quiet.iter().collect();
        let svg = history(&all);
        inspect::check(&svg).expect("on the page");
        assert!(svg.contains("commit 59") && svg.contains("commit 20") && !svg.contains("commit 19"));
        let alarms = |svg: &str| svg.matches("#D55E00").count();
        let loud =
            entry("a label that is far too long to stand beside its row in full", None, Verdict::Worse);
        let far = entry("far", Some(1e9), Verdict::Worse);
        let with: Vec<&Entry> = all.iter().copied().chain([&far, &loud]).collect();
        let shown = history(&with);
        inspect::check(&shown).expect("on the page");
        assert!(alarms(&shown) > alarms(&svg) && shown.contains("no number"));
        assert!(history(&[]).contains("empty"));
    }
}
