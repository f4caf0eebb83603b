//! The model that a method found.

use crate::model::{Curves, Points};

/// A model by the kind of its method.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Of the methods for any record.
    Curves(Curves),
    /// Of the methods for pulse experiments.
    Points(Points),
}
