//! The repaired model: its parts, and how to run it.

use crate::diagnosis::json::GapFile;
use crate::pages::error::PageError;
use crate::pages::sheet::figure;
use crate::pages::table::{Cell, Table};
use crate::plots::gap::borders;
use maud::{Markup, html};
use switchback_io::diagnosis::digits;
use switchback_io::model::{Described, ModelFile};

/// Effects with their parameters, coefficients, borders, and the command that runs it.
///
/// # Errors
/// A figure that is no drawing.
pub(super) fn model(
    gap: &GapFile,
    nominal: Option<&ModelFile>,
    augmented: Option<&ModelFile>,
) -> Result<Markup, PageError> {
    let Some(augmented) = augmented else {
        return Ok(html! { p { "There is none: the diagnosis has no model of its own." } });
    };
    let system = Described::of(&augmented.system);
    let mut table = Table::new(
        "What was added to the nominal model",
        ["effect", "parameter", "value", "90 % interval", "unit"],
    );
    for effect in &augmented.header.effects {
        for parameter in &effect.parameters {
            let reported = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), |x| digits(x, 4));
            let [low, high] = parameter.ci90.map(reported);
            table.row([
                Cell::word(effect.effect.replace('_', " ")),
                Cell::word(parameter.name.clone()),
                Cell::number(reported(parameter.value), parameter.value),
                Cell::word(format!("[{low}, {high}]")),
                Cell::word(parameter.unit.clone()),
            ]);
        }
    }
    let before = nominal.map(|model| Described::of(&model.system));
    Ok(html! {
        p { "augmented.json is the nominal model with what was found. It runs on any input, with a band, and warns where the input leaves what it was identified on:" }
        pre tabindex="0" role="region" aria-label="How to run it" { code { "switchback simulate augmented.json INPUT.csv --out predicted.csv" } }
        @if augmented.header.effects.is_empty() { p { "Nothing was added: it is the nominal model." } } @else { (table.html()) }
        dl {
            dt { "order" } dd { (system.order) }
            dt { "extra delay" } dd { (system.delay) " samples" }
            dt { "sample time" } dd { (augmented.header.sample_time) " s" }
            dt { "a" } dd { (listed(&system.a)) }
            dt { "b" } dd { (listed(&system.b)) }
        }
        p class="note" { "A(q⁻¹) y(t) = Σ bᵢ u(t − delay − i), u on the borders below; effects come on top." }
        div class="charts" { (figure("borders", &borders(&gap.input, before.as_ref(), &system))?) }
    })
}

fn listed(coefficients: &[f64]) -> String {
    coefficients.iter().map(|x| digits(*x, 5)).collect::<Vec<_>>().join(", ")
}
