//! Two tabulated borders, linear between knots, with jumps where a knot stands twice.

/// Knots of both borders on the dimensionless input axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grid {
    /// Descending border, then ascending border; each non-decreasing, a repeated knot is a jump.
    pub(crate) knots: [Vec<f64>; 2],
}

/// Index of a border in [`Grid::knots`] by branch.
pub(crate) fn side(branch: f64) -> usize {
    usize::from(branch > 0.0)
}

impl Grid {
    /// Number of border values of both borders together.
    pub(crate) fn len(&self) -> usize {
        self.knots[0].len() + self.knots[1].len()
    }

    /// The two border values that carry `v` on a border, with their weights (linear interpolation; constant outside).
    pub(crate) fn hat(&self, side: usize, v: f64) -> [(usize, f64); 2] {
        let knots = &self.knots[side];
        let offset = side * self.knots[0].len();
        let last = knots.len() - 1;
        // The first knot not below v: a value on a jump belongs to its left end.
        let right = knots.partition_point(|&k| k < v);
        if right == 0 {
            return [(offset, 1.0), (offset, 0.0)];
        }
        if right > last {
            return [(offset + last, 1.0), (offset + last, 0.0)];
        }
        let (l, r) = (knots[right - 1], knots[right]);
        let w = if r > l { (v - l) / (r - l) } else { 0.0 };
        [(offset + right - 1, 1.0 - w), (offset + right, w)]
    }

    /// Adds a knot; `jump` adds it twice. Returns whether anything changed.
    pub(crate) fn insert(&mut self, side: usize, v: f64, jump: bool) -> bool {
        let knots = &mut self.knots[side];
        let at = knots.partition_point(|&k| k < v);
        let present = knots[at..].iter().take_while(|&&k| k == v).count();
        let wanted = if jump { 2 } else { 1 };
        for _ in present..wanted {
            knots.insert(at, v);
        }
        present < wanted
    }
}
