//! The files of one command, still in memory.

use super::text::visible;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// Named contents, in the order of their names. A name is a file name, without folders.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Artefacts {
    files: BTreeMap<String, Vec<u8>>,
    /// Names of those that describe the run rather than its results.
    beside: BTreeSet<String>,
}

impl Artefacts {
    /// Adds a file. In pages and pictures control characters are shown instead of obeyed, see [`visible`].
    ///
    /// # Panics
    /// If the name contains a path separator or was added before: both are mistakes of the program, not of its user.
    pub fn add(&mut self, name: impl Into<String>, contents: impl Into<Vec<u8>>) {
        let (name, mut contents) = (name.into(), contents.into());
        assert!(!name.is_empty() && !name.contains(['/', '\\']), "`{name}` is no plain file name");
        if is_page(&name)
            && let Ok(Cow::Owned(shown)) = std::str::from_utf8(&contents).map(visible)
        {
            contents = shown.into_bytes();
        }
        let displaced = self.files.insert(name.clone(), contents);
        assert!(displaced.is_none(), "two artefacts are called `{name}`");
    }

    /// Adds a file that describes the run rather than its results: it may differ between two runs with equal results, and may be removed.
    ///
    /// # Panics
    /// As [`add`](Self::add).
    pub fn add_beside(&mut self, name: &str, contents: impl Into<Vec<u8>>) {
        self.add(name, contents);
        self.beside.insert(name.to_owned());
    }

    /// Whether a file was [added beside](Self::add_beside) the results.
    pub(super) fn is_beside(&self, name: &str) -> bool {
        self.beside.contains(name)
    }

    /// A file's text, empty where there is no such file.
    pub fn text(&self, name: &str) -> String {
        self.files.get(name).map_or_else(String::new, |bytes| String::from_utf8_lossy(bytes).into_owned())
    }

    /// A file's contents.
    pub(super) fn bytes(&self, name: &str) -> Option<&[u8]> {
        self.files.get(name).map(Vec::as_slice)
    }

    /// Names and contents, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.files.iter().map(|(name, contents)| (name.as_str(), contents.as_slice()))
    }
}

/// Whether a file is read by people, rather than by programs that need every character as it is.
fn is_page(name: &str) -> bool {
    [".svg", ".md", ".txt", ".html"].iter().any(|ending| name.ends_with(ending))
}
