//! What is fitted: two borders, a composition of effects as plain data, and the parameters linear given the effects' nonlinear ones.

pub(crate) mod assembly;
pub(crate) mod borders;
pub(crate) mod forwards;
pub(crate) mod infinite;
pub(crate) mod linear;
pub(crate) mod parts;
pub(crate) mod sensor;
pub(crate) mod stability;
