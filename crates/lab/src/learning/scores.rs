//! How good probabilities are.

/// Scores of probabilities, weighted means over rows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scores {
    /// Rows.
    pub rows: usize,
    /// `−ln p` of the true class, nats.
    pub log: f64,
    /// `Σ (p_k − [k true])²`.
    pub brier: f64,
    /// Class-wise calibration error: mean over classes of `Σ_bins (rows of the bin/rows)·|mean p − share true|`, weighted by how often a class is true.
    pub calibration: f64,
    /// The same where each truth is drawn from the probabilities: what perfect ones would show.
    pub perfect: f64,
    /// Share of rows whose class is the most probable.
    pub top1: f64,
    /// Share of rows whose class is among the five most probable.
    pub top5: f64,
}

/// Bins of a class's probabilities.
const BINS: usize = 10;
/// Least probability in a logarithm.
const LEAST: f64 = 1e-12;

/// Scores probabilities of rows against their classes.
pub fn scores(p: &[Vec<f64>], labels: &[usize], weights: &[f64]) -> Scores {
    let total: f64 = weights.iter().sum();
    let mut scores = Scores { rows: p.len(), ..Scores::default() };
    for ((p, label), weight) in p.iter().zip(labels).zip(weights) {
        let share = weight / total;
        let square = |(k, p): (usize, &f64)| (p - f64::from(u8::from(k == *label))).powi(2);
        scores.log -= share * p[*label].max(LEAST).ln();
        scores.brier += share * p.iter().enumerate().map(square).sum::<f64>();
        let better = p.iter().filter(|other| **other > p[*label]).count();
        scores.top1 += share * f64::from(u8::from(better < 1));
        scores.top5 += share * f64::from(u8::from(better < 5));
    }
    scores.calibration = calibration(p, labels, weights);
    scores.perfect = calibration(p, &drawn(p), weights);
    scores
}

/// A class of every row, drawn from its probabilities by evenly spread numbers: the same for every run.
fn drawn(p: &[Vec<f64>]) -> Vec<usize> {
    let golden = 0.618_033_988_749_894_9;
    let one = |(row, p): (usize, &Vec<f64>)| {
        let mut left = ((row + 1) as f64 * golden).fract();
        let found = p.iter().position(|p| {
            left -= p;
            left < 0.0
        });
        found.unwrap_or(p.len() - 1)
    };
    p.iter().enumerate().map(one).collect()
}

fn calibration(p: &[Vec<f64>], labels: &[usize], weights: &[f64]) -> f64 {
    let total: f64 = weights.iter().sum();
    let classes = p.first().map_or(0, Vec::len);
    let mut error = 0.0;
    for class in 0..classes {
        let mut bins = [[0.0; 3]; BINS];
        let mut often = 0.0;
        for ((p, label), weight) in p.iter().zip(labels).zip(weights) {
            let is = f64::from(u8::from(*label == class));
            let bin = ((p[class] * BINS as f64) as usize).min(BINS - 1);
            bins[bin][0] += weight;
            bins[bin][1] += weight * p[class];
            bins[bin][2] += weight * is;
            often += weight * is / total;
        }
        // Of rows that give the class a chance at all: those of the first bin are right by saying no.
        let rows: f64 = bins[1..].iter().map(|bin| bin[0]).sum();
        let off: f64 = bins[1..].iter().map(|bin| (bin[1] - bin[2]).abs()).sum();
        error += often * if rows > 0.0 { off / rows } else { 0.0 };
    }
    error
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_are_those_of_their_definitions() {
        let p = vec![vec![0.7, 0.2, 0.1], vec![0.1, 0.5, 0.4]];
        let s = scores(&p, &[0, 2], &[1.0, 1.0]);
        assert!((s.log + 0.5 * (0.7_f64.ln() + 0.4_f64.ln())).abs() < 1e-12);
        assert!((s.brier - 0.5 * (0.09 + 0.04 + 0.01 + 0.01 + 0.25 + 0.36)).abs() < 1e-12);
        assert_eq!((s.top1, s.top5), (0.5, 1.0));
    }

    #[test]
    fn sure_and_right_is_calibrated_and_sure_and_wrong_is_not() {
        let p = vec![vec![1.0, 0.0], vec![0.0, 1.0]];
        assert_eq!(scores(&p, &[0, 1], &[1.0, 1.0]).calibration, 0.0);
        assert_eq!(scores(&p, &[1, 0], &[1.0, 1.0]).calibration, 1.0);
    }
}
