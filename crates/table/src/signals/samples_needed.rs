//! How long a record must be.

/// Equations of order n reach back n samples and have 2n coefficients and at least two border values; one sample more
/// leaves a residual. Ten at the least, since no order at all can be chosen from fewer.
pub fn samples_needed(order: Option<usize>) -> usize {
    order.map_or(10, |n| (3 * n + 3).max(10))
}
