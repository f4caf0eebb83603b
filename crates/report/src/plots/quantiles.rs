//! All differences of a comparison in one figure.

use crate::plots::axis::Axis;
use crate::plots::canvas::Dash;
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::{Mark, Panel};
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{BAD, GOOD, GREY, INK, PALE, Pen, SMALL_RADIUS, plain, tint};
use switchback_study::compare::{Comparison, Difference};

/// The measures drawn, a diagram each.
const MEASURES: [(&str, &str); 4] = [
    ("bias", "bias"),
    ("sd", "standard deviation"),
    ("mse", "mean squared error"),
    ("coverage", "coverage of the 95 % intervals"),
];

/// An SVG of all differences in units of their Monte-Carlo errors: sorted, beside what chance would give.
///
/// In each diagram the differences stand in order at the normal quantiles they would have if nothing had changed; then
/// they follow the diagonal.
pub fn quantiles(comparison: &Comparison, title: &str) -> String {
    let mut sheet = Sheet::new(
        title,
        vec![
            "Every measure of the new results less the baseline's, over the joint Monte-Carlo standard error, in order."
                .to_owned(),
        ],
        Grid::new(2, 2, 260.0),
    );
    let threshold = plain((comparison.threshold * 100.0).round() / 100.0);
    sheet.legend = vec![
        Entry::disc(GOOD, "within chance"),
        Entry::disc(BAD, format!("beyond chance, |z| > {threshold}")),
        Entry::new(Sample::Dashes(Pen::hair(tint(INK, PALE)), Dash::Dashes), "its limits"),
        Entry::line(GREY, "expected where nothing changed"),
    ];
    sheet.render(|canvas, frames| {
        for (i, (measure, name)) in MEASURES.into_iter().enumerate() {
            let mut shown: Vec<&Difference> = comparison
                .differences
                .iter()
                .filter(|d| d.place.measure == measure && d.z.is_finite())
                .collect();
            shown.sort_by(|a, b| a.z.total_cmp(&b.z));
            let reach = shown.iter().map(|d| d.z.abs()).fold(comparison.threshold.min(8.0), f64::max);
            let axes = (Axis::linear([-4.5, 4.5]), Axis::linear([-reach, reach]));
            let panel = frames.panel(canvas, (i / 2, i % 2), axes);
            panel.title(name);
            panel.x_name("z expected by chance");
            panel.y_name("z found", 58.0);
            if shown.is_empty() {
                panel.remark("not in both tables");
                continue;
            }
            contents(&panel, &shown, comparison.threshold);
        }
    })
}

fn contents(panel: &Panel<'_>, shown: &[&Difference], threshold: f64) {
    panel.line(&[(-5.0, -5.0), (5.0, 5.0)], Pen::data(GREY));
    for limit in [-threshold, threshold] {
        panel.dashes(&[(-5.0, limit), (5.0, limit)], Dash::Dashes, Pen::hair(tint(INK, PALE)));
    }
    for (k, d) in thinned(shown) {
        let colour = if d.z.abs() > threshold { BAD } else { GOOD };
        let mark = Mark::disc(Pen::data(colour), SMALL_RADIUS);
        panel.mark(normal_quantile((k as f64 + 0.5) / shown.len() as f64), d.z, (d.z, d.z), mark);
    }
}

/// Enough points to fill the line; all of them near the ends, where they are few and matter.
const MOST: usize = 400;

fn thinned<'d>(sorted: &[&'d Difference]) -> Vec<(usize, &'d Difference)> {
    let every = (sorted.len() / MOST).max(1);
    let near_end = |k: usize| k < MOST / 4 || k + MOST / 4 >= sorted.len();
    sorted.iter().copied().enumerate().filter(|(k, _)| near_end(*k) || k % every == 0).collect()
}

fn normal_quantile(p: f64) -> f64 {
    use statrs::distribution::{ContinuousCDF, Normal};
    Normal::standard().inverse_cdf(p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_study::compare::compare;
    use switchback_study::results::synthetic;

    #[test]
    fn the_figure_marks_what_is_beyond_chance_and_repeats_itself() {
        let baseline = synthetic::results();
        let mut new = baseline.clone();
        for cell in &mut new.cells {
            for (i, p) in cell.parameters.iter_mut().enumerate() {
                let shift = ((i * 7 + cell.samples) % 11) as f64 / 5.0 - 1.0;
                let strange = if cell.samples == 1_000 && i == 2 { 12.0 } else { 0.0 };
                let moved = |m: switchback_study::results::Measured| {
                    switchback_study::results::Measured::new(
                        m.value() + (shift + strange) * m.mcse(),
                        m.mcse(),
                    )
                };
                p.sd = p.sd.and_then(moved);
            }
        }
        let comparison = compare(&baseline, &new);
        let svg = quantiles(&comparison, "synthetic against itself, moved");
        assert!(svg.contains("#D55E00"));
        assert_eq!(svg, quantiles(&comparison, "synthetic against itself, moved"));
    }
}
