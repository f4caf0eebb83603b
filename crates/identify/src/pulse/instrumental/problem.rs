//! The lines of the folds, the model's response at them, and one Gauss–Newton step.

use crate::pulse::data::PulseData;
use crate::pulse::experiments::{first_level_value, satellite_value};
use crate::pulse::folds::Folds;
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::TAU;

/// The folds of one or both experiments as lines, each with its weight.
#[derive(Debug, Clone)]
pub(super) struct Problem {
    pub(super) order: usize,
    pub(super) parts: Vec<Part>,
}

/// Step of a central difference, in the parameters' units.
pub(super) const DIFFERENCE: f64 = 1e-4;

/// One experiment.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// `w` at the satellite, and at `V₁`.
    rest: f64,
    first: f64,
    /// The phases of each level.
    phases: Vec<Vec<usize>>,
    /// The first of its `w₂…w_m` among the parameters.
    own: usize,
    pub(super) period: usize,
    lines: Vec<Line>,
}

/// `ω_k` of a period, from 0 to π.
#[derive(Debug, Clone, Copy)]
struct Line {
    omega: f64,
    /// `Ȳ_k`.
    output: Complex<f64>,
    /// The inverse of the variance of `Ȳ_k`, doubled where the line stands for its mirror image too.
    weight: f64,
}

/// The model at a line: the response, and its derivatives in the parameters that move it.
struct Response {
    value: Complex<f64>,
    slopes: Vec<(usize, Complex<f64>)>,
}

/// `Σ_k c_k Re(∂Z_k* ∂Z_k)` and `Σ_k c_k Re(∂Z_k* (Ȳ_k − Z_k))`.
#[derive(Debug, Clone)]
pub(super) struct Equations {
    pub(super) normal: DMatrix<f64>,
    pub(super) right: DVector<f64>,
}

impl Problem {
    /// `weight(ω)` is `1/S(ω)` up to a factor. The parameters are `a`, `b`, `o`, then `w₂…w_m` of each experiment.
    pub(super) fn new(
        experiments: &[(&PulseData, &Folds)],
        order: usize,
        weight: impl Fn(f64) -> f64,
    ) -> Self {
        let mut own = 2 * order + 1;
        let part = |(data, folds): &(&PulseData, &Folds)| {
            let visits = folds.visits.iter().enumerate();
            let of = |level| visits.clone().filter(|(_, v)| **v == Some(level)).map(|(p, _)| p).collect();
            let part = Part {
                rest: satellite_value(data.branch),
                first: first_level_value(data.branch),
                phases: (0..data.points()).map(of).collect(),
                own,
                period: folds.period(),
                lines: lines(folds, &weight),
            };
            own += data.points() - 1;
            part
        };
        Self { order, parts: experiments.iter().map(part).collect() }
    }

    /// Number of parameters.
    pub(super) fn size(&self) -> usize {
        let levels = |part: &Part| part.phases.len() - 1;
        2 * self.order + 1 + self.parts.iter().map(levels).sum::<usize>()
    }

    /// The Gauss–Newton step from `theta` on.
    pub(super) fn equations(&self, theta: &DVector<f64>) -> Equations {
        let size = self.size();
        let mut equations = Equations { normal: DMatrix::zeros(size, size), right: DVector::zeros(size) };
        for (part, line) in self.parts.iter().flat_map(|part| part.lines.iter().map(move |line| (part, line)))
        {
            let Response { value, slopes } = part.response(self.order, theta, line.omega);
            let left = line.output - value;
            for (i, slope) in &slopes {
                let weighted = slope.conj() * line.weight;
                equations.right[*i] += (weighted * left).re;
                for (j, other) in &slopes {
                    equations.normal[(*i, *j)] += (weighted * other).re;
                }
            }
        }
        equations
    }

