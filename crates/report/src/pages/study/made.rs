//! How a study was made, so that it can be made again.

use maud::{Markup, html};
use switchback_study::results::Results;
use switchback_study::scenario::Coupling;

/// Command, seed, version, engine, and the scenario.
pub(super) fn made(results: &Results) -> Markup {
    let replicates = results.cells.iter().map(|c| c.replicates);
    let (least, most) = (replicates.clone().min().unwrap_or(0), replicates.max().unwrap_or(0));
    let slopes: Vec<String> = results.slope_samples.iter().map(usize::to_string).collect();
    html! {
        dl {
            dt { "command" } dd { code { (results.command) } }
            dt { "version" } dd { "Switchback " (results.version) }
            dt { "seed" } dd { (results.seed) }
            dt { "replicates" } dd { @if least == most { (most) " a cell" } @else { (least) " to " (most) " a cell" } }
            dt { "engine" } dd { (results.engine.name()) }
            dt { "noise" } dd {
                @match results.coupling {
                    Coupling::Shared => "cells share their noise, so that they can be compared on it",
                    Coupling::Independent => "every cell has its own noise",
                }
            }
            @if !slopes.is_empty() { dt { "slopes over" } dd { "N = " (slopes.join(", ")) } }
            dt { "labels" } dd { (results.labels.input) ", " (results.labels.output) }
        }
        @if let Ok(scenario) = toml::to_string(&results.scenario) {
            h3 { "The scenario" }
            pre tabindex="0" role="region" aria-label="The scenario" { code { (scenario) } }
        }
    }
}
