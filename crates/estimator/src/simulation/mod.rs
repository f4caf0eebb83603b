//! Simulated records, and the noise in them.
