//! The regression of a method, before any data.

use super::arrow::Columns;
use super::level_rule::LevelRule;

/// The columns of a regression, and how every level is read off it.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub(crate) columns: Columns,
    /// One rule a level, one list an experiment.
    pub(crate) levels: Vec<Vec<LevelRule>>,
}
