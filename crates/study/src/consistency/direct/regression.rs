//! The regressions of the pulse methods, written out row by row, and what is read off their solutions.
//!
//! ```text
//! y(t) = −Σᵢ aᵢ y(t−i) + κ + Σᵢ bᵢ w(t−i) + ξ(t),    θ = (a, b, κ, whatever the method leaves open of w)
//! ```
//!
//! `w = u − u_m` in units of `u_M − u_m`; the paper's methods take `w` about the satellite and `y` about the step experiment's mean
//! instead of `κ`.

use super::qr::Triangle;
use crate::consistency::pulse_kind::PulseKind;
use switchback_model::hysteresis::Branch;

/// One experiment as a regression sees it.
#[derive(Debug)]
pub(super) struct Experiment {
    pub(super) branch: Branch,
    /// `V₁…V_m`.
    pub(super) levels: Vec<f64>,
    pub(super) satellite: f64,
    /// `y(t)` before that of `y`, as far as it was recorded.
    pub(super) before: Vec<f64>,
    /// `y(t)` from `t = −n` on.
    pub(super) y: Vec<f64>,
    /// After which the input repeats.
    pub(super) period: usize,
    /// The level (from 0) and the lag (from 1) at which the window of each `t ≥ 0` left the satellite, if it did.
    pub(super) seen: Vec<Option<(usize, usize)>>,
}

impl Experiment {
    /// `w` at the satellite.
    pub(super) fn rest(&self) -> f64 {
        match self.branch {
            Branch::Descending => 1.0,
            Branch::Ascending => 0.0,
        }
    }

    /// Place of a level on the straight line from `(h_m, 0)` to `(h_M, 1)`.
    fn position(&self, level: usize) -> f64 {
        let from_satellite = (self.levels[level] - self.satellite) / (self.levels[0] - self.satellite);
        self.rest() + (1.0 - 2.0 * self.rest()) * from_satellite
    }
}

/// How a method writes `w` at the levels `V₂…V_m`.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Inner {
    /// Nothing to estimate: the straight line.
    Line,
    /// A free mean for every (level, lag), rank one afterwards.
    Free,
    /// The same with one value for all levels at one place, whichever experiment visits them.
    Curve,
    /// One value a level, linearised about `b` and `w`.
    Constrained { b: Vec<f64>, w: Vec<Vec<f64>> },
}

/// A regression over some experiments up to `N` samples of each.
#[derive(Debug)]
pub(super) struct Regression<'a> {
    pub(super) order: usize,
    pub(super) experiments: Vec<&'a Experiment>,
    pub(super) samples: usize,
    pub(super) inner: Inner,
    /// Mean of the step experiment, where `κ` is not estimated.
    pub(super) step: Option<f64>,
    /// For each experiment and inner level the number of its first column among the inner ones.
    places: Vec<Vec<usize>>,
    inner_columns: usize,
}

/// Two levels nearer than this share of the interval are one level of a static curve.
const SAME_LEVEL: f64 = 1e-6;

impl<'a> Regression<'a> {
    pub(super) fn new(
        order: usize,
        experiments: Vec<&'a Experiment>,
        samples: usize,
        inner: Inner,
        step: Option<f64>,
    ) -> Self {
        let columns_a_level = if matches!(inner, Inner::Constrained { .. }) { 1 } else { order };
        let mut distinct: Vec<f64> = Vec::new();
        let places: Vec<Vec<usize>> = experiments
            .iter()
            .map(|e| {
                let tolerance = SAME_LEVEL * (e.levels[0] - e.satellite).abs();
                let mut place = |v: &f64| {
                    let known = distinct.iter().position(|d| (d - v).abs() <= tolerance);
                    let index = known.filter(|_| inner == Inner::Curve).unwrap_or_else(|| {
                        distinct.push(*v);
                        distinct.len() - 1
                    });
                    index * columns_a_level
                };
                e.levels[1..].iter().map(&mut place).collect()
            })
            .collect();
        let inner_columns = if inner == Inner::Line { 0 } else { distinct.len() * columns_a_level };
        Self { order, experiments, samples, inner, step, places, inner_columns }
    }

