//! The true borders, sampled finely enough to draw.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_model::hysteresis::{Branch, SwitchedHysteresis};

/// The true borders of one case, in the normalisation `u_M − u_m = 1`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BorderCurve {
    /// Name of the case.
    pub case: String,
    /// Name of the border.
    pub border: String,
    /// From `h_m` to `h_M`.
    pub points: Vec<CurvePoint>,
}

/// Both true borders at one position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurvePoint {
    /// Position, input units.
    pub v: f64,
    /// `C_d(v)/(u_M − u_m)`.
    pub descending: f64,
    /// `C_a(v)/(u_M − u_m)`.
    pub ascending: f64,
}

/// Enough that a jump between two positions looks upright at any sensible width of the figure.
const POSITIONS: usize = 241;

impl BorderCurve {
    /// Samples both borders over the working interval.
    pub(crate) fn sample(case: &str, border: &str, hysteresis: &SwitchedHysteresis) -> Self {
        let interval = hysteresis.interval();
        let step = interval.width() / (POSITIONS - 1) as f64;
        let at = |i: usize| {
            let v = if i + 1 == POSITIONS { interval.high() } else { interval.low() + i as f64 * step };
            let normalised = |branch| short(hysteresis.border(branch, v) / hysteresis.span());
            CurvePoint {
                v: short(v),
                descending: normalised(Branch::Descending),
                ascending: normalised(Branch::Ascending),
            }
        };
        Self { case: case.to_owned(), border: border.to_owned(), points: (0..POSITIONS).map(at).collect() }
    }
}

/// Seven digits: finer than any drawing, and files stay small.
fn short(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_model::hysteresis::{Interval, LeafSpring};

    #[test]
    fn the_ends_carry_the_normalisation() {
        let interval = Interval::new(-20.0, 20.0).expect("an interval");
        let spring = LeafSpring::constant(0.2, 0.8).expect("a spring");
        let hysteresis = SwitchedHysteresis::new(interval, Box::new(spring)).expect("Assumption 1 holds");
        let curve = BorderCurve::sample("c", "b", &hysteresis);
        let (first, last) = (curve.points[0], curve.points[POSITIONS - 1]);
        assert_eq!((first.v, last.v), (-20.0, 20.0));
        assert!((last.ascending - first.descending - 1.0).abs() < 1e-6);
    }
}