    /// `Σ_k c_k Re(∂Z_k* t_k)`, `t_k` the sum of the second derivatives of `Z_k` along the columns of `directions`.
    pub(super) fn curvature(&self, theta: &DVector<f64>, directions: &DMatrix<f64>) -> DVector<f64> {
        let moved: Vec<(DVector<f64>, [DVector<f64>; 2], f64)> = directions
            .column_iter()
            .map(|along| {
                let along = along.into_owned();
                let h = DIFFERENCE / along.amax();
                let sides = [theta + &along * h, theta - &along * h];
                (along, sides, h)
            })
            .collect();
        let mut right = DVector::zeros(self.size());
        for (part, line) in self.parts.iter().flat_map(|part| part.lines.iter().map(move |line| (part, line)))
        {
            let slope = |at: &DVector<f64>, along: &DVector<f64>| -> Complex<f64> {
                part.response(self.order, at, line.omega).slopes.iter().map(|(i, x)| x * along[*i]).sum()
            };
            let bend = |(along, [above, below], h): &(DVector<f64>, [DVector<f64>; 2], f64)| {
                (slope(above, along) - slope(below, along)) / (2.0 * h)
            };
            let bent: Complex<f64> = moved.iter().map(bend).sum();
            for (i, slope) in part.response(self.order, theta, line.omega).slopes {
                right[i] += (slope.conj() * bent).re * line.weight;
            }
        }
        right
    }

    /// What each mean `ȳ_p` adds to the right-hand side, a row a parameter, experiment by experiment.
    pub(super) fn right_of_means(&self, theta: &DVector<f64>) -> Vec<DMatrix<f64>> {
        let of_part = |part: &Part| {
            let mut right = DMatrix::zeros(self.size(), part.period);
            for line in &part.lines {
                let response = part.response(self.order, theta, line.omega);
                for p in 0..part.period {
                    let turned = Complex::from_polar(line.weight, -line.omega * p as f64);
                    for (i, slope) in &response.slopes {
                        right[(*i, p)] += (slope.conj() * turned).re;
                    }
                }
            }
            right
        };
        self.parts.iter().map(of_part).collect()
    }
}

impl Part {
    /// `w` at a level.
    pub(super) fn level(&self, theta: &DVector<f64>, level: usize) -> f64 {
        if level == 0 { self.first } else { theta[self.own + level - 1] }
    }

    /// The place of a level among the parameters, where it is one.
    pub(super) fn place(&self, level: usize) -> Option<usize> {
        (level > 0).then(|| self.own + level - 1)
    }

    /// Number of levels.
    pub(super) fn points(&self) -> usize {
        self.phases.len()
    }

    fn response(&self, n: usize, theta: &DVector<f64>, omega: f64) -> Response {
        let turn = |by: usize| Complex::from_polar(1.0, -omega * by as f64);
        let sum = |first: usize| (0..n).map(|i| turn(i + 1) * theta[first + i]).sum::<Complex<f64>>();
        let (a, b) = (sum(0) + 1.0, sum(n));
        let at_rest = omega == 0.0;
        let period = if at_rest { self.period as f64 } else { 0.0 };
        let visits: Vec<Complex<f64>> =
            self.phases.iter().map(|phases| phases.iter().map(|p| turn(*p)).sum()).collect();
        let moved = |(level, turned): (usize, &Complex<f64>)| turned * (self.level(theta, level) - self.rest);
        let u = visits.iter().enumerate().map(moved).sum::<Complex<f64>>() + period * self.rest;
        let (gain, response) = (b / a, b * u / a);
        let of_a = (0..n).map(|i| (i, -turn(i + 1) * response / a));
        let of_b = (0..n).map(|i| (n + i, turn(i + 1) * u / a));
        let offset = at_rest.then_some((2 * n, Complex::from(period)));
        let levels = (1..visits.len()).map(|level| (self.own + level - 1, gain * visits[level]));
        Response {
            value: response + period * theta[2 * n],
            slopes: of_a.chain(of_b).chain(offset).chain(levels).collect(),
        }
    }
}

/// The transform of the means. A line has variance `T S/K = T² S/N`.
fn lines(folds: &Folds, weight: &impl Fn(f64) -> f64) -> Vec<Line> {
    let period = folds.period();
    let scale = folds.samples / (period * period) as f64;
    let line = |k: usize| {
        let omega = TAU * k as f64 / period as f64;
        let turned = |(p, mean): (usize, &f64)| Complex::from_polar(*mean, -omega * p as f64);
        let alone = k == 0 || 2 * k == period;
        Line {
            omega,
            output: folds.means.iter().enumerate().map(turned).sum(),
            weight: scale * weight(omega) * if alone { 1.0 } else { 2.0 },
        }
    };
    (0..=period / 2).map(line).collect()
}
