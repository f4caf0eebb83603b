//! The diagnosis as one JSON object.

use super::{Report, Units, told};
use crate::output::stamped;
use serde::Serialize;
use switchback_gap::fitted::{self, Shares};
use switchback_gap::{
    Candidate, Cell, CellInterval, Diagnosis, Effect, Figure, FittedParameter, Horizon, HorizonGain, Together,
};

/// Name and version of the layout.
const SCHEMA: &str = "switchback/gap/1";

/// The object that `gap --json` prints; figures that do not exist are null.
#[derive(Serialize)]
struct Page<'a> {
    rig: &'a str,
    model: &'static str,
    verdict: Verdict,
    gap: Gap<'a>,
    r#where: Vec<Place<'a>>,
    candidates: Vec<Explanation>,
    together: Option<Pair>,
    samples: usize,
    left: f64,
    next_experiment: Option<Next<'a>>,
    probability_none: f64,
    probability_unexplained: f64,
    second_opinion: Option<SecondOpinion>,
    limitations: &'a [String],
    version: &'static str,
}

#[derive(Serialize)]
struct Verdict {
    status: &'static str,
    effects: Vec<&'static str>,
    class: Vec<&'static str>,
    stage: Option<&'static str>,
    probability: f64,
    calibrated: bool,
    corrected_by: Option<&'static str>,
    refit: Option<Refit>,
    held_out_error_ratio: Option<f64>,
}

#[derive(Serialize)]
struct SecondOpinion {
    examples: usize,
    prior: Prior,
    verdict: Verdict,
    effects: Vec<Weighed>,
    probability_none: f64,
    probability_unexplained: f64,
}

#[derive(Serialize)]
struct Weighed {
    effect: &'static str,
    probability: f64,
    contributions: Vec<Contribution>,
}

#[derive(Serialize)]
struct Prior {
    effect: f64,
    none: f64,
    unexplained: f64,
}

#[derive(Serialize)]
struct Contribution {
    feature: &'static str,
    value: f64,
    adds: f64,
}

#[derive(Serialize)]
struct Refit {
    order: usize,
    delay: isize,
    closure: Interval,
}

#[derive(Serialize)]
struct Gap<'a> {
    before: Interval,
    after: Interval,
    closure: Option<Interval>,
    noise_floor: f64,
    identified_anew: Option<Interval>,
    predictive_gain: f64,
    per_record: Vec<RecordGap<'a>>,
}

#[derive(Serialize)]
struct Interval {
    estimate: f64,
    ci90: [f64; 2],
}

#[derive(Serialize)]
struct RecordGap<'a> {
    record: &'a str,
    before: f64,
    after: f64,
    fit_before: f64,
    fit_after: f64,
}

#[derive(Serialize)]
struct Place<'a> {
    axis: &'static str,
    cell: &'a str,
    low: Option<f64>,
    high: Option<f64>,
    unit: Option<String>,
    share: f64,
    exposure: f64,
    enrichment: f64,
    q_value: f64,
    enrichment_q_value: f64,
}

#[derive(Serialize)]
struct Explanation {
    effect: &'static str,
    stage: &'static str,
    probability: f64,
    parameters: Vec<Parameter>,
    bic: f64,
    delta_bic: f64,
    heldout_log_score: f64,
    gains: Vec<Gain>,
    closure: Option<f64>,
    unstable: bool,
}

#[derive(Serialize)]
struct Gain {
    samples: Option<usize>,
    share: f64,
    certainty: f64,
}

#[derive(Serialize)]
struct Pair {
    effects: Vec<&'static str>,
    parameters: Vec<Vec<Parameter>>,
    gain: f64,
    left: f64,
    left_by_single: f64,
    shares: Vec<f64>,
    interaction: f64,
}

#[derive(Serialize)]
struct Parameter {
    name: String,
    value: f64,
    ci90: [f64; 2],
    unit: String,
}

