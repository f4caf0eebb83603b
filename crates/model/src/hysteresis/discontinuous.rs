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
/// use switchback_model::hysteresis::{BorderPair, Discontinuous, Piece};
/// let up = vec![Piece { from: -1.0, value: -1.0, slope: 0.5 }, Piece { from: 0.0, value: 1.0, slope: 0.0 }];
/// let down = vec![Piece { from: 0.0, value: -0.5, slope: 0.5 }];
/// let borders = Discontinuous::new(up, down)?;
/// assert_eq!((borders.ascending(-0.5), borders.ascending(0.0)), (-0.75, 1.0));
/// assert_eq!(borders.descending(-1.0), -1.0);
/// # Ok::<(), switchback_model::hysteresis::BorderError>(())
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

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(from: f64, value: f64) -> Piece {
        Piece { from, value, slope: 0.0 }
    }

    #[test]
    fn every_position_belongs_to_exactly_one_piece() {
        let up = vec![flat(-1.0, 1.0), flat(0.0, 2.0), flat(0.5, 3.0)];
        let borders = Discontinuous::new(up, vec![flat(0.0, 0.0)]).unwrap();
        let values = [-9.0, -1.0, -0.001, 0.0, 0.499, 0.5, 9.0].map(|v| borders.ascending(v));
        assert_eq!(values, [1.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
    }

    #[test]
    fn the_outer_pieces_go_on_with_their_slopes() {
        let line = Piece { from: 0.0, value: 1.0, slope: 2.0 };
        let borders = Discontinuous::new(vec![line], vec![line]).unwrap();
        assert_eq!((borders.ascending(-3.0), borders.descending(3.0)), (-5.0, 7.0));
    }

    #[test]
    fn a_border_without_pieces_is_refused() {
        let error = Discontinuous::new(vec![], vec![flat(0.0, 0.0)]).unwrap_err();
        assert_eq!(error.to_string(), "ascending is an empty list: give at least one entry");
    }

    #[test]
    fn pieces_out_of_order_are_refused_by_entry() {
        let error =
            Discontinuous::new(vec![flat(0.0, 0.0)], vec![flat(0.5, 0.0), flat(0.5, 1.0)]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "descending[1].from = 0.5 follows 0.5: positions must strictly increase; sort them and drop repetitions"
        );
    }

    #[test]
    fn a_slope_that_is_not_finite_is_refused_by_entry() {
        let steep = Piece { slope: f64::INFINITY, ..flat(1.0, 0.0) };
        let error = Discontinuous::new(vec![flat(0.0, 0.0), steep], vec![flat(0.0, 0.0)]).unwrap_err();
        assert_eq!(error.to_string(), "ascending[1].slope = inf: give a finite number");
    }
}
