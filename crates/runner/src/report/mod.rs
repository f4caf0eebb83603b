//! What a finished study shows: the table on the terminal, and the files of the report.
//!
//! Nothing is printed or written here; callers get text and [`Artefacts`].

mod page;
mod paired;
mod row;
mod table;

pub use table::table;

use crate::output::Artefacts;
use crate::plots;
use crate::results::{Results, to_csv, to_json};

/// The files of a report: `results.json`, `table.csv`, `report.md` and the figures. They are made side by side, on the rayon pool that this
/// is called from.
pub fn artefacts(results: &Results) -> Artefacts {
    let tables = || rayon::join(|| to_json(results), || to_csv(results));
    let (figures, (json, csv)) = rayon::join(|| plots::consistency(results), tables);
    let mut artefacts = Artefacts::default();
    artefacts.add("results.json", json);
    artefacts.add("table.csv", csv);
    artefacts.add("report.md", page::page(results, &figures));
    for figure in figures {
        artefacts.add(figure.name, figure.svg);
    }
    artefacts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::synthetic;

    #[test]
    fn a_report_holds_the_table_in_two_formats_a_page_and_the_figures() {
        let artefacts = artefacts(&synthetic::results());
        let names: Vec<&str> = artefacts.iter().map(|(name, _)| name).collect();
        assert!(["results.json", "table.csv", "report.md", "sd-joint.svg"].iter().all(|n| names.contains(n)));
    }
}
