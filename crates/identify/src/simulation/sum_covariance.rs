//! How the group sums of pulse experiments vary together.

use super::design::PeriodicDesign;
use super::superposition::visits;
use crate::pulse::GroupSum;
use switchback_model::linear::{autocovariance, settling_samples};

/// What is left of the noise's memory when its covariance is taken as zero.
const FORGOTTEN: f64 = 1e-17;

/// Covariances of the group sums `S_q,l = Σ_{t∈q} y(t−l)` of experiments with stationary noise `σe`, `e = C/A w`, over `N` samples each:
///
/// ```text
/// Cov(S_q,i, S_r,l) = σ² Σ_{t∈q} Σ_{s∈r} γ(t−i−s+l)
/// ```
///
/// within an experiment, and zero between experiments, whose noise is independent. Exact for every `N`: of two phases `p` and `p'`
/// there are as many pairs of samples `κ` periods apart as both have visits, and far pairs, of which the noise remembers nothing in double
/// precision, are left out.
///
/// ```
/// # use switchback_identify::pulse::GroupSum;
/// # use switchback_model::hysteresis::Branch;
/// # use switchback_identify::simulation::{PeriodicDesign, SumCovariance};
/// // One phase of four holds the visit, the rest the satellite; white noise.
/// let design = PeriodicDesign {
///     branch: Branch::Descending, levels: vec![0.0], satellite: 1.0, order: 1, u: vec![0.0; 4], groups: vec![0, 0, 1, 0],
/// };
/// let covariance = SumCovariance::new(&[&design], (&[], &[]), 2.0, 40);
/// let sum = |group, lag| GroupSum { group, lag };
/// assert_eq!(covariance.at(sum(1, 0), sum(1, 0)), 2.0 * 2.0 * 10.0);
/// assert_eq!(covariance.at(sum(1, 1), sum(1, 0)), 0.0);
/// ```
#[derive(Debug, Clone)]
pub struct SumCovariance {
    /// Phases of every group with their visits, experiments side by side.
    groups: Vec<Group>,
    period: usize,
    variance: f64,
    /// `γ(0), γ(1), …`
    gamma: Vec<f64>,
}

#[derive(Debug, Clone)]
struct Group {
    experiment: usize,
    /// Phase, and how often the record visits it.
    phases: Vec<(usize, usize)>,
}

impl SumCovariance {
    /// For experiments of one period with noise of standard deviation `sigma` times that of `C/A w`; `ar` and `ma` hold `a₁…` and `c₁…`.
    ///
    /// # Panics
    /// If there is no experiment, or they differ in their period.
    pub fn new(designs: &[&PeriodicDesign], (ar, ma): (&[f64], &[f64]), sigma: f64, samples: usize) -> Self {
        let period = designs.first().expect("at least one experiment").period();
        assert!(designs.iter().all(|d| d.period() == period), "experiments of one period");
        let groups = designs.iter().enumerate().flat_map(|(experiment, design)| {
            (0..design.group_count()).map(move |q| Group {
                experiment,
                phases: (0..period)
                    .filter(|p| design.groups[*p] == q)
                    .map(|p| (p, visits(samples, period, p)))
                    .collect(),
            })
        });
        let memory = (settling_samples(ar, FORGOTTEN) + ma.len()).min(samples) + designs[0].order;
        Self {
            groups: groups.collect(),
            period,
            variance: sigma * sigma,
            gamma: autocovariance(ar, ma, memory),
        }
    }

    /// For the sums over single phases of one experiment: group `p` is phase `p`.
    pub fn of_single_phases(period: usize, (ar, ma): (&[f64], &[f64]), sigma: f64, samples: usize) -> Self {
        let group = |p| Group { experiment: 0, phases: vec![(p, visits(samples, period, p))] };
        let memory = (settling_samples(ar, FORGOTTEN) + ma.len()).min(samples);
        Self {
            groups: (0..period).map(group).collect(),
            period,
            variance: sigma * sigma,
            gamma: autocovariance(ar, ma, memory),
        }
    }

    /// The covariance of two sums.
    pub fn at(&self, x: GroupSum, y: GroupSum) -> f64 {
        let (of_x, of_y) = (&self.groups[x.group], &self.groups[y.group]);
        if of_x.experiment != of_y.experiment {
            return 0.0;
        }
        let pairs = of_x.phases.iter().flat_map(|p| of_y.phases.iter().map(move |r| (*p, *r)));
        self.variance * pairs.map(|(p, r)| self.of_phases((p, x.lag), (r, y.lag))).sum::<f64>()
    }

    /// `Σ γ` over the pairs of visits of two phases, each seen at a lag.
    fn of_phases(
        &self,
        ((p, visits), lag): ((usize, usize), usize),
        ((r, others), back): ((usize, usize), usize),
    ) -> f64 {
        let signed = |x: usize| i64::try_from(x).expect("a record fits into memory");
        let (visits, others) = (signed(visits), signed(others));
        let apart = signed(p) - signed(lag) - signed(r) + signed(back);
        let (period, memory) = (signed(self.period), signed(self.gamma.len()) - 1);
        // |apart + κT| ≤ memory, and both visits exist.
        let first = (-memory - apart).div_euclid(period).max(1 - others);
        let last = (memory - apart).div_euclid(period).min(visits - 1);
        (first..=last)
            .filter_map(|periods| {
                let pairs = visits.min(others + periods) - periods.max(0);
                let gamma = self.gamma.get(usize::try_from((apart + periods * period).abs()).ok()?)?;
                Some(pairs as f64 * gamma)
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use switchback_model::hysteresis::Branch;

    proptest! {
        #[test]
        fn it_is_the_sum_over_all_pairs_of_samples(
            groups in prop::collection::vec(0..3_usize, 1..9), samples in 1..70_usize, pole in -0.8..0.8_f64, zero in -0.5..0.5_f64,
            lags in (0..3_usize, 0..3_usize),
        ) {
            let design = PeriodicDesign {
                branch: Branch::Descending, levels: vec![0.0], satellite: 1.0, order: 2, u: vec![0.0; groups.len()], groups,
            };
            let (ar, ma) = ([-pole], [zero]);
            let fast = SumCovariance::new(&[&design, &design], (&ar, &ma), 0.3, samples);
            let gamma = autocovariance(&ar, &ma, samples + 2);
            let groups = &design.groups;
            let visits = move |q: usize| (0..samples).filter(move |t| groups[t % groups.len()] == q);
            for (q, r) in (0..9).map(|k| (k / 3, k % 3)) {
                let pairs = visits(q).flat_map(|t| visits(r).map(move |s| (t + lags.1).abs_diff(s + lags.0)));
                let slow: f64 = pairs.map(|apart| 0.09 * gamma[apart]).sum();
                let of = |group, lag| GroupSum { group, lag };
                let fast_value = fast.at(of(q, lags.0), of(r, lags.1));
                prop_assert!((fast_value - slow).abs() < 1e-12 * (1.0 + slow.abs()), "{} against {}", fast_value, slow);
                prop_assert_eq!(fast.at(of(q, lags.0), of(3 + r, lags.1)), 0.0);
            }
        }
    }
}
