//! Drawing a pair.

use super::change::{changed, prepared, value};
use super::difference::{Difference, PairTruth, Side};
use super::row::Row;
use crate::examination::scramble;
use crate::generate::law::{Amount, Nature};
use crate::generate::simulate::{Active, Noise, simulate};
use crate::generate::stream::{Purpose, stream};
use crate::population::cause::{all_laws, candidates};
use crate::population::family::Family;
use crate::population::made;
use crate::population::model_error::magnitude;
use crate::population::random::{log_uniform, one_of, weighted};
use crate::population::setup::{Run, Setup, spread};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use switchback_model::rig::Rig;

/// B's records, each with A's output as its prediction, and what is true of them.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingPair {
    /// The records of B. [`RigRecord::predicted`](switchback_model::rig::RigRecord::predicted) is the output of A on the same input.
    pub rig: Rig,
    /// What is withheld.
    pub truth: PairTruth,
}

/// How often A are records with noise of their own, where the row does not ask for it.
const MEASURED: f64 = 0.2;
/// How often each row is drawn, in the order of [`Row::ALL`].
const ROWS: [f64; 14] = [0.1, 0.03, 0.06, 0.06, 0.06, 0.06, 0.05, 0.05, 0.07, 0.07, 0.06, 0.05, 0.03, 0.25];
/// Changes by an effect, in root mean squares of the noise, evenly over the logarithm.
const SIZES: (f64, f64) = (1.0, 60.0);
const ATTEMPTS: u64 = 12;

/// The pair of a number in the population of a seed; it depends on nothing else. None where no machine that was tried gives finite records.
pub fn draw_pair(seed: u64, index: u64) -> Option<TrainingPair> {
    let root = scramble(!seed, index);
    let row = Row::ALL[weighted(&mut stream(root, Purpose::Cause), &ROWS)];
    (0..ATTEMPTS).find_map(|attempt| pair(row, scramble(root, attempt)))
}

fn pair(row: Row, seed: u64) -> Option<TrainingPair> {
    let mut rng = stream(seed, Purpose::Base);
    let first = prepared(made::parts(&mut rng), row, &mut rng);
    let second = changed(&first, row, &mut rng);
    // Which of both is the machine is drawn, so that a value may be larger on either side.
    let (of_a, of_b) = if rng.random_bool(0.5) { (first, second) } else { (second, first) };
    let b = made::without_errors(&of_b, seed, &mut rng)?;
    let mut a = made::like(&b, &of_a, scramble(seed, 1))?;
    let mut difference = Difference {
        row,
        in_a: value(&of_a, row).unwrap_or_default(),
        in_b: value(&of_b, row).unwrap_or_default(),
        effect: None,
    };
    let (mut in_a, mut in_b) = (None, None);
    let noise = b.noise * spread(&b.runs);
    match row {
        Row::Noise => {
            let louder = (log_uniform(&mut rng, 0.3, 1.6) * one_of(&mut rng, &[-1.0, 1.0])).exp();
            made::louder(&mut a, louder);
            (difference.in_a, difference.in_b) = (louder * noise, noise);
        }
        Row::Effect => (in_a, in_b) = effect(&b, noise, &mut difference, &mut rng)?,
        _ => {}
    }
    let is_measured = row == Row::Noise || rng.random_bool(MEASURED);
    let outputs = |setup: &Setup, active: Option<Active>, noise: Noise| -> Vec<Vec<f64>> {
        let active: Vec<Active> = active.into_iter().collect();
        match noise {
            Noise::Recorded => setup.signals(&active).into_iter().map(|signals| signals.y).collect(),
            Noise::None => {
                let output = |run: &Run| {
                    let y = simulate(&setup.machine, &active, &run.passage, setup.seed, noise).y;
                    run.passage.recorded(&y).to_vec()
                };
                setup.runs.iter().map(output).collect()
            }
        }
    };
    let y_a = outputs(&a, in_a, if is_measured { Noise::Recorded } else { Noise::None });
    let size = {
        let clean = (outputs(&a, in_a, Noise::None), outputs(&b, in_b, Noise::None));
        let is_noise = in_b.is_some_and(|active| active.law.nature() == Nature::Noise);
        let recorded = (outputs(&b, None, Noise::Recorded), outputs(&b, in_b, Noise::Recorded));
        distance(if is_noise { &recorded } else { &clean }) / noise
    };
    let signals = b.signals(&in_b.into_iter().collect::<Vec<_>>());
    if !y_a.iter().flatten().all(|y| y.is_finite()) || !size.is_finite() {
        return None;
    }
    let rig = b.rig(&signals, Some(y_a)).ok()?;
    let truth =
        PairTruth { difference, size, is_measured, order: b.order, borders: b.borders, noise: b.noise };
    Some(TrainingPair { rig, truth })
}

