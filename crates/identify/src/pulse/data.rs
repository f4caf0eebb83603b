//! A pulse experiment as the estimators see it.

use super::folds::Folds;
use super::grouped::GroupedStatistics;
use std::sync::Arc;
use switchback_model::Record;
use switchback_model::hysteresis::Branch;
use thiserror::Error;

/// Levels and sufficient statistics of one descendant or ascendant experiment.
///
/// Group 0 holds the samples whose whole lag window saw the satellite; group `1 + j·n + (i−1)` those that saw level `V_{j+1}` at
/// lag `i` (and the satellite at every other lag).
#[derive(Debug, Clone, PartialEq)]
pub struct PulseData {
    /// The border the experiment reveals: descending for the descendant experiment, ascending for the other.
    pub branch: Branch,
    /// `V₁…V_m`: `V₁` is the end of the interval opposite to the satellite.
    pub levels: Vec<f64>,
    /// Where `v` rests.
    pub satellite: f64,
    /// Statistics of `y − reference`.
    pub statistics: GroupedStatistics,
    /// What was taken from `y`, to keep digits.
    pub reference: f64,
    /// Means of `y − reference` over the periods, where the visits repeat.
    pub folds: Option<Folds>,
    /// The record itself, where there is one: it lets a solution be refined beyond the digits that sums of squares keep.
    pub(crate) rows: Option<Arc<Rows>>,
}

/// The samples behind a set of statistics.
#[derive(Debug, PartialEq)]
pub(crate) struct Rows {
    /// The output from `n` samples before the first row on, as recorded.
    pub(crate) y: Vec<f64>,
    /// The group of each row.
    pub(crate) groups: Vec<usize>,
}

/// Mean of the settled output of a step experiment (3.6), without its transient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepMean {
    /// `ŷ₀`, output units.
    pub mean: f64,
    /// Samples averaged.
    pub samples: f64,
}

/// Why a record is no pulse experiment.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PulseDataError {
    /// The record ends before the first complete window.
    #[error(
        "the record has {samples} samples, and {needed} are needed: the loading sample, {settling} to settle, and one period; record longer"
    )]
    TooShort {
        /// Samples in the record.
        samples: usize,
        /// Samples needed.
        needed: usize,
        /// Of these, samples dropped while transients settle.
        settling: usize,
    },
    /// Two visits lie inside one lag window.
    #[error(
        "v leaves the satellite {satellite} at samples {first} and {second}, less than {spacing} apart; with order n = {order} the spacing must be max(n, 2) or more, or the working point climbs the wrong border"
    )]
    TooClose {
        /// The satellite.
        satellite: f64,
        /// Earlier visit.
        first: usize,
        /// Later visit.
        second: usize,
        /// Least spacing.
        spacing: usize,
        /// Order of the fit.
        order: usize,
    },
    /// The input rests at neither end of its range.
    #[error(
        "v is at its {end} {satellite} in only {share:.0} % of the samples; a {name} experiment rests there between visits (is the record's role right?)"
    )]
    NoSatellite {
        /// `highest value` or `lowest value`.
        end: &'static str,
        /// That value.
        satellite: f64,
        /// Percentage of samples there.
        share: f64,
        /// `descendant` or `ascendant`.
        name: &'static str,
    },
    /// The input never leaves the satellite.
    #[error("v never leaves {satellite}; a pulse experiment visits other levels")]
    NoVisits {
        /// The satellite.
        satellite: f64,
    },
    /// Many levels are visited once: the input is noisy or free.
    #[error(
        "{levels} different levels in {visits} visits: a pulse experiment repeats its levels; give the record the role `free`"
    )]
    LevelsNotRepeated {
        /// Distinct levels.
        levels: usize,
        /// Visits.
        visits: usize,
    },
}

impl PulseData {
    /// Reads a pulse experiment off a record.
    ///
    /// Levels within 1e-6 of the input's range count as one. The first sample (which loads the border) and the `settling` samples after it are
    /// left out, and so is whatever the lag window of `order` samples would reach into them. `V₁` is the level farthest from the satellite.
    ///
    /// # Errors
    /// [`PulseDataError`] if the record is too short or its input is no pulse experiment.
    pub fn from_record(
        record: &Record,
        branch: Branch,
        order: usize,
        settling: usize,
    ) -> Result<Self, PulseDataError> {
        let visits = Visits::find(record.v(), branch, order)?;
        let levels = visits.levels()?;
        let first = 1 + settling.max(order);
        let period = order.max(2) * (levels.len() + 3);
        if record.len() < first + period {
            return Err(PulseDataError::TooShort { samples: record.len(), needed: first + period, settling });
        }
        let y = record.y();
        let reference = y[first..].iter().sum::<f64>() / (record.len() - first) as f64;
        let mut statistics = GroupedStatistics::new(order, 1 + levels.len() * order);
        let mut window = vec![0.0; order + 1];
        let mut groups = Vec::with_capacity(y.len() - first);
        for t in first..y.len() {
            let group = (1..=order)
                .find_map(|lag| visits.level_at(t - lag, &levels).map(|j| 1 + j * order + lag - 1))
                .unwrap_or(0);
            for (l, w) in window.iter_mut().enumerate() {
                *w = y[t - l] - reference;
            }
            statistics.push(group, &window);
            groups.push(group);
        }
        let rows = Some(Arc::new(Rows { y: y[first - order..].to_vec(), groups }));
        let lags = Folds::lags(order);
        let folds = Folds::of_record(y, (first.max(lags), lags), reference, |t| visits.level_at(t, &levels));
        Ok(Self { branch, levels, satellite: visits.satellite, statistics, reference, folds, rows })
    }

