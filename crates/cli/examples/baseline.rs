//! What the repository keeps of a report: `cargo run --example baseline -- FOLDER [FILE…]`, in the workspace's root.
//!
//! FOLDER is as the program wrote it; what is kept goes to `reports/NAME`, NAME its last part:
//!
//! - every file that the README or a page of `docs/` links, and the FILEs named; `answers.csv.gz` is `answers.csv`, compressed;
//! - of a study `results.json.gz`, the condensed table of results;
//! - of a study and of a diagnosis `hashes.txt`: SHA-256 and name of every file of the folder, for `sha256sum --check`.

use miette::{IntoDiagnostic, WrapErr, miette};
use std::collections::BTreeSet;
use std::path::Path;
use switchback_io::input::gzip;
use switchback_io::output::{Artefacts, OutputFolder};
use switchback_report::pages::{Files, Kind};
use switchback_study::results::{self, COMPRESSED, condensed};

fn main() -> miette::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or_else(|| miette!("which folder?"))?;
    let folder = Path::new(&folder);
    let name = folder.file_name().and_then(|name| name.to_str()).ok_or_else(|| miette!("it has no name"))?;
    let mut kept = linked(&format!("reports/{name}/"))?;
    kept.extend(arguments);
    let mut artefacts = Artefacts::default();
    for file in &kept {
        let contents = match file.strip_suffix(".gz") {
            Some(plain) => gzip::compressed(&String::from_utf8_lossy(&read(&folder.join(plain))?)),
            None => read(&folder.join(file))?,
        };
        artefacts.add(file, contents);
    }
    let kind = Files::read(folder).and_then(|files| files.kind()).ok();
    if kind == Some(Kind::Study) {
        artefacts.add(COMPRESSED, gzip::compressed(&condensed::to_json(&results::read(folder)?)));
    }
    if matches!(kind, Some(Kind::Study | Kind::Diagnosis)) {
        artefacts.add("hashes.txt", read(&folder.join(".switchback.sha256"))?);
    }
    let written = ["*.svg", "*.csv", "*.json", "*.jsonl", "*.md", "*.html", "*.txt", "*.gz"];
    OutputFolder::claim(&Path::new("reports").join(name), true)?.clearing(&written).commit(&artefacts)?;
    Ok(())
}

/// The files behind a path that pages link, as `…](../reports/quick/zip.svg)`.
fn linked(path: &str) -> miette::Result<BTreeSet<String>> {
    let mut pages = vec![Path::new("README.md").to_owned()];
    for entry in std::fs::read_dir("docs").into_diagnostic().wrap_err("run this in the workspace's root")? {
        pages.push(entry.into_diagnostic()?.path());
    }
    pages.retain(|page| page.extension().is_some_and(|ending| ending == "md"));
    let mut found = BTreeSet::new();
    for page in &pages {
        let text = String::from_utf8_lossy(&read(page)?).into_owned();
        let links = text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
        found.extend(links.filter_map(|link| Some(link.split_once(path)?.1.to_owned())));
    }
    Ok(found)
}

fn read(path: &Path) -> miette::Result<Vec<u8>> {
    std::fs::read(path).into_diagnostic().wrap_err_with(|| format!("cannot read {}", path.display()))
}
