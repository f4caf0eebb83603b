//! A record of a plan, read and divided.

use super::cut::Part;
use switchback_table::signals::Measured;

/// One record of the plan, read and divided.
pub(super) struct Divided {
    pub(super) measured: Measured,
    pub(super) parts: Vec<Part>,
}
