//! What is taken of a table.

/// The columns taken, and the rows they come from.
pub(super) struct Series {
    pub(super) v: Vec<f64>,
    pub(super) y: Option<Vec<f64>>,
    pub(super) predicted: Option<Vec<f64>>,
    pub(super) rows: Vec<usize>,
}
