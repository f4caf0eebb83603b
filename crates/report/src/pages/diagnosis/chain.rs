//! The block diagram, with what speaks for each stage.

use crate::diagnosis::json::{GapFile, Hypothesis};
use crate::diagnosis::probability;
use maud::{Markup, html};
use switchback_diagnose::{Effect, Stage};
use switchback_io::diagnosis::closed_percent;

/// What a stage is.
fn what(stage: Stage) -> &'static str {
    match stage {
        Stage::Input => "what happens to the recorded v before it acts",
        Stage::Operator => "the switched hysteresis: borders and how it changes between them",
        Stage::Dynamics => "the linear part",
        Stage::Disturbance => "what drives the output besides the input",
        Stage::Sensor => "what happens to the true output before it is recorded",
    }
}

const STAGES: [Stage; 5] =
    [Stage::Input, Stage::Operator, Stage::Dynamics, Stage::Disturbance, Stage::Sensor];

/// `v → input → operator → dynamics → disturbance → sensor → y`, the guilty stages marked.
pub(super) fn chain(gap: &GapFile) -> Markup {
    html! {
        p { "A signal passes these stages. Each box says how likely it is that the cause lies in it, and which effect there explains most." }
        ol class="chain" {
            li class="end" { "v" }
            @for stage in STAGES { li { (one(gap, stage)) } }
            li class="end" { "y" }
        }
        p class="note" {
            "Probability that nothing is missing: " (probability(gap.probability_none))
            "; that the cause is none of the effects known here: " (probability(gap.probability_unexplained))
            ". BIC drop: how much the Bayesian information criterion falls once the effect is added; closure: the share of the gap on held-out records that goes with it."
        }
    }
}

fn one(gap: &GapFile, stage: Stage) -> Markup {
    let within = |candidate: &&Hypothesis| candidate.stage == stage.name();
    let here: Vec<&Hypothesis> = gap.candidates.iter().filter(within).collect();
    let sum: f64 = here.iter().map(|candidate| candidate.probability).filter(|p| p.is_finite()).sum();
    let accused = accused(gap, stage);
    html! {
        div class={ "stage" @if accused.is_some() { " guilty" } } {
            h3 { (stage.name()) }
            p class="note" { (what(stage)) }
            @if let Some(accused) = &accused { p class="flag" { (accused) } }
            p { "probability " strong { (probability(sum.min(1.0))) } }
            @match here.first() {
                Some(best) => p {
                    "best: " (best.effect.replace('_', " ")) ", BIC drop " (format!("{:.0}", best.delta_bic + 0.0).replace('-', "−"))
                    @if let Some(closure) = best.closure { ", closure " (closed_percent(100.0 * closure)) " %" }
                },
                None => p { "no effect of this stage is worth its parameters" },
            }
        }
    }
}

/// Why a stage is marked.
fn accused(gap: &GapFile, stage: Stage) -> Option<String> {
    let of_stage = |effects: &[String]| -> Vec<String> {
        let here = effects.iter().filter(|e| Effect::from_name(e).is_some_and(|e| e.stage() == stage));
        here.map(|e| e.replace('_', " ")).collect()
    };
    let verdict = &gap.verdict;
    let (named, class) = (of_stage(&verdict.effects), of_stage(&verdict.class));
    let points_here = verdict.stage.as_deref() == Some(stage.name());
    match verdict.status.as_str() {
        "named" if !named.is_empty() => Some(format!("▶ the cause: {}", named.join(", "))),
        "class" | "ambiguous" | "shortlist" if !class.is_empty() => {
            Some(format!("▶ possible: {}", class.join(", ")))
        }
        "unexplained" if points_here => Some("▶ the gap points here".to_owned()),
        _ => None,
    }
}
