//! Conditional logit: which of several alternatives holds, from features of each.
//!
//! ```text
//! P(k) = exp(βᵀxₖ) / Σⱼ exp(βᵀxⱼ)
//! β̂    = argmin  −Σ ln Σ_{k holds} P(k) + λ|β|²/2,   βᵢ ≥ 0 where a feature cannot speak against an alternative, βᵢ ≤ 0 likewise
//! ```
//!
//! (D. McFadden, "Conditional logit analysis of qualitative choice behavior", in P. Zarembka, Frontiers in Econometrics, 1974). Features are
//! numbers of the order of one without unit. More alternatives than one may hold, as where nobody knows which of them does; no alternative
//! counts for itself, so that what was never met before has a probability.

/// Which sign a coefficient may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sign {
    Any,
    NotNegative,
    NotPositive,
}

impl Sign {
    fn allowed(self, x: f64) -> f64 {
        match self {
            Self::Any => x,
            Self::NotNegative => x.max(0.0),
            Self::NotPositive => x.min(0.0),
        }
    }
}

/// Alternatives with their features, and those that hold.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Choice {
    pub(crate) alternatives: Vec<Vec<f64>>,
    pub(crate) holds: Vec<bool>,
}

impl Choice {
    /// `ln P` of what holds; adds its gradient, times −1.
    fn log_likelihood(&self, coefficients: &[f64], descent: &mut [f64]) -> f64 {
        let p = probabilities(coefficients, &self.alternatives);
        let right: f64 = p.iter().zip(&self.holds).filter(|(_, holds)| **holds).map(|(p, _)| p).sum();
        let right = right.max(f64::MIN_POSITIVE);
        for ((p, holds), x) in p.iter().zip(&self.holds).zip(&self.alternatives) {
            let pull = p - if *holds { p / right } else { 0.0 };
            descent.iter_mut().zip(x).for_each(|(d, x)| *d += pull * x);
        }
        right.ln()
    }
}

/// Probability of each alternative.
pub(crate) fn probabilities(coefficients: &[f64], alternatives: &[Vec<f64>]) -> Vec<f64> {
    let utility = |x: &Vec<f64>| x.iter().zip(coefficients).map(|(x, b)| x * b).sum::<f64>();
    let utilities: Vec<f64> = alternatives.iter().map(utility).collect();
    let most = utilities.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = utilities.iter().map(|u| (u - most).exp()).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|w| w / sum).collect()
}

/// Mean of `−ln P` of what holds, nats a choice.
#[cfg(test)]
fn log_loss(coefficients: &[f64], choices: &[Choice]) -> f64 {
    let mut unused = vec![0.0; coefficients.len()];
    let sum: f64 = choices.iter().map(|choice| choice.log_likelihood(coefficients, &mut unused)).sum();
    -sum / choices.len().max(1) as f64
}

/// Steps of the descent at most, and the change of a coefficient that ends it.
const STEPS: usize = 20_000;
const ENOUGH: f64 = 1e-9;

