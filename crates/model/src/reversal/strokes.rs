//! How the input goes to and fro.

use super::branches::Branches;

/// Fewest strokes of which it is said that they are alike.
const FEWEST: usize = 6;
/// Strokes are alike where nineteen of twenty lie this close to their median, as a share of it: about what a drive without feedback repeats.
const ALIKE: f64 = 0.05;

/// The motions from one reversal to the next, those cut off by the ends of a record apart.
#[derive(Debug, Default)]
pub struct Strokes {
    lengths: Vec<f64>,
    samples: Vec<f64>,
}

/// A stroke that the input repeats, at one speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// From one turning point to the next, input units.
    pub length: f64,
    /// Samples that it takes.
    pub samples: f64,
}

impl Strokes {
    /// Adds the strokes of a record.
    pub fn add(&mut self, v: &[f64], branches: &Branches) {
        let labels = branches.labels();
        let turns: Vec<usize> = (branches.first_known()..v.len().saturating_sub(1))
            .filter(|&t| labels[t] != labels[t + 1])
            .collect();
        for pair in turns.windows(2) {
            self.lengths.push((v[pair[1]] - v[pair[0]]).abs());
            self.samples.push((pair[1] - pair[0]) as f64);
        }
    }

    /// The stroke that all of them are, if they are.
    pub fn only_one(&self) -> Option<Stroke> {
        // A reversal falls between samples, so that a stroke may take one more than the next.
        let (length, samples) = (common(&self.lengths, 0.0)?, common(&self.samples, 1.0)?);
        Some(Stroke { length, samples })
    }
}

/// The median of values that are alike, or no farther from it than the resolution.
fn common(values: &[f64], resolution: f64) -> Option<f64> {
    if values.len() < FEWEST {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    let near = |x: &&f64| (**x - median).abs() <= (ALIKE * median).max(resolution);
    (20 * values.iter().filter(near).count() >= 19 * values.len()).then_some(median)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reversal::ReversalRule;

    fn strokes(v: &[f64]) -> Option<Stroke> {
        let mut all = Strokes::default();
        all.add(v, &Branches::of(v, ReversalRule::EXACT)?);
        all.only_one()
    }

    fn sine(amplitude: impl Fn(f64) -> f64, phase: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..2000).map(f64::from).map(|t| amplitude(t) * phase(t).sin()).collect()
    }

    #[test]
    fn one_amplitude_at_one_frequency_is_one_stroke() {
        let found = strokes(&sine(|_| 10.0, |t| 0.0314 * t)).expect("one stroke");
        assert!((found.length - 20.0).abs() < 0.1 && (found.samples - 100.0).abs() <= 1.0, "{found:?}");
    }

    #[test]
    fn sweeps_of_either_kind_are_none_and_neither_are_a_few_strokes() {
        assert_eq!(strokes(&sine(|_| 10.0, |t| 0.0314 * t * (1.0 + t / 2000.0))), None);
        assert_eq!(strokes(&sine(|t| 5.0 + t / 400.0, |t| 0.0314 * t)), None);
        assert_eq!(strokes(&sine(|_| 10.0, |t| 0.006 * t)), None);
    }
}
