//! What is fitted: two borders, a composition of effects as plain data, and the parameters linear given the effects' nonlinear ones.

pub(crate) mod augmented;
pub(crate) mod borders;
pub(crate) mod effect_terms;
pub(crate) mod infinite;
pub(crate) mod linear;
pub(crate) mod sensor;
pub(crate) mod sensor_polynomial;
pub(crate) mod stability;
