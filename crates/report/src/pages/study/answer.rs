//! What a study says, in a sentence or two.

use maud::{Markup, html};
use switchback_io::diagnosis::digits;
use switchback_study::results::{Results, Summary, Verdict};

/// One sentence a case: which methods converge to the truth, which do not, which remain undecided; then what was expected.
pub(super) fn answer(results: &Results) -> Markup {
    let cases = distinct(results.summaries.iter().map(|s| s.series.case.as_str()));
    let broken = results.expectations.iter().filter(|e| !e.held).count();
    html! {
        @for case in &cases {
            p {
                @if cases.len() > 1 { strong { (case) ": " } }
                (sentence(&results.summaries.iter().filter(|s| s.series.case == *case).collect::<Vec<_>>()))
            }
        }
        @if broken > 0 {
            p class="bad" { strong { "Not as expected: " (broken) " of " (results.expectations.len()) " expectations." } }
        } @else if !results.expectations.is_empty() {
            p class="good" { "As the scenario expects (" (results.expectations.len()) " of " (results.expectations.len()) ")." }
        }
        @for expectation in &results.expectations {
            @if !expectation.held { p class="bad" { (expectation.what) ": " (expectation.detail) } }
        }
    }
}

/// The methods by what the curves of each say.
fn sentence(summaries: &[&Summary]) -> String {
    let methods = distinct(summaries.iter().map(|s| s.series.method.name()));
    let (mut right, mut wrong, mut open) = (Vec::new(), Vec::new(), Vec::new());
    for method in methods {
        let of = || summaries.iter().filter(|s| s.series.method.name() == method);
        let count = |verdict: Verdict| of().filter(|s| s.verdict == verdict).count();
        let all = of().count();
        if count(Verdict::Consistent) == all {
            right.push(method.to_owned());
        } else if count(Verdict::Inconsistent) > 0 {
            let plateaus = of().filter(|s| s.verdict == Verdict::Inconsistent).filter_map(|s| s.plateau);
            let largest = plateaus.map(|p| p.estimate.abs()).fold(0.0, f64::max);
            let share = if count(Verdict::Inconsistent) == all {
                String::new()
            } else {
                format!(" on {} of {all} curves", count(Verdict::Inconsistent))
            };
            wrong.push(format!("{method} (a bias of up to {} stays{share})", digits(largest, 2)));
        } else {
            open.push(format!("{method} ({} of {all} curves)", count(Verdict::Undecided)));
        }
    }
    let parts = [
        ("The estimates converge to the truth by ", right),
        ("They do not by ", wrong),
        ("Undecided: ", open),
    ];
    let reported = parts.into_iter().filter(|(_, methods)| !methods.is_empty());
    reported.map(|(start, methods)| format!("{start}{}.", listed(&methods))).collect::<Vec<_>>().join(" ")
}

/// `a, b and c`.
fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Each once, in the order of their first appearance.
pub(super) fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found = Vec::new();
    for name in names {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_study::results::synthetic;

    #[test]
    fn methods_are_reported_by_their_verdicts() {
        let results = synthetic::results();
        let all: Vec<&Summary> = results.summaries.iter().collect();
        let reported = sentence(&all);
        assert!(
            reported.starts_with("The estimates converge to the truth by paper-descendant and joint."),
            "{reported}"
        );
        assert!(reported.contains("They do not by memoryless (a bias of up to"), "{reported}");
        assert_eq!(listed(&["a".into(), "b".into(), "c".into()]), "a, b and c");
    }
}
