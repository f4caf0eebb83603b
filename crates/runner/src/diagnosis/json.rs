//! The diagnosis as one JSON object.

use super::{Report, Units, sentences, told};
use crate::output::stamped;
use serde::{Deserialize, Serialize};
use switchback_gap::fitted::{self, Shares};
use switchback_gap::{
    Candidate, Cell, CellInterval, Diagnosis, Effect, Figure, FittedParameter, Horizon, HorizonGain, Together,
};

/// Name and version of the layout.
pub(crate) const SCHEMA: &str = "switchback/gap/1";

/// The object that `gap --json` prints and gap.json holds; figures that do not exist are null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct GapFile {
    pub(crate) rig: String,
    pub(crate) input: String,
    pub(crate) output: String,
    pub(crate) model: String,
    pub(crate) verdict: Verdict,
    pub(crate) in_words: Vec<String>,
    pub(crate) gap: Gap,
    pub(crate) r#where: Vec<Place>,
    pub(crate) candidates: Vec<Explanation>,
    pub(crate) together: Option<Pair>,
    pub(crate) samples: usize,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) left: f64,
    pub(crate) next_experiment: Option<Next>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) probability_none: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) probability_unexplained: f64,
    pub(crate) second_opinion: Option<SecondOpinion>,
    pub(crate) limitations: Vec<String>,
    pub(crate) version: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Verdict {
    pub(crate) status: String,
    pub(crate) effects: Vec<String>,
    pub(crate) class: Vec<String>,
    pub(crate) stage: Option<String>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) probability: f64,
    pub(crate) calibrated: bool,
    pub(crate) corrected_by: Option<String>,
    pub(crate) refit: Option<Refit>,
    pub(crate) held_out_error_ratio: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SecondOpinion {
    pub(crate) examples: usize,
    pub(crate) prior: Prior,
    pub(crate) verdict: Verdict,
    /// Absent in files of older versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) by_rules: Option<Verdict>,
    pub(crate) effects: Vec<Weighed>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) probability_none: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) probability_unexplained: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Weighed {
    pub(crate) effect: String,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) probability: f64,
    pub(crate) contributions: Vec<Contribution>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Prior {
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) effect: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) none: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) unexplained: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Contribution {
    pub(crate) feature: String,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) value: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) adds: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Refit {
    pub(crate) order: usize,
    pub(crate) delay: isize,
    pub(crate) closure: Interval,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Gap {
    pub(crate) before: Interval,
    pub(crate) after: Interval,
    pub(crate) closure: Option<Interval>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) noise_floor: f64,
    pub(crate) identified_anew: Option<Interval>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) predictive_gain: f64,
    pub(crate) per_record: Vec<RecordGap>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Interval {
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) estimate: f64,
    #[serde(deserialize_with = "crate::input::nullable::pair")]
    pub(crate) ci90: [f64; 2],
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RecordGap {
    pub(crate) record: String,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) before: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) after: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) fit_before: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) fit_after: f64,
    pub(crate) closure: Option<Interval>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Place {
    pub(crate) axis: String,
    pub(crate) cell: String,
    pub(crate) low: Option<f64>,
    pub(crate) high: Option<f64>,
    pub(crate) unit: Option<String>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) share: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) exposure: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) enrichment: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) q_value: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) enrichment_q_value: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Explanation {
    pub(crate) effect: String,
    pub(crate) stage: String,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) probability: f64,
    pub(crate) parameters: Vec<Parameter>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) bic: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) delta_bic: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) heldout_log_score: f64,
    pub(crate) gains: Vec<Gain>,
    pub(crate) closure: Option<f64>,
    pub(crate) unstable: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Gain {
    pub(crate) samples: Option<usize>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) share: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) certainty: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pair {
    pub(crate) effects: Vec<String>,
    pub(crate) parameters: Vec<Vec<Parameter>>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) gain: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) left: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) left_by_single: f64,
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub(crate) shares: Vec<f64>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) interaction: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Parameter {
    pub(crate) name: String,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) value: f64,
    #[serde(deserialize_with = "crate::input::nullable::pair")]
    pub(crate) ci90: [f64; 2],
    pub(crate) unit: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Next {
    pub(crate) experiment: String,
    pub(crate) separates: Vec<String>,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) distance: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) sample_time: f64,
    #[serde(deserialize_with = "crate::input::nullable::numbers")]
    pub(crate) v: Vec<f64>,
}

