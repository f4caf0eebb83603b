//! Pairs of a simulator and a machine that differ in one quantity, simulated by plain loops.
//!
//! ```text
//! p = v but for the play,   u = k·p + c·p² ± F + d·dv/dt + m·d²v/dt²,   y = gain·(zero + G(u(t − delay))),   G of unit gain at rest
//! ```
//!
//! `G` is one real pole or a pair of poles behind a zero-order hold. The machine's sensor is noisy, the simulator's output is not.

use super::drive::{Drive, add_noise, uniform};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::f64::consts::TAU;
use switchback_model::rig::Rig;

/// Samples a second, and of a record.
const RATE: f64 = 200.0;
const SAMPLES: usize = 4800;
/// Half the stroke, mm.
const STROKE: f64 = 20.0;

/// A quantity in which both sides differ, named as the row that shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Offset,
    Gain,
    Sign,
    Thousand,
    Delay,
    Friction,
    Stiffness,
    Curvature,
    TimeConstant,
    Frequency,
    Damping,
    Play,
    /// An effect that the simulator lacks.
    LacksPlay,
    LacksViscosity,
    LacksInertia,
    /// One that only the simulator has.
    HasPlay,
    HasViscosity,
    HasInertia,
    /// Effects of both, nothing differs.
    SameEffects,
    /// Neither has one, nothing differs.
    Same,
}

impl Kind {
    pub(crate) const ALL: [Self; 20] = [
        Self::Offset,
        Self::Gain,
        Self::Sign,
        Self::Thousand,
        Self::Delay,
        Self::Friction,
        Self::Stiffness,
        Self::Curvature,
        Self::TimeConstant,
        Self::Frequency,
        Self::Damping,
        Self::Play,
        Self::LacksPlay,
        Self::LacksViscosity,
        Self::LacksInertia,
        Self::HasPlay,
        Self::HasViscosity,
        Self::HasInertia,
        Self::SameEffects,
        Self::Same,
    ];

    /// The kind of a seed: kinds take turns.
    pub(crate) fn of(seed: u64) -> Self {
        Self::ALL[(seed % Self::ALL.len() as u64) as usize]
    }

    /// The row that must come first; none where nothing differs.
    pub(crate) fn row(self) -> Option<&'static str> {
        match self {
            Self::Offset => Some("offset"),
            Self::Gain | Self::Sign | Self::Thousand => Some("gain"),
            Self::Delay => Some("delay"),
            Self::Friction => Some("friction"),
            Self::Stiffness => Some("stiffness"),
            Self::Curvature => Some("curvature"),
            Self::TimeConstant => Some("time_constant"),
            Self::Frequency => Some("frequency"),
            Self::Damping => Some("damping_ratio"),
            Self::Play | Self::LacksPlay | Self::HasPlay => Some("play"),
            Self::LacksViscosity | Self::HasViscosity => Some("damping"),
            Self::LacksInertia | Self::HasInertia => Some("inertia"),
            Self::SameEffects | Self::Same => None,
        }
    }
}

/// Everything that a side has.
#[derive(Debug, Clone, PartialEq)]
struct Side {
    offset: f64,
    gain: f64,
    /// Samples.
    delay: usize,
    friction: f64,
    stiffness: f64,
    curvature: f64,
    poles: Poles,
    play: f64,
    viscosity: f64,
    inertia: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Poles {
    /// A time constant, s.
    Real(f64),
    /// Natural frequency, Hz, and damping ratio.
    Pair(f64, f64),
}

/// A simulator and a machine.
#[derive(Debug, Clone)]
pub(crate) struct Pair {
    pub(crate) kind: Kind,
    simulator: Side,
    machine: Side,
    /// Standard deviation of the sensor's noise over that of the output.
    noise: f64,
    seed: u64,
}

/// A factor between 1.15 and 1.7, or its inverse.
pub(super) fn factor(rng: &mut ChaCha8Rng) -> f64 {
    let factor = uniform(rng, 1.15, 1.7);
    if uniform(rng, 0.0, 1.0) < 0.5 { factor } else { 1.0 / factor }
}

impl Side {
    fn draw(rng: &mut ChaCha8Rng, kind: Kind) -> Self {
        let pair = Poles::Pair(uniform(rng, 6.0, 20.0), uniform(rng, 0.2, 0.55));
        let real = Poles::Real(uniform(rng, 0.01, 0.08));
        let is_pair = match kind {
            Kind::TimeConstant => false,
            Kind::Frequency | Kind::Damping => true,
            _ => uniform(rng, 0.0, 1.0) < 0.5,
        };
        let has = |of: &[Kind]| f64::from(u8::from(of.contains(&kind)));
        Self {
            offset: uniform(rng, -1.0, 1.0),
            gain: 1.0,
            delay: 4,
            friction: uniform(rng, 0.3, 1.2),
            stiffness: uniform(rng, 0.1, 0.3),
            curvature: uniform(rng, 0.0, 3e-3),
            poles: if is_pair { pair } else { real },
            play: has(&[Kind::Play, Kind::SameEffects]) * uniform(rng, 0.7, 2.0),
            viscosity: has(&[Kind::SameEffects]) * uniform(rng, 2e-3, 6e-3),
            inertia: 0.0,
        }
    }
}

impl Pair {
    /// A pair by its seed.
    pub(crate) fn draw(kind: Kind, seed: u64) -> Self {
        let rng = &mut ChaCha8Rng::seed_from_u64(seed);
        let mut simulator = Side::draw(rng, kind);
        let mut machine = simulator.clone();
        match kind {
            Kind::Offset => machine.offset += uniform(rng, 0.2, 2.0) * (factor(rng) - 1.0).signum(),
            Kind::Gain => machine.gain = factor(rng),
            Kind::Sign => machine.gain = -1.0,
            Kind::Thousand => machine.gain = 1000_f64.powf((factor(rng) - 1.0).signum()),
            Kind::Delay => {
                machine.delay =
                    (4.0 + (factor(rng) - 1.0).signum() * uniform(rng, 1.0, 4.99).floor()) as usize;
            }
            Kind::Friction => machine.friction *= factor(rng),
            Kind::Stiffness => machine.stiffness *= factor(rng),
            Kind::Curvature => machine.curvature += uniform(rng, 2e-3, 6e-3) * (factor(rng) - 1.0).signum(),
            Kind::TimeConstant | Kind::Frequency | Kind::Damping => {
                machine.poles = match (machine.poles, kind) {
                    (Poles::Real(constant), _) => Poles::Real(constant * factor(rng)),
                    (Poles::Pair(f, zeta), Kind::Frequency) => Poles::Pair(f * factor(rng), zeta),
                    (Poles::Pair(f, zeta), _) => Poles::Pair(f, zeta * factor(rng)),
                };
            }
            Kind::Play => machine.play *= factor(rng),
            Kind::LacksPlay => machine.play = uniform(rng, 0.7, 2.0),
            Kind::HasPlay => simulator.play = uniform(rng, 0.7, 2.0),
            Kind::LacksViscosity => machine.viscosity = uniform(rng, 2e-3, 6e-3),
            Kind::HasViscosity => simulator.viscosity = uniform(rng, 2e-3, 6e-3),
            Kind::LacksInertia => machine.inertia = uniform(rng, 5e-5, 3e-4),
            Kind::HasInertia => simulator.inertia = uniform(rng, 5e-5, 3e-4),
            Kind::SameEffects | Kind::Same => {}
        }
        Self { kind, simulator, machine, noise: uniform(rng, 0.003, 0.02), seed }
    }

