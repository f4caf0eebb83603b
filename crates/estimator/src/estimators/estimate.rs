//! What every method returns.

/// One estimated point of a border.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BorderPoint {
    /// Position on the input axis, input units.
    pub v: f64,
    /// `F̂` at `v`, in the normalisation `u_M − u_m = 1`.
    pub f: f64,
    /// Standard error of `f`.
    pub se: f64,
}

/// An identified system in the paper's normalisation `u_M − u_m = 1`.
///
/// `gain` restores output units: `gain·f` is the stationary output that a border value `f` holds, and
/// `gain = B̂(1)/Â(1)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// `a₁…aₙ`.
    pub a: Vec<f64>,
    /// Their standard errors.
    pub a_se: Vec<f64>,
    /// `b₁…bₙ`, output units per normalised `u`.
    pub b: Vec<f64>,
    /// Their standard errors.
    pub b_se: Vec<f64>,
    /// Extra whole samples of delay between `u` and `y`: `B` acts on `u(t−1−delay)` and older; zero in the paper. −1 is a
    /// direct term `b₀u(t)` before `b₁…bₙ`; lower values look ahead, as where the sensor of `v` lags.
    pub delay: isize,
    /// Standard deviation of the equation error, output units.
    pub noise_sd: f64,
    /// `B̂(1)/Â(1)`, output units per normalised `u`.
    pub gain: f64,
    /// Stationary output with the working point at `(h_M, u_M)`.
    pub y_high: f64,
    /// Stationary output with the working point at `(h_m, u_m)`.
    pub y_low: f64,
    /// Points of the descending border, by increasing `v`; empty where the method does not see it.
    pub descending: Vec<BorderPoint>,
    /// Points of the ascending border, by increasing `v`; empty where the method does not see it.
    pub ascending: Vec<BorderPoint>,
    /// Smallest eigenvalue of the information matrix, per sample, in squared output units or input units as the
    /// method's regressors have them: the excitation the record really gave.
    pub excitation: f64,
    /// Samples that entered the regression.
    pub samples: usize,
}
