//! MATLAB files: v5 to v7 and, as HDF5, v7.3. Numeric vectors of equal length are columns, matrices are several.

#[cfg(feature = "matlab")]
use crate::table::{Column, Place, empty_column};
use crate::table::{DataError, DataProblem, Table, TableError};
use std::path::Path;

/// Whether a file is MATLAB's: by its ending, or its first bytes where it has none.
pub(crate) fn is_matlab(path: &Path, bytes: &[u8]) -> bool {
    /// How a file in format v5 or v7.3 begins.
    const TEXT: &[u8] = b"MATLAB ";
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mat"))
        || path.extension().is_none() && bytes.starts_with(TEXT)
}

#[cfg(not(feature = "matlab"))]
pub(crate) fn read(path: &Path, _bytes: Vec<u8>) -> Result<Table, TableError> {
    Err(unreadable(path, "this program was built without the feature `matlab`".to_owned()))
}

/// Reads the numeric arrays of a MATLAB file.
///
/// # Errors
/// Bytes that are no such file, or hold no two vectors of one length.
#[cfg(feature = "matlab")]
pub(crate) fn read(path: &Path, bytes: Vec<u8>) -> Result<Table, TableError> {
    let is_hdf5 = hdf5_pure::is_hdf5_bytes(&bytes);
    let arrays = if is_hdf5 { hdf5(bytes) } else { matlab5(&bytes) };
    let arrays = arrays.map_err(|reason| unreadable(path, reason))?;
    table(path, arrays)
}

fn unreadable(path: &Path, reason: String) -> TableError {
    let path = path.display().to_string();
    TableError::Data(DataError { path, place: None, problem: DataProblem::NotMatlab { reason } })
}

#[cfg(feature = "matlab")]
mod array;
#[cfg(feature = "matlab")]
mod formats;
#[cfg(feature = "matlab")]
use array::Array;
#[cfg(feature = "matlab")]
use formats::{hdf5, matlab5};

/// The arrays as columns: those whose length most of them share.
#[cfg(feature = "matlab")]
fn table(path: &Path, arrays: Vec<Array>) -> Result<Table, TableError> {
    if let Some(array) = arrays.iter().find(|array| !array.is_whole()) {
        let [rows, columns] = array.size;
        let reason = format!(
            "`{}` is said to have {rows} rows and {columns} columns, but its contents are others",
            array.name
        );
        return Err(unreadable(path, reason));
    }
    let full = arrays.into_iter().filter(|array| !array.values.is_empty());
    let columns: Vec<(String, Vec<f64>)> = full.flat_map(columns).collect();
    let lengths: Vec<usize> = columns.iter().map(|(_, values)| values.len()).filter(|len| *len > 1).collect();
    let shared = |len: &usize| lengths.iter().filter(|other| *other == len).count();
    let rows = lengths.iter().copied().max_by_key(|len| (shared(len), *len));
    let Some(rows) = rows.filter(|rows| shared(rows) >= 2) else {
        return Err(unreadable(path, "there are no two numeric vectors of the same length".to_owned()));
    };
    let (taken, left): (Vec<_>, Vec<_>) = columns.into_iter().partition(|(_, values)| values.len() == rows);
    let mut notes = vec!["MATLAB file".to_owned()];
    if !left.is_empty() {
        let names: Vec<&str> = left.iter().map(|(name, _)| name.as_str()).collect();
        notes.push(format!("arrays of another length left out: {}", names.join(", ")));
    }
    let column = |(name, values): (String, Vec<f64>)| {
        let (name, unit) = crate::table::unit::split(&name);
        Column { values, ..empty_column(name, unit) }
    };
    Ok(Table {
        path: path.display().to_string(),
        columns: taken.into_iter().map(column).collect(),
        places: (1..=rows as u64).map(Place::Row).collect(),
        has_header: true,
        notes,
        ..Table::default()
    })
}

/// A vector lies either way; the columns of a matrix get their number after its name.
#[cfg(feature = "matlab")]
fn columns(array: Array) -> Vec<(String, Vec<f64>)> {
    let Array { name, size: [rows, count], values } = array;
    // An infinite value is as useless as a missing one.
    let values: Vec<f64> = values.into_iter().map(|x| if x.is_finite() { x } else { f64::NAN }).collect();
    if rows == 1 || count == 1 {
        return vec![(name, values)];
    }
    let column = |k: usize| (format!("{name} {}", k + 1), values[k * rows..(k + 1) * rows].to_vec());
    (0..count).map(column).collect()
}
