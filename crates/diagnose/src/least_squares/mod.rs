//! Normal equations of sparse and dense rows, summed up block by block, and their damped solution.

pub(crate) mod dense_sums;
pub(crate) mod mixed_sums;
pub(crate) mod normal;
