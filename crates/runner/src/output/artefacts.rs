//! The files of one command, still in memory.

use std::collections::BTreeMap;

/// Named contents, in the order of their names. A name is a file name, without folders.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Artefacts {
    files: BTreeMap<String, Vec<u8>>,
}

impl Artefacts {
    /// Adds a file.
    ///
    /// # Panics
    /// If the name holds a path separator or was added before: both are mistakes of the program, not of its user.
    pub fn add(&mut self, name: impl Into<String>, contents: impl Into<Vec<u8>>) {
        let name = name.into();
        assert!(!name.is_empty() && !name.contains(['/', '\\']), "`{name}` is no plain file name");
        let displaced = self.files.insert(name.clone(), contents.into());
        assert!(displaced.is_none(), "two artefacts are called `{name}`");
    }

    /// A file's text, empty where there is no such file.
    pub fn text(&self, name: &str) -> String {
        self.files.get(name).map_or_else(String::new, |bytes| String::from_utf8_lossy(bytes).into_owned())
    }

    /// Names and contents, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.files.iter().map(|(name, contents)| (name.as_str(), contents.as_slice()))
    }
}
