//! Weighing candidates that are compared as simulators: held-out records decide how much is explained.

use crate::verdict::odds::Odds;

/// Share of the held-out gap left at which "none of these" is as likely as the best candidate, and its scale.
const LEFT: (f64, f64) = (0.5, 0.05);

/// The odds with "none of these" weighed by the closure of the best candidate on held-out records.
///
/// The tests of what one-step predictions leave do not apply: errors of simulation are coloured, and the least error of
/// a law is significant on a rig with little noise. What counts is whether the candidate accounts for most of the gap.
pub(crate) fn weighed_by_closure(mut odds: Odds, closure: f64) -> Odds {
    let (middle, scale) = LEFT;
    let unlisted = 1.0 / (1.0 + (-(1.0 - closure - middle) / scale).clamp(-60.0, 60.0).exp());
    odds.unexplained = (1.0 - odds.none) * unlisted;
    let rest = (1.0 - odds.none - odds.unexplained).max(0.0);
    let sum: f64 = odds.effects.iter().sum::<f64>().max(1e-300);
    odds.effects.iter_mut().for_each(|p| *p *= rest / sum);
    odds
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn most_of_the_gap_must_be_explained() {
        let odds = || Odds { effects: vec![0.2, 0.1], none: 0.0, unexplained: 0.7 };
        let most = weighed_by_closure(odds(), 0.8);
        assert!(most.unexplained < 0.01 && (most.effects[0] - 2.0 * most.effects[1]).abs() < 1e-12);
        assert!((most.effects.iter().sum::<f64>() + most.unexplained - 1.0).abs() < 1e-12);
        assert!(weighed_by_closure(odds(), 0.2).unexplained > 0.99);
    }
}
