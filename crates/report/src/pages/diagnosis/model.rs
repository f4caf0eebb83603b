//! The repaired model: what is in it, and how to run it.

use crate::diagnosis::json::GapFile;
use crate::pages::chart::{Chart, HALF, Ink, Layer, Reading, Scale, Shape};
use crate::pages::table::{Cell, Table};
use maud::{Markup, html};
use switchback_io::diagnosis::digits;
use switchback_io::model::{Described, ModelFile};

/// Effects with their parameters, coefficients, borders, and the command that runs it.
pub(super) fn model(gap: &GapFile, nominal: Option<&ModelFile>, augmented: Option<&ModelFile>) -> Markup {
    let Some(augmented) = augmented else {
        return html! { p { "There is none: the diagnosis has no model of its own." } };
    };
    let system = Described::of(&augmented.system);
    let mut table = Table::new(
        "What was added to the nominal model",
        ["effect", "parameter", "value", "90 % interval", "unit"],
    );
    for effect in &augmented.header.effects {
        for parameter in &effect.parameters {
            let told = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), |x| digits(x, 4));
            let [low, high] = parameter.ci90.map(told);
            table.row([
                Cell::word(effect.effect.replace('_', " ")),
                Cell::word(parameter.name.clone()),
                Cell::number(told(parameter.value), parameter.value),
                Cell::word(format!("[{low}, {high}]")),
                Cell::word(parameter.unit.clone()),
            ]);
        }
    }
    html! {
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
        div class="charts" { (borders(gap, nominal, &system).html()) }
    }
}

fn listed(coefficients: &[f64]) -> String {
    coefficients.iter().map(|x| digits(*x, 5)).collect::<Vec<_>>().join(", ")
}

fn borders(gap: &GapFile, nominal: Option<&ModelFile>, augmented: &Described) -> Chart {
    let before = nominal.map(|model| Described::of(&model.system));
    let mut layers = Vec::new();
    for (name, system, dashed) in [("nominal", before.as_ref(), true), ("augmented", Some(augmented), false)]
    {
        let Some(system) = system else { continue };
        for (border, points, ink) in
            [("descending", &system.descending, Ink::Blue), ("ascending", &system.ascending, Ink::Orange)]
        {
            let shape = if dashed { Shape::Dashes(points.clone()) } else { Shape::Line(points.clone()) };
            layers.push(Layer::new(format!("{border}, {name}"), ink, shape));
        }
    }
    let all = [&augmented.descending, &augmented.ascending];
    let others = before.iter().flat_map(|b| [&b.descending, &b.ascending]);
    let points: Vec<(f64, f64)> = all.into_iter().chain(others).flatten().copied().collect();
    Chart {
        title: "Borders of the models".to_owned(),
        note: "in units of u; the scale between u and y is in b".to_owned(),
        x: Scale::linear(&gap.input, points.iter().map(|p| p.0)),
        y: Scale::linear("u", points.iter().map(|p| p.1)),
        layers,
        reading: Reading::Nearest,
        size: HALF,
    }
}