    /// The values of simulator and machine in which they differ, in the unit of their row; none where nothing differs.
    pub(crate) fn truth(&self) -> Option<[f64; 2]> {
        let row = self.kind.row()?;
        let of_poles = |side: &Side, constant, frequency, damping| match side.poles {
            Poles::Real(t) => constant * t,
            Poles::Pair(f, zeta) => frequency * f + damping * zeta,
        };
        let of = |side: &Side| match row {
            "offset" => side.offset,
            "gain" => side.gain,
            "delay" => side.delay as f64 / RATE,
            "friction" => side.friction,
            "stiffness" => side.stiffness,
            "curvature" => side.curvature,
            "time_constant" => of_poles(side, 1.0, 0.0, 0.0),
            "frequency" => of_poles(side, 0.0, 1.0, 0.0),
            "damping_ratio" => of_poles(side, 0.0, 0.0, 1.0),
            "play" => side.play,
            "damping" => side.viscosity,
            _ => side.inertia,
        };
        Some([of(&self.simulator), of(&self.machine)])
    }

    /// The machine's records with the predictions of the simulator; the last third is held out.
    pub(crate) fn rig(&self) -> Rig {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(1);
        let drive = Drive::draw(&mut rng, (RATE, SAMPLES), STROKE);
        let predicted = self.simulator.run(&drive);
        let mut y = self.machine.run(&drive);
        add_noise(&mut y, self.noise, &mut rng);
        drive.rig("pair", ["travel [mm]", "force [kN]"], y, predicted)
    }
}

impl Side {
    fn run(&self, drive: &Drive) -> Vec<f64> {
        let first = drive.at(0)[0];
        let (mut p, mut side) = (first, 1.0);
        let force = |t: usize| {
            let [x, v, a] = drive.at(t);
            let moved = p.max(x - 0.5 * self.play).min(x + 0.5 * self.play);
            if moved != p {
                side = f64::signum(moved - p);
                p = moved;
            }
            let curve = self.stiffness * p + self.curvature * p * p;
            curve + side * self.friction + self.viscosity * v + self.inertia * a
        };
        let u: Vec<f64> = (0..SAMPLES).map(force).collect();
        let [a, b] = self.poles.discrete();
        let mut y = vec![u[0]; SAMPLES];
        for t in 1..SAMPLES {
            let u = |lag: usize| u[t.saturating_sub(lag + self.delay)];
            let y_at = |lag: usize| if t >= lag { y[t - lag] } else { u(0) };
            y[t] = b[0] * u(1) + b[1] * u(2) - a[0] * y_at(1) - a[1] * y_at(2);
        }
        y.iter().map(|y| self.gain * (self.offset + y)).collect()
    }
}

impl Poles {
    /// Coefficients of lags 1 and 2 of output and input, behind a zero-order hold.
    fn discrete(self) -> [[f64; 2]; 2] {
        match self {
            Self::Real(constant) => {
                let pole = (-1.0 / (RATE * constant)).exp();
                [[-pole, 0.0], [1.0 - pole, 0.0]]
            }
            Self::Pair(frequency, zeta) => {
                let (omega, root) = (TAU * frequency, (1.0 - zeta * zeta).sqrt());
                let (radius, angle) = ((-zeta * omega / RATE).exp(), omega * root / RATE);
                let (cos, sin) = (angle.cos(), zeta / root * angle.sin());
                let a = [-2.0 * radius * cos, radius * radius];
                [a, [1.0 - radius * (cos + sin), radius * radius + radius * (sin - cos)]]
            }
        }
    }
}
