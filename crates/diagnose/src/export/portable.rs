//! The model as it is written and read.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::lasting::notes;
use super::place::Known;
use crate::model::augmented::AugmentedModel;
use crate::model::borders::Grid;
use crate::model::linear::Linear;
use crate::nominal_model::NominalModel;
use crate::records::dataset::{Criterion, HIGHEST_ORDER};
use crate::records::motion::ReversalRule;

/// A fitted model as plain data: all that its free runs depend on, to the last bit.
///
/// ```text
/// v → delay → play → borders (transition, wear, widening, relaxation) + border columns → gain → filter → B/A → + disturbances → sensor → y
/// ```
///
/// Everything is dimensionless: `(v − v_low)/v_width`, `(y − y_mean)/y_scale`, lengths in strokes (`v_width`), times in samples.
/// `docs/schemas/model-1.json` says what each key holds.
///
/// A model that was read has parts that fit together: [`PortableError`] says what does not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Wire", into = "Wire")]
#[schemars(description = "Borders with effects, dimensionless: lengths in strokes, times in samples.")]
pub struct PortableModel(pub(super) Wire);

/// What is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Wire {
    /// Back to physical units: `v = v_low + v_width·v′`, `y = y_mean + y_scale·y′`.
    pub(super) scales: Scales,
    /// Samples by which the output follows the input sooner than in `A y(t) = b₁u(t−1) + …`.
    pub(super) lead: isize,
    /// What counts as a reversal.
    pub(super) rule: ReversalRule,
    /// What it was fitted to.
    pub(super) criterion: Criterion,
    /// The records that slow changes follow.
    pub(super) clock: Known,
    /// Knots of the falling, then of the rising border.
    pub(super) grid: Grid,
    /// The effects.
    #[serde(rename = "assembly")]
    pub(super) augmented: AugmentedModel,
    /// Coefficients: dynamics, border values and border columns, equation columns.
    pub(super) linear: Linear,
    /// Variance of the equation error as fitted, weighted where its law weighs.
    pub(super) variance: f64,
    /// Variance of the noise in the output before the sensor.
    pub(super) output_noise: f64,
    /// Covariance of `a`, `b`, `f`, `d` and the nonlinear parameters of the effects: rows of the lower triangle; null where nothing was estimated.
    pub(super) covariance: Option<Vec<Vec<f64>>>,
    /// For each nonlinear parameter of the effects the augmented model a step away from the fitted one: its derivative.
    pub(super) moved: Vec<Moved>,
}

/// Origins and scales of input and output.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Scales {
    /// Input at 0.
    pub(super) v_low: f64,
    /// The stroke.
    pub(super) v_width: f64,
    /// Output at 0.
    pub(super) y_mean: f64,
    /// Unit of the output.
    pub(super) y_scale: f64,
}

/// What a step of a nonlinear parameter makes of the augmented model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Moved {
    /// The step, in the parameter.
    pub(super) step: f64,
    /// The effects there.
    #[serde(rename = "assembly")]
    pub(super) augmented: AugmentedModel,
}

/// Why parts make no model.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub(crate) enum PortableError {
    /// A list has not as many entries as the rest of the model asks for.
    #[error("`{effect_term}` has {found} entries, but the rest of the model makes {expected}")]
    Length {
        /// The list.
        effect_term: &'static str,
        /// Its entries.
        found: usize,
        /// Those expected.
        expected: usize,
    },
    /// A number is out of its range.
    #[error("`{effect_term}` is {found}, but must be {expected}")]
    Range {
        /// The number's key.
        effect_term: &'static str,
        /// Its value.
        found: f64,
        /// The range in words.
        expected: &'static str,
    },
    /// Knots do not rise.
    #[error("the knots of a border must not fall, and each border needs two")]
    Knots,
}

/// Longest delay and filter that a file may ask for, samples: what is longer is a mistake in the file.
const LONGEST: f64 = 1e5;

impl PortableModel {
    /// Its linear part and borders in physical units, without effects.
    ///
    /// The level of the borders is that at which a rest of `y` is `B(1)/A(1)·u`; it is lost where `B(1)` is zero.
    pub fn system(&self) -> NominalModel {
        let Wire { scales, linear, grid, .. } = &self.0;
        let dc = linear.b.iter().sum::<f64>();
        let level = (1.0 + linear.a.iter().sum::<f64>()) * scales.y_mean / dc;
        let level = if level.is_finite() { level } else { 0.0 };
        let mut values = linear.f.iter();
        let [descending, ascending] = [0, 1].map(|side: usize| {
            let knots = grid.knots[side].iter().zip(values.by_ref());
            knots.map(|(v, f)| (scales.v_low + scales.v_width * v, scales.y_scale * f + level)).collect()
        });
        NominalModel { a: linear.a.clone(), b: linear.b.clone(), descending, ascending }
    }

