//! What is true of a pair.

use super::row::Row;

/// Who has an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// The simulator alone.
    A,
    /// The machine alone.
    B,
    /// Both, each at a size of its own.
    Both,
}

/// The one thing that two sources differ in.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The line of the table.
    pub row: Row,
    /// Its value in A, in the unit of [`Row`]; of an effect its magnitude, zero where A has none.
    pub in_a: f64,
    /// Its value in B.
    pub in_b: f64,
    /// The effect with its law, and who has it.
    pub effect: Option<(&'static str, &'static str, Side)>,
}

/// What is true of a pair.
#[derive(Debug, Clone, PartialEq)]
pub struct PairTruth {
    /// What differs.
    pub difference: Difference,
    /// Root mean square of what the difference changes in the output, over that of B's noise. Noise that only B has counts.
    pub size: f64,
    /// Whether A are records too, with noise of their own.
    pub is_measured: bool,
    /// Order of B's linear part.
    pub order: usize,
    /// Kind of borders.
    pub borders: &'static str,
    /// B's noise as a share of its output's standard deviation.
    pub noise: f64,
}
