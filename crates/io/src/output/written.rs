//! Which files of a folder the program wrote itself.

use super::{Artefacts, sha256};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::io;
use std::path::Path;

/// The file that tells the program's own files from all others: a line `SHA-256  NAME` for each, as `sha256sum` writes them,
/// so that `sha256sum -c .switchback.sha256` checks a folder. Hidden, because it is no result.
pub(super) const SUMS: &str = ".switchback.sha256";

/// The same of the files that tell of the run rather than what came out: the list above does not depend on them.
pub(super) const BESIDE: &str = ".switchback.beside.sha256";

/// Names and SHA-256 of what the program wrote into a folder. A file is its own only while both hold: one of the same name
/// that was put there or edited by someone else is theirs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Written {
    sums: BTreeMap<String, String>,
    beside: BTreeMap<String, String>,
}

/// Whose a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Owner {
    /// Written by the program, or not there.
    Program,
    /// Written by the program and changed since.
    Editor,
    /// Never written by the program.
    Stranger,
}

impl Written {
    /// What a folder's list says; an empty list where there is none.
    pub(super) fn in_folder(folder: &Path) -> io::Result<Self> {
        Ok(Self { sums: listed(&folder.join(SUMS))?, beside: listed(&folder.join(BESIDE))? })
    }

    /// Names of the files listed, without those beside the results.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.sums.keys().map(String::as_str)
    }

    /// Names of the files beside the results.
    pub(super) fn beside(&self) -> impl Iterator<Item = &str> {
        self.beside.keys().map(String::as_str)
    }

    /// Whether a file is listed.
    pub(super) fn lists(&self, name: &str) -> bool {
        self.sum(name).is_some()
    }

    fn sum(&self, name: &str) -> Option<&String> {
        self.sums.get(name).or_else(|| self.beside.get(name))
    }

    /// Whose the file of a name is.
    pub(super) fn owner(&self, folder: &Path, name: &str) -> io::Result<Owner> {
        let place = folder.join(name);
        // What a link leads to is not asked: the link itself would be replaced, and the program makes none.
        let kind = match fs::symlink_metadata(&place) {
            Ok(found) => found.file_type(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Owner::Program),
            Err(error) => return Err(error),
        };
        match self.sum(name) {
            Some(sum) if kind.is_file() && *sum == sha256(fs::read(&place)?) => Ok(Owner::Program),
            Some(_) => Ok(Owner::Editor),
            None => Ok(Owner::Stranger),
        }
    }

    /// The list once these files are written too.
    pub(super) fn with(mut self, artefacts: &Artefacts) -> Self {
        for (name, contents) in artefacts.iter() {
            let list = if artefacts.is_beside(name) { &mut self.beside } else { &mut self.sums };
            list.insert(name.to_owned(), sha256(contents));
        }
        self
    }

    /// The list once these files are gone.
    pub(super) fn without(mut self, names: &[String]) -> Self {
        self.sums.retain(|name, _| !names.contains(name));
        self.beside.retain(|name, _| !names.contains(name));
        self
    }

    /// The files that hold the lists, by name.
    pub(super) fn files(&self) -> impl Iterator<Item = (&'static str, String)> {
        let beside = (!self.beside.is_empty()).then(|| (BESIDE, text(&self.beside)));
        [(SUMS, text(&self.sums))].into_iter().chain(beside)
    }
}

/// Whether a file of this name is a list itself.
pub(super) fn is_list(name: &str) -> bool {
    [SUMS, BESIDE].contains(&name)
}

/// The names and sums of a list, none where there is none.
fn listed(list: &Path) -> io::Result<BTreeMap<String, String>> {
    match fs::read(list) {
        Ok(list) => Ok(parse(&String::from_utf8_lossy(&list))),
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
            Ok(BTreeMap::new())
        }
        Err(error) => Err(error),
    }
}

fn parse(list: &str) -> BTreeMap<String, String> {
    let sums = list.lines().filter_map(|line| line.split_once("  "));
    sums.map(|(sum, name)| (name.to_owned(), sum.to_owned())).collect()
}

/// A list as text, by name.
fn text(sums: &BTreeMap<String, String>) -> String {
    sums.iter().fold(String::new(), |mut text, (name, sum)| {
        let _ = writeln!(text, "{sum}  {name}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    #[test]
    fn a_list_is_read_as_it_was_written() {
        let mut artefacts = Artefacts::default();
        artefacts.add("a b.csv", "1");
        artefacts.add("c.svg", "2");
        artefacts.add_beside("d", "3");
        let root = tempdir().unwrap();
        let written = Written::default().with(&artefacts);
        for (name, list) in written.files() {
            fs::write(root.path().join(name), list).unwrap();
        }
        assert_eq!(Written::in_folder(root.path()).unwrap(), written);
        let lists: Vec<String> = written.files().map(|(_, list)| list).collect();
        assert_eq!(lists[0], format!("{}  a b.csv\n{}  c.svg\n", sha256("1"), sha256("2")));
        assert_eq!(lists[1], format!("{}  d\n", sha256("3")));
        assert!(written.lists("d") && !written.names().any(|name| name == "d"));
    }

    #[test]
    fn a_file_is_the_programs_while_nobody_changes_it() {
        let root = tempdir().unwrap();
        let mut artefacts = Artefacts::default();
        artefacts.add("a", "1");
        let written = Written::default().with(&artefacts);
        let owner = |name| written.owner(root.path(), name).unwrap();
        assert_eq!(owner("a"), Owner::Program);
        fs::write(root.path().join("a"), "1").unwrap();
        assert_eq!(owner("a"), Owner::Program);
        fs::write(root.path().join("a"), "2").unwrap();
        assert_eq!(owner("a"), Owner::Editor);
        fs::write(root.path().join("b"), "1").unwrap();
        assert_eq!(owner("b"), Owner::Stranger);
    }
}
