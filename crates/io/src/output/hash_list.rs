//! The files of a folder that the program wrote itself.

use super::artefacts::Artefacts;
use super::sha256::sha256;
use crate::input::own;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;

/// The file that distinguishes the program's own files from all others: a line `SHA-256  NAME` for each, as `sha256sum` writes them,
/// so that `sha256sum -c .switchback.sha256` checks a folder. Hidden, because it is no result.
pub(super) const SUMS: &str = ".switchback.sha256";

/// The same for the files that describe the run rather than its results: the list above does not depend on them.
const BESIDE: &str = ".switchback.beside.sha256";

/// Names and SHA-256 of the files that the program wrote into a folder. A file is its own only while both agree: one of the same name
/// that someone else put there or edited belongs to them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct HashList {
    sums: BTreeMap<String, String>,
    beside: BTreeMap<String, String>,
}

/// The owner of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Owner {
    /// Written by the program, or not there.
    Program,
    /// Written by the program and changed since.
    Editor,
    /// Never written by the program.
    Stranger,
}

impl HashList {
    /// The list in a folder, empty where there is none.
    pub(super) fn in_folder(folder: &Path) -> io::Result<Self> {
        Ok(Self { sums: read(&folder.join(SUMS))?, beside: read(&folder.join(BESIDE))? })
    }

    /// Names of the results.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.sums.keys().map(String::as_str)
    }

    /// Whether a file is listed.
    pub(super) fn lists(&self, name: &str) -> bool {
        self.sum(name).is_some()
    }

    fn sum(&self, name: &str) -> Option<&String> {
        self.sums.get(name).or_else(|| self.beside.get(name))
    }

    /// The owner of the file of a name. The lists themselves are the program's.
    pub(super) fn owner(&self, folder: &Path, name: &str) -> io::Result<Owner> {
        let place = folder.join(name);
        // A link is not followed: the link itself would be replaced, and the program makes none.
        let kind = match fs::symlink_metadata(&place) {
            Ok(found) => found.file_type(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Owner::Program),
            Err(error) => return Err(error),
        };
        match self.sum(name) {
            Some(sum) if kind.is_file() && *sum == sha256(own(&place)?) => Ok(Owner::Program),
            Some(_) => Ok(Owner::Editor),
            None if [SUMS, BESIDE].contains(&name) => Ok(Owner::Program),
            None => Ok(Owner::Stranger),
        }
    }

    /// The list after these artefacts are written and files of these names removed.
    pub(super) fn after(mut self, artefacts: &Artefacts, removed: &[String]) -> Self {
        for list in [&mut self.sums, &mut self.beside] {
            list.retain(|name, _| !removed.contains(name));
        }
        for (name, contents) in artefacts.iter() {
            let list = if artefacts.is_beside(name) { &mut self.beside } else { &mut self.sums };
            list.insert(name.to_owned(), sha256(contents));
        }
        self
    }

    /// The files that contain the list, by name.
    pub(super) fn files(&self) -> impl Iterator<Item = (&'static str, String)> {
        let beside = (!self.beside.is_empty()).then(|| (BESIDE, text(&self.beside)));
        [(SUMS, text(&self.sums))].into_iter().chain(beside)
    }
}

fn read(list: &Path) -> io::Result<BTreeMap<String, String>> {
    match own(list) {
        Ok(bytes) => {
            let text = String::from_utf8_lossy(&bytes);
            let sums = text.lines().filter_map(|line| line.split_once("  "));
            Ok(sums.map(|(sum, name)| (name.to_owned(), sum.to_owned())).collect())
        }
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
            Ok(BTreeMap::new())
        }
        Err(error) => Err(error),
    }
}

fn text(sums: &BTreeMap<String, String>) -> String {
    sums.iter().map(|(name, sum)| format!("{sum}  {name}\n")).collect()
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
        let written = HashList::default().after(&artefacts, &[]);
        for (name, list) in written.files() {
            fs::write(root.path().join(name), list).unwrap();
        }
        assert_eq!(HashList::in_folder(root.path()).unwrap(), written);
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
        let written = HashList::default().after(&artefacts, &[]);
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
