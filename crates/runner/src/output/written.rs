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

/// Names and SHA-256 of what the program wrote into a folder. A file is its own only while both hold: one of the same name
/// that was put there or edited by someone else is theirs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Written {
    sums: BTreeMap<String, String>,
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
        match fs::read(folder.join(SUMS)) {
            Ok(list) => Ok(Self::parse(&String::from_utf8_lossy(&list))),
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                Ok(Self::default())
            }
            Err(error) => Err(error),
        }
    }

    fn parse(list: &str) -> Self {
        let sums = list.lines().filter_map(|line| line.split_once("  "));
        Self { sums: sums.map(|(sum, name)| (name.to_owned(), sum.to_owned())).collect() }
    }

    /// Names of the files listed.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.sums.keys().map(String::as_str)
    }

    /// Whether a file is listed.
    pub(super) fn lists(&self, name: &str) -> bool {
        self.sums.contains_key(name)
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
        match self.sums.get(name) {
            Some(sum) if kind.is_file() && *sum == sha256(fs::read(&place)?) => Ok(Owner::Program),
            Some(_) => Ok(Owner::Editor),
            None => Ok(Owner::Stranger),
        }
    }

    /// The list once these files are written too.
    pub(super) fn with(mut self, artefacts: &Artefacts) -> Self {
        self.sums.extend(artefacts.iter().map(|(name, contents)| (name.to_owned(), sha256(contents))));
        self
    }

    /// The list once these files are gone.
    pub(super) fn without(mut self, names: &[String]) -> Self {
        self.sums.retain(|name, _| !names.contains(name));
        self
    }

    /// The list as text, by name.
    pub(super) fn text(&self) -> String {
        self.sums.iter().fold(String::new(), |mut text, (name, sum)| {
            let _ = writeln!(text, "{sum}  {name}");
            text
        })
    }
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
        let written = Written::default().with(&artefacts);
        assert_eq!(Written::parse(&written.text()), written);
        assert!(written.text().starts_with(&format!("{}  a b.csv\n", sha256("1"))));
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
