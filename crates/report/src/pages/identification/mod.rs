//! The page of an identification.

mod borders;
mod coefficients;
mod linear;
mod others;

use super::error::PageError;
use super::files::Files;
use super::layout::Page;
use super::series::{loops, outputs};
use super::sheet::{figure, sheets};
use crate::plots::identify;
use crate::plots::runs::Shown;
use maud::{Markup, html};
use switchback_io::diagnosis::fit_percent;
use switchback_io::identification::json::{EstimateFile, SCHEMA};
use switchback_io::model::{Series, of_text};

/// Files whose figures the page draws anew.
const DRAWN_HERE: [&str; 2] = ["borders", "measured_and_simulated_"];

/// The page of the files of `identify --out`.
///
/// # Errors
/// [`PageError`] if one is missing, of another format, or of another rig.
pub(super) fn identification(files: &Files) -> Result<String, PageError> {
    let estimate: EstimateFile = files.object("estimate.json", SCHEMA)?;
    let series = Series::parse(&files.place("series.csv"), files.needed("series.csv")?)?;
    let model = files.text("model.json").map(|text| of_text(&files.place("model.json"), text)).transpose()?;
    if let Some(model) = &model {
        files.same_rig(("estimate.json", &estimate.rig), ("model.json", &model.header.rig))?;
    }
    let held_out = || estimate.records.iter().filter(|record| record.r#use == "holdout");
    let shown = Shown {
        series: &series,
        input: &estimate.input,
        output: &estimate.output,
        records: held_out().map(|record| record.name.clone()).collect(),
        noise: None,
    };
    Ok(Page::new("Identification", &estimate.rig, lead(&estimate))
        .section("fit", "Fit", fits(&estimate))
        .section("borders", "Borders", borders::borders(&estimate)?)
        .section("loop", "The loop over the data", loops(&shown)?)
        .section("outputs", "Outputs over time", outputs(&shown)?)
        .section("coefficients", "Coefficients", coefficients::coefficients(&estimate))
        .section("linear", "The linear part", linear::linear(&estimate, model.as_ref())?)
        .section("residuals", "Residual correlations", residuals(&estimate, &series)?)
        .section("others", "Other models", others::others(&estimate))
        .section("model", "The model to take away", take_away(model.is_some()))
        .section("figures", "Other figures", sheets(files.other_figures(&DRAWN_HERE))?)
        .html())
}

fn lead(estimate: &EstimateFile) -> Markup {
    let held_out: Vec<String> = estimate
        .records
        .iter()
        .filter(|record| record.r#use == "holdout")
        .filter_map(|record| Some(format!("{} % on {}", fit_percent(record.fit_percent?), record.name)))
        .collect();
    html! {
        p class="lead" {
            "Identified by " (estimate.method) ": order " (estimate.order)
            @match estimate.delay { 0 => "", 1 => ", 1 sample of extra delay", delay if delay > 0 => { ", " (delay) " samples of extra delay" }, lead => { ", looking " (-lead) " samples ahead" } }
            ", " (estimate.samples) " samples."
            @if held_out.is_empty() { " No record is held out, so that no fit proves anything." } @else { " Fit in free-run simulation of what was held out: " (held_out.join(", ")) "." }
        }
        @if estimate.warnings.is_empty() {
            div class="box" { p class="good" { "Nothing speaks against the model." } }
        } @else {
            div class="box" { p class="bad" { strong { "Before it is trusted:" } } ul { @for warning in &estimate.warnings { li { (warning) } } } }
        }
    }
}

fn fits(estimate: &EstimateFile) -> Markup {
    use super::table::{Cell, Table};
    let mut table = Table::new(
        "Fit in free-run simulation, from v alone: 100 % is perfect, 0 % is the record's mean",
        ["record", "use", "samples", "fit"],
    );
    for record in &estimate.records {
        table.row([
            Cell::word(record.name.clone()),
            Cell::word(if record.r#use == "holdout" { "held out" } else { "fitted" }),
            Cell::number(record.samples.to_string(), Some(record.samples as f64)),
            Cell::number(
                record.fit_percent.map_or_else(|| "–".to_owned(), |fit| format!("{} %", fit_percent(fit))),
                record.fit_percent,
            ),
        ]);
    }
    html! { (table.html()) }
}

/// The correlations of the residuals.
fn residuals(estimate: &EstimateFile, series: &Series) -> Result<Markup, PageError> {
    let Some(svg) = identify::correlations(estimate, series) else {
        return Ok(html! { p { "The fitted records are too short, or have no run." } });
    };
    Ok(html! {
        (figure("correlations", &svg)?)
        p class="note" {
            @if let Some(innovations) = &estimate.innovations {
                "The past of the residuals predicts " (format!("{:.1} %", 100.0 * innovations.forecast)) " of their variance (Ljung–Box "
                (format!("{:.0}", innovations.ljung_box)) " over " (innovations.lags) " lags). "
            }
            "Correlation with the input at negative lags means feedback from output to input, or a model that looks too far ahead. "
            code { "switchback gap" } " looks for the cause of the rest."
        }
    })
}

fn take_away(is_there: bool) -> Markup {
    html! {
        @if is_there {
            p { "model.json runs on any input, with a band, and warns where the input leaves what it was identified on:" }
            pre tabindex="0" role="region" aria-label="How to run it" { code { "switchback simulate model.json INPUT.csv --out predicted.csv" } }
            p { code { "switchback gap DATA.csv --model model.json" } " asks whether the machine still is what it was." }
        } @else {
            p { "There is none: the estimate cannot run by itself." }
        }
    }
}
