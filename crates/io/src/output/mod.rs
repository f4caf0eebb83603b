//! Writing and printing results: all of a command's files appear, or none does.
//!
//! | file | purpose |
//! |---|---|
//! | `artefacts` | the files of a command, in memory |
//! | `folder`, `file` | the folder or file that they go to: found writable before the computation, filled after it |
//! | `hash_list` | the list that distinguishes the program's own files from those of others |
//! | `staging`, `lock` | the folder to write in before anything is shown, and one run at a time for each destination |
//! | `replacement`, `moves` | the replacement of a folder by another, its undoing after a failure, its end after a kill |
//! | `verify` | the check that a folder's files are those of one run |
//! | `disk`, `faults` | the calls that change the disk, and the means of tests to make them fail |
//! | `working` | files that a command keeps while it runs |
//! | `schema` | JSON Schemas of what is written |
//! | `text`, `plain`, `shell`, `terminal`, `sha256` | formats of text, failures as text, words of a command line, standard output and error, hashes |

mod artefacts;
mod disk;
mod faults;
mod file;
mod folder;
mod hash_list;
mod lock;
mod moves;
mod plain;
mod replacement;
mod schema;
mod sha256;
mod staging;
mod terminal;
mod text;
mod verify;
mod working;
mod wrapped;

pub use artefacts::Artefacts;
pub use disk::Disk;
pub use file::{FileError, OutputFile};
pub use folder::{FolderError, OutputFolder, PART};
pub use plain::{Diagnostic, plain};
pub use schema::{schema, schema_text, stamped_schema};
pub use sha256::sha256;
pub use staging::abandon;
pub use switchback_table::shell::{in_shell, path_in_shell};
pub use terminal::{is_watched, note, print};
pub use text::{columns, csv_cell, markdown, markdown_code, markdown_text, number, stamped, visible};
pub use verify::{NotWhole, verify};
pub use working::{Growing, make_folder, overwrite, remove, run_script};
pub use wrapped::wrapped;
