//! Piecewise-linear curves of `v`, written as sums of hat functions.

use switchback_model::hysteresis::{Branch, Interval};

/// The hat functions of one static curve or of two borders.
///
/// ```text
/// C(v) = Σₖ f_k · hat_k(v),   hat_k(knot_l) = δ_kl, linear in between
/// ```
///
/// Knots are numbered through: the descending curve first, then the ascending one. At each `v` two hats are non-zero and they add up to one, so a
/// constant added to every `f` is a constant added to `u`. That constant is kept apart: `f₀` (the descending border at
/// `h_m`, or the low end of a static curve) is 0 by convention and the constant has its own parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Basis {
    curves: Vec<Vec<f64>>,
    /// Straight lines go on beyond their ends; curves keep their end values, since nothing was seen there.
    extrapolate: bool,
}

/// The hats that are non-zero at one sample: two neighbours of one curve, or of both where the reversal falls inside the sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// On the branch of the sample.
    pub(super) main: Place,
    /// On the branch that the reversal leads to, and its share of the sample.
    pub(super) next: Option<(Place, f64)>,
}

/// Where a sample lies between two knots.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Number of the left knot; the right one is the next.
    pub(super) knot: usize,
    /// Height of the right hat; the left one's is `1 − weight`.
    pub(super) weight: f64,
}

impl Place {
    /// The two hats as (feature, height); the reference knot has no feature.
    fn features(self, share: f64) -> impl Iterator<Item = (usize, f64)> {
        let left = self.knot.checked_sub(1).map(|k| (k, share * (1.0 - self.weight)));
        left.into_iter().chain([(self.knot, share * self.weight)])
    }

    /// The two hats as (knot, height).
    pub(super) fn hats(self) -> [(usize, f64); 2] {
        [(self.knot, 1.0 - self.weight), (self.knot + 1, self.weight)]
    }

    /// `u` here, for knot values `f₁…`, relative to the reference knot.
    pub(super) fn value(self, f: &[f64]) -> f64 {
        let left = if self.knot == 0 { 0.0 } else { (1.0 - self.weight) * f[self.knot - 1] };
        left + self.weight * f[self.knot]
    }
}

impl Cell {
    /// The non-zero hats as (feature, height).
    pub(super) fn features(self) -> impl Iterator<Item = (usize, f64)> {
        let share = self.next.map_or(1.0, |(_, share)| 1.0 - share);
        self.main
            .features(share)
            .chain(self.next.into_iter().flat_map(|(place, share)| place.features(share)))
    }

    /// `u`, for knot values `f₁…`, relative to the reference knot.
    pub(super) fn value(self, f: &[f64]) -> f64 {
        let main = self.main.value(f);
        self.next.map_or(main, |(place, share)| main + share * (place.value(f) - main))
    }
}

impl Basis {
    /// The straight line `u = v`.
    pub fn linear(interval: Interval) -> Self {
        Self { curves: vec![vec![interval.low(), interval.high()]], extrapolate: true }
    }

    /// One static curve on the given knots (increasing, at least two).
    pub fn curve(knots: Vec<f64>) -> Self {
        Self { curves: vec![knots], extrapolate: false }
    }

    /// Two borders, each on its own knots (increasing, at least two).
    pub fn borders(descending: Vec<f64>, ascending: Vec<f64>) -> Self {
        Self { curves: vec![descending, ascending], extrapolate: false }
    }

    /// Knots of the descending border, or of the only curve.
    pub fn descending(&self) -> &[f64] {
        &self.curves[0]
    }

    /// Knots of the ascending border, or of the only curve.
    pub fn ascending(&self) -> &[f64] {
        &self.curves[self.curves.len() - 1]
    }

    /// Whether the two branches have curves of their own.
    pub fn is_switched(&self) -> bool {
        self.curves.len() == 2
    }

    /// Whether it is the straight line `u = v`, which goes on beyond its ends.
    pub fn is_line(&self) -> bool {
        self.extrapolate
    }

    /// Number of free knot values: all but the reference.
    pub(super) fn features(&self) -> usize {
        self.curves.iter().map(Vec::len).sum::<usize>() - 1
    }

    /// Sizes of the curves, in the order of the knots' numbers.
    pub(super) fn sizes(&self) -> impl Iterator<Item = usize> {
        self.curves.iter().map(Vec::len)
    }

    /// The hats at `v` on a branch.
    pub(super) fn place(&self, branch: Branch, v: f64) -> Place {
        let (curve, first) = match branch {
            Branch::Ascending if self.is_switched() => (&self.curves[1], self.curves[0].len()),
            _ => (&self.curves[0], 0),
        };
        let left = curve.partition_point(|&k| k <= v).clamp(1, curve.len() - 1) - 1;
        let weight = (v - curve[left]) / (curve[left + 1] - curve[left]);
        let weight = if self.extrapolate { weight } else { weight.clamp(0.0, 1.0) };
        Place { knot: first + left, weight }
    }
}

/// How knots lie between the ends of the interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Spacing {
    /// At equal shares, for a static curve that may bend anywhere.
    Even,
    /// At the shares `(1 − cos πs)/2`, denser towards the ends: a loop bends most just after a reversal, and reversals
    /// lie near the ends of the motion.
    DenseEnds,
}

impl Spacing {
    fn share(self, s: f64) -> f64 {
        match self {
            Self::Even => s,
            Self::DenseEnds => 0.5 * (1.0 - (std::f64::consts::PI * s).cos()),
        }
    }
}

/// `count` knots (at least 2) over the interval, each midway between the share of the interval and the same share of the
/// visits.
///
/// Shares of the visits alone crowd where the input dwells (the turning points of a sine) and leave the middle bare; shares
/// of the interval alone may leave a hat without data. `values` need not be sorted. Knots closer than a thousandth of the
/// interval are merged.
pub(super) fn place_knots(values: &[f64], interval: Interval, count: usize, spacing: Spacing) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|&v| interval.contains(v)).collect();
    sorted.sort_by(f64::total_cmp);
    let closest = 1e-3 * interval.width();
    let mut knots = vec![interval.low()];
    for j in 1..count - 1 {
        let share = spacing.share(j as f64 / (count - 1) as f64);
        let even = interval.low() + share * interval.width();
        let visited = sorted.get((share * sorted.len() as f64) as usize).copied().unwrap_or(even);
        let knot = 0.5 * (even + visited);
        if knot - knots[knots.len() - 1] > closest && interval.high() - knot > closest {
            knots.push(knot);
        }
    }
    knots.push(interval.high());
    knots
}
