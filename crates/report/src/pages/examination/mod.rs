//! The page of an examination.

mod measures;
mod tables;

use super::error::PageError;
use super::files::Files;
use super::layout::Page;
use super::sheet::sheets;
use maud::{Markup, html};
use switchback_lab::examination::{Design, Refused, Results};
use tables::{CLOSURE, PLACES, RULES, SIZES, shown};

/// Figures that have a section of their own.
const PLACED: [&str; 6] = ["accuracy", "abstention", "baselines", "calibration", "closure", "confusion"];

/// The page of the files of an examination.
///
/// # Errors
/// [`PageError`] if results.json is of another format.
pub(super) fn examination(files: &Files) -> Result<String, PageError> {
    let design = match files.needed("results.json")?.contains("\"switchback/field/") {
        true => Design::Field,
        false => Design::Laboratory,
    };
    let results: Results = files.object("results.json", design.schema())?;
    let figure = |name: &str| sheets(files.figures(name));
    let lead = lead(&results);
    let measures = measures::table(&results.measures);
    let made = made(&results);
    let page = match design {
        Design::Laboratory => Page::new("Blind examination of the diagnosis", &results.name, lead)
            .section("measures", "What was reached", measures)
            .section("confusion", "What was named", figure("confusion")?)
            .section(
                "sizes",
                "By the size of the effect",
                html! { (figure("accuracy")?) (shown(&results, SIZES)) },
            )
            .section(
                "calibration",
                "What the probabilities are worth",
                html! { (figure("calibration")?) (figure("abstention")?) },
            )
            .section(
                "closure",
                "How far gaps close",
                html! { (figure("closure")?) (shown(&results, CLOSURE)) },
            )
            .section("where", "Whether places are found", shown(&results, PLACES))
            .section(
                "rules",
                "Other rules on the same rigs",
                html! { (figure("baselines")?) (shown(&results, RULES)) },
            ),
        Design::Field => Page::new("Field examination of the diagnosis", &results.name, lead)
            .section("measures", "What was reached", measures)
            .section("answers", "Answers", tables::answers(&results))
            .section("confusion", "What was named", figure("confusion")?)
            .section(
                "calibration",
                "What the probabilities are worth",
                html! { (figure("calibration")?) (tables::strata(&results)) },
            ),
    };
    Ok(page
        .section("figures", "Other figures", sheets(files.other_figures(&PLACED))?)
        .section("unresolved", "What it cannot say", unresolved(design, &results))
        .section("made", "How it was made", made)
        .html())
}

fn has_no_measured_base(results: &Results) -> bool {
    results.measured_bases.as_ref().is_some_and(|bases| bases.is_empty())
}

fn lead(results: &Results) -> Markup {
    html! {
        p class="lead" { (results.question) }
        div class="box" {
            @if let Some(partial) = results.partial { p class="bad" { strong { (partial) } } }
            (measures::answer(&results.measures))
            @if has_no_measured_base(results) { p class="bad" { "No measured base is among these rigs: all figures are of made bases." } }
        }
    }
}

fn unresolved(design: Design, results: &Results) -> Markup {
    match design {
        Design::Laboratory => html! {
            ul {
                @if results.refused.is_empty() { li { "Every rig could be diagnosed." } }
                @else { li { (results.refused.len()) " rigs could not be diagnosed, and count as not named: " (ids(&results.refused).join(", ")) "." } }
                li { "Rigs are made by the program's own maker; a figure holds for rigs drawn like these." }
            }
        },
        Design::Field => html! {
            ul {
                li { "Every rig is diagnosed twice, with its model given and without, and judged by what is named beyond what its base shows by itself; silence about a fault counts as missed." }
                @if let Some(count) = results.not_observable.filter(|count| *count > 0) { li { (count) " faults are not observable (size below ½), and not counted." } }
                @if let Some(count) = results.failed.filter(|count| *count > 0) { li { (count) " diagnoses were refused, and count as silent." } }
                @if has_no_measured_base(results) { li { "No machine that was measured is among the bases." } }
                @else { li { "Measured bases: " (results.measured_bases.iter().flatten().cloned().collect::<Vec<_>>().join(", ")) "." } }
            }
            (tables::refused(results))
        },
    }
}

fn ids(refused: &[Refused]) -> Vec<String> {
    let id = |one: &Refused| match one {
        Refused::Rig(id) | Refused::Reported { id, .. } => id.to_string(),
    };
    refused.iter().map(id).collect()
}

/// How it was made.
fn made(results: &Results) -> Markup {
    let rigs: Vec<String> = results.rigs.iter().map(|(kind, count)| format!("{kind} {count}")).collect();
    html! {
        dl {
            dt { "kind" } dd { (results.study) }
            dt { "version" } dd { "Switchback " (results.version) }
            dt { "seed" } dd { (results.seed) }
            dt { "rigs" } dd { (rigs.join(", ")) }
            dt { "SHA-256 of the keys" } dd { code { (results.key_sha256) } }
        }
        p class="note" { "Keys, which say what was put into each rig, were written and hashed before the first diagnosis; key.jsonl holds them." }
        h3 { "The design" }
        pre tabindex="0" role="region" aria-label="The design" { code { (format!("{:#}", results.design)) } }
    }
}
