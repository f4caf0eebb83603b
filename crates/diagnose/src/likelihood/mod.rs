//! Maximum likelihood: from an augmented model and the records to residuals and derivatives, whitened and weighed, and to the estimates.

pub(crate) mod design;
pub(crate) mod engine;
pub(crate) mod gains;
pub(crate) mod input_noise_whitening;
pub(crate) mod jacobian;
pub(crate) mod mask;
pub(crate) mod rows;
pub(crate) mod spectral;
pub(crate) mod uncertainty;
pub(crate) mod weights;
pub(crate) mod whitener;
