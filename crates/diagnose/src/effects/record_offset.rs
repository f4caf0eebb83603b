//! The sensor's zero differs from record to record.
//!
//! ```text
//! y = x + cₖ in record k,  Σ cₖ = 0;  a zero enters the equation as A(1)·cₖ
//! ```
//!
//! Law: one constant for each fitted record but the first, which has the negative sum of the others: a zero that all records share is a level
//! of the borders. On top of a given model, whose borders stay, every fitted record has a constant of its own. In another record the zero is predicted from the first samples. Parameters, output units: `largest_difference` between two records
//! and `sd_between_records`. Stage: sensor. Left by sensors that are switched on, re-zeroed or mounted anew before each record: every
//! record lies above or below the simulation by a constant. Confused with: sensor drift, of which it is the limit where the zero moves in the pauses only.

use super::{Card, Reading, Scene, Variant, fitted_scaled_records};
use crate::effect::{Effect, Stage};
use crate::fitted_parameter::FittedParameter;
use crate::model::augmented::EquationColumn;
use crate::simulation::initial_conditions::offsets;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::SensorDrift],
    of_its_record: true,
    dominates_dynamics: true,
    reported_first: differences,
    ..Card::of(Stage::Sensor, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let scaled_records = fitted_scaled_records(scene.dataset);
    if scene.dataset.holds_nominal() {
        return vec![zeros(scaled_records, None)];
    }
    // Of one record the zero is that of the borders.
    let Some((&first, others)) = scaled_records.split_first().filter(|(_, others)| !others.is_empty()) else {
        return Vec::new();
    };
    vec![zeros(others.to_vec(), Some(first))]
}

/// A zero for each of the records.
fn zeros(scaled_records: Vec<usize>, against: Option<usize>) -> Variant {
    Variant::new(vec![Vec::new()], move |_, augmented| {
        let zero = |&scaled: &usize| EquationColumn::Offset { scaled, against };
        augmented.equation_columns.extend(scaled_records.iter().map(zero));
    })
}

/// How far the zeros of the fitted records lie apart; that of a model that stays is one of them.
fn differences(reading: &Reading<'_>) -> Vec<FittedParameter> {
    let fit = reading.fit;
    let at_rest = 1.0 + fit.linear.a.iter().sum::<f64>();
    let mut zeros: Vec<f64> =
        offsets(&fit.augmented, &fit.linear.d).into_values().map(|zero| zero / at_rest).collect();
    if reading.dataset.holds_nominal() {
        zeros.push(0.0);
    }
    let [low, high] = zeros
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &zero| [low.min(zero), high.max(zero)]);
    // Of zeros reported against each other the mean is 0, and one of them follows from the others.
    let mean = zeros.iter().sum::<f64>() / zeros.len().max(1) as f64;
    let square = |zero: &f64| (zero - mean) * (zero - mean);
    let variance = zeros.iter().map(square).sum::<f64>() / (zeros.len() as f64 - 1.0).max(1.0);
    vec![reading.step("largest_difference", high - low), reading.step("sd_between_records", variance.sqrt())]
}
