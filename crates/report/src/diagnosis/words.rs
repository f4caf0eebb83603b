//! The diagnosis as a page for a person.

use super::probability::probability;
use super::sentences;
use super::sentences::parameters;
use std::fmt::Write;
use std::path::Path;
use switchback_diagnose::Candidate;
use switchback_io::diagnosis::separates;
use switchback_io::diagnosis::{NEXT_EXPERIMENT, Report, Units};
use switchback_io::diagnosis::{closed_percent, digits, fit_percent};
use switchback_io::output::{columns, wrapped};

/// Candidates listed; the rest is in the JSON.
pub(super) const LISTED: usize = 6;

/// What is left when all candidates are ruled out, and when there is nothing to explain.
const NONE_OF_THESE: &str = "none of these";
const NOTHING: &str = "nothing";

/// The verdict in sentences, the hold-out records, the best candidates, what could not be judged, and what to do next.
/// `out` is where the report's folder was written, if it was.
pub fn words(report: &Report, out: Option<&Path>) -> String {
    let file = match out {
        Some(folder) => format!("its input is ready in {}", folder.join(NEXT_EXPERIMENT).display()),
        None => "`--out DIR` writes its input as a CSV".to_owned(),
    };
    let mut page = page(report, &file);
    if let Some(folder) = out {
        let _ = write!(page, "\nreport: {}\n", folder.display());
    }
    page
}

/// The same for a file that lies beside the others of the report.
pub fn verdict(report: &Report) -> String {
    page(report, &format!("its input is in {NEXT_EXPERIMENT}"))
}

/// `file` says where the input of the next experiment is.
fn page(report: &Report, file: &str) -> String {
    let units = Units::of(&report.rig);
    let mut page = format!("{}\n\n", report.rig.name);
    page.push_str(&wrapped(&sentences::verdict(report).join(" "), ""));
    page.push('\n');
    page.push_str(&records(report));
    page.push('\n');
    match &report.diagnosis.differences {
        Some(differences) => page.push_str(&super::differences::table(report, differences)),
        None => page.push_str(&hypotheses(report, &units)),
    }
    if !report.diagnosis.limitations.is_empty() {
        page.push_str("\nto be read with care:\n");
        for limitation in &report.diagnosis.limitations {
            page.push_str(&wrapped(&format!("- {limitation}"), "  "));
        }
    }
    if let Some(text) = next(report, file) {
        let _ = write!(page, "\n{}", wrapped(&text, ""));
    }
    page
}

fn records(report: &Report) -> String {
    let head = ["record", "fit % before", "after", "gap % of var(y) before", "after"];
    let mut rows = vec![head.map(str::to_owned)];
    for record in &report.diagnosis.gap.per_record {
        let gap = |x: f64| digits(100.0 * x, 3);
        rows.push([
            record.record.clone(),
            fit_percent(record.fit_before),
            fit_percent(record.fit_after),
            gap(record.before),
            gap(record.after),
        ]);
    }
    columns(&rows)
}

fn hypotheses(report: &Report, units: &Units) -> String {
    let diagnosis = &report.diagnosis;
    let head = ["candidate", "probability", "BIC drop", "nats/sample", "closure %"];
    let mut rows = vec![head.map(str::to_owned)];
    let listed = || diagnosis.candidates.iter().take(LISTED);
    for candidate in listed() {
        rows.push(row(candidate));
    }
    for (name, p) in
        [(NONE_OF_THESE, diagnosis.probability_unexplained), (NOTHING, diagnosis.probability_none)]
    {
        let rest = ["", "", ""].map(str::to_owned);
        let [a, b, c] = rest;
        rows.push([name.to_owned(), probability(p), a, b, c]);
    }
    let rest =
        format!("`{NONE_OF_THESE}`: a cause that is no candidate; `{NOTHING}`: the model is right as it is.");
    let table = format!("{}{}", columns(&rows), wrapped(&rest, ""));
    let reported: Vec<String> = listed()
        .map(|candidate| (candidate.effect, parameters(&candidate.parameters, units)))
        .filter(|(_, text)| !text.is_empty())
        .map(|(effect, text)| wrapped(&format!("  {effect}: {text}"), "    "))
        .collect();
    if reported.is_empty() {
        table
    } else {
        format!(
            "{table}\nparameters of each candidate by itself, with 90 % intervals:\n{}",
            reported.concat()
        )
    }
}

fn row(candidate: &Candidate) -> [String; 5] {
    [
        candidate.effect.to_string(),
        probability(candidate.probability),
        format!("{:.0}", candidate.delta_bic + 0.0).replace('-', "−"),
        digits(candidate.heldout_log_score, 2),
        match candidate.closure {
            _ if candidate.unstable => "unstable".to_owned(),
            Some(closure) => closed_percent(100.0 * closure),
            None => "–".to_owned(),
        },
    ]
}

fn next(report: &Report, file: &str) -> Option<String> {
    let next = report.diagnosis.next_experiment.as_ref()?;
    let seconds = digits(next.v.len() as f64 * report.rig.sample_time, 3);
    let rivals = next.separates.iter().map(|effect| effect.name()).collect::<Vec<_>>().join(" and ");
    if !separates(next) {
        let least = digits(next.distance, 2);
        return Some(format!(
            "next experiment: none of the kinds tried would separate {rivals}; the best sets their predictions apart by \
             {least} noise sd."
        ));
    }
    Some(format!(
        "next experiment: {} ({} samples, {seconds} s) sets the predictions of {rivals} apart by {} noise sd; {file}.",
        next.kind.name(),
        next.v.len(),
        digits(next.distance, 2),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_diagnose::Effect;

    #[test]
    fn a_candidate_without_a_free_run_has_no_closure() {
        let reported = |closure: Option<f64>, unstable: bool| {
            let candidate = Candidate {
                effect: Effect::Creep,
                stage: Effect::Creep.stage(),
                probability: 0.1,
                parameters: Vec::new(),
                bic: -900.0,
                delta_bic: 34.6,
                heldout_log_score: 0.1,
                gains: Vec::new(),
                closure,
                unstable,
            };
            row(&candidate)
        };
        assert_eq!(reported(Some(0.977), false), ["creep", "0.10", "35", "0.10", "98"]);
        assert_eq!(reported(None, true)[4], "unstable");
        assert_eq!(reported(None, false)[4], "–");
        assert_eq!(reported(Some(-2.7e10), false)[4], "< −999");
    }

    #[test]
    fn long_texts_are_broken_between_words() {
        let text = "word ".repeat(60);
        let page = wrapped(text.trim_end(), "  ");
        assert!(page.lines().all(|line| line.chars().count() <= 100));
        assert!(page.lines().skip(1).all(|line| line.starts_with("  word")));
        assert_eq!(page.split_whitespace().count(), 60);
    }
}