    /// What a method fits; `Efficient` starts from its free version.
    pub(super) fn inner_of(kind: PulseKind) -> Inner {
        match kind {
            PulseKind::LinearArx => Inner::Line,
            PulseKind::Memoryless => Inner::Curve,
            _ => Inner::Free,
        }
    }

    /// Columns before the inner ones: `a`, `b`, and `κ` where it is estimated.
    pub(super) fn core(&self) -> usize {
        2 * self.order + usize::from(self.step.is_none())
    }

    pub(super) fn columns(&self) -> usize {
        self.core() + self.inner_columns
    }

    /// `w` at the satellite, about what this regression takes it.
    fn rest(&self, e: &Experiment) -> f64 {
        if self.step.is_some() { 0.0 } else { e.rest() }
    }

    /// `w` at `V₁`, likewise.
    fn first(&self, e: &Experiment) -> f64 {
        self.rest(e) + 1.0 - 2.0 * e.rest()
    }

    /// All rows with two targets: `y`, and a one (for the answer to a constant left in `y`).
    pub(super) fn triangle(&self) -> Triangle {
        let (n, columns) = (self.order, self.columns());
        let mut triangle = Triangle::new(columns, 2);
        let about = self.step.unwrap_or(0.0);
        let mut row = vec![0.0; columns + 2];
        for (index, e) in self.experiments.iter().enumerate() {
            for (window, seen) in e.y.windows(n + 1).zip(&e.seen).take(self.samples) {
                row.fill(0.0);
                for i in 1..=n {
                    row[i - 1] = about - window[n - i];
                    row[n + i - 1] = self.rest(e);
                }
                if self.step.is_none() {
                    row[2 * n] = 1.0;
                }
                row[columns] = window[n] - about;
                row[columns + 1] = 1.0;
                if let &Some((level, lag)) = seen {
                    self.visit(index, (level, lag), &mut row);
                }
                triangle.push(&row);
            }
        }
        triangle.reduce();
        triangle
    }

    /// What a window that left the satellite changes in its row.
    fn visit(&self, index: usize, (level, lag): (usize, usize), row: &mut [f64]) {
        let e = self.experiments[index];
        let known = &mut row[self.order + lag - 1];
        if level == 0 {
            *known = self.first(e);
            return;
        }
        let place = self.core() + self.places[index][level - 1];
        match &self.inner {
            Inner::Line => *known = e.position(level),
            Inner::Free => row[place + lag - 1] = 1.0,
            Inner::Curve => {
                *known = 0.0;
                row[place + lag - 1] = 1.0;
            }
            Inner::Constrained { b, w } => {
                *known = w[index][level];
                row[place] = b[lag - 1];
                row[self.columns()] += b[lag - 1] * w[index][level];
            }
        }
    }

    /// `w` of every level of every experiment, from a solution `θ`.
    pub(super) fn levels(&self, theta: &[f64]) -> Vec<Vec<f64>> {
        let b = &theta[self.order..2 * self.order];
        let norm: f64 = b.iter().map(|x| x * x).sum();
        let level = |index: usize, level: usize| {
            let e = self.experiments[index];
            if level == 0 {
                return self.first(e);
            }
            let open = &theta
                [self.core() + if self.inner == Inner::Line { 0 } else { self.places[index][level - 1] }..];
            let rank_one = || b.iter().zip(open).map(|(b, h)| b * h).sum::<f64>() / norm;
            match self.inner {
                Inner::Line => e.position(level),
                Inner::Free => self.rest(e) + rank_one(),
                Inner::Curve => rank_one(),
                Inner::Constrained { .. } => open[0],
            }
        };
        self.experiments
            .iter()
            .enumerate()
            .map(|(index, e)| (0..e.levels.len()).map(|j| level(index, j)).collect())
            .collect()
    }

    /// All that is reported of a solution: `a`, `b`, then `F` at every level, with the step experiment's mean at `step`.
    pub(super) fn read(&self, theta: &[f64], step: f64) -> Vec<f64> {
        let n = self.order;
        let at_one = |c: &[f64]| c.iter().sum::<f64>();
        let held = if self.step.is_some() { (1.0 + at_one(&theta[..n])) * step } else { theta[2 * n] };
        let base = held / at_one(&theta[n..2 * n]);
        let levels = self.levels(theta).into_iter().flatten().map(|w| base + w);
        theta[..2 * n].iter().copied().chain(levels).collect()
    }
}
