//! What is negligible, what matters, and how seldom a false alarm may come.

/// Limits of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// A difference of bias that matters, in standard deviations of the baseline.
    ///
    /// A bias of a tenth takes 95 % intervals to 94.9 %, one of four tenths to 93.2 %: W. G. Cochran, *Sampling Techniques*, 3rd ed., Wiley 1977, section 1.8.
    pub bias: f64,
    /// A difference of standard deviations that matters: logarithm of their ratio.
    pub sd: f64,
    /// A difference of failures that matters: share of the replicates.
    pub failures: f64,
    /// How often two versions without a difference beyond the negligible one may give an alarm, over all cells and parameters together.
    pub false_alarms: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { bias: 0.1, sd: 0.1, failures: 0.01, false_alarms: 0.01 }
    }
}

impl Limits {
    /// Up to this share of what matters a difference gives no alarm, however certain it is.
    pub(super) const NEGLIGIBLE: f64 = 0.5;

    /// How often one version may be called equivalent that is not: the level of each of two one-sided tests. D. J. Schuirmann, *Journal of
    /// Pharmacokinetics and Biopharmaceutics* 15 (1987), pp. 657–680.
    pub(super) const EQUIVALENCE: f64 = 0.05;

    /// How often a difference is overlooked from which on it is said to be found.
    pub(super) const OVERLOOKED: f64 = 0.05;
}
