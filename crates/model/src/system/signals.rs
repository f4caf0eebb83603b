//! What laws see of a record, and what they change.

/// Where a record lies among those of a dataset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Number of the record.
    pub record: usize,
    /// Samples of the dataset before it.
    pub before: usize,
    /// Samples of the whole dataset.
    pub total: usize,
}

impl Span {
    /// A record by itself.
    pub fn alone(samples: usize) -> Self {
        Self { record: 0, before: 0, total: samples }
    }

    /// The clock of slow changes: the share of the dataset that is over, from 0 to 1.
    pub fn clock(&self, t: usize) -> f64 {
        (self.before + t) as f64 / self.total.max(1) as f64
    }
}

/// The working point between the borders: `u = mean + z·width·half + added`, one entry a sample each.
#[derive(Debug, Clone, PartialEq)]
pub struct Operator {
    /// −1 on the descending border, 1 on the ascending one.
    pub z: Vec<f64>,
    /// Width of the loop over that of the borders.
    pub width: Vec<f64>,
    /// Added to `u`, output units.
    pub added: Vec<f64>,
}
