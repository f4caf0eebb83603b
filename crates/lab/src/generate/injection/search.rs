//! The magnitude that gives a wanted size.

use super::base::Base;
use super::injection_error::InjectionError;
use crate::generate::size::magnitude_for;
use switchback_model::rig::Rig;

/// How closely a wanted size is met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Precision {
    /// The size is met to this share.
    tolerance: f64,
    /// In at most so many identifications.
    rounds: usize,
}

impl Precision {
    /// To 5 %, in at most ten identifications: where sizes are compared.
    pub const FINE: Self = Self { tolerance: 0.05, rounds: 10 };
    /// To a factor of √2, in at most three: where the size that is reached is all that counts.
    pub(crate) const COARSE: Self = Self { tolerance: 0.35, rounds: 3 };
}

/// What is searched for.
pub(crate) struct Goal {
    /// Size.
    pub size: f64,
    /// Largest magnitude.
    pub limit: f64,
    /// How closely.
    pub precision: Precision,
}

/// Largest change of the magnitude, as a factor, from one identification to the next.
const STRIDE: f64 = 4.0;

/// The records with the fault at a magnitude, and its size there.
pub(crate) struct Trial {
    pub magnitude: f64,
    pub size: f64,
    pub rig: Rig,
}

/// Finds the magnitude, up to a limit, whose surviving size is as wanted, or comes closest; `with` gives the records with the fault.
///
/// # Errors
/// Those of `with`.
pub(crate) fn search(
    base: &Base,
    Goal { size: wanted_size, limit, precision }: Goal,
    with: impl Fn(f64) -> Result<Rig, InjectionError>,
) -> Result<Trial, InjectionError> {
    // The raw size costs no identification: the search begins where that is as wanted.
    let raw = |magnitude: f64| with(magnitude).map_or(f64::INFINITY, |rig| base.raw(&rig));
    let mut tried = magnitude_for(wanted_size, limit, raw).magnitude;
    let sized = |magnitude: f64| {
        let rig = with(magnitude)?;
        let size = base.surviving(&rig);
        Ok::<_, InjectionError>(Trial { magnitude, size, rig })
    };
    let miss = |size: f64| (size / wanted_size).max(1e-9).ln().abs();
    let mut best = sized(tried)?;
    let mut last = best.size;
    for _ in 1..precision.rounds {
        let wanted = wanted_size / last.max(1e-9);
        let next = (tried * wanted.clamp(1.0 / STRIDE, STRIDE)).min(limit);
        if (wanted - 1.0).abs() < precision.tolerance || next == tried {
            break;
        }
        tried = next;
        let trial = sized(tried)?;
        last = trial.size;
        if miss(trial.size) < miss(best.size) {
            best = trial;
        }
    }
    Ok(best)
}
