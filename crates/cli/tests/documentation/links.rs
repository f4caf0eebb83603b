//! Links between pages.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Pages whose links are followed, besides those of `docs/`.
const OTHERS: [&str; 8] = [
    "README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "benches/peers/README.md",
    "fuzz/README.md",
    "crates/identify/README.md",
    "crates/diagnose/README.md",
    "crates/lab/README.md",
];

/// Every link to a file or heading that is not there, and every source file named that is not.
pub(crate) fn dead(root: &Path) -> Vec<String> {
    let docs = root.join("docs").read_dir().expect("docs/");
    let docs = docs.map(|entry| entry.expect("a readable entry").path());
    let pages = docs.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    let pages = pages.chain(OTHERS.iter().map(|name| root.join(name)));
    pages.flat_map(|page| [of_page(&page), missing_sources(root, &page)].concat()).collect()
}

/// The source files that a page names in code, by their path from the root, and that are not there. The change log names those of its day.
fn missing_sources(root: &Path, page: &Path) -> Vec<String> {
    if page.ends_with("CHANGELOG.md") {
        return Vec::new();
    }
    let text = fs::read_to_string(page).unwrap_or_else(|error| panic!("{}: {error}", page.display()));
    let missing = sources(&text).into_iter().filter(|path| !root.join(path).exists());
    missing.map(|path| format!("{}: there is no `{path}`", page.display())).collect()
}

/// Code that is the path of a source file; capitals stand for a name to choose.
fn sources(text: &str) -> Vec<&str> {
    let prose = text.split("```").step_by(2);
    let is_path = |code: &&str| {
        let may_be =
            |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '/' | '_' | '.' | '-');
        code.starts_with("crates/") && code.contains('.') && code.chars().all(may_be)
    };
    prose.flat_map(|part| part.split('`').skip(1).step_by(2)).filter(is_path).collect()
}

fn of_page(page: &Path) -> Vec<String> {
    let text = fs::read_to_string(page).unwrap_or_else(|error| panic!("{}: {error}", page.display()));
    let folder = page.parent().expect("a folder");
    let complaint = |target: &str| {
        let (file, heading) = target.split_once('#').map_or((target, None), |(file, h)| (file, Some(h)));
        let path: PathBuf = if file.is_empty() { page.to_owned() } else { folder.join(file) };
        let is_there = path.exists()
            && heading.is_none_or(|heading| headings(&path).contains(heading) || !is_markdown(&path));
        (!is_there).then(|| format!("{}: `{target}` leads nowhere", page.display()))
    };
    targets(&text).into_iter().filter(|target| !target.contains("://")).filter_map(complaint).collect()
}

fn is_markdown(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "md")
}

/// Where the links and pictures of a page lead, code left out.
fn targets(text: &str) -> Vec<&str> {
    let prose = text.split("```").step_by(2);
    prose
        .flat_map(|part| part.split("](").skip(1))
        .filter_map(|rest| rest.split_once(')').map(|(target, _)| target))
        .collect()
}

/// The anchors of a page: headings in lower case, their punctuation left out, blanks as hyphens.
fn headings(page: &Path) -> HashSet<String> {
    let text = fs::read_to_string(page).unwrap_or_default();
    let is_kept = |c: &char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
    let anchor = |title: &str| title.trim().to_lowercase().chars().filter(is_kept).collect::<String>();
    let titles = text.split("```").step_by(2).flat_map(str::lines).filter(|line| line.starts_with('#'));
    titles.map(|line| anchor(line.trim_start_matches('#')).replace(' ', "-")).collect()
}

#[test]
fn links_and_headings_are_found() {
    let page = "[a](b.md#c-d) ![e](f.svg)\n```text\n[g](h)\n```\n[i](#j)";
    assert_eq!(targets(page), ["b.md#c-d", "f.svg", "#j"]);
    let named = "`crates/a/b.rs`, `crates/a/NAME.rs`, `crates/a` and `c.rs`\n```text\n`crates/d.rs`\n```";
    assert_eq!(sources(named), ["crates/a/b.rs"]);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.md");
    fs::write(&path, "# What `x` is, and why\n[b](#what-x-is-and-why) [c](#d) [e](f.md)\n").expect("a file");
    assert!(headings(&path).contains("what-x-is-and-why"));
    assert_eq!(of_page(&path).len(), 2);
}
