//! The page of a diagnosis.

mod candidates;
mod chain;
mod closure;
mod differences;
mod experiment;
mod model;
mod places;

use super::error::PageError;
use super::files::Files;
use super::layout::Page;
use super::series::{loops, outputs};
use super::sheet::sheets;
use crate::diagnosis::json::{GapFile, SCHEMA};
use crate::plots::runs::Shown;
use maud::{Markup, html};
use switchback_io::model::{Series, of_text};

/// The page of the files of `gap --out`.
///
/// # Errors
/// [`PageError`] if one is missing, of another format, or of another rig.
pub(super) fn diagnosis(files: &Files) -> Result<String, PageError> {
    let gap: GapFile = files.object("gap.json", SCHEMA)?;
    let series = Series::parse(&files.place("series.csv"), files.needed("series.csv")?)?;
    let model = |file: &str| files.text(file).map(|text| of_text(&files.place(file), text)).transpose();
    let (nominal, augmented) = (model("nominal.json")?, model("augmented.json")?);
    let models = [("nominal.json", &nominal), ("augmented.json", &augmented)];
    for (file, model) in models.into_iter().filter_map(|(file, model)| Some((file, model.as_ref()?))) {
        files.same_rig(("gap.json", &gap.rig), (file, &model.header.rig))?;
    }
    let shown = Shown {
        series: &series,
        input: &gap.input,
        output: &gap.output,
        records: gap.gap.per_record.iter().map(|record| record.record.clone()).collect(),
        noise: Some(gap.gap.noise_floor),
    };
    let page = Page::new("Diagnosis of the sim-to-real gap", &gap.rig, verdict(&gap));
    let page = match gap.differences.is_empty() {
        true => page,
        false => page.section("differences", "What differs", differences::differences(&gap)),
    };
    Ok(page
        .section("stages", "Where in the machine", chain::chain(&gap))
        .section("loop", "The loop", loops(&shown)?)
        .section("outputs", "Outputs over time", outputs(&shown)?)
        .section(
            "where",
            "Where the gap lies",
            html! { (sheets(files.figures("where"))?) (places::places(&gap)) },
        )
        .section(
            "candidates",
            "What explains it",
            html! { (sheets(files.figures("candidates"))?) (candidates::candidates(&gap)) },
        )
        .section("closure", "How far it closes", closure::closure(&gap))
        .section("residuals", "What is left, one step ahead", sheets(files.figures("residuals"))?)
        .section("next", "The next experiment", experiment::experiment(&gap)?)
        .section("model", "The model to take away", model::model(&gap, nominal.as_ref(), augmented.as_ref())?)
        .section(
            "figures",
            "Other figures",
            sheets(files.other_figures(&["where", "candidates", "residuals", "outputs_"]))?,
        )
        .section("care", "To be read with care", care(&gap))
        .html())
}

/// The verdict in words, then the worth of its probability.
fn verdict(gap: &GapFile) -> Markup {
    // That it is not calibrated is one of the sentences.
    let is_calibrated =
        gap.verdict.calibrated && !matches!(gap.verdict.status.as_str(), "none" | "refit" | "parameters");
    html! {
        p class="lead" { (headline(gap)) }
        div class="box" {
            @for sentence in &gap.in_words { p { (sentence) } }
            @if is_calibrated {
                p class="note" { "The probability is calibrated: of verdicts reported with it about that share was right on the rigs of the examination." }
            }
        }
    }
}

/// The answer in a line.
fn headline(gap: &GapFile) -> String {
    let verdict = &gap.verdict;
    let named = |effects: &[String], word: &str| {
        effects.iter().map(|e| e.replace('_', " ")).collect::<Vec<_>>().join(word)
    };
    let probability = crate::diagnosis::probability(verdict.probability);
    match verdict.status.as_str() {
        "none" => "Nothing significant is missing from the model.".to_owned(),
        "parameters" => {
            "Values of what was compared with the machine are off; nothing is missing in it.".to_owned()
        }
        "refit" => "The model's own parameters are off: identified anew it has no gap that asks for a cause."
            .to_owned(),
        "named" => {
            format!("The model lacks {} (probability {probability}).", named(&verdict.effects, " and "))
        }
        "class" => format!(
            "The model lacks one of {}, which these records do not distinguish (probability {probability}).",
            named(&verdict.class, ", ")
        ),
        "shortlist" => format!(
            "No cause is certain enough to be named; the likeliest: {} (together {probability}).",
            named(&verdict.class, ", ")
        ),
        "ambiguous" => format!(
            "Several causes are possible: {} (probability {probability}).",
            named(&verdict.class, ", ")
        ),
        _ => "There is a gap, and none of the effects known here is its cause.".to_owned(),
    }
}

fn care(gap: &GapFile) -> Markup {
    html! {
        ul {
            @for limitation in &gap.limitations { li { (limitation) } }
            li { "A static nonlinearity in series with the input, an offset common to all records and a shift of the borders look the same in any record." }
            li { "A cause is one of the effects that the program knows, or none: what it does not know it cannot name." }
        }
        p class="note" { "gap.json holds every figure of this page, series.csv every sample. Version " (gap.version) "." }
    }
}
