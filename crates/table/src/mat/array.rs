//! A numeric array of a MATLAB file.

/// A numeric array: its name, rows and columns, and the values column by column.
pub(super) struct Array {
    pub(super) name: String,
    pub(super) size: [usize; 2],
    pub(super) values: Vec<f64>,
}

impl Array {
    /// Whether it has as many values as its size says, which a damaged file may not: sizes there are of any number and sign.
    pub(super) fn is_whole(&self) -> bool {
        let [rows, columns] = self.size;
        rows.checked_mul(columns) == Some(self.values.len())
    }
}
