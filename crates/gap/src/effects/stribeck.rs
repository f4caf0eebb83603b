//! Friction that falls as the speed rises from zero.
//!
//! ```text
//! u = C(v) + c·branch·exp(−(r/r_s)^power),   r = |v(t) − v(t−1)|
//! ```
//!
//! Parameters: Stribeck speed `r_s` in strokes per sample, `power` 1 or 2; the coefficient is estimated with the borders. Stage:
//! operator. Slow passages show a wider loop than fast ones, and only below `r_s`. Confused with: rate dependence.

use super::{Scene, Variant, own, typical_speed};
use crate::assembly::{BorderColumn, Resting};

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let typical = typical_speed(scene.campaign);
    let mut out = Vec::new();
    for while_resting in [Resting::Held, Resting::Zero] {
        for power in [1.0, 2.0] {
            let starts = [0.2, 0.7, 2.0]
                .iter()
                .map(|&s| {
                    let scale = s * typical;
                    vec![own(
                        "stribeck_speed",
                        "strokes per sample",
                        scale,
                        (0.02 * typical, 4.0 * typical),
                        0.02 * scale,
                    )]
                })
                .collect();
            out.push(Variant::conditional(starts, move |p, assembly| {
                assembly.border_columns.push(BorderColumn::LowSpeed { power, scale: p[0], while_resting });
            }));
        }
    }
    out
}
