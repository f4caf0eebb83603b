//! What is taken of a table.

/// The columns taken, and the rows they come from.
pub(super) struct Series {
    pub v: Vec<f64>,
    pub y: Option<Vec<f64>>,
    pub predicted: Option<Vec<f64>>,
    pub rows: Vec<usize>,
}
