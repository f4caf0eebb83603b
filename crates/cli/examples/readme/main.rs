//! Copies the figures that the README and the pages of `docs/` quote out of `reports/`, between their markers.
//!
//! `cargo run --example readme` rewrites the pages; with `-- --check` it only says whether they are up to date (exit code 1 if not). A section
//! stands on lines of its own, a value within a sentence:
//!
//! ```text
//! <!-- begin leafspring -->
//! …
//! <!-- end leafspring -->
//! … of <!-- value blind.rigs -->512<!-- /value --> rigs …
//! ```

mod markers;
mod quotes;

use miette::{IntoDiagnostic, WrapErr, miette};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn main() -> miette::Result<()> {
    let is_check = std::env::args().any(|argument| argument == "--check");
    let (sections, values) = (quotes::sections()?, quotes::values()?);
    let mut quoted = BTreeSet::new();
    for page in pages()? {
        let old = read(&page)?;
        let fill = |text: &str, (begin, end): (&str, &str), quotes, quoted: &mut BTreeSet<String>| {
            markers::filled(text, (begin, end), quotes, quoted)
                .map_err(|wrong| miette!("{}: {wrong}", page.display()))
        };
        let new = fill(&old, ("<!-- begin {} -->\n", "<!-- end {} -->"), &sections, &mut quoted)?;
        let new = fill(&new, ("<!-- value {} -->", "<!-- /value -->"), &values, &mut quoted)?;
        if new != old && is_check {
            return Err(miette!(
                "{} differs from reports/; run `cargo run --example readme`",
                page.display()
            ));
        }
        if new != old {
            std::fs::write(&page, new).into_diagnostic()?;
        }
    }
    let unused = sections.iter().chain(&values).find(|(name, _)| !quoted.contains(*name));
    unused.map_or(Ok(()), |(name, _)| Err(miette!("no page quotes `{name}`: take it out of quotes.rs")))
}

/// The README and the pages of `docs/`.
fn pages() -> miette::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir("docs").into_diagnostic().wrap_err("run this in the workspace's root")?;
    let mut pages = vec![PathBuf::from("README.md")];
    for entry in entries {
        pages.push(entry.into_diagnostic()?.path());
    }
    pages.retain(|page| page.extension().is_some_and(|ending| ending == "md"));
    pages.sort();
    Ok(pages)
}

fn read(path: &Path) -> miette::Result<String> {
    std::fs::read_to_string(path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))
}
