//! The borders depend on the speed of the input.
//!
//! ```text
//! u = C(v) + c·branch·(r/r₀)^power,   r = |v(t) − v(t−1)|, r₀ its median
//! u = C(v) + w·(r/r₀)^power·half(v)·branch,   half(v) = ½(C_a − C_d)              the whole loop widens
//! ```
//!
//! Parameters: `power` (0.1…3); the coefficient is estimated with the borders, `widening` w (−0.9…20) is not. Stage: operator. Fast records have wider loops
//! than slow ones. While the input rests, the term keeps its last value or vanishes. Confused with: Stribeck
//! friction (which falls with speed), creep.

use super::{Scene, Variant, own, typical_speed};
use crate::model::assembly::{BorderColumn, Resting, Speeds, Widening};

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let scale = typical_speed(scene.campaign);
    let mut out = Vec::new();
    for while_resting in [Resting::Held, Resting::Zero] {
        // Viscous friction is the commonest.
        let starts = [0.4, 1.0].iter().map(|&p| vec![own("power", "1", p, (0.1, 3.0), 0.02)]).collect();
        out.push(Variant::conditional(starts, move |p, assembly| {
            assembly.border_columns.push(BorderColumn::Speed { power: p[0], scale, while_resting });
        }));
    }
    let starts = [(0.2, 0.3), (1.0, 0.3), (0.2, 1.0), (1.0, 1.0)].map(|(share, power)| {
        vec![
            own("widening", "half widths of the loop", share, (-0.9, 20.0), 0.005),
            own("power", "1", power, (0.1, 3.0), 0.02),
        ]
    });
    out.push(Variant::conditional(starts.into(), move |p, assembly| {
        assembly.widening = Some(Widening { share: p[0], power: p[1], scale, speeds: Speeds::High });
    }));
    out
}
