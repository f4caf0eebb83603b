//! Sufficient statistics of an autoregression whose input part is constant within groups of samples.

/// Counts, group sums and lag products: all that a least-squares fit of
///
/// ```text
/// y(t) = −Σᵢ aᵢ y(t−i) + x_{q(t)}ᵀη + ξ(t),   i = 1…n
/// ```
///
/// can use of a record, when the regressor `x` takes one known value a group `q`.
///
/// ```text
/// K_q    = #{t : q(t) = q}                  counts,       length Q
/// S_q,l  = Σ_{t : q(t) = q} y(t−l)          group sums,   Q × (n+1), l = 0…n
/// P_i,l  = Σ_t y(t−i) y(t−l)                lag products, (n+1) × (n+1), symmetric
/// ```
///
/// Counts are real numbers so that expectations, which are the same statistics of a typical record, fit too.
/// In the pulse experiments with spacing `s ≥ n` at most one pulse is inside the lag window, so the groups are the
/// satellite and the pairs (level, lag): the nm pulse columns of (3.21) have disjoint supports.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupedStatistics {
    order: usize,
    counts: Vec<f64>,
    sums: Vec<f64>,
    products: Vec<f64>,
}

impl GroupedStatistics {
    /// Empty statistics of an autoregression of order `order` over `groups` groups.
    pub fn new(order: usize, groups: usize) -> Self {
        let width = order + 1;
        Self {
            order,
            counts: vec![0.0; groups],
            sums: vec![0.0; groups * width],
            products: vec![0.0; width * width],
        }
    }

    /// Assembles statistics computed elsewhere; shapes as in the type's formula, rows first.
    ///
    /// # Panics
    /// If a shape does not fit `order` and the number of counts.
    pub fn from_parts(order: usize, counts: Vec<f64>, sums: Vec<f64>, products: Vec<f64>) -> Self {
        assert_eq!(sums.len(), counts.len() * (order + 1), "one sum a group and lag");
        assert_eq!(products.len(), (order + 1) * (order + 1), "one product a pair of lags");
        Self { order, counts, sums, products }
    }

    /// Adds one sample: `window[l] = y(t−l)`, `l = 0…n`.
    ///
    /// # Panics
    /// If the window is shorter than `n + 1` or the group does not exist.
    pub fn push(&mut self, group: usize, window: &[f64]) {
        let width = self.width();
        self.counts[group] += 1.0;
        for l in 0..width {
            self.sums[group * width + l] += window[l];
            for i in 0..=l {
                self.products[i * width + l] += window[i] * window[l];
            }
        }
        for l in 0..width {
            for i in 0..l {
                self.products[l * width + i] = self.products[i * width + l];
            }
        }
    }

    /// The order `n` of the autoregression.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Number of groups `Q`.
    pub fn groups(&self) -> usize {
        self.counts.len()
    }

    /// Number of samples `N`.
    pub fn samples(&self) -> f64 {
        self.counts.iter().sum()
    }

    /// `K_q`.
    pub fn count(&self, group: usize) -> f64 {
        self.counts[group]
    }

    /// `S_q,l`.
    pub fn sum(&self, group: usize, lag: usize) -> f64 {
        self.sums[group * self.width() + lag]
    }

    /// `P_i,l`.
    pub fn product(&self, i: usize, l: usize) -> f64 {
        self.products[i * self.width() + l]
    }

    /// `Σ_t y(t−l)` over all groups.
    pub(crate) fn total(&self, lag: usize) -> f64 {
        (0..self.groups()).map(|q| self.sum(q, lag)).sum()
    }

    /// The statistics of `y − level`, exactly.
    pub(crate) fn shifted(&self, level: f64) -> Self {
        let width = self.width();
        let samples = self.samples();
        let totals: Vec<f64> = (0..width).map(|l| self.total(l)).collect();
        let mut shifted = self.clone();
        for (q, row) in shifted.sums.chunks_exact_mut(width).enumerate() {
            row.iter_mut().for_each(|s| *s -= level * self.counts[q]);
        }
        for i in 0..width {
            for l in 0..width {
                shifted.products[i * width + l] -= level * (totals[i] + totals[l] - samples * level);
            }
        }
        shifted
    }

    /// The statistics of several records under one autoregression: groups side by side, lag products added.
    ///
    /// # Panics
    /// If the orders differ or there is no record.
    pub(crate) fn stacked(parts: &[&Self]) -> Self {
        let order = parts.first().expect("at least one record").order;
        let mut stacked = Self::new(order, 0);
        for part in parts {
            assert_eq!(part.order, order, "one autoregression has one order");
            stacked.counts.extend_from_slice(&part.counts);
            stacked.sums.extend_from_slice(&part.sums);
            for (sum, p) in stacked.products.iter_mut().zip(&part.products) {
                *sum += p;
            }
        }
        stacked
    }

    /// The statistics of two records that share their groups.
    ///
    /// # Panics
    /// If orders or groups differ.
    pub fn merged(&self, other: &Self) -> Self {
        assert_eq!((self.order, self.groups()), (other.order, other.groups()), "the same groups");
        let add = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x + y).collect();
        Self {
            order: self.order,
            counts: add(&self.counts, &other.counts),
            sums: add(&self.sums, &other.sums),
            products: add(&self.products, &other.products),
        }
    }

    fn width(&self) -> usize {
        self.order + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn collect(y: &[f64], groups: usize) -> GroupedStatistics {
        let mut statistics = GroupedStatistics::new(2, groups);
        for t in 2..y.len() {
            statistics.push(t % groups, &[y[t], y[t - 1], y[t - 2]]);
        }
        statistics
    }

    proptest! {
        #[test]
        fn shifting_the_statistics_is_shifting_the_record(y in prop::collection::vec(-5.0..5.0_f64, 12..40), level in -3.0..3.0_f64) {
            let moved: Vec<f64> = y.iter().map(|x| x - level).collect();
            let (fast, slow) = (collect(&y, 3).shifted(level), collect(&moved, 3));
            for (f, s) in fast.products.iter().chain(&fast.sums).zip(slow.products.iter().chain(&slow.sums)) {
                prop_assert!((f - s).abs() < 1e-10);
            }
        }
    }
}
