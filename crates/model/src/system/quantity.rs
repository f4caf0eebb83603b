//! What a person would change in a machine or in a simulator.

use super::law::Unit;
use super::modes::Mode;
use super::scale::Scale;
use super::simulate::System;

/// A number of a system with a meaning of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// Factor of the output; negative where its sign is turned.
    Gain,
    /// Zero of the output.
    Offset,
    /// Delay between input and output.
    Delay,
    /// Half the distance of the borders, in the mean over the stroke.
    Friction,
    /// Slope at the pivot of the mean curve between the borders: of the parabola of least squares over the stroke, about the input's zero where the stroke contains it.
    Stiffness,
    /// The coefficient of the square in that parabola.
    Curvature,
    /// Time constant of a real pole, by its number among those, slowest first.
    TimeConstant(usize),
    /// Natural frequency of a pair of poles.
    Frequency(usize),
    /// Damping ratio of a pair of poles.
    Damping(usize),
    /// A parameter of a term: number of the term, number of the parameter.
    Value(usize, usize),
    /// The value of a border at a knot, numbered through.
    Knot(usize),
    /// A free coefficient of the linear part.
    Coefficient(usize),
}

/// A quantity with a value that differs from the system's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The quantity.
    pub quantity: Quantity,
    /// Its value.
    pub value: f64,
}

/// Shortest time constant, samples: what is left of it after a sample is 2·10⁻⁹.
const SHORTEST: f64 = 0.05;
/// Longest time constant, samples: a pole that is one has none.
const LONGEST: f64 = 1e9;

/// Places over the stroke at which borders are compared.
const PLACES: usize = 33;

/// The mean curve as a parabola about a pivot, by least squares over the stroke, and the half width.
///
/// The pivot is the input's zero where the stroke contains it, else the middle of the stroke: a stiffer spring turns the curve about its zero.
struct Shape {
    pivot: f64,
    /// Slope at the pivot, and coefficient of the square.
    slope: f64,
    square: f64,
    /// Mean of the half width, and of its absolute value.
    half: (f64, f64),
}

impl Shape {
    fn of(system: &System) -> Self {
        let (low, high) = system.borders.range();
        let (centre, reach) = (0.5 * (low + high), 0.5 * INNER * (high - low));
        let pivot = if low < 0.0 && high > 0.0 { 0.0 } else { centre };
        let (mut mean, mut norms, mut half) = ([0.0; 3], [0.0; 3], (0.0, 0.0));
        for k in 0..PLACES {
            let xi = (2 * k + 1) as f64 / PLACES as f64 - 1.0;
            let (m, h) = system.borders.at(centre + reach * xi);
            half = (half.0 + h / PLACES as f64, half.1 + h.abs() / PLACES as f64);
            // Nearly orthogonal: the even places make the sum of odd products vanish, and the square is freed of its mean.
            for (j, basis) in [1.0, xi, xi * xi - MEAN_SQUARE].into_iter().enumerate() {
                mean[j] += m * basis;
                norms[j] += basis * basis;
            }
        }
        let [slope, square] = [mean[1] / norms[1] / reach, mean[2] / norms[2] / (reach * reach)];
        Self { pivot, slope: slope + 2.0 * square * (pivot - centre), square, half }
    }

    /// Whether the loop has a width that a factor can change.
    fn is_scaled_in_width(&self) -> bool {
        self.half.0.abs() > 0.5 * self.half.1
    }
}

/// Share of the stroke over which curves are compared: near its ends hardly any sample shows them.
const INNER: f64 = 0.8;
/// Mean of `ξ²` over the places: `(1 − 1/n²)/3`.
const MEAN_SQUARE: f64 = (1.0 - 1.0 / (PLACES * PLACES) as f64) / 3.0;

