//! All tests of the estimators in one binary: linked once, and run side by side.

mod control_mean;
mod dataset;
mod doubts;
mod excitation;
mod finite_sample;
mod free;
mod hysteresis;
mod input_noise;
mod instrumental;
mod invariance;
mod lanes;
mod morris;
mod oracle;
mod pulse_methods;
mod second_order_term;
mod stray;
mod structure;
mod support;
mod sweep;
mod undersmoothing;
