//! Tables as CSV.

use super::measure::Share;
use switchback_io::output::csv_cell;

/// A share as a field of a table; empty of nothing.
pub(crate) fn share_field(share: Share) -> String {
    share.value().map_or_else(String::new, |x| format!("{x:.4}"))
}

/// A table as CSV.
///
/// # Panics
/// If a row is not as long as the header.
pub fn csv(header: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header).expect("writing to memory");
    for row in rows {
        let row = row.iter().map(|cell| csv_cell(cell));
        writer.write_record(row).expect("writing to memory, each row as long as the header");
    }
    String::from_utf8(writer.into_inner().expect("writing to memory")).expect("every field is UTF-8")
}