impl Quantity {
    /// Those that every system has, and its poles'.
    pub fn all(system: &System) -> Vec<Self> {
        let mut all =
            vec![Self::Gain, Self::Offset, Self::Delay, Self::Friction, Self::Stiffness, Self::Curvature];
        let modes = system.linear.modes();
        let reals = modes.iter().filter(|m| m.time_constant().is_some()).count();
        let pairs = modes.iter().filter(|m| matches!(m, Mode::Pair { .. })).count();
        all.extend((0..reals).map(Self::TimeConstant));
        all.extend((0..pairs).flat_map(|k| [Self::Frequency(k), Self::Damping(k)]));
        all
    }

    /// The free numbers of a system: borders, linear part, the parameters of its terms.
    pub fn coordinates(system: &System) -> Vec<Self> {
        let knots = (0..system.borders.count()).map(Self::Knot);
        let coefficients = (0..system.linear.coefficients()).map(Self::Coefficient);
        let terms = (0..system.terms.len()).flat_map(|k| Self::of_term(system, k));
        knots.chain(coefficients).chain(terms).collect()
    }

    /// The free parameters of a term.
    ///
    /// # Panics
    /// If the system has no such term.
    pub fn of_term(system: &System, term: usize) -> Vec<Self> {
        system.terms[term].free().map(|k| Self::Value(term, k)).collect()
    }

    /// Its value in a system.
    ///
    /// # Panics
    /// If the system has no such pole, term or knot.
    pub fn value(self, system: &System) -> f64 {
        match self {
            Self::Gain => system.sensor.gain,
            Self::Offset => system.sensor.zero,
            Self::Delay => system.linear.lag() as f64 + system.linear.delay,
            Self::Friction => Shape::of(system).half.0,
            Self::Stiffness => Shape::of(system).slope,
            Self::Curvature => Shape::of(system).square,
            Self::TimeConstant(k) => reals(system).nth(k).expect("a real pole").1,
            Self::Frequency(k) => pairs(system).nth(k).expect("a pair of poles").1.0,
            Self::Damping(k) => pairs(system).nth(k).expect("a pair of poles").1.1,
            Self::Value(term, index) => system.terms[term].values[index],
            Self::Knot(knot) => *system.borders.clone().value_mut(knot),
            Self::Coefficient(k) => system.linear.coefficient(k),
        }
    }

    /// The system with another value of it.
    ///
    /// # Panics
    /// As [`Self::value`].
    #[must_use]
    pub fn set(self, system: &System, value: f64) -> System {
        let mut out = system.clone();
        match self {
            Self::Gain => out.sensor.gain = value,
            Self::Offset => out.sensor.zero = value,
            Self::Delay => out.linear.delay = value - system.linear.lag() as f64,
            Self::Friction => {
                let shape = Shape::of(system);
                let (old, more) = (shape.half.0, value - shape.half.0);
                out.borders = if shape.is_scaled_in_width() {
                    system.borders.map(|_, mean, half| (mean, half * value / old))
                } else {
                    system.borders.map(|_, mean, half| (mean, half + more))
                };
            }
            Self::Stiffness => {
                let shape = Shape::of(system);
                let more = value - shape.slope;
                out.borders = system.borders.map(|v, mean, half| (mean + more * (v - shape.pivot), half));
            }
            Self::Curvature => {
                let shape = Shape::of(system);
                let more = value - shape.square;
                let bent = |v: f64, mean: f64, half| (mean + more * (v - shape.pivot).powi(2), half);
                out.borders = system.borders.dense().map(bent);
            }
            Self::TimeConstant(k) => {
                let (at, _) = reals(system).nth(k).expect("a real pole");
                let mode = Mode::Real((-1.0 / value.clamp(SHORTEST, LONGEST)).exp());
                out.linear = system.linear.with_mode(at, mode);
            }
            Self::Frequency(k) => {
                let (at, (_, damping)) = pairs(system).nth(k).expect("a pair of poles");
                let mode = Mode::Pair { frequency: value.clamp(1e-6, 3.1), damping };
                out.linear = system.linear.with_mode(at, mode);
            }
            Self::Damping(k) => {
                let (at, (frequency, _)) = pairs(system).nth(k).expect("a pair of poles");
                let mode = Mode::Pair { frequency, damping: value.clamp(1e-4, 0.9999) };
                out.linear = system.linear.with_mode(at, mode);
            }
            Self::Value(term, index) => out.terms[term] = system.terms[term].set(index, value),
            Self::Knot(knot) => *out.borders.value_mut(knot) = value,
            Self::Coefficient(k) => out.linear.set_coefficient(k, value),
        }
        out
    }

