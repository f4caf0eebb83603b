//! Designed experiments: what to drive the input with.
