//! How large an effect must be for a wanted surviving gap.
//!
//! The *size* of an effect is what survives the best nominal re-fit, in standard deviations of the rig's noise:
//!
//! ```text
//! size = √(V_refit / V_oracle − 1)
//! ```
//!
//! `V_refit` is the one-step residual variance of the best nominal re-fit on the fit records, `V_oracle` that of a
//! model which knows the effect. For a systematic effect `V_oracle = σ²` and size·σ is the RMS of what the re-fit could
//! not absorb; for a noise effect `½·ln(1 + size²)` is the predictive gain, in nats per sample, that knowing it brings.

/// The magnitude found, and the size it really has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sized {
    /// Magnitude in the law's unit.
    pub magnitude: f64,
    /// Size reached; below the wanted one where the law's limit does not allow more.
    pub size: f64,
}

const STEPS_UP: i32 = 18;
const BISECTIONS: usize = 24;
/// Sizes are met to this share.
const TOLERANCE: f64 = 0.01;

/// Smallest magnitude in `(0, limit]` at which `size_of` reaches `wanted`; else the one that comes closest.
///
/// Climbs from `limit·2⁻¹⁸` in doublings to the first crossing, then bisects: sizes need not grow with magnitude everywhere
/// (a pole at 1 becomes a constant), but the first crossing is the effect one would call small.
pub(crate) fn magnitude_for(wanted: f64, limit: f64, mut size_of: impl FnMut(f64) -> f64) -> Sized {
    let mut best = Sized { magnitude: 0.0, size: 0.0 };
    let mut below = 0.0;
    for step in (0..=STEPS_UP).rev() {
        let magnitude = limit * 0.5_f64.powi(step);
        let size = size_of(magnitude);
        if size < wanted {
            below = magnitude;
            if size > best.size {
                best = Sized { magnitude, size };
            }
            continue;
        }
        let mut above = Sized { magnitude, size };
        for _ in 0..BISECTIONS {
            if (above.size / wanted - 1.0).abs() < TOLERANCE {
                break;
            }
            let middle = 0.5 * (below + above.magnitude);
            let size = size_of(middle);
            if size < wanted {
                below = middle;
                if wanted / size - 1.0 < TOLERANCE {
                    return Sized { magnitude: middle, size };
                }
            } else {
                above = Sized { magnitude: middle, size };
            }
        }
        return above;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crossing_is_found_to_the_tolerance() {
        let found = magnitude_for(2.0, 10.0, |x| x * x);
        assert!((found.magnitude - 2.0_f64.sqrt()).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn out_of_reach_returns_the_closest() {
        let found = magnitude_for(2.0, 1.0, |x| x * (1.5 - x));
        assert_eq!(found.magnitude, 1.0 * 0.5);
        assert!((found.size - 0.5).abs() < 1e-12);
    }
}
