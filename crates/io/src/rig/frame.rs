//! Records that are in memory already: the columns of a data frame.

use super::assemble::{Loaded, assemble_tables};
use super::plan::Plan;
use super::problem::{RigError, RigProblem};
use switchback_table::table::{Cells, Table};

/// A record as columns in memory, all of the same length, which is not zero.
#[derive(Debug)]
pub struct Frame(Table);

impl Frame {
    /// Takes columns with their labels, as `force [N]`; `name` is what messages call the record.
    ///
    /// # Errors
    /// Columns of different lengths, or without a row.
    pub fn new(name: &str, columns: Vec<(String, Cells)>) -> Result<Self, RigError> {
        let refuse = |message: String, remedy: &str| {
            Err(RigProblem::Asked { message: format!("{name}: {message}"), remedy: remedy.to_owned() }.into())
        };
        let Some((first, cells)) = columns.first() else {
            return refuse("there is no column".to_owned(), "give the input and the output in two columns");
        };
        if cells.is_empty() {
            return refuse("there is no row".to_owned(), "give one row a sample");
        }
        if let Some((other, others)) = columns.iter().find(|(_, other)| other.len() != cells.len()) {
            let message =
                format!("the column `{other}` has {} rows, but `{first}` has {}", others.len(), cells.len());
            return refuse(message, "give columns of one length");
        }
        Ok(Self(Table::of_columns(name, columns)))
    }
}

/// Makes a rig of records in memory, one frame for each record of the plan, in its order. What is checked and inferred is the same as of
/// [files](super::load_plan).
///
/// # Errors
/// [`RigError`] with all that is wrong.
///
/// # Panics
/// If there is another number of frames than of records.
pub fn load_frames(plan: &Plan, frames: Vec<Frame>) -> Result<Loaded, RigError> {
    assert_eq!(plan.records.len(), frames.len(), "a frame for each record");
    let tables = frames.into_iter().map(|Frame(table)| table).collect();
    assemble_tables(plan, tables)
        .map_err(|problems| RigError::new(problems.into_iter().map(|located| located.problem).collect()))
}
