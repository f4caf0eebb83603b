//! Why the first candidate comes first: what each saves, by how far ahead it predicts.

use super::posterior;
use super::words::LISTED;
use switchback_diagnose::{Candidate, Diagnosis, Horizon, HorizonGain};
use switchback_io::diagnosis::Report;
use switchback_io::diagnosis::{closed_percent, digits, whole_percent};
use switchback_io::output::{columns, wrapped};

/// Standard errors from which a gain is beyond chance (95 %, one side).
const CERTAIN: f64 = 1.645;

/// A table of the gains and, where there is a first candidate, its difference from the next.
pub fn why(report: &Report) -> String {
    let diagnosis = &report.diagnosis;
    let listed = &diagnosis.candidates[..diagnosis.candidates.len().min(LISTED)];
    let Some(first) = listed.first() else {
        let posterior = diagnosis.classification.as_ref().map_or_else(String::new, posterior::words);
        return format!("\nwhy: no effect was left as a candidate\n{posterior}");
    };
    let head = "why: share of the nominal model's mean square error on the fit records that each candidate saves, predicting so far ahead; \
                in brackets the same in its standard errors, which come from the errors themselves";
    let sentences = [verdict(diagnosis).to_owned(), lead(first, listed.get(1)), reach(first)].concat();
    let posterior = diagnosis.classification.as_ref().map_or_else(String::new, posterior::words);
    let sentences = wrapped(sentences.trim_end(), "");
    format!("\n{}{}{sentences}{posterior}", wrapped(head, ""), columns(&table(listed)))
}

fn table(listed: &[Candidate]) -> Vec<[String; 6]> {
    // The nearest and the farthest horizon are always there; of those between, as many as the records are long for.
    let between: Vec<Horizon> = listed
        .iter()
        .map(|c| c.gains.iter().map(|g| g.horizon).filter(|h| matches!(h, Horizon::Samples(_))).collect())
        .max_by_key(Vec::len)
        .unwrap_or_default();
    let [near, far] = [0, 1].map(|at| between.get(at).copied());
    let horizons = [Some(Horizon::Step), near, far, Some(Horizon::FreeRun)];
    let name = |horizon: &Option<Horizon>| horizon.map_or_else(String::new, ahead);
    let [one, two, three, four] = horizons.each_ref().map(name);
    let mut rows = vec![["candidate".to_owned(), one, two, three, four, "closure % held out".to_owned()]];
    for candidate in listed {
        let [one, two, three, four] =
            horizons.map(|horizon| horizon.map_or_else(String::new, |h| share(at(candidate, h))));
        let closure = candidate.closure.map_or("–".to_owned(), |closure| closed_percent(100.0 * closure));
        rows.push([candidate.effect.to_string(), one, two, three, four, closure]);
    }
    rows
}

fn ahead(horizon: Horizon) -> String {
    match horizon {
        Horizon::Step => "1 sample".to_owned(),
        Horizon::Samples(samples) => format!("{samples} samples"),
        Horizon::FreeRun => "whole record".to_owned(),
    }
}

fn at(candidate: &Candidate, horizon: Horizon) -> Option<HorizonGain> {
    candidate.gains.iter().copied().find(|gain| gain.horizon == horizon)
}

fn share(gain: Option<HorizonGain>) -> String {
    gain.map_or("–".to_owned(), |g| {
        format!("{} % ({})", closed_percent(100.0 * g.share), digits(g.certainty, 2))
    })
}

/// What the shares cannot show.
fn verdict(diagnosis: &Diagnosis) -> &'static str {
    match diagnosis.verdict.effects.len() {
        0 if diagnosis.verdict.class.is_empty() => "No cause is named. ",
        0 | 1 => "",
        _ => "Each is taken by itself here; those named act together. ",
    }
}