/// One JSON object, indented, with a newline at its end.
///
/// `input` and `output` are the rig's labels with their units, `in_words` the sentences of the verdict.
/// `gap` holds `G²`, simulation error on the hold-out records beyond the noise over the variance of `y`; `noise_floor` is in
/// output units, `identified_anew` the `G²` of a nominal model identified from the fit records where another was given,
/// `predictive_gain` and `heldout_log_score` in nats per hold-out sample, parameters in the rig's units,
/// `bic` is the criterion's value and `delta_bic` its drop, that of the nominal model less that of the candidate: positive where the effect
/// is worth its parameters. `gains` are shares of the nominal model's mean square error on the fit records that the candidate saves, predicting
/// so many `samples` ahead (null: the whole record), and the same in standard errors (`certainty`). `closure` is null where there is no gap to close, and where `unstable` says that the candidate has no free run.
/// A cell of `where` runs from `low` to `high` in `unit`: all three null where the axis has kinds, an end null where it is open. `share` is its
/// share of the energy beyond the noise, `exposure` its share of the samples (of the frequency range, on that axis), `enrichment` the one over
/// the other; `q_value` tells whether there is energy beyond the noise, `enrichment_q_value` whether it is denser than elsewhere.
/// `probability_none` is that nothing is missing, the nominal model being right as it is; `probability_unexplained` that something is missing
/// which is none of the candidates; with the candidates' probabilities both sum to one. `together` is the best pair of effects: `parameters` those of each, fitted beside the other,
/// `gain` in penalised deviance over the best single one, `shares` the Shapley shares of its members in what both gain and `interaction` what they gain only together;
/// `left` is the deviance that causes in general would still gain, which grows with `samples`. `corrected_by` is an effect in
/// the augmented model that is no cause of its own; `calibrated` tells whether the probability was calibrated for such records; `refit`
/// is the model identified anew that closes as much of the gap as any cause (status `refit`), its `delay` as `identify` tells it;
/// `held_out_error_ratio` is how many times as much (root mean square) the model errs on held-out records that were taken under other
/// conditions than the fit records, which show nothing missing. `second_opinion` is what a verdict says
/// that was fitted to so many diagnoses (`examples`) of rigs with known causes, null where an order is declared or an experiment was
/// designed; `by_rules` is what the rules say before that is asked. `effects` with their probability and what each feature `adds` to the logarithm of their odds, for causes as common as `prior` says.
pub fn json(report: &Report) -> String {
    let diagnosis = &report.diagnosis;
    let units = Units::of(&report.rig);
    let page = GapFile {
        rig: report.rig.name.clone(),
        input: report.rig.input_label.clone(),
        output: report.rig.output_label.clone(),
        model: report.source.name().to_owned(),
        verdict: verdict(&diagnosis.verdict),
        in_words: sentences::verdict(report),
        gap: gap(diagnosis),
        r#where: diagnosis.where_.iter().map(|cell| place(cell, &units)).collect(),
        candidates: diagnosis.candidates.iter().map(|c| explanation(c, &units)).collect(),
        together: diagnosis.together.as_ref().map(|together| pair(together, &units)),
        samples: diagnosis.samples,
        left: diagnosis.left,
        next_experiment: diagnosis.next_experiment.as_ref().map(|next| Next {
            experiment: next.kind.name().to_owned(),
            separates: names(&next.separates),
            distance: next.distance,
            sample_time: report.rig.sample_time,
            v: next.v.clone(),
        }),
        probability_none: diagnosis.probability_none,
        probability_unexplained: diagnosis.probability_unexplained,
        second_opinion: diagnosis.second_opinion.as_ref().map(second_opinion),
        limitations: diagnosis.limitations.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    };
    stamped(SCHEMA, &page)
}

fn second_opinion(told: &fitted::SecondOpinion) -> SecondOpinion {
    let contribution = |c: &fitted::Contribution| Contribution {
        feature: c.feature.to_owned(),
        value: c.value,
        adds: c.adds,
    };
    let weighed = |(effect, probability, contributions): &(Effect, f64, Vec<fitted::Contribution>)| Weighed {
        effect: effect.name().to_owned(),
        probability: *probability,
        contributions: contributions.iter().map(contribution).collect(),
    };
    let Shares { effect, none, none_of_these } = told.shares;
    SecondOpinion {
        examples: told.examples,
        prior: Prior { effect, none, unexplained: none_of_these },
        verdict: verdict(&told.verdict),
        by_rules: Some(verdict(&told.by_rules)),
        effects: told.effects.iter().map(weighed).collect(),
        probability_none: told.none,
        probability_unexplained: told.none_of_these,
    }
}

