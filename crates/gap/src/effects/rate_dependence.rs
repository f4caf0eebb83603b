//! The borders depend on the speed of the input.
//!
//! ```text
//! u = C(v) + c·branch·(r/r₀)^power,   r = |v(t) − v(t−1)|, r₀ its median
//! ```
//!
//! Parameter: `power` (0.1…3); the coefficient is estimated with the borders. Stage: operator. Fast records have wider loops
//! than slow ones. While the input rests, the term keeps its last value or vanishes. Confused with: Stribeck
//! friction (which falls with speed), creep.

use super::{Scene, Variant, own, typical_speed};
use crate::assembly::{BorderColumn, Resting};

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let scale = typical_speed(scene.campaign);
    let mut out = Vec::new();
    for while_resting in [Resting::Held, Resting::Zero] {
        let starts = [0.4, 1.2].iter().map(|&p| vec![own("power", "1", p, (0.1, 3.0), 0.02)]).collect();
        out.push(Variant::conditional(starts, move |p, assembly| {
            assembly.border_columns.push(BorderColumn::Speed { power: p[0], scale, while_resting });
        }));
    }
    out
}
