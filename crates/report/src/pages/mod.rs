//! `index.html`: a report on one page that is one file. It shows the content of the files beside it, and nothing is simulated for it, so
//! that `switchback report` draws it again.
//!
//! | file | purpose |
//! |---|---|
//! | `layout` | how every page is put together: head, contents, sections, foot |
//! | `style.css`, `script.js` | how it looks, and how it answers the pointer and the keys |
//! | `table` | sortable tables |
//! | `sheet`, `drawing` | figures of [`plots`], from files and drawn anew; both are read and written again |
//! | `series` | sections of series.csv |
//! | `files` | the files of a report, in memory or in a folder, and the kind of report they are |
//! | `study` | the page of each kind of report, which only says its sections |

mod diagnosis;
mod drawing;
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

/// The results of a study among some files.
///
/// # Errors
/// [`PageError`] if they are not there or cannot be read.
pub fn results(files: &Files) -> Result<Results, PageError> {
    let (name, text) = match files.results() {
        Some(found) => found,
        None => ("results.json", files.needed("results.json")?),
    };
    Ok(results::parse(&files.place(name), text)?)
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
