//! Friction that falls as the speed rises from zero.
//!
//! ```text
//! u = C(v) + c·branch·exp(−(r/r_s)^power),   r = |v(t) − v(t−1)|
//! ```
//!
//! Parameters: Stribeck speed `r_s` in strokes per sample, `power` (0.3…4; 2 is the Gaussian law, below 1 near the hyperbolic one); the coefficient is estimated with the borders. Stage:
//! operator. Slow passages show a wider loop than fast ones, and only below `r_s`. Confused with: rate dependence.

use super::{Scene, Variant, own, typical_speed};
use crate::assembly::{BorderColumn, Resting};

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let typical = typical_speed(scene.campaign);
    let mut out = Vec::new();
    for while_resting in [Resting::Held, Resting::Zero] {
        let starts = [(0.2, 1.0), (0.7, 1.0), (0.5, 2.0), (2.0, 2.0), (6.0, 2.0)]
            .iter()
            .map(|&(share, power)| {
                let scale = share * typical;
                let range = (0.02 * typical, 20.0 * typical);
                vec![
                    own("stribeck_speed", "strokes per sample", scale, range, 0.02 * scale),
                    own("power", "1", power, (0.3, 4.0), 0.02),
                ]
            })
            .collect();
        out.push(Variant::conditional(starts, move |p, assembly| {
            let column = BorderColumn::LowSpeed { power: p[1], scale: p[0], while_resting };
            assembly.border_columns.push(column);
        }));
    }
    out
}
