//! What a diagnosis says, field by field as the JSON contract has it.

use schemars::JsonSchema;

use crate::comparison::Compared;
use crate::differences::Differences;
use crate::effect::{Effect, Stage};
use crate::export::PortableModel;
use crate::figure::Figure;
use crate::fitted_parameter::FittedParameter;
use crate::horizon::HorizonGain;
use crate::posterior::Classification;
use crate::verdict::answer::Verdict;

/// The gap `G²` (noise-corrected mean square simulation error over the variance of `y`) on one hold-out record.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordGap {
    /// The record's name.
    pub record: String,
    /// `G²` of the model as it was.
    pub before: f64,
    /// `G²` of the augmented model.
    pub after: f64,
    /// Fit in free-run simulation, `100·(1 − ‖y−ŷ‖/‖y−ȳ‖)`, of the model as it was.
    pub fit_before: f64,
    /// The same of the augmented model.
    pub fit_after: f64,
    /// Share of the gap on this record that the augmented model closes; absent where the gap's interval includes zero or nothing was added.
    pub closure: Option<Figure>,
}

/// How large the gap is and how far it closes.
#[derive(Debug, Clone, PartialEq)]
pub struct Gap {
    /// `G²` of the model as it was, over all hold-out records.
    pub before: Figure,
    /// `G²` of the augmented model.
    pub after: Figure,
    /// `C = 1 − G²after/G²before`; absent where the gap's interval includes zero or nothing was added.
    pub closure: Option<Figure>,
    /// Standard deviation of the noise in the output, output units.
    pub noise_floor: f64,
    /// `G²` of the nominal model identified anew from the fit records; absent where that is the model under diagnosis.
    pub identified_anew: Option<Figure>,
    /// Predictive gain of the augmentation, nats per hold-out sample.
    pub predictive_gain: f64,
    /// A hold-out record at a time.
    pub per_record: Vec<RecordGap>,
}

/// One cell of the localisation map.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// What the map runs over, e.g. `travel_since_reversal`.
    pub axis: &'static str,
    /// The cell, e.g. `0.00..0.10`.
    pub cell: String,
    /// The same as figures; none where the axis has kinds, not values.
    pub interval: Option<CellInterval>,
    /// Its share of the excess energy; what lies in no cell of the axis has a share too.
    pub share: f64,
    /// Share of the samples that lie in it: of the range, where the axis is frequency.
    pub exposure: f64,
    /// Share of the energy over share of the samples: how many times the average a sample here carries.
    pub enrichment: f64,
    /// Significance of its energy beyond the noise, false discoveries controlled (Benjamini–Hochberg).
    pub q_value: f64,
    /// Significance of its energy being denser than elsewhere, controlled likewise.
    pub enrichment_q_value: f64,
}

/// The ends of a cell, infinite where it is open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellInterval {
    /// Lower end, in the cell.
    pub low: f64,
    /// Upper end, not in the cell.
    pub high: f64,
    /// What both are measured in.
    pub unit: CellUnit,
}

/// What a cell's ends are measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CellUnit {
    /// Units of the input.
    Input,
    /// Units of the input a second.
    InputPerSecond,
    /// Units of the output.
    Output,
    /// Samples.
    Samples,
    /// Cycles a second.
    Hertz,
    /// Share of the samples of all records, in the order of the file.
    ShareOfDataset,
}

/// One effect as a candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The effect.
    pub effect: Effect,
    /// Its stage.
    pub stage: Stage,
    /// Calibrated probability that it is the cause.
    pub probability: f64,
    /// Its fitted parameters.
    pub parameters: Vec<FittedParameter>,
    /// Bayesian information criterion of the augmented model; lower is better, and only differences on the same records mean anything.
    pub bic: f64,
    /// Its drop, criterion of the nominal model less that of the augmented one: positive where the effect is worth its parameters.
    pub delta_bic: f64,
    /// Gain in log predictive score over the nominal model, nats per hold-out sample.
    pub heldout_log_score: f64,
    /// What it gains over the nominal model on the fit records, a horizon at a time, the nearest first; less where errors are no numbers.
    pub gains: Vec<HorizonGain>,
    /// Closure on the hold-out records with this effect alone; none where there is no gap to close, or the model is unstable.
    pub closure: Option<f64>,
    /// Whether the model with this effect has no free run: its output leaves every range, or its `A` is unstable.
    pub unstable: bool,
}

/// The best pair of effects, whether or not it was named.
#[derive(Debug, Clone, PartialEq)]
pub struct Together {
    /// Both effects.
    pub effects: Vec<Effect>,
    /// The parameters of each, fitted beside the other.
    pub parameters: Vec<Vec<FittedParameter>>,
    /// Penalised deviance gained over the best single effect.
    pub gain: f64,
    /// Deviance that causes in general would still gain beside the pair, beyond chance.
    pub left: f64,
    /// The same beside the best single effect.
    pub left_by_single: f64,
    /// Shapley share of each effect in the penalised deviance that both gain over the nominal model; the shares sum to one.
    ///
    /// `φ₁ = (g₁ + g₁₂ − g₂)/(2·g₁₂)` with `gᵢ` the gain alone and `g₁₂` that of both (L. S. Shapley, "A value for n-person
    /// games", 1953).
    pub shares: Vec<f64>,
    /// `(g₁₂ − g₁ − g₂)/g₁₂`: what they gain only together (positive), or could gain in place of each other (negative).
    pub interaction: f64,
}