fn verdict(verdict: &switchback_gap::Verdict) -> Verdict {
    Verdict {
        status: verdict.status.name().to_owned(),
        effects: names(&verdict.effects),
        class: names(&verdict.class),
        stage: verdict.stage.map(|stage| stage.name().to_owned()),
        probability: verdict.probability,
        calibrated: verdict.calibrated,
        corrected_by: verdict.corrected_by.map(|effect| effect.name().to_owned()),
        refit: verdict.refit.map(|refit| Refit {
            order: refit.order,
            delay: refit.delay,
            closure: interval(&refit.closure),
        }),
        held_out_error_ratio: verdict.held_out_error_ratio,
    }
}

fn gap(diagnosis: &Diagnosis) -> Gap {
    let gap = &diagnosis.gap;
    let per_record = gap.per_record.iter().map(|record| RecordGap {
        record: record.record.clone(),
        before: record.before,
        after: record.after,
        fit_before: record.fit_before,
        fit_after: record.fit_after,
        closure: record.closure.as_ref().map(interval),
    });
    Gap {
        before: interval(&gap.before),
        after: interval(&gap.after),
        closure: gap.closure.as_ref().map(interval),
        noise_floor: gap.noise_floor,
        identified_anew: gap.identified_anew.as_ref().map(interval),
        predictive_gain: gap.predictive_gain,
        per_record: per_record.collect(),
    }
}

fn interval(figure: &Figure) -> Interval {
    Interval { estimate: figure.estimate, ci90: figure.ci90 }
}

fn place(cell: &Cell, units: &Units) -> Place {
    let end = |end: fn(&CellInterval) -> f64| cell.interval.as_ref().map(end).filter(|x| x.is_finite());
    Place {
        axis: cell.axis.to_owned(),
        cell: cell.cell.clone(),
        low: end(|interval| interval.low),
        high: end(|interval| interval.high),
        unit: cell.interval.map(|interval| units.of_cell(interval.unit)),
        share: cell.share,
        exposure: cell.exposure,
        enrichment: cell.enrichment,
        q_value: cell.q_value,
        enrichment_q_value: cell.enrichment_q_value,
    }
}

fn explanation(candidate: &Candidate, units: &Units) -> Explanation {
    Explanation {
        effect: candidate.effect.name().to_owned(),
        stage: candidate.stage.name().to_owned(),
        probability: candidate.probability,
        parameters: parameters(&candidate.parameters, units),
        bic: candidate.bic,
        delta_bic: candidate.delta_bic,
        heldout_log_score: candidate.heldout_log_score,
        gains: candidate.gains.iter().map(gain).collect(),
        closure: candidate.closure,
        unstable: candidate.unstable,
    }
}

fn gain(gain: &HorizonGain) -> Gain {
    let samples = match gain.horizon {
        Horizon::Step => Some(1),
        Horizon::Samples(samples) => Some(samples),
        Horizon::FreeRun => None,
    };
    Gain { samples, share: gain.share, certainty: gain.certainty }
}

fn parameters(fitted: &[FittedParameter], units: &Units) -> Vec<Parameter> {
    let one = |parameter: &FittedParameter| {
        let told = told(parameter, units);
        Parameter { name: told.name, value: told.value, ci90: told.ci90, unit: told.unit }
    };
    fitted.iter().map(one).collect()
}

fn pair(pair: &Together, units: &Units) -> Pair {
    let Together { effects, parameters: fitted, gain, left, left_by_single, shares, interaction } = pair;
    Pair {
        effects: names(effects),
        parameters: fitted.iter().map(|of_one| parameters(of_one, units)).collect(),
        gain: *gain,
        left: *left,
        left_by_single: *left_by_single,
        shares: shares.clone(),
        interaction: *interaction,
    }
}

fn names(effects: &[Effect]) -> Vec<String> {
    effects.iter().map(|effect| effect.name().to_owned()).collect()
}