/// An effect of A, of B or of both.
fn effect(
    b: &Setup,
    noise: f64,
    difference: &mut Difference,
    rng: &mut ChaCha8Rng,
) -> Option<(Option<Active>, Option<Active>)> {
    let name = one_of(rng, &candidates(Family::Wide));
    let law = one_of(rng, &all_laws(name));
    let is_noise = law.nature() == Nature::Noise;
    let side = if is_noise { Side::B } else { one_of(rng, &[Side::A, Side::B, Side::Both]) };
    let shape = std::array::from_fn(|_| rng.random());
    let wanted = noise * log_uniform(rng, SIZES.0, SIZES.1);
    let found = if is_noise {
        law.limit() * log_uniform(rng, 0.01, 0.2)
    } else {
        magnitude(b, (law, shape, 0), wanted)?
    };
    let active = |magnitude: f64| Active { law, amount: Amount { magnitude, shape }, slot: 0 };
    let other = (found * (log_uniform(rng, 0.3, 1.4) * one_of(rng, &[-1.0, 1.0])).exp()).min(law.limit());
    let (in_a, in_b) = match side {
        Side::A => (found, 0.0),
        Side::B => (0.0, found),
        Side::Both => (other, found),
    };
    difference.effect = Some((law.effect(), law.name(), side));
    (difference.in_a, difference.in_b) = (in_a, in_b);
    let there = |magnitude: f64| (magnitude > 0.0).then(|| active(magnitude));
    Some((there(in_a), there(in_b)))
}

fn distance((one, other): &(Vec<Vec<f64>>, Vec<Vec<f64>>)) -> f64 {
    let pairs = one.iter().flatten().zip(other.iter().flatten());
    let (sum, count) = pairs.fold((0.0, 0.0), |(s, n), (x, y)| (s + (x - y).powi(2), n + 1.0));
    (sum / f64::max(count, 1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn pairs_differ_in_the_row_that_they_are_made_for_and_in_nothing_else() {
        let mut rows = BTreeSet::new();
        for index in 0..200 {
            let pair = draw_pair(3, index).expect("a pair");
            assert_eq!(pair, draw_pair(3, index).expect("a pair"));
            let TrainingPair { rig, truth } = pair;
            let difference = &truth.difference;
            rows.insert(difference.row);
            assert_eq!(
                difference.row == Row::Nothing,
                truth.size == 0.0 && difference.row != Row::Noise,
                "{truth:?}"
            );
            assert_eq!(difference.row == Row::Effect, difference.effect.is_some());
            let is_equal = difference.in_a == difference.in_b;
            assert_eq!(is_equal, difference.row == Row::Nothing, "{truth:?}");
            for record in &rig.records {
                let predicted = record.predicted.as_ref().expect("the output of A");
                assert_eq!(predicted.len(), record.record.len());
                let pairs = predicted.iter().zip(record.record.y());
                if difference.row == Row::Nothing && !truth.is_measured {
                    let count = predicted.len() as f64;
                    let apart = (pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / count).sqrt();
                    let mean = record.record.y().iter().sum::<f64>() / count;
                    let sd =
                        (record.record.y().iter().map(|y| (y - mean).powi(2)).sum::<f64>() / count).sqrt();
                    assert!(apart < sd, "{truth:?}");
                }
            }
        }
        assert_eq!(rows.len(), Row::ALL.len());
    }
}
