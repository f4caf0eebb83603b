//! Borders with jumps.

use super::border_error::increasing_entries;
use super::{BorderError, BorderPair, Branch};

/// One straight piece of a discontinuous border, from a position to the next piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Where the piece begins, input units.
    pub from: f64,
    /// Its value there, `u` units.
    pub value: f64,
    /// Its slope, `u` units per input unit.
    pub slope: f64,
}

/// Borders made of straight pieces that need not meet.
///
/// ```text
/// C(v) = value_k + slope_k·(v − from_k),   from_k ≤ v < from_{k+1}
/// ```
///
/// The first piece goes on to the left and the last to the right without end. At a jump the border takes the value of
/// the piece that begins there. Positions in input units, strictly increasing; at least one piece a border.
///
/// Reference: the SYSID 2009 paper, which asks for no continuity of the borders.
///
/// ```
/// use switchback_estimator::hysteresis::{BorderPair, Discontinuous, Piece};
/// let up = vec![Piece { from: -1.0, value: -1.0, slope: 0.5 }, Piece { from: 0.0, value: 1.0, slope: 0.0 }];
/// let down = vec![Piece { from: 0.0, value: -0.5, slope: 0.5 }];
/// let borders = Discontinuous::new(up, down)?;
/// assert_eq!((borders.ascending(-0.5), borders.ascending(0.0)), (-0.75, 1.0));
/// assert_eq!(borders.descending(-1.0), -1.0);
/// # Ok::<(), switchback_estimator::hysteresis::BorderError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Discontinuous {
    ascending: Vec<Piece>,
    descending: Vec<Piece>,
}

impl Discontinuous {
    /// Joins the pieces of the two borders.
    ///
    /// # Errors
    /// [`BorderError::Empty`], [`BorderError::NotFinite`], or [`BorderError::NotIncreasing`].
    pub fn new(ascending: Vec<Piece>, descending: Vec<Piece>) -> Result<Self, BorderError> {
        for (branch, pieces) in [(Branch::Ascending, &ascending), (Branch::Descending, &descending)] {
            increasing_entries(branch, pieces, |p| {
                [("from", p.from), ("value", p.value), ("slope", p.slope)]
            })?;
        }
        Ok(Self { ascending, descending })
    }
}

impl BorderPair for Discontinuous {
    fn ascending(&self, v: f64) -> f64 {
        piecewise(&self.ascending, v)
    }

    fn descending(&self, v: f64) -> f64 {
        piecewise(&self.descending, v)
    }
}

fn piecewise(pieces: &[Piece], v: f64) -> f64 {
    let begun = pieces.partition_point(|piece| piece.from <= v);
    let piece = &pieces[begun.saturating_sub(1)];
    piece.value + piece.slope * (v - piece.from)
}
