//! What is left: tests of the residuals against causes in general, their spectra and scores.

pub(crate) mod clustering;
pub(crate) mod horizons;
pub(crate) mod noise_size;
pub(crate) mod omnibus;
pub(crate) mod quantisation_grid;
pub(crate) mod score;

/// Lags of the Ljung–Box statistic.
const LAGS: usize = 20;
