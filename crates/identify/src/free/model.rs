//! An identified system that runs on its own.

use super::basis::{Basis, Cell};
use super::cells::Cells;
use super::problem::{Parameters, Segment, Structure};
use super::simulation_error::free_run;
use switchback_model::hysteresis::Branch;
use switchback_model::record::Record;
use switchback_model::reversal::{Branches, LookAhead, ReversalRule};
use thiserror::Error;

/// A Hammerstein system on piecewise-linear curves, in output units.
///
/// ```text
/// A(q⁻¹) y(t) = Σᵢ bᵢ u(t−d−i) + c,   u(t) = Σₖ f_k hat_k(v(t)) on the branch of t
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    pub(super) basis: Basis,
    pub(super) structure: Structure,
    pub(super) parameters: Parameters,
    pub(super) rule: ReversalRule,
}

/// A free run over a record.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeRun {
    /// One output a sample; the measured ones before `start`.
    pub y: Vec<f64>,
    /// First sample that is simulated.
    pub start: usize,
    /// `100·(1 − ‖y − ŷ‖ / ‖y − ȳ‖)` over the simulated samples; negative infinity if `y` is constant there.
    pub fit_percent: f64,
}

/// The numbers of a [`Model`], in any scale that `b` and `f` share.
#[derive(Debug, Clone, PartialEq)]
pub struct Coefficients {
    /// `a₁…aₙ`.
    pub a: Vec<f64>,
    /// `b`, one number a lag.
    pub b: Vec<f64>,
    /// Knot values, in the order of the knots, without the reference knot's, which is 0.
    pub f: Vec<f64>,
    /// The constant `c`.
    pub c: f64,
}

/// Why parts make no [`Model`].
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// A list has the wrong length.
    #[error("`{part}` has {found} numbers, but the structure and the knots make {expected}")]
    Length {
        /// The list.
        part: &'static str,
        /// Its numbers.
        found: usize,
        /// Those expected.
        expected: usize,
    },
    /// The knots of a curve do not rise, or are fewer than two.
    #[error("the knots of a curve must rise, and each curve needs two")]
    Knots,
    /// The order is zero.
    #[error("the order is 0: a model needs a pole at least")]
    Order,
    /// A coefficient is not finite.
    #[error("a coefficient is not finite")]
    NotFinite,
}

impl Model {
    /// Joins the parts of a model.
    ///
    /// # Errors
    /// [`ModelError`] where they do not fit together.
    pub fn new(
        basis: Basis,
        structure: Structure,
        coefficients: Coefficients,
        rule: ReversalRule,
    ) -> Result<Self, ModelError> {
        let falls = |knots: &[f64]| knots.len() < 2 || knots.windows(2).any(|pair| pair[1] <= pair[0]);
        if falls(basis.descending()) || falls(basis.ascending()) {
            return Err(ModelError::Knots);
        }
        if structure.order == 0 {
            return Err(ModelError::Order);
        }
        let Coefficients { a, b, f, c } = coefficients;
        let lists =
            [("a", &a, structure.order), ("b", &b, structure.numerator()), ("f", &f, basis.features())];
        for (part, list, expected) in lists {
            if list.len() != expected {
                return Err(ModelError::Length { part, found: list.len(), expected });
            }
        }
        if a.iter().chain(&b).chain(&f).chain([&c]).any(|x| !x.is_finite()) {
            return Err(ModelError::NotFinite);
        }
        Ok(Self { basis, structure, parameters: Parameters { a, b, f, c }, rule })
    }

    /// The numbers.
    pub fn coefficients(&self) -> Coefficients {
        let Parameters { a, b, f, c } = self.parameters.clone();
        Coefficients { a, b, f, c }
    }

    /// The same model with its parameters `(a, b, f, c)` moved by a step, one number each.
    ///
    /// # Panics
    /// If the step has another length.
    pub fn moved(&self, step: &[f64]) -> Self {
        let parameters = self.parameters.moved(step);
        Self { parameters, ..self.clone() }
    }

    /// The first sample that a [`Self::free_run`] over an input simulates.
    pub fn start(&self, v: &[f64]) -> usize {
        let known = Branches::of(v, self.rule).map_or(v.len(), |b| b.first_known());
        (known + self.structure.memory()).min(v.len())
    }

    /// The hat functions of the curves.
    pub fn basis(&self) -> &Basis {
        &self.basis
    }

