//! A random plant and the effects in it, simulated sample by sample.

use std::f64::consts::PI;

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Cause, Foreign};
use crate::effect::Effect;

/// An effect with its size and the random choices of its law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Active {
    cause: Cause,
    magnitude: f64,
    /// Four uniform numbers that choose the law and its other parameters.
    choice: [f64; 4],
}

/// A nominal system and what acts on it.
#[derive(Debug, Clone)]
pub(super) struct Plant {
    a: Vec<f64>,
    b: Vec<f64>,
    shape: Shape,
    /// Half the distance between the borders.
    half_gap: f64,
    /// Standard deviation of the equation error.
    pub(super) noise: f64,
    pub(super) effects: Vec<Active>,
}

/// The mid-line of the borders.
#[derive(Debug, Clone, Copy)]
enum Shape {
    Line { slope: f64 },
    Cubic { slope: f64, hardening: f64 },
    Tanh { steepness: f64 },
    Jump { slope: f64, at: f64, height: f64 },
    Wave { slope: f64, height: f64 },
}

impl Shape {
    fn at(self, v: f64) -> f64 {
        match self {
            Self::Line { slope } => slope * v,
            Self::Cubic { slope, hardening } => slope * v + hardening * v.powi(3),
            Self::Tanh { steepness } => (steepness * v).tanh() / steepness.tanh(),
            Self::Jump { slope, at, height } => slope * v + if v > at { height } else { 0.0 },
            Self::Wave { slope, height } => slope * v + height * (3.0 * v).sin(),
        }
    }
}

impl Plant {
    pub(super) fn draw(rng: &mut impl Rng) -> Self {
        let order = if rng.random::<f64>() < 0.7 { 2 } else { rng.random_range(1..4) };
        let mut a = vec![1.0];
        let mut left = order;
        while left > 0 {
            if left >= 2 && rng.random::<f64>() < 0.5 {
                let (r, w): (f64, f64) = (rng.random_range(0.4..0.85), rng.random_range(0.2..1.6));
                a = crate::model::assembly::convolve(&a, &[1.0, -2.0 * r * w.cos(), r * r]);
                left -= 2;
            } else {
                a = crate::model::assembly::convolve(&a, &[1.0, -rng.random_range(0.1..0.85)]);
                left -= 1;
            }
        }
        let dc: f64 = a.iter().sum();
        let mut b: Vec<f64> = vec![1.0];
        b.extend((1..order).map(|_| rng.random_range(-0.5..0.8)));
        let gain = dc / b.iter().sum::<f64>();
        b.iter_mut().for_each(|b| *b *= gain);
        let slope = rng.random_range(0.3..0.9);
        let shape = match rng.random_range(0..5) {
            0 => Shape::Line { slope },
            1 => Shape::Cubic { slope: 0.4 * slope, hardening: 0.6 * slope },
            2 => Shape::Tanh { steepness: rng.random_range(0.8..3.0) },
            3 => Shape::Jump { slope, at: rng.random_range(-0.6..0.6), height: rng.random_range(0.15..0.5) },
            _ => Shape::Wave { slope, height: rng.random_range(0.05..0.2) },
        };
        Self {
            a: a[1..].to_vec(),
            b,
            shape,
            half_gap: rng.random_range(0.12..0.4),
            noise: rng.random_range(0.003_f64..0.03),
            effects: Vec::new(),
        }
    }

    pub(super) fn order(&self) -> usize {
        self.a.len()
    }

    /// Adds a cause of a magnitude in (0, 1].
    pub(super) fn add(&mut self, cause: Cause, magnitude: f64, draw: u64) {
        let mut rng = ChaCha8Rng::seed_from_u64(draw);
        let choice = [0; 4].map(|_| rng.random::<f64>());
        if cause != Cause::Nothing {
            self.effects.push(Active { cause, magnitude, choice });
        }
    }

    fn of(&self, effect: Effect) -> Option<Active> {
        self.effects.iter().copied().find(|e| e.cause == Cause::Library(effect))
    }

