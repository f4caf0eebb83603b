//! Drawing a nominal system.

use super::shape::Shape;
use super::{Machine, Table};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use switchback_model::hysteresis::{Interval, SwitchedHysteresis};

/// What all systems of a family share; everything else is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Family {
    /// Order `n` of the linear part, 1 to 3; drawn if none.
    pub order: Option<usize>,
    /// Shape of the borders; drawn if none.
    pub shape: Option<Shape>,
}

impl Machine {
    /// Draws a system: order, poles, zeros, interval, levels, borders, units, noise.
    pub(crate) fn draw(family: Family, rng: &mut ChaCha8Rng) -> Self {
        Self::draw_with(family, (draw_poles, CURVED), rng)
    }

    /// The same with a law of its own for the denominator of a given order, and with so many of the borders that bend curved between the
    /// levels.
    pub(crate) fn draw_with(
        family: Family,
        (poles, often_curved): (impl FnOnce(usize, &mut ChaCha8Rng) -> Vec<f64>, f64),
        rng: &mut ChaCha8Rng,
    ) -> Self {
        let order = family.order.unwrap_or_else(|| rng.random_range(1..=3));
        let shape = family.shape.unwrap_or_else(|| Shape::ALL[rng.random_range(0..Shape::ALL.len())]);
        let interval = draw_interval(rng);
        let m = rng.random_range(7..=11);
        let levels: Vec<f64> =
            (0..=m).map(|j| interval.low() + interval.width() * f64::from(j) / f64::from(m)).collect();
        let borders = Borders::draw(shape, &levels, rng);
        let a = poles(order, rng);
        let span = rng.random_range(-0.5..2.0_f64).exp2() * 10.0_f64.powi(rng.random_range(-1..=2));
        let b = draw_numerator(&a, span, rng);
        let sample_time = [1e-4, 1e-3, 0.01, 0.05][rng.random_range(0..4)];
        // The output's noise, not the equation's, is what an engineer sees: 0.1 % to 2 % of the stationary span.
        let noise = 10.0_f64.powf(rng.random_range(-3.0..-1.7));
        let curved = shape.is_curved() && rng.random_bool(often_curved);
        let table = borders.table(&levels, if curved { POINTS } else { 1 });
        let hysteresis =
            SwitchedHysteresis::new(interval, Box::new(table)).expect("drawn borders span exactly one");
        let mut machine = Self {
            a,
            b,
            hysteresis,
            interval,
            levels,
            noise_sd: 0.0,
            reach: 0.0,
            sample_time,
            shape,
            curved,
        };
        machine.reach = machine.y_half();
        machine.noise_sd = 2.0 * machine.y_half() * noise / machine.noise_amplification();
        machine
    }
}

fn draw_interval(rng: &mut ChaCha8Rng) -> Interval {
    let scale = 10.0_f64.powi(rng.random_range(-1..=1));
    let (low, high) = if rng.random_bool(0.4) {
        (-1.0, 1.0)
    } else {
        let low: f64 = rng.random_range(-2.0..1.0);
        (low, low + rng.random_range(0.5..4.0))
    };
    Interval::new(low * scale, high * scale).expect("the second end lies above the first")
}

/// How often borders that bend do so between the levels too, and in how many straight pieces a cell.
pub(crate) const CURVED: f64 = 0.5;
const POINTS: usize = 16;

/// The curves that borders follow.
struct Borders {
    shape: Shape,
    /// Distance of the borders, in units of the drawn curves.
    gap: f64,
    /// The cell that a jump falls into.
    jump: usize,
    /// Centres of the ascending and the descending border's steps.
    centres: (f64, f64),
    steep: f64,
    waves: f64,
    offset: f64,
}

impl Borders {
    fn draw(shape: Shape, levels: &[f64], rng: &mut ChaCha8Rng) -> Self {
        let gap = rng.random_range(0.1..0.6);
        let jump = rng.random_range(1..levels.len() - 1);
        // At least a cell and a half apart, or both borders of a relay could fall together.
        let centres = (rng.random_range(0.61..0.8), rng.random_range(0.2..0.39));
        let steep = rng.random_range(3.0..12.0);
        let waves = rng.random_range(0.8..1.6);
        let offset = rng.random_range(-1.0..0.0);
        Self { shape, gap, jump, centres, steep, waves, offset }
    }

    /// One border at `x`, a share of the interval, where `level` is the number of the last level up to there.
    fn curve(&self, x: f64, level: usize, rising: bool) -> f64 {
        let side = if rising { self.gap } else { -self.gap };
        let s = 2.0 * x - 1.0;
        let centre = if rising { self.centres.0 } else { self.centres.1 };
        match self.shape {
            Shape::LeafSpring => s + side,
            Shape::HardeningSpring => (0.5 + 0.5 * s * s) * s + side,
            Shape::Relay => 0.1 * s + if x > centre { 1.0 } else { -1.0 },
            Shape::General => (self.steep * (x - centre)).tanh() + 0.3 * x * x,
            Shape::Discontinuous => 0.7 * s + side + if level > self.jump { 0.8 } else { 0.0 },
            Shape::NonMonotone => s + side + 0.5 * (self.waves * std::f64::consts::TAU * x).sin(),
        }
    }

