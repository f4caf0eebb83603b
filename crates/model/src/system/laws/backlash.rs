//! Play before the operator.

use super::super::law::{Law, Parameter, Unit};
use super::super::scale::Scale;

/// `p(t) = p(t−1)` unless `|v − p|` exceeds half the play, in the middle of which it begins.
#[derive(Debug)]
pub(super) struct Play;

const PARAMETERS: [Parameter; 1] = [Parameter::new("play", Unit::Input, (0.0, f64::INFINITY))];

impl Law for Play {
    fn effect(&self) -> &'static str {
        "backlash"
    }

    fn name(&self) -> &'static str {
        "play"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        [0.003, 0.01, 0.03, 0.08, 0.2].map(|share| vec![share * scale.travel]).into()
    }

    fn moves_reversals(&self) -> bool {
        true
    }

    fn is_sound(&self, values: &[f64], scale: &Scale) -> bool {
        values[0] < 0.8 * scale.travel
    }

    fn position(&self, values: &[f64], position: &mut [f64]) {
        let half = 0.5 * values[0];
        let Some(mut p) = position.first().copied() else { return };
        for v in position {
            p = p.clamp(*v - half, *v + half);
            *v = p;
        }
    }
}
