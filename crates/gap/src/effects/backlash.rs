//! Play between the recorded input and the operator.
//!
//! ```text
//! p(t) = p(t−1) unless |v − p| exceeds half the play; u = F[p]
//! ```
//!
//! Parameter: full width `play`, in strokes (0.0003…0.7). Stage: operator. It leaves a rest of `u` after each reversal, for a
//! travel equal to the play; the shift `v ∓ play/2` along the branches is absorbed by the borders, so designed
//! pulse experiments alone do not see it. Confused with: gradual transition (the jump at the end of the rest tells),
//! a reversal threshold against noise on `v`.

use super::{Search, Variant, own};

pub(super) fn variants() -> Vec<Variant> {
    // The profile is not smooth: a width off by half has lost the trace.
    let widths = std::iter::successors(Some(0.0006), |w| Some(1.5 * w)).take_while(|w| *w < 0.6);
    let starts = widths.map(|w: f64| vec![own("play", "strokes", w, (0.0003, 0.7), 0.16 * w)]).collect();
    let mut variant = Variant::new(starts, |p, assembly| assembly.play = p[0]);
    variant.search = Search::Profile;
    vec![variant]
}
