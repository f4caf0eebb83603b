//! Why a rig cannot be diagnosed.

use thiserror::Error;

/// Why a rig cannot be diagnosed at all; what can only be judged in part becomes a limitation instead.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DiagnoseError {
    /// No record has the role `fit`.
    #[error("no record has use = \"fit\"; mark at least one record to identify the nominal model from")]
    NoFitRecord,
    /// The fit records are too short for the order.
    #[error(
        "the fit records hold {samples} usable samples, but order {order} with {knots} border points needs at least {needed}; \
         record longer, or lower the order"
    )]
    TooShort {
        /// Usable samples.
        samples: usize,
        /// Order of the linear part.
        order: usize,
        /// Border points.
        knots: usize,
        /// Samples needed.
        needed: usize,
    },
    /// The input never moves in any fit record.
    #[error("the input v is constant in every fit record; drive it over the working interval")]
    ConstantInput,
    /// The output never moves.
    #[error("the output y is constant in every fit record; check the sensor or the column")]
    ConstantOutput,
    /// A value that no sensor of the fit records can have read.
    #[error(
        "record {record:?} has {signal} = {value:e} at sample {index}, {times:.0e} times the central range of {signal} in the fit records \
         from their median, which no sensor resolves beside them; correct its unit or empty the cells where the sensor failed, or leave \
         the record out"
    )]
    Implausible {
        /// The record's name.
        record: String,
        /// `v` or `y`.
        signal: &'static str,
        /// Position of the sample, from 0.
        index: usize,
        /// The offending value.
        value: f64,
        /// Its distance from the median of the fit records, in central ranges of these.
        times: f64,
    },
    /// `y_sim` was asked for, but a record has none or one of another length.
    #[error(
        "record {record:?} has {found} values of y_sim for {expected} samples; supply one a sample or diagnose the identified model"
    )]
    Prediction {
        /// The record's name.
        record: String,
        /// Values found, zero where the column is missing.
        found: usize,
        /// Samples of the record.
        expected: usize,
    },
    /// `y_sim` holds NaN or infinity.
    #[error("record {record:?} has y_sim = {value} at sample {index}; every value must be finite")]
    PredictionNotFinite {
        /// The record's name.
        record: String,
        /// Position of the sample, from 0.
        index: usize,
        /// The offending value.
        value: f64,
    },
    /// The given model cannot be simulated.
    #[error(
        "the given model is unusable: {reason}; give a, b of equal order n ≥ 1 with A stable, and both borders by increasing v"
    )]
    Model {
        /// What is wrong.
        reason: String,
    },
    /// The given model's order contradicts the rig's.
    #[error("the given model has order {model}, the rig declares order {rig}; make them agree")]
    Order {
        /// Order of the model.
        model: usize,
        /// Order in the rig.
        rig: usize,
    },
    /// A side of a comparison cannot be identified.
    #[error("the comparison is not possible: {reason}")]
    Comparison {
        /// Why.
        reason: String,
    },
    /// The inputs of both sides of a comparison hardly overlap.
    #[error(
        "the input of the records runs from {here_low} to {here_high}, that of the records compared with from {there_low} to {there_high}: they hardly overlap; compare records over the same range, or correct the zero or the unit of one"
    )]
    Ranges {
        /// Lower end of the machine's input.
        here_low: f64,
        /// Its upper end.
        here_high: f64,
        /// Lower end of the other input.
        there_low: f64,
        /// Its upper end.
        there_high: f64,
    },
    /// The posterior knows other columns of evidence.
    #[error("the posterior cannot be asked: {0}")]
    Posterior(#[from] crate::posterior::PosteriorError),
    /// The regression has no solution.
    #[error(
        "the records do not determine the model: {reason}; add a record that moves v over its interval in both directions"
    )]
    Singular {
        /// What is undetermined.
        reason: String,
    },
}
