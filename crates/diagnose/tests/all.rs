//! All tests of diagnoses in one binary: linked once, and run side by side.

mod bad_input;
mod bench;
mod differences;
mod dominant_effects;
mod given_models;
mod held_out;
mod pairs;
mod units;
