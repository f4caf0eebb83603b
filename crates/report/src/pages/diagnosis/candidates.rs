//! The candidates, and why each stands where it stands.

use crate::diagnosis::json::{GapFile, Hypothesis, Pair, Parameter};
use crate::diagnosis::posterior::Posterior;
use crate::diagnosis::probability;
use crate::pages::table::{Cell, Table};
use maud::{Markup, html};
use switchback_io::diagnosis::{closed_percent, digits};
use switchback_io::output::number;

/// A row a candidate; then what each saves by how far ahead it predicts; then the pair and what the verdict rests on, where there are.
pub(super) fn candidates(gap: &GapFile) -> Markup {
    html! {
        (table(gap).html())
        p class="note" {
            "Probabilities weigh all of the evidence: an effect that gains much by itself is improbable beside one that gains more. "
            "nats / sample: how much better held-out samples are predicted. A closure below 0 says that the effect makes held-out records worse. "
            "None of these: a cause that is no candidate; nothing: the model is right as it is."
        }
        (gains(gap))
        @if let Some(pair) = &gap.together { (together(pair)) }
        @if let Some(posterior) = &gap.posterior { (self::posterior(posterior)) }
    }
}

fn table(gap: &GapFile) -> Table {
    let head = [
        "candidate",
        "stage",
        "probability",
        "BIC drop",
        "nats / sample",
        "closure",
        "parameters, 90 % interval",
    ];
    let mut table = Table::new("The candidates, best first", head);
    for candidate in &gap.candidates {
        let closure = match candidate.closure {
            _ if candidate.unstable => "unstable".to_owned(),
            Some(closure) => format!("{} %", closed_percent(100.0 * closure)),
            None => "–".to_owned(),
        };
        table.row([
            Cell::word(candidate.effect.replace('_', " ")),
            Cell::word(candidate.stage.clone()),
            Cell::number(probability(candidate.probability), Some(candidate.probability)),
            Cell::number(
                format!("{:.0}", candidate.delta_bic + 0.0).replace('-', "−"),
                Some(candidate.delta_bic),
            ),
            Cell::number(digits(candidate.heldout_log_score, 2), Some(candidate.heldout_log_score)),
            Cell::number(closure, candidate.closure),
            Cell::word(parameters(candidate)),
        ]);
    }
    for (name, p) in [("none of these", gap.probability_unexplained), ("nothing", gap.probability_none)] {
        let rest = || Cell::number("", None);
        table.row([
            Cell::word(name),
            Cell::word(""),
            Cell::number(probability(p), Some(p)),
            rest(),
            rest(),
            rest(),
            Cell::word(""),
        ]);
    }
    table
}

/// Causes of a second opinion or a posterior listed; the rest is in gap.json.
const LISTED: usize = 6;
/// Parameters of one effect that are reported one by one.
const READABLE: usize = 6;

fn parameters(candidate: &Hypothesis) -> String {
    match candidate.parameters.len() {
        count if count > READABLE => format!("{count} parameters, in gap.json"),
        _ => candidate.parameters.iter().map(reported).collect::<Vec<_>>().join("; "),
    }
}

/// `play 1.003 [1.000, 1.004] mm`.
pub(super) fn reported(parameter: &Parameter) -> String {
    let [low, high] = parameter.ci90;
    let interval = match low.is_finite() && high.is_finite() {
        true => format!(" [{}, {}]", digits(low, 4), digits(high, 4)),
        false => ", undetermined".to_owned(),
    };
    format!(
        "{} {}{interval} {}",
        parameter.name.replace('_', " "),
        digits(parameter.value, 4),
        parameter.unit
    )
    .trim_end()
    .to_owned()
}

/// What share of the error each saves on the fit records, by how many samples ahead it predicts.
fn gains(gap: &GapFile) -> Markup {
    let ahead = |candidate: &Hypothesis| candidate.gains.iter().map(|gain| gain.samples).collect::<Vec<_>>();
    let Some(horizons) = gap.candidates.iter().map(ahead).max_by_key(Vec::len).filter(|h| !h.is_empty())
    else {
        return html! {};
    };
    let name = |samples: &Option<usize>| match samples {
        Some(1) => "1 sample".to_owned(),
        Some(samples) => format!("{samples} samples"),
        None => "whole record".to_owned(),
    };
    html! {
        h3 { "Why: the error that each saves, by how far ahead it predicts" }
        div class="scroll" tabindex="0" role="region" aria-label="Errors saved by how far ahead models predict" {
            table class="sortable" {
                thead { tr { th scope="col" { "candidate" } @for h in &horizons { th scope="col" class="n" { (name(h)) } } } }
                tbody {
                    @for candidate in gap.candidates.iter().filter(|c| !c.gains.is_empty()) {
                        tr {
                            td { (candidate.effect.replace('_', " ")) }
                            @for h in &horizons {
                                @match candidate.gains.iter().find(|gain| gain.samples == *h) {
                                    Some(gain) => td class="n" data-v=(number(gain.share)) {
                                        (percent(gain.share)) " (" (digits(gain.certainty, 2)) " se)"
                                    },
                                    None => td class="n" { "–" },
                                }
                            }
                        }
                    }
                }
            }
        }
        p class="note" { "Share of the nominal model's mean square error on the fit records that the effect saves, and the same in standard errors (se). What the machine lacks saves much far ahead; noise saves only the next sample." }
    }
}

/// Without a minus before what rounds to zero.
fn percent(share: f64) -> String {
    let rounded = (1000.0 * share).round() / 10.0 + 0.0;
    format!("{rounded:.1} %").replace('-', "−")
}

fn together(pair: &Pair) -> Markup {
    let shares = pair
        .effects
        .iter()
        .zip(&pair.shares)
        .map(|(e, s)| format!("{} {:.0} %", e.replace('_', " "), 100.0 * s));
    html! {
        h3 { "The best pair" }
        p {
            (pair.effects.iter().map(|e| e.replace('_', " ")).collect::<Vec<_>>().join(" and "))
            ": together they gain " (digits(pair.gain, 3)) " in penalised deviance over the best single effect; shares in what both gain: "
            (shares.collect::<Vec<_>>().join(", ")) "."
        }
    }
}

fn posterior(posterior: &Posterior) -> Markup {
    let basis = match posterior.examples {
        0 => "The likelihoods of all fits, joined with a prior, say".to_owned(),
        rigs => format!("A posterior trained on {rigs} rigs with known causes, joined by the fits, says"),
    };
    let mut table = Table::new(
        "What the verdict rests on: probabilities of causes",
        ["cause", "probability", "gain, nats a sample"],
    );
    for cause in posterior.causes.iter().take(LISTED) {
        let gain = cause.gain.map_or("–".to_owned(), |gain| digits(gain, 3));
        table.row([
            Cell::word(cause.words()),
            Cell::number(probability(cause.probability), Some(cause.probability)),
            Cell::number(gain, cause.gain),
        ]);
    }
    html! {
        h3 { "What the verdict rests on" }
        p {
            (basis) ", with probabilities: nothing is missing "
            (probability(posterior.probability_none)) ", none of these " (probability(posterior.probability_unexplained))
            ". The gain is that of the log-likelihood where the cause is fitted together with the model."
        }
        (table.html())
    }
}
