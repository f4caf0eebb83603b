//! How trees are boosted.

/// How trees are boosted.
#[derive(Debug, Clone, PartialEq)]
pub struct BoostingSettings {
    /// Rounds of one tree a class.
    pub rounds: usize,
    /// Learning rate.
    pub rate: f64,
    /// Leaves of a tree, at most.
    pub leaves: usize,
    /// Rows of a leaf, at least.
    pub least_rows: usize,
    /// Ridge of a leaf's value.
    pub l2: f64,
    /// Gain of a split, at least.
    pub least_gain: f64,
    /// Share of the columns that a tree sees.
    pub columns: f64,
    /// Share of the rows that a round sees.
    pub rows: f64,
    /// Seed of the draws.
    pub seed: u64,
}

impl Default for BoostingSettings {
    /// Small trees of few columns: many columns of evidence say much the same.
    fn default() -> Self {
        Self {
            rounds: 160,
            rate: 0.08,
            leaves: 20,
            least_rows: 15,
            l2: 3.0,
            least_gain: 0.01,
            columns: 0.25,
            rows: 0.7,
            seed: 1,
        }
    }
}
