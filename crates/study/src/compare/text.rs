//! The comparison in words.

use super::{Comparison, Difference};
use crate::results::Results;

/// Differences, cells and names listed at most; the rest is counted.
const MOST: usize = 12;

/// The comparison as text, ending with a newline.
pub fn summary(comparison: &Comparison, baseline: &Results, new: &Results) -> String {
    let mut lines =
        vec![format!("baseline: {}", origin(baseline)), format!("new:      {}", origin(new)), String::new()];
    let beyond = comparison.beyond_chance();
    lines.push(format!(
        "{} measures in both; largest |z| {:.2}; chance alone stays below {:.2} (99 %, Šidák)",
        comparison.differences.len(),
        comparison.differences.iter().map(|d| d.z.abs()).fold(0.0, f64::max),
        comparison.threshold
    ));
    listed(&mut lines, "beyond chance", &beyond.iter().map(|d| reported(d)).collect::<Vec<_>>());
    listed(&mut lines, "only in the baseline", &comparison.only_baseline);
    listed(&mut lines, "only in the new results", &comparison.only_new);
    listed(&mut lines, "differences that chance does not explain", &comparison.known);
    listed(&mut lines, "differences of the runs", &comparison.runs);
    lines.push(verdict(comparison).to_owned());
    lines.join("\n") + "\n"
}

fn origin(results: &Results) -> String {
    format!("{}, seed {}, Switchback {}", results.name, results.seed, results.version)
}

fn reported(d: &Difference) -> String {
    let (place, b, n) = (&d.place, d.baseline, d.new);
    format!(
        "z = {:+.1}  {} of {}: {:.4e} ± {:.1e} → {:.4e} ± {:.1e}  ({}, N = {})",
        d.z,
        place.measure,
        place.parameter,
        b.value(),
        b.mcse(),
        n.value(),
        n.mcse(),
        place.series,
        place.samples
    )
}

fn listed(lines: &mut Vec<String>, what: &str, items: &[String]) {
    if items.is_empty() {
        return;
    }
    lines.push(format!("{} {what}:", items.len()));
    lines.extend(items.iter().take(MOST).map(|item| format!("  {item}")));
    if items.len() > MOST {
        lines.push(format!("  … and {} more", items.len() - MOST));
    }
}

fn verdict(comparison: &Comparison) -> &'static str {
    if comparison.identical() {
        "The two are identical."
    } else if comparison.differences.is_empty() {
        "The two have no measure in common."
    } else if !comparison.known.is_empty() {
        "The two are of different studies, or one is not as it was made: what chance does not explain differs."
    } else if comparison.agrees() {
        "The two agree within their Monte-Carlo errors."
    } else if comparison.beyond_chance().is_empty() {
        "What both hold agrees within Monte-Carlo errors, but they do not hold the same measures."
    } else {
        "The two differ beyond chance."
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::compare;
    use crate::results::{Measured, synthetic};

    #[test]
    fn the_summary_says_whether_the_two_agree() {
        let baseline = synthetic::results();
        let reported = summary(&compare(&baseline, &baseline), &baseline, &baseline);
        assert!(reported.ends_with("The two are identical.\n"), "{reported}");

        let mut new = baseline.clone();
        let bias = &mut new.cells[0].parameters[0].bias;
        *bias = bias.and_then(|m| Measured::new(m.value() + 30.0 * m.mcse(), m.mcse()));
        let reported = summary(&compare(&baseline, &new), &baseline, &new);
        assert!(reported.contains("1 beyond chance:\n  z = +21.2  bias of a1"), "{reported}");
        assert!(reported.ends_with("The two differ beyond chance.\n"), "{reported}");

        new.cells[0].parameters[0].truth += 5.0;
        let reported = summary(&compare(&baseline, &new), &baseline, &new);
        assert!(reported.contains("1 differences that chance does not explain:\n"), "{reported}");
        assert!(reported.ends_with("what chance does not explain differs.\n"), "{reported}");
    }
}
