//! Models that leave the diagnosis: everything that a fitted model needs to run on new inputs, as plain data.

mod band;
mod causal;
mod fitted;
mod lasting;
mod place;
mod portable;
mod simulate;
#[cfg(test)]
mod tests;

pub use self::causal::LooksAhead;
pub(crate) use self::fitted::Exporter;
pub use self::portable::PortableModel;
