//! The arrays of the two formats that MATLAB writes.

use super::array::Array;
use hdf5_pure::{File, Group};
use matfile::{MatFile, NumericData};

/// Format v5, which v6 and v7 share. Structs, cells and text are passed over.
pub(super) fn matlab5(bytes: &[u8]) -> Result<Vec<Array>, String> {
    let file = MatFile::parse(bytes).map_err(|error| error.to_string())?;
    let arrays = file.arrays().iter().filter(|array| array.ndims() == 2);
    Ok(arrays
        .map(|array| Array {
            name: array.name().to_owned(),
            size: [array.size()[0], array.size()[1]],
            values: numbers(array.data()),
        })
        .collect())
}

fn numbers(data: &NumericData) -> Vec<f64> {
    match data {
        NumericData::Int8 { real, .. } => real.iter().copied().map(f64::from).collect(),
        NumericData::UInt8 { real, .. } => real.iter().copied().map(f64::from).collect(),
        NumericData::Int16 { real, .. } => real.iter().copied().map(f64::from).collect(),
        NumericData::UInt16 { real, .. } => real.iter().copied().map(f64::from).collect(),
        NumericData::Int32 { real, .. } => real.iter().copied().map(f64::from).collect(),
        NumericData::UInt32 { real, .. } => real.iter().copied().map(f64::from).collect(),
        NumericData::Int64 { real, .. } => real.iter().map(|x| *x as f64).collect(),
        NumericData::UInt64 { real, .. } => real.iter().map(|x| *x as f64).collect(),
        NumericData::Single { real, .. } => real.iter().copied().map(f64::from).collect(),
        NumericData::Double { real, .. } => real.clone(),
    }
}

/// Format v7.3: HDF5 with the axes exchanged. The fields of a struct are the datasets of a group, named `struct.field`.
pub(super) fn hdf5(bytes: Vec<u8>) -> Result<Vec<Array>, String> {
    let file = File::from_bytes(bytes).map_err(|error| error.to_string())?;
    let mut arrays = Vec::new();
    collect(&file.root(), "", &mut arrays).map_err(|error| error.to_string())?;
    Ok(arrays)
}

fn collect(group: &Group, prefix: &str, arrays: &mut Vec<Array>) -> Result<(), hdf5_pure::Error> {
    for name in group.datasets()? {
        let dataset = group.dataset(&name)?;
        // Text and other things that are no numbers are passed over.
        if let (Ok(shape), Ok(values)) = (dataset.shape(), dataset.read_f64())
            && let Some(size) = size(&shape)
        {
            arrays.push(Array { name: format!("{prefix}{name}"), size, values });
        }
    }
    // `#refs#` and `#subsystem#` hold what MATLAB needs for cells and objects.
    for name in group.groups()?.into_iter().filter(|name| !name.starts_with('#')) {
        collect(&group.group(&name)?, &format!("{prefix}{name}."), arrays)?;
    }
    Ok(())
}

/// Rows and columns as MATLAB sees them; column-major data come out column by column either way.
fn size(shape: &[u64]) -> Option<[usize; 2]> {
    let of = |x: u64| usize::try_from(x).ok();
    match *shape {
        [len] => Some([of(len)?, 1]),
        [columns, rows] => Some([of(rows)?, of(columns)?]),
        _ => None,
    }
}
