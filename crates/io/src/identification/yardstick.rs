//! An identification beside what a user would otherwise pick.

use super::errors_of_run::RunErrors;
use super::{Flag, Identification, Method};
use switchback_identify::statistics::MeanInterval;
use switchback_model::rig::{Rig, Usage};

/// How well another model simulates the held-out records.
#[derive(Debug, Clone, PartialEq)]
pub struct Yardstick {
    /// Its method.
    pub method: Method,
    /// Fit of its free runs over all held-out records, per cent.
    pub fit_percent: f64,
    /// The same of the identification, over the same samples.
    pub own_fit_percent: f64,
    /// Mean over those samples of the identification's squared error less this one's, as a share of the output's variance there, with its 95 %
    /// interval; `None` where the held-out records are too short for their memory.
    pub excess: Option<MeanInterval>,
}

impl Yardstick {
    /// Compares over the held-out records; `None` if nothing held out was simulated by both.
    pub(super) fn of(rig: &Rig, own: &Identification, other: &Identification) -> Option<Self> {
        let own_runs = RunErrors::of(rig, own, Usage::Holdout);
        let other_runs = RunErrors::of(rig, other, Usage::Holdout);
        let (mut differences, mut sums) = (Vec::new(), [0.0; 3]);
        for (own, other) in both(&own_runs, &other_runs) {
            let from = own.start.max(other.start);
            let y = &own.record.record.y()[from..];
            let mean = y.iter().sum::<f64>() / y.len().max(1) as f64;
            let squares: Vec<[f64; 2]> =
                own.squares_from(from).zip(other.squares_from(from)).map(Into::into).collect();
            for ([own, other], y) in squares.iter().zip(y) {
                sums = [sums[0] + own, sums[1] + other, sums[2] + (y - mean).powi(2)];
            }
            differences.push(squares.iter().map(|[own, other]| own - other).collect::<Vec<f64>>());
        }
        let [missed, missed_by_other, energy] = sums;
        if energy.is_nan() || energy <= 0.0 {
            return None;
        }
        let count: usize = differences.iter().map(Vec::len).sum();
        let variance = energy / count as f64;
        let shares: Vec<Vec<f64>> =
            differences.iter().map(|d| d.iter().map(|x| x / variance).collect()).collect();
        let fit = |missed: f64| 100.0 * (1.0 - (missed / energy).sqrt());
        Some(Self {
            method: other.method,
            fit_percent: fit(missed_by_other),
            own_fit_percent: fit(missed),
            excess: MeanInterval::of(&shares.iter().map(Vec::as_slice).collect::<Vec<_>>()),
        })
    }

    /// Points of held-out fit that the identification has above this one.
    pub(crate) fn lead(&self) -> f64 {
        self.own_fit_percent - self.fit_percent
    }

    /// Speaks up where the identification simulates worse than this, and says whether beyond chance.
    pub(super) fn flag(&self, own: Method) -> Option<Flag> {
        if self.lead() >= 0.0 {
            return None;
        }
        let Self { method, fit_percent, own_fit_percent, .. } = self;
        let (kind, verdict) = match self.excess {
            Some(excess) if excess.low > 0.0 => (
                "worse_than_yardstick",
                format!("beyond chance (block bootstrap, 95 %): prefer `--method {method}`"),
            ),
            Some(_) => (
                "no_better_than_yardstick",
                format!(
                    "within chance (block bootstrap, 95 %): nothing held out speaks for `{own}`, so prefer the simpler `--method {method}`"
                ),
            ),
            None => (
                "no_better_than_yardstick",
                "but too little is held out to say whether by chance: hold out more".to_owned(),
            ),
        };
        let fits =
            format!("{own_fit_percent:.1} % of fit on the held-out records against {fit_percent:.1} %");
        Some(Flag::new(kind, self.lead(), format!("`{own}` reaches {fits} by `{method}`, {verdict}")))
    }
}

/// The runs of the same records.
fn both<'r, 'a>(
    own: &'r [RunErrors<'a>],
    other: &'r [RunErrors<'a>],
) -> impl Iterator<Item = (&'r RunErrors<'a>, &'r RunErrors<'a>)> {
    own.iter().filter_map(|run| Some((run, other.iter().find(|o| std::ptr::eq(o.record, run.record))?)))
}