/// What shows the first from the next: the horizon at which it is farthest ahead.
fn lead(first: &Candidate, second: Option<&Candidate>) -> String {
    let Some(second) = second else {
        return format!("No other effect explains anything beside {}. ", first.effect);
    };
    let both = first.gains.iter().filter_map(|one| Some((*one, at(second, one.horizon)?)));
    // Where the first itself gains nothing no lead means anything.
    let ahead = both.filter(|(one, other)| one.share > other.share.max(0.0));
    let Some((one, other)) = ahead.max_by(|x, y| (x.0.share - x.1.share).total_cmp(&(y.0.share - y.1.share)))
    else {
        return format!(
            "{} saves no more than {} at any horizon: they differ in the penalty for parameters and on held-out records. ",
            first.effect, second.effect
        );
    };
    let over = match one.horizon {
        Horizon::Step => "Predicting one sample ahead".to_owned(),
        Horizon::Samples(samples) => format!("Predicting {samples} samples ahead"),
        Horizon::FreeRun => "Simulating whole records".to_owned(),
    };
    let of_other = match other.share {
        s if s < -1.0 => "makes it more than twice as large".to_owned(),
        s if s < 0.0 => format!("adds {} %", whole_percent(-100.0 * s)),
        s => format!("saves {} %", whole_percent(100.0 * s)),
    };
    format!(
        "{over}, {} saves {} % of the mean square error; the next, {}, {of_other}. ",
        first.effect,
        whole_percent(100.0 * one.share),
        second.effect
    )
}

/// How far ahead the first gains.
fn reach(first: &Candidate) -> String {
    let gains = |gain: &&HorizonGain| gain.share > 0.0 && gain.certainty > CERTAIN;
    let gaining: Vec<Horizon> = first.gains.iter().filter(gains).map(|gain| gain.horizon).collect();
    match (gaining.first(), gaining.last()) {
        (None, _) | (_, None) => format!("{} saves nothing beyond chance at any horizon.", first.effect),
        (Some(Horizon::Step), Some(Horizon::Step)) => {
            format!(
                "{} gains one sample ahead only, as the colour of noise does: it moves no simulation.",
                first.effect
            )
        }
        (_, Some(Horizon::FreeRun)) => format!("{} moves the simulation of whole records.", first.effect),
        (_, Some(last)) => format!(
            "{} gains up to {} ahead, and nothing beyond chance over whole records.",
            first.effect,
            ahead(*last)
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_diagnose::Effect;

    fn candidate(effect: Effect, shares: [f64; 3]) -> Candidate {
        let horizons = [Horizon::Step, Horizon::Samples(30), Horizon::FreeRun];
        let gains = horizons.into_iter().zip(shares);
        Candidate {
            effect,
            stage: effect.stage(),
            probability: 0.5,
            parameters: Vec::new(),
            bic: 0.0,
            delta_bic: 0.0,
            heldout_log_score: 0.0,
            gains: gains
                .map(|(horizon, share)| HorizonGain { horizon, share, certainty: 20.0 * share })
                .collect(),
            closure: Some(0.4),
            unstable: false,
        }
    }

    #[test]
    fn the_horizon_of_the_largest_lead_is_reported() {
        let first = candidate(Effect::Backlash, [0.02, 0.6, 0.9]);
        let reported = lead(&first, Some(&candidate(Effect::Creep, [0.05, 0.1, 0.7])));
        assert_eq!(
            reported,
            "Predicting 30 samples ahead, backlash saves 60 % of the mean square error; the next, creep, saves 10 %. "
        );
        let reported = lead(&first, Some(&candidate(Effect::Creep, [0.05, 0.7, 0.95])));
        assert!(reported.starts_with("backlash saves no more than creep at any horizon"), "{reported}");
        let reported =
            lead(&candidate(Effect::Backlash, [-0.1; 3]), Some(&candidate(Effect::Creep, [-0.2; 3])));
        assert!(reported.starts_with("backlash saves no more than creep"), "{reported}");
        assert_eq!(lead(&first, None), "No other effect explains anything beside backlash. ");
    }

    #[test]
    fn how_far_a_gain_reaches_is_reported() {
        let reach = |shares| reach(&candidate(Effect::Outliers, shares));
        assert_eq!(reach([0.02, 0.6, 0.9]), "outliers moves the simulation of whole records.");
        assert_eq!(
            reach([0.3, 0.01, 0.0]),
            "outliers gains one sample ahead only, as the colour of noise does: it moves no simulation."
        );
        assert_eq!(
            reach([0.3, 0.2, 0.0]),
            "outliers gains up to 30 samples ahead, and nothing beyond chance over whole records."
        );
        assert_eq!(reach([0.01, -0.2, 0.0]), "outliers saves nothing beyond chance at any horizon.");
    }

    #[test]
    fn a_horizon_without_a_gain_is_a_dash() {
        let mut short = candidate(Effect::Creep, [0.1, 0.2, 0.3]);
        short.gains.pop();
        let rows = table(&[candidate(Effect::Backlash, [0.02, 0.6, 0.9]), short]);
        assert_eq!(rows[0][1..3], ["1 sample", "30 samples"]);
        assert_eq!([&rows[1][4], &rows[2][4]], ["90 % (18)", "–"]);
    }
}