    /// Both borders in `points` straight pieces a cell, scaled to `u_m = C_d(h_m)`, `u_M = C_a(h_M) = u_m + 1`.
    fn table(&self, levels: &[f64], points: usize) -> Table {
        let m = levels.len() - 1;
        let places = points * m;
        let at = |rising: bool| -> Vec<f64> {
            (0..=places).map(|i| self.curve(i as f64 / places as f64, i / points, rising)).collect()
        };
        let (mut ascending, mut descending) = (at(true), at(false));
        if matches!(self.shape, Shape::General) {
            close(&mut ascending, &mut descending, points);
        }
        let (low, span) = (descending[0], ascending[places] - descending[0]);
        for values in [&mut ascending, &mut descending] {
            values.iter_mut().for_each(|u| *u = self.offset + (*u - low) / span);
        }
        let place = |i: usize| match i % points {
            0 => levels[i / points],
            _ => levels[0] + (levels[m] - levels[0]) * i as f64 / places as f64,
        };
        Table { levels: (0..=places).map(place).collect(), ascending, descending }
    }
}

/// Makes a loop that closes: straight in the first cell and in the last, beyond which both curves would meet.
fn close(ascending: &mut [f64], descending: &mut [f64], points: usize) {
    let last = ascending.len() - 1;
    let ends = [0, last].map(|end| 0.5 * (ascending[end] + descending[end]));
    for values in [ascending, descending] {
        let inner = [values[points], values[last - points]];
        for i in 0..points {
            let share = i as f64 / points as f64;
            values[i] = ends[0] + (inner[0] - ends[0]) * share;
            values[last - i] = ends[1] + (inner[1] - ends[1]) * share;
        }
    }
}

/// A stable denominator of the given order: real poles and complex pairs, radius 0.3 to 0.93.
fn draw_poles(order: usize, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let mut polynomial = vec![1.0];
    let mut left = order;
    while left > 0 {
        let radius: f64 = rng.random_range(0.3..0.93);
        let factor = if left >= 2 && rng.random_bool(0.6) {
            left -= 2;
            let angle = rng.random_range(0.05..0.6) * std::f64::consts::PI;
            vec![1.0, -2.0 * radius * f64::cos(angle), radius * radius]
        } else {
            left -= 1;
            vec![1.0, -radius]
        };
        polynomial = multiply(&polynomial, &factor);
    }
    polynomial[1..].to_vec()
}

/// A numerator with stationary gain `span`, clear of cancelling: `B(1)` carries at least 0.4 of `Σ|bᵢ|`.
fn draw_numerator(a: &[f64], span: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    loop {
        let b: Vec<f64> = a.iter().map(|_| rng.random_range(-0.6..1.0_f64)).collect();
        let (sum, size) = (b.iter().sum::<f64>(), b.iter().map(|x| x.abs()).sum::<f64>());
        if sum > 0.4 * size && b[0].abs() > 0.2 * size {
            let scale = span * (1.0 + a.iter().sum::<f64>()) / sum;
            return b.iter().map(|x| x * scale).collect();
        }
    }
}

/// Product of two polynomials, constant term first.
pub(crate) fn multiply(p: &[f64], q: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; p.len() + q.len() - 1];
    for (i, x) in p.iter().enumerate() {
        for (j, y) in q.iter().enumerate() {
            product[i + j] += x * y;
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use switchback_model::hysteresis::BorderPair;

    #[test]
    fn curved_borders_pass_through_those_that_are_straight_between_the_levels() {
        let levels: Vec<f64> = (0..=9).map(|j| -2.0 + f64::from(j) / 3.0).collect();
        for (seed, shape) in (0..).zip(Shape::ALL) {
            let borders = Borders::draw(shape, &levels, &mut ChaCha8Rng::seed_from_u64(seed));
            let [straight, curved] = [1, POINTS].map(|points| borders.table(&levels, points));
            for v in &levels {
                assert!((straight.ascending(*v) - curved.ascending(*v)).abs() < 1e-12, "{shape:?} at {v}");
                assert!((straight.descending(*v) - curved.descending(*v)).abs() < 1e-12, "{shape:?} at {v}");
            }
            let inside = || (1..90).map(|i| -2.0 + f64::from(i) / 30.0);
            let apart = inside().any(|v| (straight.ascending(v) - curved.ascending(v)).abs() > 1e-3);
            assert!(apart || !shape.is_curved(), "{shape:?}");
        }
    }
}
