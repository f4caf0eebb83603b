//! Writing and printing results: all of a command's files appear, or none does.
//!
//! | file | what it is for |
//! |---|---|
//! | `artefacts` | the files of a command, in memory |
//! | `folder`, `single` | the folder or file that they go to: found writable before the computation, filled after it |
//! | `written` | the list of hashes that tells the program's own files from those of others |
//! | `staging`, `lock` | the place to write in before anything is shown, and one run at a time for each destination |
//! | `replace`, `moves` | how a folder takes the place of another, and how that is taken back |
//! | `finish` | what remains to be done for a process that was killed |
//! | `whole` | whether a folder holds what one run wrote |
//! | `disk`, `faults` | the calls that change the disk, and how tests make them fail |
//! | `columns`, `page`, `schema`, `sha256`, `error` | text tables, stdout, JSON with a name, hashes, what is told |

mod artefacts;
mod columns;
mod disk;
mod error;
mod faults;
mod finish;
mod folder;
mod foreign;
mod lock;
mod moves;
mod page;
mod replace;
mod schema;
mod sha256;
mod single;
mod staging;
mod visible;
mod whole;
mod wrapped;
mod written;

pub use artefacts::Artefacts;
pub use columns::columns;
pub use disk::Disk;
pub use error::OutputError;
pub use folder::OutputFolder;
pub use foreign::{csv_cell, markdown, markdown_code, markdown_text};
pub use page::{note, print};
pub use schema::stamped;
pub use sha256::sha256;
pub use single::OutputFile;
pub use staging::abandon;
pub use visible::visible;
pub use whole::{NotWhole, verify, verify_but, verify_those};
pub use wrapped::wrapped;
