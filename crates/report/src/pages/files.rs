//! The files of a report: those of a command before they are written, or those of a folder.

use super::error::PageError;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use switchback_io::input::{TextKind, gzip, json_file, names, read_text};
use switchback_io::output::{Artefacts, verify};
use switchback_study::results::{COMPRESSED, ResultsError};

/// Texts by their names, and the folder that messages name.
#[derive(Debug, Clone)]
pub struct Files {
    folder: PathBuf,
    texts: BTreeMap<String, String>,
}

/// Which report the files are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Of a consistency study.
    Study,
    /// Of a blind or a field examination.
    Examination,
    /// Of `gap --out`.
    Diagnosis,
    /// Of `identify --out`.
    Identification,
}

impl Kind {
    fn reported(self) -> &'static str {
        match self {
            Self::Study => "the results of a study",
            Self::Examination => "the results of an examination",
            Self::Diagnosis => "a diagnosis",
            Self::Identification => "an identification",
        }
    }
}

const RESULTS: &str = "results.json";

/// Whether a page may show a file.
fn is_shown(name: &str) -> bool {
    let named = [
        RESULTS,
        COMPRESSED,
        "gap.json",
        "estimate.json",
        "model.json",
        "nominal.json",
        "augmented.json",
        "series.csv",
    ];
    named.contains(&name) || name.ends_with(".svg")
}

#[derive(Deserialize)]
struct Peek {
    schema: Option<Value>,
}

impl Files {
    /// The files of a command that are to be written.
    pub(crate) fn of(artefacts: &Artefacts) -> Self {
        let shown = artefacts.iter().filter(|(name, _)| is_shown(name));
        let texts = shown.map(|(name, _)| (name.to_owned(), artefacts.text(name)));
        Self { folder: PathBuf::new(), texts: texts.collect() }
    }

    /// The files of a report's folder.
    ///
    /// # Errors
    /// [`PageError`] if it is no folder, cannot be read, or is not as one run wrote it.
    pub fn read(folder: &Path) -> Result<Self, PageError> {
        let unreadable = |path: &Path| {
            let path = path.to_owned();
            move |source| PageError::Unreadable { path, source }
        };
        if folder.is_file() {
            return Err(PageError::IsFile { path: folder.to_owned() });
        }
        let found = names(folder).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => PageError::Missing { folder: folder.to_owned() },
            _ => unreadable(folder)(error),
        })?;
        let mut texts = BTreeMap::new();
        for name in found.into_iter().filter(|name| is_shown(name) && name != COMPRESSED) {
            let path = folder.join(&name);
            if path.is_file() {
                texts.insert(name, read_text(&path, TextKind::Results)?);
            }
        }
        let compressed = folder.join(COMPRESSED);
        if !texts.contains_key(RESULTS) && compressed.is_file() {
            texts.insert(COMPRESSED.to_owned(), gzip::read(&compressed).map_err(ResultsError::from)?);
        }
        let files = Self { folder: folder.to_owned(), texts };
        // Whatever is drawn again may be missing: of a study all but its results.
        let is_study = files.kind()? == Kind::Study;
        verify(folder, |name| is_shown(name) && !(is_study && name.ends_with(".svg")))?;
        Ok(files)
    }

    /// Which report they are.
    ///
    /// # Errors
    /// [`PageError`] if they are none, or more than one.
    pub fn kind(&self) -> Result<Kind, PageError> {
        let results = self.results().map(|(_, text)| match serde_json::from_str(text) {
            Ok(Peek { schema: Some(Value::String(_)) }) => Kind::Examination,
            _ => Kind::Study,
        });
        let has = |name: &str, kind: Kind| self.text(name).map(|_| kind);
        let kinds = [results, has("gap.json", Kind::Diagnosis), has("estimate.json", Kind::Identification)];
        let kinds: Vec<Kind> = kinds.into_iter().flatten().collect();
        match kinds[..] {
            [] => Err(PageError::NoReport { folder: self.folder.clone() }),
            [kind] => Ok(kind),
            _ => {
                let reported: Vec<&str> = kinds.iter().map(|kind| kind.reported()).collect();
                Err(PageError::Mixture { folder: self.folder.clone(), kinds: reported.join(" and ") })
            }
        }
    }

    /// The name and text of the results of a study or an examination.
    pub(super) fn results(&self) -> Option<(&'static str, &str)> {
        [RESULTS, COMPRESSED].into_iter().find_map(|name| Some((name, self.text(name)?)))
    }

    /// The text of a file.
    pub(super) fn text(&self, name: &str) -> Option<&str> {
        self.texts.get(name).map(String::as_str)
    }

    /// The text of a file that must be there.
    pub(super) fn needed(&self, file: &'static str) -> Result<&str, PageError> {
        self.text(file).ok_or_else(|| PageError::Lacks { folder: self.folder.clone(), file })
    }

    /// What a JSON file holds that says which format it has.
    pub(super) fn object<T: DeserializeOwned>(
        &self,
        file: &'static str,
        wanted: &'static str,
    ) -> Result<T, PageError> {
        let (text, place) = (self.needed(file)?, self.place(file));
        let peek: Peek = parsed(&place, text)?;
        match peek.schema {
            Some(Value::String(found)) if found != wanted => {
                Err(PageError::OtherFormat { file: place, found: format!("`{found}`"), wanted })
            }
            _ => parsed(&place, text),
        }
    }

    /// What messages call a file.
    pub(super) fn place(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Figures whose names begin so, by name.
    pub(super) fn figures<'a>(&'a self, start: &'a str) -> impl Iterator<Item = (&'a str, &'a str)> {
        let drawn =
            self.texts.iter().filter(move |(name, _)| name.starts_with(start) && name.ends_with(".svg"));
        drawn.map(|(name, svg)| (name.as_str(), svg.as_str()))
    }

    /// Figures whose names begin otherwise.
    pub(super) fn other_figures<'a>(
        &'a self,
        starts: &'a [&str],
    ) -> impl Iterator<Item = (&'a str, &'a str)> {
        self.figures("").filter(|(name, _)| !starts.iter().any(|start| name.starts_with(start)))
    }

    /// That two files are of the same rig.
    pub(super) fn same_rig(&self, one: (&str, &str), other: (&str, &str)) -> Result<(), PageError> {
        if one.1 == other.1 {
            return Ok(());
        }
        Err(PageError::Unrelated {
            folder: self.folder.clone(),
            one: one.0.to_owned(),
            of: one.1.to_owned(),
            other: other.0.to_owned(),
            but: other.1.to_owned(),
        })
    }
}

fn parsed<T: DeserializeOwned>(place: &Path, text: &str) -> Result<T, PageError> {
    json_file::parse(place, text).map_err(PageError::from)
}
