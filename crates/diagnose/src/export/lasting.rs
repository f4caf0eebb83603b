//! What of a model holds beyond the records it was fitted to.
//!
//! On a record from elsewhere the clocks of slow changes stand where the dataset ended, what belongs to single records has its mean, and
//! a wave, whose phase nobody knows there, is part of the noise.

use std::collections::BTreeMap;

use crate::model::augmented::{AugmentedModel, BorderColumn, Clock, EquationColumn, Slow};
use crate::model::effect_terms::Operator;
use crate::model::linear::Linear;

/// The parameters without waves.
pub(super) fn without_waves(linear: &Linear, augmented: &AugmentedModel) -> Linear {
    let mut out = linear.clone();
    for (d, column) in out.d.iter_mut().zip(&augmented.equation_columns) {
        if let EquationColumn::Line { .. } = column {
            *d = 0.0;
        }
    }
    out
}

/// Mean square of what the waves make of the output, the mean over the records where each has its own.
///
/// ```text
/// Σ |d_cos + i·d_sin|² / (2 |A(e^(iω))|²)
/// ```
pub(super) fn power_of_waves(linear: &Linear, augmented: &AugmentedModel) -> f64 {
    // By the bits of the frequency, so that cosine and sine of one wave meet.
    let mut waves: BTreeMap<(Option<usize>, u64), f64> = BTreeMap::new();
    for (d, column) in linear.d.iter().zip(&augmented.equation_columns) {
        if let EquationColumn::Line { frequency, scaled, .. } = *column {
            *waves.entry((scaled, frequency.to_bits())).or_default() += d * d;
        }
    }
    let records = waves.keys().filter_map(|key| key.0).collect::<std::collections::BTreeSet<_>>().len();
    let power = |((scaled, bits), square): (&(Option<usize>, u64), &f64)| {
        let omega = f64::from_bits(*bits);
        let effect_term = |trig: fn(f64) -> f64| -> f64 {
            linear.a.iter().enumerate().map(|(i, a)| a * trig(omega * (i + 1) as f64)).sum()
        };
        let (re, im) = (1.0 + effect_term(f64::cos), effect_term(f64::sin));
        let shares = if scaled.is_some() { records.max(1) } else { 1 };
        square / (2.0 * (re * re + im * im) * shares as f64)
    };
    waves.iter().map(power).sum()
}

/// What a reader must know about a run on a record from elsewhere, one sentence each.
pub(super) fn notes(augmented: &AugmentedModel) -> Vec<String> {
    let mut notes = Vec::new();
    let clocks = clocks(augmented);
    if clocks.iter().any(|clock| *clock != Clock::Record) {
        notes.push("the slow change in the model is taken as it was at the end of the dataset");
    }
    if clocks.contains(&Clock::Record) {
        notes.push("the change within each record is taken as it was at a record's end");
    }
    let any = |is: fn(&EquationColumn) -> bool| augmented.equation_columns.iter().any(is);
    if any(|c| matches!(c, EquationColumn::Line { .. })) {
        notes.push("the phase of the periodic disturbance is unknown here: its size is in the band, the wave is not in y");
    }
    if any(|c| matches!(c, EquationColumn::Local { .. })) {
        notes.push("the drift that every record had of its own is taken at its mean level");
    }
    if any(|c| matches!(c, EquationColumn::Offset { .. })) {
        notes.push("the zero that every record had of its own is taken at its mean, corrected by the first outputs where some are given");
    }
    notes.into_iter().map(str::to_owned).collect()
}

/// The clocks that the model follows.
fn clocks(augmented: &AugmentedModel) -> Vec<Clock> {
    let effect_terms = augmented.effect_terms();
    let Operator { wear, gain, columns, jitter: _, transition: _, widening: _, relaxation: _ } =
        effect_terms.operator;
    let slow = |slow: Option<&Slow>| slow.filter(|s| s.changes()).map(|s| s.clock);
    let border = columns.iter().filter_map(|column| match column {
        BorderColumn::BranchSlow { clock } | BorderColumn::SideSlow { clock, .. } => Some(*clock),
        _ => None,
    });
    let equation = effect_terms.columns.iter().filter_map(|column| match column {
        EquationColumn::Trend { clock, .. } => Some(*clock),
        _ => None,
    });
    slow(wear).into_iter().chain(slow(gain)).chain(border).chain(equation).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_last_is_said_sentence_by_sentence() {
        let trend = |clock| EquationColumn::Trend { clock, degree: 1 };
        let reported = |columns: &[EquationColumn]| {
            notes(&AugmentedModel { equation_columns: columns.to_vec(), ..AugmentedModel::default() })
        };
        assert!(reported(&[]).is_empty());
        assert_eq!(
            reported(&[trend(Clock::Samples)]),
            ["the slow change in the model is taken as it was at the end of the dataset"]
        );
        assert_eq!(
            reported(&[trend(Clock::Record)]),
            ["the change within each record is taken as it was at a record's end"]
        );
        let wave = EquationColumn::Line { frequency: 0.3, scaled: None, sine: true };
        let path = EquationColumn::Local { scaled: 0, piece: 0, pieces: 4 };
        assert_eq!(reported(&[EquationColumn::Offset { scaled: 1, against: Some(0) }]).len(), 1);
        assert_eq!(
            reported(&[wave, path]),
            [
                "the phase of the periodic disturbance is unknown here: its size is in the band, the wave is not in y",
                "the drift that every record had of its own is taken at its mean level",
            ]
        );
    }
}