    fn foreign(&self, foreign: Foreign) -> Option<f64> {
        self.effects.iter().find(|e| e.cause == Cause::Foreign(foreign)).map(|e| e.magnitude)
    }

    /// The measured output over an input, starting on the campaign's clock (0…1) at `start`, `tick` a sample.
    pub(super) fn run(&self, v: &[f64], start: f64, tick: f64, rng: &mut impl Rng) -> Vec<f64> {
        let clock: Vec<f64> = (0..v.len()).map(|t| start + tick * t as f64).collect();
        let u = self.operator(v, &clock, rng);
        let u = self.before_plant(&u, &clock);
        let x = self.plant(&u, start / tick, rng);
        self.sensor(&x, &clock, start / tick, rng)
    }

    /// The switched hysteresis with its effects.
    fn operator(&self, v: &[f64], clock: &[f64], rng: &mut impl Rng) -> Vec<f64> {
        let branch0 = if v[0] > 0.0 { 1.0 } else { -1.0 };
        let mut state = (branch0, self.shape.at(v[0]) + branch0 * self.half_gap);
        let play = self.of(Effect::Backlash).map_or(0.0, |e| 0.9 * e.magnitude);
        let mut p = v[0];
        let mut turn = (v[0], 0.0);
        let mut travel = 0.0;
        let mut path = 0.0;
        let mut rest = 0.0;
        let mut out = Vec::with_capacity(v.len());
        for t in 0..v.len() {
            let step = if t > 0 { v[t] - v[t - 1] } else { 0.0 };
            path += step.abs();
            // The play's output moves only when its gap is taken up.
            let before = p;
            p = p.clamp(v[t] - 0.5 * play, v[t] + 0.5 * play);
            let moved = p - before;
            if moved != 0.0 {
                let branch = moved.signum();
                rest = 0.0;
                if branch != state.0 || t == 1 {
                    turn = (before, state.1 - self.border(branch, before, clock[t], path));
                    travel = 0.0;
                    state.0 = branch;
                }
                travel += moved.abs();
                let noisy = match self.of(Effect::InputNoise) {
                    Some(e) => p + 0.3 * e.magnitude * normal(rng),
                    None => p,
                };
                let mut u = self.border(branch, noisy, clock[t], path) + branch * self.speed_term(step.abs());
                if let Some(e) = self.of(Effect::GradualTransition) {
                    let length = 0.6 * e.magnitude;
                    let x = travel / length;
                    let fade = if e.choice[0] < 0.6 { (-x).exp() } else { (1.0 - 0.5 * x).max(0.0) };
                    u += fade * turn.1;
                }
                state.1 = u;
            } else {
                rest += 1.0;
            }
            let mut u = state.1;
            if let Some(e) = self.of(Effect::Creep)
                && e.choice[0] < 0.2
            {
                let scale: f64 = 2.0 + 20.0 * e.choice[1];
                u += e.magnitude * self.half_gap * state.0 * (rest / scale).ln_1p();
            }
            out.push(u);
        }
        out
    }

    fn border(&self, branch: f64, v: f64, clock: f64, path: f64) -> f64 {
        let wear = self.of(Effect::BorderWear).map_or(1.0, |e| {
            let s = if e.choice[0] < 0.6 { clock } else { path / 300.0 };
            1.0 - 1.2 * e.magnitude * s
        });
        self.shape.at(v) + branch * self.half_gap * wear
    }

    fn speed_term(&self, speed: f64) -> f64 {
        let mut sum = 0.0;
        if let Some(e) = self.of(Effect::RateDependence) {
            let r = speed / 0.08;
            sum += 0.6
                * e.magnitude
                * self.half_gap
                * if e.choice[0] < 0.5 { r.powf(0.4 + e.choice[1]) } else { (1.0 + 3.0 * r).ln() };
        }
        if let Some(e) = self.of(Effect::Stribeck) {
            let r = speed / (0.02 + 0.08 * e.choice[1]);
            sum += 2.0
                * e.magnitude
                * self.half_gap
                * if e.choice[0] < 0.6 { (-r * r).exp() } else { (-r).exp() };
        }
        sum
    }

