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
/// use switchback_model::hysteresis::{BorderPair, Table, TablePoint};
/// let up = vec![TablePoint { v: -1.0, u: 0.0 }, TablePoint { v: 1.0, u: 4.0 }];
/// let borders = Table::new(up, vec![TablePoint { v: 0.0, u: -1.0 }])?;
/// assert_eq!([-3.0, -1.0, 0.0, 1.0, 2.0].map(|v| borders.ascending(v)), [0.0, 0.0, 2.0, 4.0, 4.0]);
/// assert_eq!(borders.descending(0.7), -1.0);
/// # Ok::<(), switchback_model::hysteresis::BorderError>(())
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

#[cfg(test)]
mod tests {
    use super::*;

    fn points(pairs: &[(f64, f64)]) -> Vec<TablePoint> {
        pairs.iter().map(|&(v, u)| TablePoint { v, u }).collect()
    }

    #[test]
    fn each_point_is_taken_exactly() {
        let given = points(&[(-0.7, 0.1), (0.1, -0.3), (0.3, 0.9), (1.1, 0.2)]);
        let table = Table::new(given.clone(), given.clone()).unwrap();
        for point in given {
            assert_eq!((table.ascending(point.v), table.descending(point.v)), (point.u, point.u));
        }
    }

    #[test]
    fn one_point_makes_a_constant_border() {
        let table = Table::new(points(&[(0.0, 2.0)]), points(&[(0.0, -2.0)])).unwrap();
        for v in [-5.0, 0.0, 5.0] {
            assert_eq!((table.ascending(v), table.descending(v)), (2.0, -2.0));
        }
    }

    #[test]
    fn a_table_without_points_is_refused() {
        let error = Table::new(points(&[(0.0, 0.0)]), vec![]).unwrap_err();
        assert_eq!(error, BorderError::Empty { parameter: "descending".to_owned() });
    }

    #[test]
    fn points_that_do_not_increase_are_refused_by_entry() {
        let error =
            Table::new(points(&[(0.0, 0.0), (1.0, 1.0), (0.5, 2.0)]), points(&[(0.0, 0.0)])).unwrap_err();
        assert!(error.to_string().starts_with("ascending[2].v = 0.5 follows 1:"));
    }

    #[test]
    fn a_value_that_is_not_finite_is_refused_by_entry() {
        let error = Table::new(points(&[(0.0, f64::NAN)]), points(&[(0.0, 0.0)])).unwrap_err();
        assert_eq!(error.to_string(), "ascending[0].u = NaN: give a finite number");
    }
}
