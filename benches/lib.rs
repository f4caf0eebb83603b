//! Systems, experiments and seeds the benches share.