    /// A move small enough to differentiate by, and large enough for rounding.
    pub fn step(self, system: &System, scale: &Scale) -> f64 {
        const SMALL: f64 = 1e-4;
        match self {
            Self::Gain => SMALL * system.sensor.gain.abs(),
            Self::Offset | Self::Knot(_) => SMALL * scale.output,
            Self::Delay => 1e-3,
            Self::Friction => SMALL * Shape::of(system).half.1.max(1e-3 * scale.output),
            Self::Stiffness => SMALL * scale.output / scale.travel,
            Self::Curvature => SMALL * scale.output / (scale.travel * scale.travel),
            Self::TimeConstant(_) | Self::Frequency(_) | Self::Damping(_) => SMALL * self.value(system).abs(),
            Self::Value(term, index) => system.terms[term].step(index, scale),
            Self::Coefficient(_) => 1e-6,
        }
    }

    /// Whether a change of it changes the path of the working point.
    pub fn moves_the_path(self) -> bool {
        matches!(self, Self::Value(..))
    }

    /// Its name in reports; that of its parameter for a term's.
    pub fn name(self, system: &System) -> String {
        match self {
            Self::Gain => "gain".into(),
            Self::Offset => "offset".into(),
            Self::Delay => "delay".into(),
            Self::Friction => "friction".into(),
            Self::Stiffness => "stiffness".into(),
            Self::Curvature => "curvature".into(),
            Self::TimeConstant(k) => numbered("time_constant", k),
            Self::Frequency(k) => numbered("frequency", k),
            Self::Damping(k) => numbered("damping_ratio", k),
            Self::Value(term, index) => system.terms[term].law.parameters()[index].name.into(),
            Self::Knot(k) => numbered("border", k),
            Self::Coefficient(k) => numbered("coefficient", k),
        }
    }

    /// Its unit.
    pub fn unit(self, system: &System) -> Unit {
        match self {
            Self::Gain | Self::Damping(_) | Self::Coefficient(_) => Unit::One,
            Self::Offset | Self::Friction | Self::Knot(_) => Unit::Output,
            Self::Delay | Self::TimeConstant(_) => Unit::Samples,
            Self::Stiffness => Unit::OutputPerInput,
            Self::Curvature => Unit::OutputPerSquaredInput,
            Self::Frequency(_) => Unit::Frequency,
            Self::Value(term, index) => system.terms[term].law.parameters()[index].unit,
        }
    }
}

fn numbered(name: &str, k: usize) -> String {
    if k == 0 { name.into() } else { format!("{name}_{}", k + 1) }
}

/// Real poles with a time constant: their number among the modes, and the constant.
fn reals(system: &System) -> impl Iterator<Item = (usize, f64)> + '_ {
    let modes = system.linear.modes().iter().enumerate();
    modes.filter_map(|(at, mode)| Some((at, mode.time_constant()?)))
}

/// Pairs of poles: their number among the modes, frequency and damping.
fn pairs(system: &System) -> impl Iterator<Item = (usize, (f64, f64))> + '_ {
    system.linear.modes().iter().enumerate().filter_map(|(at, mode)| match *mode {
        Mode::Pair { frequency, damping } => Some((at, (frequency, damping))),
        Mode::Real(_) => None,
    })
}