#[derive(Serialize)]
struct Next<'a> {
    experiment: &'static str,
    separates: Vec<&'static str>,
    distance: f64,
    sample_time: f64,
    v: &'a [f64],
}

/// One JSON object, indented, with a newline at its end.
///
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
/// designed: `effects` with their probability and what each feature `adds` to the logarithm of their odds, for causes as common as `prior` says.
pub fn json(report: &Report) -> String {
    let diagnosis = &report.diagnosis;
    let units = Units::of(&report.rig);
    let page = Page {
        rig: &report.rig.name,
        model: report.source.name(),
        verdict: verdict(&diagnosis.verdict),
        gap: gap(diagnosis),
        r#where: diagnosis.where_.iter().map(|cell| place(cell, &units)).collect(),
        candidates: diagnosis.candidates.iter().map(|c| explanation(c, &units)).collect(),
        together: diagnosis.together.as_ref().map(|together| pair(together, &units)),
        samples: diagnosis.samples,
        left: diagnosis.left,
        next_experiment: diagnosis.next_experiment.as_ref().map(|next| Next {
            experiment: next.kind.name(),
            separates: names(&next.separates),
            distance: next.distance,
            sample_time: report.rig.sample_time,
            v: &next.v,
        }),
        probability_none: diagnosis.probability_none,
        probability_unexplained: diagnosis.probability_unexplained,
        second_opinion: diagnosis.second_opinion.as_ref().map(second_opinion),
        limitations: &diagnosis.limitations,
        version: env!("CARGO_PKG_VERSION"),
    };
    stamped(SCHEMA, &page)
}

fn second_opinion(told: &fitted::SecondOpinion) -> SecondOpinion {
    let contribution =
        |c: &fitted::Contribution| Contribution { feature: c.feature, value: c.value, adds: c.adds };
    let weighed = |(effect, probability, contributions): &(Effect, f64, Vec<fitted::Contribution>)| Weighed {
        effect: effect.name(),
        probability: *probability,
        contributions: contributions.iter().map(contribution).collect(),
    };
    let Shares { effect, none, none_of_these } = told.shares;
    SecondOpinion {
        examples: told.examples,
        prior: Prior { effect, none, unexplained: none_of_these },
        verdict: verdict(&told.verdict),
        effects: told.effects.iter().map(weighed).collect(),
        probability_none: told.none,
        probability_unexplained: told.none_of_these,
    }
}

fn verdict(verdict: &switchback_gap::Verdict) -> Verdict {
    Verdict {
        status: verdict.status.name(),
        effects: names(&verdict.effects),
        class: names(&verdict.class),
        stage: verdict.stage.map(|stage| stage.name()),
        probability: verdict.probability,
        calibrated: verdict.calibrated,
        corrected_by: verdict.corrected_by.map(|effect| effect.name()),
        refit: verdict.refit.map(|refit| Refit {
            order: refit.order,
            delay: refit.delay,
            closure: interval(&refit.closure),
        }),
        held_out_error_ratio: verdict.held_out_error_ratio,
    }
}

fn gap(diagnosis: &Diagnosis) -> Gap<'_> {
    let gap = &diagnosis.gap;
    let per_record = gap.per_record.iter().map(|record| RecordGap {
        record: &record.record,
        before: record.before,
        after: record.after,
        fit_before: record.fit_before,
        fit_after: record.fit_after,
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

fn place<'a>(cell: &'a Cell, units: &Units) -> Place<'a> {
    let end = |end: fn(&CellInterval) -> f64| cell.interval.as_ref().map(end).filter(|x| x.is_finite());
    Place {
        axis: cell.axis,
        cell: &cell.cell,
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
        effect: candidate.effect.name(),
        stage: candidate.stage.name(),
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

fn names(effects: &[Effect]) -> Vec<&'static str> {
    effects.iter().map(|effect| effect.name()).collect()
}
