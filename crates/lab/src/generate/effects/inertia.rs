//! `inertia`: a force by the acceleration of the input, as of an armature or a mass behind the sensor of the input.

use super::card;
use super::motion::{moves, position};
use crate::generate::law::{Law, Scene};
use std::f64::consts::TAU;

pub(super) static LAWS: [&dyn Law; 4] = [&Armature, &SoftMount, &CentralDifference, &UnevenMass];

/// `u' = u + x·(v(t) − 2v(t−1) + v(t−2))`, in interval widths.
#[derive(Debug)]
struct Armature;

impl Law for Armature {
    card!("inertia", "armature", Operator, "spans of u per width a squared sample", 200.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let force = accelerations(scene, v);
        u.iter_mut().zip(force).for_each(|(u, a)| *u += scene.amount.magnitude * a);
    }
}

/// The mass hangs on a soft mount: its acceleration follows with a pole of 0.2 to 0.8.
#[derive(Debug)]
struct SoftMount;

impl Law for SoftMount {
    card!("inertia", "mass on a soft mount", Operator, "spans of u per width a squared sample", 300.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let pole = scene.amount.between(0, 0.2, 0.8);
        let mut felt = 0.0;
        for (u, a) in u.iter_mut().zip(accelerations(scene, v)) {
            felt += (1.0 - pole) * (a - felt);
            *u += scene.amount.magnitude * felt;
        }
    }
}

/// `u' = u + x·(v(t+1) − 2v(t) + v(t−1))`: the force of the instant itself, for an input that moves between samples.
#[derive(Debug)]
struct CentralDifference;

impl Law for CentralDifference {
    card!("inertia", "central difference", Operator, "spans of u per width a squared sample", 200.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let force = accelerations(scene, v);
        for t in 0..u.len() {
            u[t] += scene.x() * force[(t + 1).min(force.len() - 1)];
        }
    }
}

/// A mass that differs along the stroke by up to 70 %, as of a linkage.
#[derive(Debug)]
struct UnevenMass;

impl Law for UnevenMass {
    card!("inertia", "mass by position", Operator, "spans of u per width a squared sample", 200.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let phase = scene.amount.between(0, 0.0, TAU);
        for (t, a) in accelerations(scene, v).into_iter().enumerate() {
            let mass = 1.0 + 0.7 * (TAU * position(scene.machine, v[t]) + phase).sin();
            u[t] += scene.x() * mass * a;
        }
    }
}

/// Second differences in interval widths; the first two are zero.
fn accelerations(scene: &Scene<'_>, v: &[f64]) -> Vec<f64> {
    let moves = moves(scene.machine, v);
    (0..v.len()).map(|t| if t < 2 { 0.0 } else { moves[t] - moves[t - 1] }).collect()
}

#[cfg(test)]
mod tests {
    use crate::generate::law::Amount;
    use crate::generate::machine::{Family, Machine};
    use crate::generate::simulate::{Active, Noise, simulate};
    use crate::generate::stream::{Purpose, stream};
    use crate::generate::{Passage, RequestedFault};
    use switchback_model::rig::{Role, Usage};

    #[test]
    fn a_constant_speed_has_no_force_and_a_parabola_a_constant_one() {
        let machine = Machine::draw(Family { order: Some(1), shape: None }, &mut stream(3, Purpose::Machine));
        let (low, width) = (machine.interval.low(), machine.interval.width());
        let of = |course: fn(f64) -> f64| -> Vec<f64> {
            let v: Vec<f64> = (0..40).map(|t| low + width * course(f64::from(t))).collect();
            let passage = Passage::of(0, "r".to_owned(), (Role::Free, Usage::Fit), (vec![v[0]], v));
            let law = RequestedFault::plain("inertia", 1.0).expect("an effect").law;
            let run = |magnitude: f64| {
                let active = Active { law, amount: Amount { magnitude, shape: [0.5; 4] }, slot: 0 };
                simulate(&machine, &[active], &passage, 1, Noise::None).y
            };
            run(10.0).iter().zip(run(0.0)).map(|(with, without)| with - without).skip(30).collect()
        };
        assert!(of(|t| 0.01 * t).iter().all(|force| force.abs() < 1e-9));
        let settled = machine.gain() * 10.0 * 0.001;
        let forces = of(|t| 0.0005 * t * t);
        let last = forces[forces.len() - 1];
        assert!((last / settled - 1.0).abs() < 0.2, "{last} {settled}");
    }
}
