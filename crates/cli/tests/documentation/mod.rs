//! The documentation is right: its commands run, what they print is what pages quote, and no link leads nowhere.
//!
//! Every block of ```` ```sh ```` in the README and in `docs/` is run, page by page, in a fresh folder that holds `scenarios/`. A block of ```` ```text ````
//! right below is what it prints: a line `…` stands for any number of lines, line breaks may differ, figures may by two per cent. What takes too long or
//! needs another tool says in the line above who checks it instead:
//!
//! ```text
//! <!-- checked by .ci/run: for study in leafspring -->
//! <!-- not run: it needs a cluster -->
//! ```
//!
//! The first names a file and a text that is in it.

#![cfg(unix)]

mod commands;
mod links;
mod page;
mod quoted;

use page::Page;
use std::path::{Path, PathBuf};
use std::thread;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// The README and the pages of `docs/`, by their path in the repository.
fn pages() -> Vec<Page> {
    let docs = root().join("docs").read_dir().expect("docs/");
    let mut files: Vec<PathBuf> = docs
        .map(|entry| Path::new("docs").join(entry.expect("a readable entry").file_name()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "md"))
        .chain([PathBuf::from("README.md")])
        .collect();
    files.sort();
    files.iter().map(|path| Page::read(root(), path)).collect()
}

/// Fails with all that is wrong.
fn report(wrong: &[String]) {
    assert!(wrong.is_empty(), "\n{}\n", wrong.join("\n\n"));
}

#[test]
fn commands_run_and_print_what_pages_quote() {
    let pages = pages();
    let wrong: Vec<String> = thread::scope(|scope| {
        let runs: Vec<_> =
            pages.iter().map(|page| scope.spawn(move || commands::complaints(root(), page))).collect();
        runs.into_iter().flat_map(|run| run.join().expect("it does not panic")).collect()
    });
    report(&wrong);
}

#[test]
fn what_is_not_run_here_is_checked_elsewhere() {
    report(&pages().iter().flat_map(|page| page.unchecked(root())).collect::<Vec<_>>());
}

#[test]
fn no_link_leads_nowhere() {
    report(&links::dead(root()));
}

#[test]
fn every_page_is_in_the_index() {
    let index = std::fs::read_to_string(root().join("docs/README.md")).expect("the index");
    let missing = pages().into_iter().map(|page| page.path).filter(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name != "README.md" && !index.contains(&format!("({name})"))
    });
    report(
        &missing.map(|path| format!("docs/README.md does not link {}", path.display())).collect::<Vec<_>>(),
    );
}

#[test]
fn the_readme_is_read_in_one_sitting() {
    let lines = std::fs::read_to_string(root().join("README.md")).expect("README.md").lines().count();
    assert!(lines <= 150, "README.md has {lines} lines");
}
