//! The diagnosis as one JSON object.

use super::differences::{Difference, written};
use super::posterior::Posterior;
use super::sentences;
use super::shift::Shift;
use super::stability::Stability;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use switchback_diagnose::{
    Candidate, Cell, CellInterval, Diagnosis, Effect, ExperimentKind, Figure, FittedParameter, Horizon,
    HorizonGain, Stage, Status, Together,
};
use switchback_io::diagnosis::{Report, Source, Units, reported};
use switchback_io::output::{stamped, stamped_schema};

/// Name and version of the layout.
pub(crate) const SCHEMA: &str = "switchback/gap/1";

/// A diagnosis: `gap --json`, `gap.json`. Figures that do not exist are null.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub(crate) struct GapFile {
    /// The rig's name.
    pub rig: String,
    /// Label and unit of the input.
    pub input: String,
    /// Label and unit of the output.
    pub output: String,
    /// What was diagnosed: `identified` from the fit records, `given`, `y_sim`, or records that these were compared with (`against`).
    #[schemars(with = "Source")]
    pub model: String,
    /// The answer.
    pub verdict: Verdict,
    /// The same in sentences.
    pub in_words: Vec<String>,
    /// Every quantity of the machine beside that of the model, simulator or records compared with it, those that differ first; empty where the model was
    /// identified from the machine's own records.
    pub differences: Vec<Difference>,
    /// How large the gap is, and how far it closes.
    pub gap: Gap,
    /// The map of the gap, a cell an entry.
    pub r#where: Vec<Place>,
    /// The effects that were considered, best first.
    pub candidates: Vec<Hypothesis>,
    /// The best pair of effects, whether or not it is named.
    pub together: Option<Pair>,
    /// Samples that were fitted.
    pub samples: usize,
    /// Deviance that causes in general would still gain beside the best candidate.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub left: f64,
    /// The record that would separate the rivals best.
    pub next_experiment: Option<Next>,
    /// Probability that nothing is missing.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub probability_none: f64,
    /// Probability that something is missing which is none of the candidates.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub probability_unexplained: f64,
    /// What a posterior says that was trained on rigs whose cause is known; absent where it was not asked: an order is declared or an experiment was designed, or few differences align the source that is compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub posterior: Option<Posterior>,
    /// Held-out recordings whose output differs from that of the fit records' model by a constant or a factor: all else is of these recordings without it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shifts: Vec<Shift>,
    /// The verdicts of parts of the records, where these were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<Stability>,
    /// What to read with care, a sentence each.
    pub limitations: Vec<String>,
    /// Version of Switchback that wrote it.
    pub version: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Verdict {
    /// `none`: nothing significant; `parameters`: values of what was compared are off, and nothing is missing in it; `named`: `effects` are the cause; `class`: one of `class`, which these records cannot separate; `ambiguous`: one of `class`, which `next_experiment` would separate; `shortlist`: `class` are the likeliest, none of them likely enough to be named; `refit`: identifying the model anew closes the gap; `unexplained`: a gap whose cause is none of the candidates.
    #[schemars(with = "Status")]
    pub status: String,
    /// The effects named; of a class its likeliest member.
    #[schemars(with = "Vec<Effect>")]
    pub effects: Vec<String>,
    /// The rivals left standing, likeliest first.
    #[schemars(with = "Vec<Effect>")]
    pub class: Vec<String>,
    /// The part of the machine that the gap points at, also where it is unexplained.
    #[schemars(with = "Option<Stage>")]
    pub stage: Option<String>,
    /// Probability that the verdict holds.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub probability: f64,
    /// Whether that was calibrated for records like these; else it only ranks.
    pub calibrated: bool,
    /// An effect in the augmented model that is no cause of its own: it takes up what the law of the effect named leaves.
    #[schemars(with = "Option<Effect>")]
    pub corrected_by: Option<String>,
    /// The model identified anew (status `refit`).
    pub refit: Option<Refit>,
    /// How many times larger the error is on held-out records that were taken under other conditions than the fit records.
    #[schemars(range(min = 0))]
    pub held_out_error_ratio: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Refit {
    /// Its order.
    pub order: usize,
    /// Its delay, samples; negative where it looks ahead.
    pub delay: isize,
    /// Share of the gap that it closes.
    pub closure: Interval,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Gap {
    /// Mean square simulation error on held-out records beyond the noise, over the variance of `y`.
    pub before: Interval,
    /// The same with the effects named.
    pub after: Interval,
    /// `1 − after/before`; null where the gap's interval includes zero or nothing was added.
    pub closure: Option<Interval>,
    /// Standard deviation of the noise, output units.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0))]
    pub noise_floor: f64,
    /// `before` of a model identified from the fit records, where another was diagnosed.
    pub identified_anew: Option<Interval>,
    /// What the effects gain in one-step prediction, nats a held-out sample.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub predictive_gain: f64,
    /// An entry a held-out record.
    pub per_record: Vec<RecordGap>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Interval {
    /// The estimate.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub estimate: f64,
    /// Ends of its 90 % interval.
    #[serde(deserialize_with = "switchback_io::input::nullable::pair")]
    pub ci90: [f64; 2],
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RecordGap {
    /// Its name.
    pub record: String,
    /// As above, on this record.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub before: f64,
    /// As above, on this record.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub after: f64,
    /// Fit in free run, per cent: `100·(1 − ‖y−ŷ‖/‖y−ȳ‖)`.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub fit_before: f64,
    /// The same with the effects named.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub fit_after: f64,
    /// Share of this record's gap that closes.
    pub closure: Option<Interval>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Place {
    /// What the map runs over.
    pub axis: String,
    /// The cell in words.
    pub cell: String,
    /// Lower end; null where it is open, or the axis has kinds.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
    /// Unit of both.
    pub unit: Option<String>,
    /// Share of the energy beyond the noise.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub share: f64,
    /// Share of the samples; on the frequency axis of the range.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub exposure: f64,
    /// `share` over `exposure`.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub enrichment: f64,
    /// Significance of the energy beyond the noise, false discoveries controlled.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub q_value: f64,
    /// Significance of its being denser than elsewhere.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub enrichment_q_value: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Hypothesis {
    /// The effect.
    #[schemars(with = "Effect")]
    pub effect: String,
    /// The part of the machine.
    #[schemars(with = "Stage")]
    pub stage: String,
    /// Probability that it is the cause.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub probability: f64,
    /// Its fitted parameters.
    pub parameters: Vec<Parameter>,
    /// Bayesian information criterion of the model with it.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub bic: f64,
    /// What it drops by: positive where the effect is worth its parameters.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub delta_bic: f64,
    /// Gain in one-step prediction, nats a held-out sample.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub heldout_log_score: f64,
    /// What it saves on the fit records, by how far ahead it predicts.
    pub gains: Vec<Gain>,
    /// Share of the gap that it closes by itself.
    pub closure: Option<f64>,
    /// Whether the model with it has no free run.
    pub unstable: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Gain {
    /// Samples ahead; null for the whole record.
    pub samples: Option<usize>,
    /// Share of the mean square error that it saves.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub share: f64,
    /// The same in standard errors.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub certainty: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pair {
    /// Both effects.
    #[schemars(with = "Vec<Effect>")]
    pub effects: Vec<String>,
    /// Parameters of each, fitted beside the other.
    pub parameters: Vec<Vec<Parameter>>,
    /// Penalised deviance gained over the best single effect.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub gain: f64,
    /// Deviance that causes in general would still gain.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub left: f64,
    /// The same beside the best single effect.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub left_by_single: f64,
    /// Shapley share of each in what both gain.
    #[serde(deserialize_with = "switchback_io::input::nullable::numbers")]
    pub shares: Vec<f64>,
    /// What they gain only together, over what both gain.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub interaction: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Parameter {
    /// Its name.
    pub name: String,
    /// The estimate; null where it is no finite number.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(with = "Option<f64>")]
    pub value: f64,
    /// Ends of its 90 % interval; null where the likelihood gives none.
    #[serde(deserialize_with = "switchback_io::input::nullable::pair")]
    #[schemars(with = "[Option<f64>; 2]")]
    pub ci90: [f64; 2],
    /// Its unit; empty for a pure number.
    pub unit: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Next {
    /// Its kind.
    #[schemars(with = "ExperimentKind")]
    pub experiment: String,
    /// The rivals that it separates.
    #[schemars(with = "Vec<Effect>")]
    pub separates: Vec<String>,
    /// Least distance between their predictions, root mean square over the noise.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0))]
    pub distance: f64,
    /// Seconds between samples.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sample_time: f64,
    /// The input to play.
    #[serde(deserialize_with = "switchback_io::input::nullable::numbers")]
    pub v: Vec<f64>,
}

/// The JSON Schema of [`json`].
pub fn schema() -> Schema {
    stamped_schema::<GapFile>(SCHEMA)
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
/// the other; `q_value` shows whether there is energy beyond the noise, `enrichment_q_value` whether it is denser than elsewhere.
/// `probability_none` is that nothing is missing, the nominal model being right as it is; `probability_unexplained` that something is missing
/// which is none of the candidates; with the candidates' probabilities both sum to one. `together` is the best pair of effects: `parameters` those of each, fitted beside the other,
/// `gain` in penalised deviance over the best single one, `shares` the Shapley shares of its members in what both gain and `interaction` what they gain only together;
/// `left` is the deviance that causes in general would still gain, which grows with `samples`. `corrected_by` is an effect in
/// the augmented model that is no cause of its own; `calibrated` shows whether the probability was calibrated for such records; `refit`
/// is the model identified anew that closes as much of the gap as any cause (status `refit`), its `delay` as `identify` shows it;
/// `shifts` are held-out recordings with another zero or gain than the fit records, absent where there are none;
/// `held_out_error_ratio` is how many times as much (root mean square) the model errs on held-out records that were taken under other
/// conditions than the fit records, which show nothing missing. `posterior` says of every cause that it knows its probability and the log-likelihood that it gains, for causes as
/// common as `prior` says; absent where an order is declared or an experiment was designed.
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
        differences: written(report),
        gap: gap(diagnosis),
        r#where: diagnosis.where_.iter().map(|cell| place(cell, &units)).collect(),
        candidates: diagnosis.candidates.iter().map(|c| hypothesis(c, &units)).collect(),
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
        posterior: diagnosis.classification.as_ref().map(Posterior::of),
        shifts: report.shifts.iter().map(Shift::of).collect(),
        stability: report.stability.as_ref().map(Stability::of),
        limitations: diagnosis.limitations.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    };
    stamped(SCHEMA, &page)
}

fn verdict(verdict: &switchback_diagnose::Verdict) -> Verdict {
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

fn hypothesis(candidate: &Candidate, units: &Units) -> Hypothesis {
    Hypothesis {
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
        let reported = reported(parameter, units);
        Parameter { name: reported.name, value: reported.value, ci90: reported.ci90, unit: reported.unit }
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
