//! Play between the recorded input and the operator.
//!
//! ```text
//! p(t) = p(t−1) unless |v − p| exceeds half the play; u = F[p]
//! ```
//!
//! Parameter: full width `play`, in strokes (0.002…0.7). Stage: operator. It leaves a rest of `u` after each reversal, for a
//! travel equal to the play; the shift `v ∓ play/2` along the branches is absorbed by the borders, so designed
//! pulse experiments alone do not see it. Confused with: gradual transition (the jump at the end of the rest tells),
//! a reversal threshold against noise on `v`.

use super::{Search, Variant, own};

pub(super) fn variants() -> Vec<Variant> {
    let widths = [0.008, 0.015, 0.025, 0.04, 0.06, 0.085, 0.12, 0.16, 0.22, 0.3, 0.42];
    let starts = widths.iter().map(|&w| vec![own("play", "strokes", w, (0.002, 0.7), 0.16 * w)]).collect();
    let mut variant = Variant::new(starts, |p, assembly| assembly.play = p[0]);
    variant.search = Search::Profile;
    vec![variant]
}
