//! `play_background`: a Preisach-like memory beside the borders.

use crate::generate::effects::card;
use crate::generate::effects::motion::position;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&SumOfPlays];

/// `u' = u + x·Σ_k c_k·tanh(g_k·(p_k − ½))`, `p_k` plays of four radii: nested loops that congruent borders cannot have.
#[derive(Debug)]
struct SumOfPlays;

impl Law for SumOfPlays {
    card!("play_background", "sum of plays", Operator, "spans of u", 1.0);

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let start = position(scene.machine, v[0]);
        let mut plays = [start; 4];
        for (t, now) in v.iter().enumerate() {
            let z = position(scene.machine, *now);
            let mut sum = 0.0;
            for (k, play) in plays.iter_mut().enumerate() {
                let radius = 0.05 + 0.25 * scene.amount.shape[k];
                *play = play.max(z - radius).min(z + radius);
                let side = if k % 2 == 0 { 1.0 } else { -1.0 };
                sum += side * ((2.0 + 4.0 * scene.amount.shape[3 - k]) * (*play - 0.5)).tanh();
            }
            u[t] += scene.x() * sum;
        }
    }
}
