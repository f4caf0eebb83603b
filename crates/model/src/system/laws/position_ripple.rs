//! A force that is periodic in the position: cogging, the teeth of a gear.

use super::super::law::{Law, Parameter, Unit};
use super::super::motion::Motion;
use super::super::scale::Scale;
use super::super::signals::{Operator, Span};

/// `u + c·sin(2πp/λ + φ)`.
#[derive(Debug)]
pub(super) struct Ripple;

const PARAMETERS: [Parameter; 3] = [
    Parameter::new("ripple", Unit::Output, (f64::NEG_INFINITY, f64::INFINITY)),
    Parameter::new("ripple_length", Unit::Input, (f64::MIN_POSITIVE, f64::INFINITY)),
    Parameter::new("ripple_phase", Unit::One, (-10.0, 10.0)),
];

impl Law for Ripple {
    fn effect(&self) -> &'static str {
        "position_ripple"
    }

    fn name(&self) -> &'static str {
        "sine"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>> {
        let lengths = [4.0, 6.0, 9.0, 13.0, 19.0, 28.0].map(|periods| scale.travel / periods);
        let phases = [0.0, std::f64::consts::FRAC_PI_2];
        lengths
            .iter()
            .flat_map(|&length| phases.map(|phase| vec![0.1 * scale.output, length, phase]))
            .collect()
    }

    /// Longer than half the stroke it is a shape of the borders.
    fn is_sound(&self, values: &[f64], scale: &Scale) -> bool {
        (0.005..0.4).contains(&(values[1] / scale.travel))
    }

    fn operator(&self, values: &[f64], motion: &Motion, _: Span, operator: &mut Operator) {
        let rate = std::f64::consts::TAU / values[1];
        for (added, p) in operator.added.iter_mut().zip(&motion.position) {
            *added += values[0] * (rate * p + values[2]).sin();
        }
    }
}
