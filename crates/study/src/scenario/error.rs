//! Why a scenario is refused.

use miette::Diagnostic;
use std::ops::Range;
use switchback_io::input::{FileError, TomlError, TomlFile};
use thiserror::Error;
use toml::de::{DeTable, DeValue};

/// Why a file is no scenario.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Unreadable(#[from] FileError),
    /// Something in it is wrong; the message names the key, its value and why it cannot be.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Invalid(#[from] TomlError),
}

/// A fault that knows its place in the text, but not yet the file nor the name of the key there.
#[derive(Debug)]
pub(super) enum Fault {
    /// A value that cannot be: where, what is wrong with it, and what to write instead.
    Value(Range<usize>, String, String),
    /// No TOML, an unknown or missing key, or a wrong type.
    Toml(toml::de::Error),
}

impl Fault {
    /// `message` says what is wrong with the value at `span`, `remedy` what to write instead.
    pub(super) fn new(span: Range<usize>, message: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Value(span, message.into(), remedy.into())
    }

    /// Adds file, line, key and value.
    pub(super) fn locate(self, file: &TomlFile) -> ScenarioError {
        let (span, message, remedy) = match self {
            Self::Value(span, message, remedy) => (span, message, remedy),
            Self::Toml(error) => {
                let (message, remedy) = file.explain(&error);
                (error.span().unwrap_or(0..0), message, remedy)
            }
        };
        let message = match subject(file.text(), span.clone()) {
            Some(subject) => format!("{subject}: {message}"),
            None => message,
        };
        file.error(span, message, remedy).into()
    }
}

impl From<toml::de::Error> for Fault {
    fn from(error: toml::de::Error) -> Self {
        Self::Toml(error)
    }
}

/// `key = value` for the value at `span`, `key` alone for a table or a key, `None` outside any.
fn subject(text: &str, span: Range<usize>) -> Option<String> {
    let document = DeTable::parse(text).ok()?;
    let mut finder = Finder { span: span.clone(), best: None };
    finder.table(document.get_ref(), "");
    let (_, path, scalar) = finder.best?;
    let value = text.get(span)?.split_whitespace().collect::<Vec<_>>().join(" ");
    Some(match scalar {
        true if value.chars().count() > 60 => {
            format!("`{path} = {}…`", value.chars().take(60).collect::<String>())
        }
        true => format!("`{path} = {value}`"),
        false => format!("`{path}`"),
    })
}

/// Searches a document for the smallest key or value that holds a span.
struct Finder {
    span: Range<usize>,
    best: Option<(usize, String, bool)>,
}

impl Finder {
    fn table(&mut self, table: &DeTable<'_>, prefix: &str) {
        for (key, value) in table {
            let path = match prefix {
                "" => key.get_ref().to_string(),
                _ => format!("{prefix}.{}", key.get_ref()),
            };
            self.offer(key.span(), &path, false);
            self.value(value.get_ref(), value.span(), &path);
        }
    }

    fn value(&mut self, value: &DeValue<'_>, span: Range<usize>, path: &str) {
        self.offer(span, path, !matches!(value, DeValue::Table(_)));
        match value {
            DeValue::Table(table) => self.table(table, path),
            DeValue::Array(items) => {
                for (i, item) in items.iter().enumerate() {
                    self.value(item.get_ref(), item.span(), &format!("{path}[{i}]"));
                }
            }
            _ => {}
        }
    }

    fn offer(&mut self, span: Range<usize>, path: &str, scalar: bool) {
        let holds = span.start <= self.span.start && self.span.end <= span.end && !span.is_empty();
        if holds && self.best.as_ref().is_none_or(|(size, ..)| span.len() <= *size) {
            self.best = Some((span.len(), path.to_owned(), scalar));
        }
    }
}