    /// Delay, creep, extra pole, mode and gain drift.
    fn before_plant(&self, u: &[f64], clock: &[f64]) -> Vec<f64> {
        let mut u = u.to_vec();
        if let Some(e) = self.of(Effect::InputDelay) {
            let delay = 3.0 * e.magnitude;
            let (k, part) = (delay.floor() as usize, delay.fract());
            let old = u.clone();
            for t in 0..u.len() {
                u[t] = (1.0 - part) * old[t.saturating_sub(k)] + part * old[t.saturating_sub(k + 1)];
            }
        }
        if let Some(e) = self.of(Effect::Creep)
            && e.choice[0] >= 0.2
        {
            let pole = (-1.0 / (20.0 * 15.0_f64.powf(e.choice[1]))).exp();
            let mut slow = u[0];
            for x in &mut u {
                slow = pole * slow + (1.0 - pole) * *x;
                *x += 1.5 * e.magnitude * slow;
            }
        }
        if let Some(e) = self.of(Effect::ExtraPole)
            && e.choice[0] < 0.5
        {
            let pole = 0.95 * e.magnitude;
            let mut y = u[0];
            for x in &mut u {
                y = pole * y + (1.0 - pole) * *x;
                *x = y;
            }
        }
        if let Some(e) = self.of(Effect::Resonance) {
            let (w, r) = (0.25 + 1.8 * e.choice[1], 0.8 + 0.17 * e.choice[2]);
            let (mut y1, mut y2) = (0.0, 0.0);
            let level = u[0];
            for x in &mut u {
                let y = 2.0 * r * w.cos() * y1 - r * r * y2 + (*x - level);
                (y1, y2) = (y, y1);
                *x += 0.8 * e.magnitude * (1.0 - r) * y;
            }
        }
        if let Some(e) = self.of(Effect::GainDrift) {
            for (x, s) in u.iter_mut().zip(clock) {
                let g = if e.choice[0] < 0.6 { *s } else { (2.0 * PI * (1.0 + e.choice[1]) * s).sin() };
                *x *= 1.0 + 0.8 * e.magnitude * g;
            }
        }
        u
    }

    /// The difference equation and its error.
    fn plant(&self, u: &[f64], first: f64, rng: &mut impl Rng) -> Vec<f64> {
        let dc = self.b.iter().sum::<f64>() / (1.0 + self.a.iter().sum::<f64>());
        let mut a = self.a.clone();
        if let Some(e) = self.of(Effect::ExtraPole)
            && e.choice[0] >= 0.5
        {
            let pole = 0.95 * e.magnitude;
            a = crate::model::assembly::times_monic(&a, &[-pole]);
            let gain = 1.0 - pole;
            return self.recursion(&a, gain, u, (dc, first), rng);
        }
        self.recursion(&a, 1.0, u, (dc, first), rng)
    }

    fn recursion(
        &self,
        a: &[f64],
        gain: f64,
        u: &[f64],
        (dc, first): (f64, f64),
        rng: &mut impl Rng,
    ) -> Vec<f64> {
        let rest = dc * u[0];
        let mut x: Vec<f64> = Vec::with_capacity(u.len());
        let mut colour = [0.0; 2];
        for t in 0..u.len() {
            let at = |lag: usize| if t >= lag { x[t - lag] } else { rest };
            let mut now = 0.0;
            let level = at(1);
            for (i, a) in a.iter().enumerate() {
                now -= a * at(i + 1);
            }
            if let Some(m) = self.foreign(Foreign::LevelDependentPole) {
                let moved = 0.5 * m * level.tanh();
                now += moved * (at(1) - dc * u[t.saturating_sub(1)]);
            }
            for (j, b) in self.b.iter().enumerate() {
                let mut drive = u[t.saturating_sub(j + 1)];
                if let Some(m) = self.foreign(Foreign::OutputDependentBorder)
                    && level > 0.3
                {
                    drive -= 0.5 * m * (level - 0.3).min(0.4);
                }
                now += gain * b * drive;
            }
            now += self.equation_error(first + t as f64, level, &mut colour, rng);
            x.push(now);
        }
        x
    }

