//! Gradient boosting of trees.

use super::binned::Binned;
use super::boosting_settings::BoostingSettings;
use super::grower::{Derivatives, grow};
use rand::SeedableRng;
use rand::seq::index::sample;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use switchback_diagnose::posterior::{Tree, Trees, softmax};

/// What is learnt.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// One of so many classes: multinomial loss.
    Classes(Vec<usize>, usize),
    /// Which of so many alternatives, each a row of its own, the rows of one choice behind each other: conditional logit.
    Choice(Vec<usize>, usize),
}

/// Smallest second derivative of a row.
const LEAST: f64 = 1e-6;

/// Boosts trees on binned columns.
pub fn boost(binned: &Binned, target: &Target, weights: &[f64], settings: &BoostingSettings) -> Trees {
    let start = target.start(weights);
    let mut scores: Vec<Vec<f64>> = start.iter().map(|s| vec![f64::from(*s); binned.rows()]).collect();
    let mut rounds = Vec::with_capacity(settings.rounds);
    for round in 0..settings.rounds {
        let derivatives = target.derivatives(&scores, weights);
        let rows = drawn(settings, (round, usize::MAX), binned.rows(), settings.rows);
        let rows: Vec<u32> = rows.into_iter().map(|row| row as u32).collect();
        let grown: Vec<Tree> = derivatives
            .par_iter()
            .enumerate()
            .map(|(class, (first, second))| {
                let columns = drawn(settings, (round, class), binned.bins.len(), settings.columns);
                let columns: Vec<u16> = columns.into_iter().map(|column| column as u16).collect();
                grow(binned, (rows.clone(), &columns), Derivatives { first, second }, settings)
            })
            .collect();
        scores.par_iter_mut().zip(&grown).for_each(|(scores, tree)| {
            for (row, score) in scores.iter_mut().enumerate() {
                let left = |column: u16, edge: u8| binned.bins[usize::from(column)][row] <= edge;
                *score += f64::from(tree.value(left));
            }
        });
        rounds.push(grown);
    }
    Trees { edges: binned.edges.clone(), start, rounds }
}

/// Positions in increasing order, drawn without replacement.
fn drawn(settings: &BoostingSettings, (round, class): (usize, usize), of: usize, share: f64) -> Vec<usize> {
    let mut rng = ChaCha8Rng::seed_from_u64(settings.seed);
    rng.set_stream(((round as u64) << 20) ^ (class as u64 & 0xF_FFFF));
    let count = ((of as f64 * share).round() as usize).clamp(1.min(of), of);
    let mut all = sample(&mut rng, of, count).into_vec();
    all.sort_unstable();
    all
}

impl Target {
    /// The constant scores of least loss.
    fn start(&self, weights: &[f64]) -> Vec<f32> {
        let total: f64 = weights.iter().sum();
        let share = |is: &dyn Fn(usize) -> bool| {
            let sum: f64 = weights.iter().enumerate().filter(|(row, _)| is(*row)).map(|(_, w)| w).sum();
            (sum / total).clamp(1e-4, 1.0 - 1e-4)
        };
        match self {
            Self::Classes(labels, classes) => {
                (0..*classes).map(|class| libm::log(share(&|row| labels[row] == class)) as f32).collect()
            }
            // What all alternatives have in common decides nothing.
            Self::Choice(..) => vec![0.0],
        }
    }

    /// First and second derivatives of the loss by each score, at every row.
    pub(super) fn derivatives(&self, scores: &[Vec<f64>], weights: &[f64]) -> Vec<(Vec<f64>, Vec<f64>)> {
        let of =
            |p: f64, is: bool, w: f64| (w * (p - f64::from(u8::from(is))), (w * p * (1.0 - p)).max(LEAST));
        match self {
            Self::Classes(labels, classes) => {
                let probabilities: Vec<Vec<f64>> = (0..labels.len())
                    .into_par_iter()
                    .map(|row| softmax(&scores.iter().map(|s| s[row]).collect::<Vec<f64>>()))
                    .collect();
                let class = |class: usize| {
                    let row = |(row, p): (usize, &Vec<f64>)| of(p[class], labels[row] == class, weights[row]);
                    probabilities.iter().enumerate().map(row).unzip()
                };
                (0..*classes).map(class).collect()
            }
            Self::Choice(labels, alternatives) => {
                let choice = |(number, scores): (usize, &[f64])| {
                    let (label, first) = (labels[number], number * alternatives);
                    let p = softmax(scores).into_iter().enumerate();
                    p.map(move |(k, p)| of(p, k == label, weights[first + k])).collect::<Vec<_>>()
                };
                vec![scores[0].chunks(*alternatives).enumerate().flat_map(choice).unzip()]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The loss by its definition.
    fn loss(target: &Target, scores: &[Vec<f64>], weights: &[f64]) -> f64 {
        let row = |row: usize| match target {
            Target::Classes(labels, _) => {
                let all: Vec<f64> = scores.iter().map(|s| s[row]).collect();
                all.iter().map(|s| s.exp()).sum::<f64>().ln() - all[labels[row]]
            }
            Target::Choice(labels, alternatives) => {
                let own = &scores[0][row * alternatives..(row + 1) * alternatives];
                own.iter().map(|s| s.exp()).sum::<f64>().ln() - own[labels[row]]
            }
        };
        let (rows, weight) = match target {
            Target::Classes(..) => (weights.len(), 1),
            Target::Choice(_, alternatives) => (weights.len() / alternatives, *alternatives),
        };
        (0..rows).map(|r| weights[r * weight] * row(r)).sum()
    }

    #[test]
    fn derivatives_are_those_of_the_loss() {
        let targets = [
            (
                Target::Classes(vec![0, 2, 1], 3),
                vec![vec![0.1, -0.4, 0.3], vec![1.0, 0.2, -0.6], vec![0.0, 0.7, 0.5]],
                vec![1.0, 0.5, 2.0],
            ),
            (Target::Choice(vec![1, 0], 2), vec![vec![0.3, -0.8, 1.4, 0.2]], vec![1.0, 1.0, 2.0, 2.0]),
        ];
        for (target, scores, weights) in targets {
            for (class, (first, second)) in target.derivatives(&scores, &weights).iter().enumerate() {
                for row in 0..first.len() {
                    let at = |step: f64| {
                        let mut moved = scores.clone();
                        moved[class][row] += step;
                        loss(&target, &moved, &weights)
                    };
                    let d = 1e-4;
                    assert!((first[row] - (at(d) - at(-d)) / (2.0 * d)).abs() < 1e-7);
                    assert!((second[row] - (at(d) - 2.0 * at(0.0) + at(-d)) / (d * d)).abs() < 1e-5);
                }
            }
        }
    }
}
