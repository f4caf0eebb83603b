//! A joint of a robot with the attributes of one of MuJoCo, beside the machine that it stands for: angle in, torque out, by the formula of these attributes.
//!
//! ```text
//! torque(t) = stiffness·q + frictionloss·sign(dq/dt) + damping·dq/dt + armature·d²q/dt²   at t − delay
//! ```

use super::drive::{Drive, add_noise, uniform};
use super::pair::factor;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use switchback_model::rig::Rig;

/// Samples a second, and of a record.
const RATE: f64 = 200.0;
const SAMPLES: usize = 5000;
/// Largest angle, rad.
const REACH: f64 = 1.5;

/// What is off in the simulator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Off {
    FrictionLoss,
    JointDamping,
    Armature,
    JointDelay,
    AllFour,
}

impl Off {
    pub(crate) const ALL: [Self; 5] =
        [Self::FrictionLoss, Self::JointDamping, Self::Armature, Self::JointDelay, Self::AllFour];
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Attributes {
    stiffness: f64,
    frictionloss: f64,
    damping: f64,
    armature: f64,
    /// Samples.
    delay: usize,
}

/// A joint and its machine.
#[derive(Debug, Clone)]
pub(crate) struct Joint {
    simulator: Attributes,
    machine: Attributes,
    /// Standard deviation of the sensor's noise over that of the torque.
    noise: f64,
    seed: u64,
}

impl Joint {
    pub(crate) fn draw(off: Off, seed: u64) -> Self {
        let rng = &mut ChaCha8Rng::seed_from_u64(seed);
        let simulator = Attributes {
            stiffness: uniform(rng, 0.5, 3.0),
            frictionloss: uniform(rng, 0.3, 1.0),
            damping: uniform(rng, 0.05, 0.3),
            armature: uniform(rng, 0.01, 0.05),
            delay: 0,
        };
        let mut machine = simulator;
        let is_off = |one| off == one || off == Off::AllFour;
        if is_off(Off::FrictionLoss) {
            machine.frictionloss *= factor(rng);
        }
        if is_off(Off::JointDamping) {
            machine.damping *= factor(rng);
        }
        if is_off(Off::Armature) {
            machine.armature *= factor(rng);
        }
        if is_off(Off::JointDelay) {
            machine.delay = uniform(rng, 1.0, 4.99).floor() as usize;
        }
        Self { simulator, machine, noise: uniform(rng, 0.003, 0.02), seed }
    }

    /// The rows that must come first, each with its values in simulator and machine.
    pub(crate) fn expected(&self) -> Vec<(&'static str, [f64; 2])> {
        let [a, b] = [self.simulator, self.machine];
        let all = [
            ("friction", [a.frictionloss, b.frictionloss]),
            ("damping", [a.damping, b.damping]),
            ("inertia", [a.armature, b.armature]),
            ("delay", [a.delay as f64 / RATE, b.delay as f64 / RATE]),
        ];
        all.into_iter().filter(|(_, [a, b])| a != b).collect()
    }

    /// The attribute to set, of a row.
    pub(crate) fn attribute(row: &str) -> Option<&'static str> {
        match row {
            "friction" => Some("frictionloss"),
            "damping" => Some("damping"),
            "inertia" => Some("armature"),
            _ => None,
        }
    }

    pub(crate) fn rig(&self) -> Rig {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(1);
        let drive = Drive::draw(&mut rng, (RATE, SAMPLES), REACH);
        let predicted = self.simulator.torque(&drive);
        let mut y = self.machine.torque(&drive);
        add_noise(&mut y, self.noise, &mut rng);
        drive.rig("joint", ["angle [rad]", "torque [Nm]"], y, predicted)
    }
}

impl Attributes {
    fn torque(&self, drive: &Drive) -> Vec<f64> {
        let at = |t: usize| {
            let [q, speed, acceleration] = drive.at(t.saturating_sub(self.delay));
            let friction = self.frictionloss * speed.signum();
            self.stiffness * q + friction + self.damping * speed + self.armature * acceleration
        };
        (0..SAMPLES).map(at).collect()
    }
}
