//! A sinusoid of unknown frequency.
//!
//! ```text
//! A y = B u + Σ (α cos ωt + β sin ωt),   amplitude and phase free a record, or one for the dataset;
//!                                      two frequencies; or the harmonics 1, 2, 3 and 5, or 1, 3, …, 11, of one wave; the latter free a record, too
//! ```
//!
//! Parameters: angular frequencies `omega`, radians per sample: eight periods or more in the longest record, two in the shortest, and harmonics that
//! sampling folds below that left out. Stage: disturbance. One line in the residual spectrum of every record. Confused
//! with: resonance where the drive excites it, drift where it is slow.

use std::f64::consts::TAU;

use super::{Card, Follows, Scene, Variant, fitted_scaled_records, parameter};
use crate::effect::Stage;
use crate::model::augmented::{AugmentedModel, EquationColumn};
use switchback_model::spectrum::{share_of_line, sharpened, strongest_lines};

pub(super) const CARD: Card = Card {
    of_its_record: true,
    dominates_dynamics: true,
    follows: Some(Follows::Steps),
    ..Card::of(Stage::Disturbance, variants)
};

/// Highest frequency of a line, radians per sample.
const FASTEST: f64 = 3.13;
/// Share of what the errors make of the output from which a line rules it.
const RULES: f64 = 0.1;

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let sharpest = |signals: &[Vec<f64>], count: usize| -> Vec<f64> {
        strongest_lines(signals, count).into_iter().map(|omega| sharpened(signals, omega)).collect()
    };
    let lines = sharpest(scene.innovations, 3);
    let lengths = || scene.innovations.iter().map(|w| w.len() as f64);
    let (longest, shortest) = (lengths().fold(1.0, f64::max), lengths().fold(f64::INFINITY, f64::min));
    // Few periods are a drift.
    let slowest = (8.0 * TAU / longest).max(2.0 * TAU / shortest);
    let is_line = |omega: &f64| *omega > slowest && *omega < FASTEST;
    let scaled_records = fitted_scaled_records(scene.dataset);
    let start =
        |omega: f64| parameter("omega", "radians per sample", omega, (slowest, FASTEST), 0.05 / longest);
    // Lines that rule the output have made pole pairs of `A` their own: the innovations have none of them, the output has.
    let output = scene.fit.linear.behind_poles(scene.innovations);
    let mut ruling = sharpest(&output, 2);
    ruling.retain(|omega| is_line(omega) && share_of_line(&output, *omega) > RULES);
    let lines = lines.into_iter().filter(is_line);
    let omegas: Vec<f64> = lines.chain(ruling.iter().copied()).collect();
    let Some((&strongest, others)) = omegas.split_first() else { return Vec::new() };
    let starts: Vec<_> = omegas.iter().map(|&omega| vec![start(omega)]).collect();
    let two = others.iter().map(|&other| [strongest, other]);
    let pairs = two.chain(ruling.windows(2).map(|w| [w[0], w[1]]));
    let pairs: Vec<_> = pairs.map(|two| two.map(start).to_vec()).collect();
    // Slower than any line, once it is folded: a drift, which no harmonic is.
    let audible = move |frequency: f64| folded(frequency) > slowest;
    let a_record = move |p: &[f64], augmented: &mut AugmentedModel| {
        for &frequency in p {
            let columns = scaled_records.iter().flat_map(|&scaled| wave(frequency, audible, Some(scaled)));
            augmented.equation_columns.extend(columns);
        }
    };
    let each_record = a_record.clone();
    let mut out = vec![Variant::new(starts.clone(), a_record.clone())];
    if !pairs.is_empty() {
        out.push(Variant::new(pairs, a_record));
    }
    // What rises as it falls has odd harmonics only, those of a square wave fall slowly.
    const HARMONICS: [&[f64]; 2] = [&[1.0, 2.0, 3.0, 5.0], &[1.0, 3.0, 5.0, 7.0, 9.0, 11.0]];
    out.extend(HARMONICS.map(|harmonics| {
        Variant::new(starts.clone(), move |p, augmented| {
            let columns = harmonics.iter().flat_map(|harmonic| wave(harmonic * p[0], audible, None));
            augmented.equation_columns.extend(columns);
        })
    }));
    let square = move |p: &[f64], augmented: &mut AugmentedModel| {
        let frequencies: Vec<f64> = HARMONICS[1].iter().map(|harmonic| harmonic * p[0]).collect();
        each_record(&frequencies, augmented);
    };
    out.push(Variant::new(starts.clone(), square));
    out.push(Variant::new(starts, move |p, augmented| {
        augmented.equation_columns.extend(wave(p[0], audible, None));
    }));
    out
}

/// Both phases of a wave; two columns of zeros where it cannot be heard.
fn wave(
    frequency: f64,
    audible: impl Fn(f64) -> bool,
    scaled: Option<usize>,
) -> impl Iterator<Item = EquationColumn> {
    let heard = audible(frequency);
    let frequency = if heard { frequency } else { 0.0 };
    [false, true].into_iter().map(move |sine| EquationColumn::Line {
        frequency,
        scaled,
        sine: sine || !heard,
    })
}

/// Where sampling puts a frequency, between 0 and π.
fn folded(omega: f64) -> f64 {
    let turn = omega.rem_euclid(TAU);
    turn.min(TAU - turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sampling_folds_frequencies_between_zero_and_half_its_own() {
        for (omega, at) in [(0.3, 0.3), (TAU - 0.3, 0.3), (TAU + 0.3, 0.3), (4.0, TAU - 4.0)] {
            assert!((folded(omega) - at).abs() < 1e-12);
        }
    }

    #[test]
    fn a_harmonic_that_sampling_makes_a_drift_is_not_heard() {
        // The second harmonic of a line at half the sampling frequency, but for a little.
        let omega = 0.5 * TAU - 1e-4;
        let heard = |frequency: f64| wave(frequency, |f| folded(f) > 0.01, None).collect::<Vec<_>>();
        let line = |frequency, sine| EquationColumn::Line { frequency, scaled: None, sine };
        assert_eq!(heard(omega), [line(omega, false), line(omega, true)]);
        assert_eq!(heard(2.0 * omega), [line(0.0, true), line(0.0, true)]);
    }
}
