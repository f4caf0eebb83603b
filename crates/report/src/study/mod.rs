//! What a finished study shows: the table on the terminal, and the files of the report.
//!
//! Nothing is printed or written here; callers get text and [`Artefacts`].

mod page;
pub(crate) mod paired;
pub(crate) mod row;
pub mod table;

pub use table::table;

use crate::pages::{self, INDEX, PageError};
use crate::plots;
use switchback_io::output::Artefacts;
use switchback_study::results::{Results, to_csv, to_json};

/// What the files of a report are called; a `*` stands for what is not known of a name.
pub const FILES: [&str; 12] = [
    "results.json",
    "table.csv",
    "report.md",
    INDEX,
    "bias-*.svg",
    "sd-*.svg",
    "borders-*.svg",
    "paired-*.svg",
    "forest-*.svg",
    "ratios*.svg",
    "efficiency*.svg",
    "zip*.svg",
];

/// The files of a report: `results.json`, `table.csv`, `report.md`, the figures and the page `index.html`. They are made side by side, on
/// the rayon pool that this is called from.
///
/// # Errors
/// [`PageError`] if a figure is no drawing.
pub fn artefacts(results: &Results) -> Result<Artefacts, PageError> {
    let tables = || rayon::join(|| to_json(results), || to_csv(results));
    let (figures, (json, csv)) = rayon::join(|| plots::consistency(results), tables);
    let mut artefacts = Artefacts::default();
    artefacts.add("results.json", json);
    artefacts.add("table.csv", csv);
    artefacts.add("report.md", page::page(results, &figures));
    artefacts.add(INDEX, pages::study(results, &figures)?);
    for figure in figures {
        artefacts.add(figure.name, figure.svg);
    }
    Ok(artefacts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_study::results::synthetic;

    #[test]
    fn a_report_holds_the_table_in_two_formats_a_page_and_the_figures() {
        let artefacts = artefacts(&synthetic::results()).expect("drawings");
        let names: Vec<&str> = artefacts.iter().map(|(name, _)| name).collect();
        assert!(
            ["results.json", "table.csv", "report.md", "index.html", "sd-joint.svg"]
                .iter()
                .all(|n| names.contains(n))
        );
    }
}
