//! `slack`: a play that is crossed at zero force. While no flank is in contact nothing is transmitted.
//!
//! Its magnitude is the full width of the gap. `backlash` keeps the force of the last contact; here the force falls to that of the free part.

use super::card;
use super::motion::directions;
use crate::generate::law::{INTERVAL_WIDTHS, Law, Scene};

pub(super) static LAWS: [&dyn Law; 4] = [&FreeCrossing, &SoftFlank, &OneFlank, &CrossingWithDrag];

/// What its magnitude is.
const QUANTITY: &str = "full width";
/// A gap narrower than this, in interval widths, falls between the samples of a moving input.
const NARROWEST: f64 = 0.02;

/// `u' = u₀` within the gap, `u₀` 0.3 to 0.7 of the span above its low end.
#[derive(Debug)]
struct FreeCrossing;

impl Law for FreeCrossing {
    card!("slack", "free crossing", Operator, INTERVAL_WIDTHS, 0.3);

    fn quantity(&self) -> Option<&'static str> {
        Some(QUANTITY)
    }

    fn least(&self) -> f64 {
        NARROWEST
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        cross(scene, v, u, |_, _| 1.0);
    }
}

/// The force grows with the square of the way through the gap, as of a rubber flank.
#[derive(Debug)]
struct SoftFlank;

impl Law for SoftFlank {
    card!("slack", "soft flank", Operator, INTERVAL_WIDTHS, 0.4);

    fn quantity(&self) -> Option<&'static str> {
        Some(QUANTITY)
    }

    fn least(&self) -> f64 {
        NARROWEST
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        cross(scene, v, u, |inside, _| 1.0 - (1.0 - inside) * (1.0 - inside));
    }
}

/// The gap opens in one direction only: the other is preloaded.
#[derive(Debug)]
struct OneFlank;

impl Law for OneFlank {
    card!("slack", "one flank", Operator, INTERVAL_WIDTHS, 0.4);

    fn quantity(&self) -> Option<&'static str> {
        Some(QUANTITY)
    }

    fn least(&self) -> f64 {
        NARROWEST
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let side = scene.amount.sign(1);
        cross(scene, v, u, |_, direction| if direction == side { 1.0 } else { 0.0 });
    }
}

/// 20 to 60 % of the force stays while the gap is crossed.
#[derive(Debug)]
struct CrossingWithDrag;

impl Law for CrossingWithDrag {
    card!("slack", "crossing with drag", Operator, INTERVAL_WIDTHS, 0.4);

    fn quantity(&self) -> Option<&'static str> {
        Some(QUANTITY)
    }

    fn least(&self) -> f64 {
        NARROWEST
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let lost = scene.amount.between(1, 0.4, 0.8);
        cross(scene, v, u, |_, _| lost);
    }
}

/// Takes a share of `u − u₀` away while neither flank of the gap is in contact. `lost` gets how far inside the nearer flank is, 0 at contact
/// and 1 in the middle, and the direction.
fn cross(scene: &Scene<'_>, v: &[f64], u: &mut [f64], lost: impl Fn(f64, f64) -> f64) {
    let hysteresis = &scene.machine.hysteresis;
    let free = hysteresis.u_low() + scene.amount.between(0, 0.3, 0.7);
    let half = 0.5 * scene.x() * scene.machine.interval.width();
    let mut middle = v[0] + half;
    for (t, direction) in directions(scene.machine, v).into_iter().enumerate() {
        middle = middle.max(v[t] - half).min(v[t] + half);
        let inside = half - (v[t] - middle).abs();
        // Contact to within the rounding of the sums.
        if inside > 1e-9 * half {
            u[t] += lost(inside / half, direction) * (free - u[t]);
        }
    }
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
    fn the_force_returns_when_the_gap_is_crossed() {
        let machine = Machine::draw(Family { order: Some(1), shape: None }, &mut stream(3, Purpose::Machine));
        let (low, width) = (machine.interval.low(), machine.interval.width());
        // Up to the top, then down by steps of 2 %: the gap of 20 % is crossed within ten of them.
        let mut shares: Vec<f64> = (0..=50).map(|k| 0.02 * f64::from(k)).collect();
        shares.extend((1..=50).map(|k| 1.0 - 0.02 * f64::from(k)));
        let v: Vec<f64> = shares.iter().map(|z| low + width * z).collect();
        let passage = Passage::of(0, "r".to_owned(), (Role::Free, Usage::Fit), (vec![v[0]], v));
        let law = RequestedFault::plain("slack", 1.0).expect("an effect").law;
        let run = |magnitude: f64| {
            let active = Active { law, amount: Amount { magnitude, shape: [0.5; 4] }, slot: 0 };
            simulate(&machine, &[active], &passage, 1, Noise::None).y
        };
        let apart: Vec<f64> =
            run(0.2).iter().zip(run(0.0)).map(|(with, without)| (with - without).abs()).collect();
        // Record sample 50 is the top; behind the leading sample and the machine's own delay of one.
        let largest = apart[53..62].iter().copied().fold(0.0, f64::max);
        assert!(largest > 0.05 * machine.y_half(), "{largest}");
        assert!(apart[45..52].iter().all(|d| *d < 0.02 * largest.max(1e-9) + 1e-9), "{:?}", &apart[45..52]);
        assert!(apart[apart.len() - 1] < 0.2 * largest, "{}", apart[apart.len() - 1]);
    }
}