    fn equation_error(&self, at: f64, level: f64, colour: &mut [f64; 2], rng: &mut impl Rng) -> f64 {
        let mut e = self.noise * normal(rng);
        if let Some(c) = self.of(Effect::ColouredNoise) {
            let rho = 0.95 * c.magnitude.min(1.0) * if c.choice[0] < 0.8 { 1.0 } else { -1.0 };
            let second = if c.choice[1] < 0.3 { 0.3 * rho.abs() * (1.0 - rho.abs()) } else { 0.0 };
            // One standard deviation of the innovation stays what the surviving gap is measured in.
            e += rho * colour[0] + second * colour[1];
            *colour = [e, colour[0]];
        }
        if let Some(o) = self.of(Effect::Outliers)
            && o.choice[0] < 0.5
            && rng.random::<f64>() < 0.01
        {
            e += 60.0 * o.magnitude * self.noise * normal(rng);
        }
        if let Some(p) = self.of(Effect::PeriodicDisturbance)
            && p.choice[0] < 0.5
        {
            e += 0.4 * p.magnitude * (0.1 + 2.5 * p.choice[1]).mul_add(at, p.choice[2]).sin();
        }
        if let Some(m) = self.foreign(Foreign::MultiplicativeNoise) {
            e *= 1.0 + 20.0 * m * level.abs();
        }
        e
    }

    fn sensor(&self, x: &[f64], clock: &[f64], first: f64, rng: &mut impl Rng) -> Vec<f64> {
        let mut y = x.to_vec();
        if let Some(n) = self.of(Effect::SensorNonlinearity) {
            for y in &mut y {
                *y += if n.choice[0] < 0.5 {
                    0.5 * n.magnitude * *y * *y
                } else {
                    -0.35 * n.magnitude * y.powi(3)
                };
            }
        }
        if let Some(d) = self.of(Effect::SensorDrift) {
            for (t, (y, s)) in y.iter_mut().zip(clock).enumerate() {
                *y += 4.0
                    * d.magnitude
                    * if d.choice[0] < 0.5 {
                        *s
                    } else {
                        (2.0 * PI * t as f64 / (600.0 + 2000.0 * d.choice[1])).sin()
                    };
            }
        }
        if let Some(n) = self.of(Effect::OutputNoise) {
            y.iter_mut().for_each(|y| *y += 30.0 * n.magnitude * self.noise * normal(rng));
        }
        if let Some(p) = self.of(Effect::PeriodicDisturbance)
            && p.choice[0] >= 0.5
        {
            for (t, y) in y.iter_mut().enumerate() {
                *y += 0.4 * p.magnitude * ((0.1 + 2.5 * p.choice[1]) * (first + t as f64)).sin();
            }
        }
        if let Some(o) = self.of(Effect::Outliers)
            && o.choice[0] >= 0.5
        {
            for y in &mut y {
                if rng.random::<f64>() < 0.008 {
                    *y += 60.0 * o.magnitude * self.noise * normal(rng);
                }
            }
        }
        if let Some(m) = self.foreign(Foreign::Dropouts) {
            for t in 1..y.len() {
                if rng.random::<f64>() < 0.3 * m {
                    y[t] = y[t - 1];
                }
            }
        }
        if let Some(s) = self.of(Effect::SensorSaturation) {
            let limit = 0.85 * (1.0 - 0.6 * s.magnitude);
            y.iter_mut().for_each(|y| *y = y.clamp(if s.choice[0] < 0.5 { -limit } else { -9.0 }, limit));
        }
        if let Some(q) = self.of(Effect::SensorQuantisation) {
            let step = 0.5 * q.magnitude;
            y.iter_mut().for_each(|y| *y = (*y / step).round() * step);
        }
        y
    }
}

/// A standard normal deviate by the polar method's simpler cousin (Box–Muller).
fn normal(rng: &mut impl Rng) -> f64 {
    let u: f64 = 1.0 - rng.random::<f64>();
    (-2.0 * u.ln()).sqrt() * (2.0 * PI * rng.random::<f64>()).cos()
}