    /// Whether [`Self::system`] is all of it: no effects, no lead, fitted to predictions one step ahead.
    pub fn is_plain(&self) -> bool {
        let Wire { augmented, lead, criterion, .. } = &self.0;
        *augmented == AugmentedModel::default() && *lead == 0 && !criterion.simulates()
    }

    /// Samples by which the output follows the input sooner than in the paper; negative where it follows later.
    pub fn lead(&self) -> isize {
        self.0.lead
    }

    /// Whether anything in it changes with the dataset's clock or belongs to single records, so that a run depends on its place there.
    pub fn follows_clock(&self) -> bool {
        !notes(&self.0.augmented).is_empty()
    }

    /// A move against the branch below this is no reversal, input units.
    pub fn reversal_threshold(&self) -> f64 {
        self.0.rule.threshold * self.0.scales.v_width
    }
}

impl TryFrom<Wire> for PortableModel {
    type Error = PortableError;

    fn try_from(wire: Wire) -> Result<Self, PortableError> {
        wire.check_numbers()?;
        wire.check_lengths()?;
        Ok(Self(wire))
    }
}

impl From<PortableModel> for Wire {
    fn from(model: PortableModel) -> Self {
        model.0
    }
}

impl Wire {
    fn check_numbers(&self) -> Result<(), PortableError> {
        let positive = |effect_term, found: f64| match found > 0.0 && found.is_finite() {
            true => Ok(()),
            false => Err(PortableError::Range { effect_term, found, expected: "positive" }),
        };
        positive("v_width", self.scales.v_width)?;
        positive("y_scale", self.scales.y_scale)?;
        positive("total", self.clock.total as f64)?;
        for (effect_term, found) in [("variance", self.variance), ("output_noise", self.output_noise)] {
            if !(found >= 0.0 && found.is_finite()) {
                return Err(PortableError::Range { effect_term, found, expected: "zero or positive" });
            }
        }
        for augmented in self.augmented_models() {
            if !(0.0..LONGEST).contains(&augmented.delay) {
                let expected = "at least 0 and below 100000 samples";
                return Err(PortableError::Range { effect_term: "delay", found: augmented.delay, expected });
            }
            if let Some(s) =
                augmented.saturation.filter(|s| s.low > s.high || s.low.is_nan() || s.high.is_nan())
            {
                return Err(PortableError::Range {
                    effect_term: "low",
                    found: s.low,
                    expected: "at most `high`",
                });
            }
        }
        for moved in &self.moved {
            if moved.step == 0.0 {
                return Err(PortableError::Range {
                    effect_term: "step",
                    found: 0.0,
                    expected: "other than zero",
                });
            }
        }
        Ok(())
    }

    fn check_lengths(&self) -> Result<(), PortableError> {
        let equal = |effect_term, found, expected| match found == expected {
            true => Ok(()),
            false => Err(PortableError::Length { effect_term, found, expected }),
        };
        let falls = |knots: &Vec<f64>| knots.len() < 2 || knots.windows(2).any(|w| w[1] < w[0]);
        if self.grid.knots.iter().any(falls) {
            return Err(PortableError::Knots);
        }
        let order = self.linear.a.len();
        if order == 0 || order > HIGHEST_ORDER {
            let expected = "from 1 to 20 coefficients";
            return Err(PortableError::Range { effect_term: "a", found: order as f64, expected });
        }
        equal("b", self.linear.b.len(), order + self.augmented.extra_b)?;
        for augmented in self.augmented_models() {
            let columns = self.grid.len() + augmented.border_columns.len();
            equal("f", self.linear.f.len(), columns)?;
            equal("d", self.linear.d.len(), augmented.equation_columns.len())?;
        }
        if let Some(rows) = &self.covariance {
            equal("covariance", rows.len(), self.linear.len() + self.moved.len())?;
            for (i, row) in rows.iter().enumerate() {
                equal("covariance", row.len(), i + 1)?;
            }
        }
        Ok(())
    }

    fn augmented_models(&self) -> impl Iterator<Item = &AugmentedModel> {
        std::iter::once(&self.augmented).chain(self.moved.iter().map(|m| &m.augmented))
    }
}
