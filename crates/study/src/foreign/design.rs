//! What is known of the records of a cell.

use switchback_identify::excitation::Direction;

/// What an estimator may know of the records of a cell: how they were made, and nothing of the system.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// Place of the cell in the results.
    pub cell: usize,
    /// Order `n` that methods assume.
    pub order: usize,
    /// Points `m` on each border.
    pub points: usize,
    /// `N`: regression samples of each record.
    pub samples: usize,
    /// Where the input may go, `h_m` and `h_M`.
    pub interval: [f64; 2],
    /// Names of the parameters that are asked for.
    pub parameters: Vec<String>,
    /// Descendant and ascendant experiment.
    pub experiments: [DesignExperiment; 2],
}

/// One pulse experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignExperiment {
    /// Which one.
    pub direction: Direction,
    /// `V₁…V_m`, input units.
    pub levels: Vec<f64>,
    /// Where the input rests between visits.
    pub satellite: f64,
    /// Samples before `t = 0`, which serve as lags only.
    pub lead: usize,
    /// `v(t)`, `t = −lead…N−1`.
    pub v: Vec<f64>,
}