/// A kind of record that could be taken next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, JsonSchema)]
#[schemars(rename_all = "snake_case")]
pub enum ExperimentKind {
    /// Reversals inside reversals, of shrinking amplitude.
    NestedReversals,
    /// Moves between random levels.
    RandomLevels,
    /// A sine of rising frequency.
    Sweep,
    /// The same triangle at several speeds.
    SeveralRates,
    /// A pseudo-random binary sequence between two levels.
    Prbs,
    /// Moves followed by long rests.
    Rest,
    /// Triangles of rising amplitude.
    AmplitudeSeries,
    /// The first record once more.
    RepeatOfFirst,
}

impl ExperimentKind {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::NestedReversals => "nested_reversals",
            Self::RandomLevels => "random_levels",
            Self::Sweep => "sweep",
            Self::SeveralRates => "several_rates",
            Self::Prbs => "prbs",
            Self::Rest => "rest",
            Self::AmplitudeSeries => "amplitude_series",
            Self::RepeatOfFirst => "repeat_of_first",
        }
    }
}

/// The record that would separate the rivals best.
#[derive(Debug, Clone, PartialEq)]
pub struct NextExperiment {
    /// Its kind.
    pub kind: ExperimentKind,
    /// The input to apply, one value a sample, input units.
    pub v: Vec<f64>,
    /// The rivals it separates.
    pub separates: Vec<Effect>,
    /// Least distance between the rivals' predictions, root mean square over the noise floor.
    pub distance: f64,
}

/// Measured and simulated outputs of one hold-out record.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldoutSeries {
    /// The record's name.
    pub record: String,
    /// Measured output.
    pub measured: Vec<f64>,
    /// Free-run simulation of the model as it was.
    pub nominal: Vec<f64>,
    /// Free-run simulation of the augmented model.
    pub augmented: Vec<f64>,
}

/// Autocorrelation and spectrum of one-step residuals.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ResidualPicture {
    /// Autocorrelation at lags 0, 1, ….
    pub autocorrelation: Vec<f64>,
    /// Frequencies in cycles per sample.
    pub frequency: Vec<f64>,
    /// Power density at these, squared output units per unit frequency, averaged over segments.
    pub spectrum: Vec<f64>,
    /// Half-width of the 95 % band of the autocorrelation of white noise.
    pub band: f64,
}

/// The models of a diagnosis.
#[derive(Debug, Clone, PartialEq)]
pub struct Models {
    /// The model as it was, the one under diagnosis; absent where only its predictions are known.
    pub nominal: Option<PortableModel>,
    /// The same with what was found added; without effects it is the nominal model.
    pub augmented: PortableModel,
    /// The effects in the augmented model, with their parameters there.
    pub added: Vec<(Effect, Vec<FittedParameter>)>,
}

/// Everything [`diagnose`](crate::diagnose) finds.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// The answer.
    pub verdict: Verdict,
    /// What differs between the machine and the model, simulator or records compared with it; absent where the model was identified from the machine's
    /// own records, or where a source has no gain at rest.
    pub differences: Option<Differences>,
    /// What the posterior says, where it was asked: nobody designed the records and no order is declared, or no few differences align a source.
    pub classification: Option<Classification>,
    /// How large the gap is and how far it closes.
    pub gap: Gap,
    /// Where the gap lies.
    pub where_: Vec<Cell>,
    /// The effects as candidates, best first.
    pub candidates: Vec<Candidate>,
    /// Probability that nothing is missing from the nominal model.
    pub probability_none: f64,
    /// Probability that the cause is none of the candidates.
    pub probability_unexplained: f64,
    /// Deviance that causes in general would still gain beside what the verdict rests on, beyond chance.
    pub left: f64,
    /// What the records say of every effect that was fitted, where any was.
    pub evidence: Option<Compared>,
    /// Samples fitted, which deviances grow with.
    pub samples: usize,
    /// Passes over all of these samples that the diagnosis took: what it cost.
    pub passes: u64,
    /// The best pair of effects, where the best single one left something to look for.
    pub together: Option<Together>,
    /// The record that would separate the rivals, where there are rivals.
    pub next_experiment: Option<NextExperiment>,
    /// Hold-out records: measured, nominal, augmented.
    pub series: Vec<HoldoutSeries>,
    /// Residuals of the nominal model on the fit records.
    pub residuals_before: ResidualPicture,
    /// Residuals of the augmented model on the fit records.
    pub residuals_after: ResidualPicture,
    /// What could not be judged, and why.
    pub limitations: Vec<String>,
    /// The models to take along; absent in a diagnosis that was put together by hand.
    pub models: Option<Models>,
}
