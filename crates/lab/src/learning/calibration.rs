//! Temperatures and shares that minimise the log score on rows that were held out.

/// The temperature between 1/4 and 4 of least mean `−ln p`, by golden section in its logarithm; `−ln p` is convex in `1/T`.
pub(super) fn temperature(p: &[Vec<f64>], labels: &[usize], weights: &[f64]) -> f64 {
    let loss = |log_t: f64| {
        let power = libm::exp(-log_t);
        let one = |((p, label), w): ((&Vec<f64>, &usize), &f64)| {
            let sum: f64 = p.iter().map(|p| libm::pow(p.max(1e-300), power)).sum();
            w * (libm::log(sum) - power * libm::log(p[*label].max(1e-300)))
        };
        p.iter().zip(labels).zip(weights).map(one).sum::<f64>()
    };
    libm::exp(golden(loss, (-libm::log(4.0), libm::log(4.0))))
}

/// Probabilities at a temperature: `pᵢ^(1/T)`, summing to one.
pub(super) fn cooled(p: &[f64], temperature: f64) -> Vec<f64> {
    let powers: Vec<f64> = p.iter().map(|p| libm::pow(p.max(1e-300), 1.0 / temperature)).collect();
    let sum: f64 = powers.iter().sum();
    powers.iter().map(|p| p / sum).collect()
}

/// Shares in the geometric mean of least log score, by a coarse grid that holds each model alone and all together.
pub(super) fn shares(models: &[Vec<Vec<f64>>], labels: &[usize], weights: &[f64]) -> Vec<f64> {
    let mut best = (f64::INFINITY, vec![1.0; models.len()]);
    for shares in grid(models.len()) {
        let mixed = mixed(models, &shares);
        let one = |((p, label), w): ((&Vec<f64>, &usize), &f64)| -w * libm::log(p[*label].max(1e-12));
        let loss: f64 = mixed.iter().zip(labels).zip(weights).map(one).sum();
        if loss < best.0 {
            best = (loss, shares);
        }
    }
    best.1
}

/// Steps of a share.
const STEPS: usize = 5;

/// All shares in fifths that sum to one.
fn grid(models: usize) -> Vec<Vec<f64>> {
    let mut all: Vec<(Vec<f64>, usize)> = vec![(Vec::new(), STEPS)];
    for model in 0..models {
        let next = |(shares, left): (Vec<f64>, usize)| {
            let of = if model + 1 == models { left..=left } else { 0..=left };
            of.map(move |k| ([&shares[..], &[k as f64 / STEPS as f64]].concat(), left - k))
                .collect::<Vec<_>>()
        };
        all = all.into_iter().flat_map(next).collect();
    }
    all.into_iter().map(|(shares, _)| shares).collect()
}

/// The geometric mean of several models' probabilities.
pub(super) fn mixed(models: &[Vec<Vec<f64>>], shares: &[f64]) -> Vec<Vec<f64>> {
    let row = |row: usize| {
        let class = |k: usize| {
            let each = models.iter().zip(shares).map(|(p, s)| s * libm::log(p[row][k].max(1e-6)));
            libm::exp(each.sum::<f64>())
        };
        let p: Vec<f64> = (0..models[0][row].len()).map(class).collect();
        let sum: f64 = p.iter().sum();
        p.iter().map(|p| p / sum).collect()
    };
    (0..models[0].len()).map(row).collect()
}

fn golden(f: impl Fn(f64) -> f64, (mut low, mut high): (f64, f64)) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..40 {
        let (left, right) = (high - ratio * (high - low), low + ratio * (high - low));
        if f(left) <= f(right) { high = right } else { low = left }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_that_are_too_sure_are_cooled() {
        // Three of four rows are right, and 0.99 is claimed of each: T brings that to 0.75.
        let p = vec![vec![0.99, 0.01]; 4];
        let t = temperature(&p, &[0, 0, 0, 1], &[1.0; 4]);
        let cooled = (99.0_f64).powf(1.0 / t);
        assert!((cooled / (1.0 + cooled) - 0.75).abs() < 1e-3 || (t - 4.0).abs() < 1e-3, "{t} {cooled}");
    }

    #[test]
    fn the_model_that_is_right_gets_the_share() {
        let (right, wrong) = (vec![vec![0.9, 0.1]; 6], vec![vec![0.2, 0.8]; 6]);
        assert_eq!(shares(&[right, wrong], &[0; 6], &[1.0; 6]), [1.0, 0.0]);
        assert_eq!(grid(3).len(), 21);
    }
}
