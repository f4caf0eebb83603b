//! Logs of cars in MDF 4 (ASAM): groups of channels, each group with records at instants of its own.
//!
//! Every channel of numbers is a column in its unit, converted as the log says. Names that stand in several groups are preceded by that of the
//! group: `engine.speed`. Words, arrays, formulas, and data stored by columns are left out.

use crate::chosen::Choice;
use crate::table::{DataError, DataProblem, Table, TableError};
use std::path::Path;

#[cfg(feature = "mdf")]
mod channel;
#[cfg(feature = "mdf")]
mod columns;
#[cfg(feature = "mdf")]
mod conversion;
#[cfg(feature = "mdf")]
mod fault;
#[cfg(feature = "mdf")]
mod number;
#[cfg(feature = "mdf")]
mod pieces;
#[cfg(feature = "mdf")]
mod records;
#[cfg(feature = "mdf")]
mod source;
#[cfg(all(test, feature = "mdf"))]
mod tests;
#[cfg(feature = "mdf")]
mod tree;

/// How such a log begins: one that is whole, and one whose writer did not finish it.
const MAGIC: [&[u8]; 2] = [b"MDF     ", b"UnFinMF "];

/// Whether a file is one: by its ending, or its first bytes.
pub(crate) fn is_mdf(path: &Path, bytes: &[u8]) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mf4"))
        || MAGIC.iter().any(|magic| bytes.starts_with(magic))
}

fn unreadable(path: &Path, reason: String) -> TableError {
    let path = path.display().to_string();
    TableError::Data(DataError { path, place: None, problem: DataProblem::NotMdf { reason } })
}

#[cfg(not(feature = "mdf"))]
pub(crate) fn read(path: &Path, _choice: Choice<'_>) -> Result<Table, TableError> {
    Err(unreadable(path, "this program was built without the feature `mdf`".to_owned()))
}

/// The columns chosen, with their clocks; the first records of all where nothing can be chosen.
///
/// # Errors
/// A file that is no such log, or holds no numbers that can be read.
#[cfg(feature = "mdf")]
pub(crate) fn read(path: &Path, choice: Choice<'_>) -> Result<Table, TableError> {
    /// Numbers looked at to see what there is: 128 MiB.
    const FIRST: usize = 1 << 24;
    /// Most numbers of a table, which is kept whole: 2 GiB.
    const MOST: usize = 1 << 28;
    let file = crate::door::open(path).map_err(TableError::File)?;
    chosen(file, path, [FIRST, MOST], choice).map_err(|fault| unreadable(path, fault.to_string()))
}

#[cfg(feature = "mdf")]
fn chosen(
    file: impl std::io::Read + std::io::Seek,
    path: &Path,
    [first, most]: [usize; 2],
    choice: Choice<'_>,
) -> Result<Table, fault::Fault> {
    use crate::chosen::Chosen;
    use crate::table::Column;
    use columns::Columns;
    let mut source = source::Source::of(file)?;
    let tree = tree::Tree::read(&mut source)?;
    let head = records::collect(&mut source, &tree, &|_, _| true, first);
    let columns = Columns::of(&tree, head.numbers, path)?;
    let Some(Chosen { signals, time, rivals }) = choice(&columns.table) else { return Ok(columns.table) };
    let taken: Vec<(usize, usize)> = signals.into_iter().chain(time).map(|k| columns.origins[k]).collect();
    let is_taken = |group: usize, channel: usize| {
        let is_clock = || tree.groups[group].clock == Some(channel);
        taken.contains(&(group, channel)) || is_clock() && taken.iter().any(|(of, _)| *of == group)
    };
    let name = |k: usize| format!("`{}`", columns.table.columns[k].name);
    let rivals: Vec<String> = rivals.into_iter().map(name).collect();
    let mut table = if head.is_whole {
        columns.with_only(is_taken)
    } else {
        drop(columns);
        let whole = records::collect(&mut source, &tree, &is_taken, most);
        if !whole.is_whole {
            return Err(fault::Fault::More(most));
        }
        Columns::of(&tree, whole.numbers, path)?.table
    };
    for (group, channel) in taken {
        let channel = &tree.groups[group].channels[channel];
        let is_missing =
            |column: &Column| column.name == channel.name && column.values.iter().any(|x| x.is_nan());
        if channel.may_be_word() && table.columns.iter().any(is_missing) {
            table.notes.push(format!(
                "`{}` is missing where the log has a word in place of the number",
                channel.name
            ));
        }
    }
    if !rivals.is_empty() {
        table.notes.push(format!("the log also holds {}", rivals.join(", ")));
    }
    Ok(table)
}