    /// Statistics computed without a record, of an output about zero.
    pub fn from_statistics(
        branch: Branch,
        levels: Vec<f64>,
        satellite: f64,
        statistics: GroupedStatistics,
    ) -> Self {
        Self { branch, levels, satellite, statistics, reference: 0.0, folds: None, rows: None }
    }

    /// The same with folds, of an output about the same reference.
    #[must_use]
    pub fn with_folds(self, folds: Option<Folds>) -> Self {
        Self { folds, ..self }
    }

    /// Number of levels `m`.
    pub fn points(&self) -> usize {
        self.levels.len()
    }

    /// Order `n` of the autoregression.
    pub(crate) fn order(&self) -> usize {
        self.statistics.order()
    }

    /// The group of level `j` (from 0) at lag `i` (from 1).
    pub fn group(order: usize, level: usize, lag: usize) -> usize {
        1 + level * order + lag - 1
    }

    /// The same data with its statistics taken about another reference.
    pub fn about(&self, reference: f64) -> Self {
        let level = reference - self.reference;
        let folds = self.folds.as_ref().map(|folds| folds.shifted(level));
        Self { statistics: self.statistics.shifted(level), reference, folds, ..self.clone() }
    }
}

/// Where the input leaves its satellite.
struct Visits<'a> {
    v: &'a [f64],
    branch: Branch,
    satellite: f64,
    /// Inputs nearer to each other than this are one level.
    tolerance: f64,
}

impl<'a> Visits<'a> {
    fn find(v: &'a [f64], branch: Branch, order: usize) -> Result<Self, PulseDataError> {
        let high = v.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let low = v.iter().copied().fold(f64::INFINITY, f64::min);
        let (satellite, end, name) = match branch {
            Branch::Descending => (high, "highest value", "descendant"),
            Branch::Ascending => (low, "lowest value", "ascendant"),
        };
        if high == low {
            return Err(PulseDataError::NoVisits { satellite });
        }
        let visits = Self { v, branch, satellite, tolerance: 1e-6 * (high - low) };
        let away: Vec<usize> = (1..v.len()).filter(|&t| visits.is_away(t)).collect();
        // s(m+3) samples a period, m of them away: at least half rest at the satellite for every s ≥ 2.
        let share = 100.0 * (1.0 - away.len() as f64 / v.len() as f64);
        if share < 49.0 {
            return Err(PulseDataError::NoSatellite { end, satellite, share, name });
        }
        let spacing = order.max(2);
        if let Some(pair) = away.windows(2).find(|pair| pair[1] - pair[0] < spacing) {
            return Err(PulseDataError::TooClose {
                satellite,
                first: pair[0],
                second: pair[1],
                spacing,
                order,
            });
        }
        Ok(visits)
    }

    fn is_away(&self, t: usize) -> bool {
        (self.v[t] - self.satellite).abs() > self.tolerance
    }

    /// Distinct levels visited after the loading sample, the farthest from the satellite first.
    fn levels(&self) -> Result<Vec<f64>, PulseDataError> {
        let mut visited: Vec<f64> =
            (1..self.v.len()).filter(|&t| self.is_away(t)).map(|t| self.v[t]).collect();
        visited.sort_by(f64::total_cmp);
        if self.branch == Branch::Ascending {
            visited.reverse();
        }
        let count = visited.len();
        visited.dedup_by(|next, kept| (*next - *kept).abs() <= self.tolerance);
        if visited.is_empty() {
            return Err(PulseDataError::NoVisits { satellite: self.satellite });
        }
        if visited.len() > 1 && 2 * visited.len() > count {
            return Err(PulseDataError::LevelsNotRepeated { levels: visited.len(), visits: count });
        }
        Ok(visited)
    }

    /// Which of `levels` the input visits at `t`, if it is away from the satellite.
    fn level_at(&self, t: usize, levels: &[f64]) -> Option<usize> {
        self.is_away(t)
            .then(|| levels.iter().position(|l| (l - self.v[t]).abs() <= 2.0 * self.tolerance))
            .flatten()
    }
}
