//! Borders that are straight between given levels.

use switchback_model::hysteresis::BorderPair;

/// Two borders given by their values at common levels, straight in between, constant outside.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table {
    /// Levels, increasing.
    pub levels: Vec<f64>,
    /// `C_a` at the levels.
    pub ascending: Vec<f64>,
    /// `C_d` at the levels.
    pub descending: Vec<f64>,
}

impl Table {
    /// The value at `v` of a curve that is straight between the levels.
    pub(crate) fn between(&self, values: &[f64], v: f64) -> f64 {
        let above = self.levels.partition_point(|&level| level <= v);
        if above == 0 {
            return values[0];
        }
        if above == self.levels.len() {
            return values[above - 1];
        }
        let (left, right) = (self.levels[above - 1], self.levels[above]);
        let share = (v - left) / (right - left);
        values[above - 1] + (values[above] - values[above - 1]) * share
    }
}

impl BorderPair for Table {
    fn ascending(&self, v: f64) -> f64 {
        self.between(&self.ascending, v)
    }

    fn descending(&self, v: f64) -> f64 {
        self.between(&self.descending, v)
    }
}