    /// Order and delay.
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// What counts as a reversal.
    pub fn rule(&self) -> ReversalRule {
        self.rule
    }

    /// Whether `y(t)` follows from `v` up to `t` alone, so that the model could run in real time.
    ///
    /// No coefficient may weigh a sample ahead, and the branch of every sample that has weight must be known by then. A turning sample shared
    /// between the borders is known one sample later, which a model without a direct term can wait for.
    pub fn is_causal(&self) -> bool {
        let known_in_time = match self.rule.looks_ahead() {
            LookAhead::Never => true,
            LookAhead::OneSample => self.structure.delay >= 0,
            LookAhead::UntilConfirmed => false,
        };
        self.structure.ahead() == 0 && (known_in_time || !self.basis.is_switched())
    }

    /// The output for an input, given the outputs measured before the simulation starts.
    ///
    /// The run starts from `y_before` (any length). Where it reaches back further, the system rests: `u` at
    /// its first value and `y` at the output this holds, or at the first of `y_before`. An input that never moves
    /// by more than the threshold counts as ascending.
    pub fn simulate(&self, v: &[f64], y_before: &[f64]) -> Vec<f64> {
        let cells = self.cells(v);
        let Some(end) = cells.len().checked_sub(1) else { return Vec::new() };
        let (first, last, memory) = (cells.at(0), cells.at(end), self.structure.memory());
        let rests = |cell: Cell, samples| std::iter::repeat_n(cell, samples);
        let cells: Cells =
            rests(first, memory).chain(cells.iter()).chain(rests(last, self.structure.ahead())).collect();
        let rest = y_before.first().copied().unwrap_or_else(|| self.rest(first.value(&self.parameters.f)));
        let given = y_before.len().min(v.len());
        let mut y = [vec![rest; memory], y_before[..given].to_vec()].concat();
        y.resize(memory + v.len(), 0.0);
        let from = memory + given;
        let segment =
            Segment { y: &y, cells: &cells, from, to: memory + v.len(), weights: None, counted_from: from };
        let run = free_run(self.structure, &self.parameters, &segment);
        y[memory..memory + given].iter().copied().chain(run).collect()
    }

    /// A free run over a record, and how well it fits.
    ///
    /// The same rule serves every method: the outputs measured up to the first sample whose inputs are
    /// all known, the first move plus the memory of the model, are its initial state; all later ones are
    /// simulated from `v` alone.
    pub fn free_run(&self, record: &Record) -> FreeRun {
        let start = self.start(record.v());
        let y = self.simulate(record.v(), &record.y()[..start]);
        let fit_percent = fit_percent(&record.y()[start..], &y[start..]);
        FreeRun { y, start, fit_percent }
    }

    /// Stationary output at a value of `u`.
    fn rest(&self, u: f64) -> f64 {
        let a: f64 = 1.0 + self.parameters.a.iter().sum::<f64>();
        (self.parameters.b.iter().sum::<f64>() * u + self.parameters.c) / a
    }

    /// Hats of every sample.
    fn cells(&self, v: &[f64]) -> Cells {
        match Branches::of(v, self.rule) {
            Some(branches) => Cells::of(&self.basis, v, &branches),
            None => {
                let resting = |&v: &f64| Cell { main: self.basis.place(Branch::Ascending, v), next: None };
                v.iter().map(resting).collect()
            }
        }
    }
}

/// `100·(1 − ‖y − ŷ‖ / ‖y − ȳ‖)`: 100 for a perfect prediction, 0 for the mean, negative for worse; −∞ where `y` never moves, since
/// there is nothing to explain. Both have one value a sample.
///
/// ```
/// use switchback_identify::free::fit_percent;
/// assert_eq!(fit_percent(&[1.0, 2.0, 3.0], &[1.0, 2.0, 3.0]), 100.0);
/// assert_eq!(fit_percent(&[1.0, 2.0, 3.0], &[2.0, 2.0, 2.0]), 0.0);
/// ```
pub fn fit_percent(measured: &[f64], predicted: &[f64]) -> f64 {
    let mean = measured.iter().sum::<f64>() / measured.len().max(1) as f64;
    let energy: f64 = measured.iter().map(|y| (y - mean) * (y - mean)).sum();
    let missed: f64 = measured.iter().zip(predicted).map(|(y, p)| (y - p) * (y - p)).sum();
    if energy > 0.0 { 100.0 * (1.0 - (missed / energy).sqrt()) } else { f64::NEG_INFINITY }
}
