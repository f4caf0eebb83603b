//! `index.html`: a report on one page that is one file. It shows what the files beside it hold, and nothing is simulated for it, so that
//! `switchback report` draws it again.
//!
//! | file | what it is for |
//! |---|---|
//! | `layout` | how every page is put together: head, contents, sections, foot |
//! | `style.css`, `script.js` | how it looks, and what the pointer and the keys do |
//! | `table`, `chart`, `sheet` | sortable tables, charts of the page, figures that are files |
//! | `files` | the files of a report, in memory or in a folder, and which report they are |
//! | `study` | the page of each kind of report, which only says its sections |

mod chart;
mod diagnosis;
mod error;
mod examination;
mod files;
mod identification;
mod layout;
mod series;
mod sheet;
mod study;
mod table;

pub use error::PageError;
pub use files::Files;
pub use files::Kind;
pub(crate) use study::study;

use crate::plots;
use switchback_io::output::Artefacts;
use switchback_study::results::{self, Results};

/// Name of the page.
pub const INDEX: &str = "index.html";

/// Half the width of a 95 % interval in standard errors of a normal estimate.
const Z95: f64 = 1.959_963_984_540_054;

/// The results of a study among some files.
///
/// # Errors
/// [`PageError`] if they are not there or cannot be read.
pub fn results(files: &Files) -> Result<Results, PageError> {
    Ok(results::parse(&files.place("results.json"), files.needed("results.json")?)?)
}

/// The files of a report with the page that is drawn from them.
///
/// # Errors
/// [`PageError`] if they are no report that can be read.
pub fn bound(mut artefacts: Artefacts) -> Result<Artefacts, PageError> {
    artefacts.add(INDEX, index(&Files::of(&artefacts))?);
    Ok(artefacts)
}

/// The page of some files.
///
/// # Errors
/// [`PageError`] if they are no report, more than one, or cannot be read.
pub fn index(files: &Files) -> Result<String, PageError> {
    match files.kind()? {
        Kind::Study => {
            let results = results(files)?;
            study(&results, &plots::consistency(&results))
        }
        Kind::Diagnosis => diagnosis::diagnosis(files),
        Kind::Identification => identification::identification(files),
        Kind::Examination => examination::examination(files),
    }
}
