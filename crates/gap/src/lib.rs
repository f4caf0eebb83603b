//! The sim-to-real gap of a switched-hysteresis model.
