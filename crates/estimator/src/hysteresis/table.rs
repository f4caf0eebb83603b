//! Borders given by points.

use super::border_error::increasing_entries;
use super::{BorderError, BorderPair, Branch};

/// One point of a tabulated border.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TablePoint {
    /// Position, input units.
    pub v: f64,
    /// Value there, `u` units.
    pub u: f64,
}

/// Borders given by tables of points, straight between them and constant beyond the ends.
///
/// ```text
/// C(v) = u_k + (u_{k+1} − u_k)·(v − v_k)/(v_{k+1} − v_k),   v_k ≤ v ≤ v_{k+1}
///        u_1 for v < v_1,   u_K for v > v_K
/// ```
///
/// Positions in input units, strictly increasing; at least one point a border; the borders may have different points.
/// At a point the border takes its value exactly.
///
/// ```
/// use switchback_estimator::hysteresis::{BorderPair, Table, TablePoint};
/// let up = vec![TablePoint { v: -1.0, u: 0.0 }, TablePoint { v: 1.0, u: 4.0 }];
/// let borders = Table::new(up, vec![TablePoint { v: 0.0, u: -1.0 }])?;
/// assert_eq!([-3.0, -1.0, 0.0, 1.0, 2.0].map(|v| borders.ascending(v)), [0.0, 0.0, 2.0, 4.0, 4.0]);
/// assert_eq!(borders.descending(0.7), -1.0);
/// # Ok::<(), switchback_estimator::hysteresis::BorderError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    ascending: Vec<TablePoint>,
    descending: Vec<TablePoint>,
}

impl Table {
    /// Joins the tables of the two borders.
    ///
    /// # Errors
    /// [`BorderError::Empty`], [`BorderError::NotFinite`], or [`BorderError::NotIncreasing`].
    pub fn new(ascending: Vec<TablePoint>, descending: Vec<TablePoint>) -> Result<Self, BorderError> {
        for (branch, points) in [(Branch::Ascending, &ascending), (Branch::Descending, &descending)] {
            increasing_entries(branch, points, |p| [("v", p.v), ("u", p.u)])?;
        }
        Ok(Self { ascending, descending })
    }
}

impl BorderPair for Table {
    fn ascending(&self, v: f64) -> f64 {
        interpolate(&self.ascending, v)
    }

    fn descending(&self, v: f64) -> f64 {
        interpolate(&self.descending, v)
    }
}

fn interpolate(points: &[TablePoint], v: f64) -> f64 {
    let right = points.partition_point(|point| point.v <= v);
    if right == 0 {
        return points[0].u;
    }
    let from = points[right - 1];
    match points.get(right) {
        Some(to) => from.u + (to.u - from.u) * ((v - from.v) / (to.v - from.v)),
        None => from.u,
    }
}
