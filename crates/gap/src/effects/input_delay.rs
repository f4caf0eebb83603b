//! The input acts later than recorded.
//!
//! ```text
//! ũ(t) = (1−δ)·u(t−k) + δ·u(t−k−1),            delay = k + δ      the actuator's response is late
//! ũ(t) = F[(1−δ)·v + δ·v(·−1)](t−k)                                the positions are
//! ```
//!
//! Parameter: `delay` in samples (0…10). Stage: input. Confused with: extra pole, resonance (all delay the response).

use super::{Variant, outlasts_the_records, own};
use crate::engine::Own;

pub(super) fn variants() -> Vec<Variant> {
    let starts: Vec<_> = [0.15, 0.4, 0.6, 0.85, 1.15, 1.4, 1.6, 1.85, 2.2, 2.5, 2.8, 3.3, 3.7, 5.0]
        .iter()
        .map(|&d| vec![own("delay", "samples", d, (0.0, 10.0), 0.02)])
        .collect();
    let response = Variant::conditional(starts.clone(), |p, assembly| assembly.delay = p[0]);
    let positions = Variant::conditional(starts, |p, assembly| {
        assembly.delay = p[0].floor();
        assembly.late = p[0] - assembly.delay;
    });
    // B takes a whole sample where it has room: every whole sample is a valley of its own.
    let whole = |own: &[Own]| own[0].value.floor() as i64;
    [response, positions]
        .map(|law| law.sound_if(|_, fit| !outlasts_the_records(fit)))
        .map(|law| Variant { climbs: law.starts.len(), valley: Some(whole), ..law })
        .into()
}