/// Coefficients of the highest penalised likelihood: projected gradient steps, accelerated, begun anew where they go astray (A. Beck and M.
/// Teboulle, SIAM J. Imaging Sciences 2, 2009; B. O'Donoghue and E. Candès, Found. Comput. Math. 15, 2015).
pub(super) fn fitted(choices: &[Choice], signs: &[Sign], ridge: f64) -> Vec<f64> {
    let of = |coefficients: &[f64], descent: &mut [f64]| {
        descent.iter_mut().zip(coefficients).for_each(|(d, b)| *d = ridge * b);
        let penalty = 0.5 * ridge * coefficients.iter().map(|b| b * b).sum::<f64>();
        penalty - choices.iter().map(|choice| choice.log_likelihood(coefficients, descent)).sum::<f64>()
    };
    let mut best = vec![0.0; signs.len()];
    let (mut ahead, mut momentum, mut step) = (best.clone(), 1.0_f64, 1.0);
    let mut descent = vec![0.0; signs.len()];
    for _ in 0..STEPS {
        let here = of(&ahead, &mut descent);
        let downhill = descent.clone();
        let next = loop {
            let moved =
                ahead.iter().zip(&downhill).zip(signs).map(|((b, d), sign)| sign.allowed(b - step * d));
            let next: Vec<f64> = moved.collect();
            let change = next.iter().zip(&ahead).map(|(x, y)| x - y);
            let (mut along, mut square) = (0.0, 0.0);
            change.zip(&downhill).for_each(|(c, d)| {
                along += c * d;
                square += c * c;
            });
            if of(&next, &mut descent) <= here + along + 0.5 * square / step + 1e-12 * here.abs() {
                break next;
            }
            step *= 0.5;
        };
        let moved: Vec<f64> = next.iter().zip(&best).map(|(x, y)| x - y).collect();
        let uphill: f64 = moved.iter().zip(&downhill).map(|(m, d)| m * d).sum();
        let rests = moved.iter().all(|m| m.abs() < ENOUGH);
        if rests && momentum == 1.0 {
            return next;
        }
        // Once more without momentum, where it leads uphill and where the end may be reached.
        let grown = if rests || uphill > 0.0 { 1.0 } else { 0.5 + (0.25 + momentum * momentum).sqrt() };
        let share = if grown > 1.0 { (momentum - 1.0) / grown } else { 0.0 };
        ahead = next.iter().zip(&moved).map(|(x, m)| x + share * m).collect();
        momentum = grown;
        best = next;
        step *= 1.1;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::white;

    /// Choices between `of` alternatives by known coefficients; the right one is drawn by its probability.
    fn drawn(truth: &[f64], (count, of): (usize, usize)) -> Vec<Choice> {
        let mut noise = white();
        let mut state = 7_u64;
        let mut uniform = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut one = || {
            let alternatives: Vec<Vec<f64>> =
                (0..of).map(|_| truth.iter().map(|_| 1.7 * noise()).collect()).collect();
            let (p, mut left) = (probabilities(truth, &alternatives), uniform());
            let right = p.iter().position(|p| {
                left -= p;
                left < 0.0
            });
            let holds = (0..of).map(|k| Some(k) == right.or(Some(of - 1))).collect();
            Choice { alternatives, holds }
        };
        (0..count).map(|_| one()).collect()
    }

    #[test]
    fn two_alternatives_without_features_but_a_constant_have_the_odds_of_their_counts() {
        let one =
            |first: bool| Choice { alternatives: vec![vec![1.0], vec![0.0]], holds: vec![first, !first] };
        let choices: Vec<Choice> = (0..40).map(|k| one(k % 4 != 0)).collect();
        let found = fitted(&choices, &[Sign::Any], 0.0);
        assert!((found[0] - 3_f64.ln()).abs() < 1e-6, "{found:?}");
        // λ·β = Σ (y − p): the root by bisection.
        let slope = |b: f64| 2.0 * b - 40.0 * (0.75 - 1.0 / (1.0 + (-b).exp()));
        let (mut low, mut high) = (0.0, 2.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        let found = fitted(&choices, &[Sign::Any], 2.0);
        assert!((found[0] - low).abs() < 1e-6, "{found:?} {low}");
    }

    #[test]
    fn coefficients_are_found_again() {
        let truth = [1.2, -0.7, 0.0];
        let found = fitted(&drawn(&truth, (4000, 5)), &[Sign::Any; 3], 1e-6);
        assert!(found.iter().zip(&truth).all(|(f, t)| (f - t).abs() < 0.1), "{found:?}");
    }

    #[test]
    fn signs_hold_and_the_likelihood_has_no_better_neighbour() {
        let choices = drawn(&[0.8, -0.5], (300, 4));
        let signs = [Sign::NotNegative, Sign::NotNegative];
        let found = fitted(&choices, &signs, 1.0);
        assert!(found[0] > 0.3 && found[1] == 0.0, "{found:?}");
        let cost = |b: &[f64]| 300.0 * log_loss(b, &choices) + 0.5 * b.iter().map(|b| b * b).sum::<f64>();
        for neighbour in [[found[0] + 1e-3, 0.0], [found[0] - 1e-3, 0.0], [found[0], 1e-3]] {
            assert!(cost(&found) < cost(&neighbour));
        }
    }

    #[test]
    fn of_several_that_may_hold_any_counts() {
        let choice = Choice { alternatives: vec![vec![0.0]; 4], holds: vec![true, true, false, false] };
        assert!((log_loss(&[1.0], &[choice]) - 2_f64.ln()).abs() < 1e-12);
    }
}
