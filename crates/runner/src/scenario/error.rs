//! Why a scenario is refused.

use crate::input::closest;
use miette::{Diagnostic, NamedSource, SourceSpan};
use std::ops::Range;
use std::path::PathBuf;
use thiserror::Error;
use toml::de::{DeTable, DeValue};

/// Why a file is no scenario.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error("cannot read the scenario {}: {source}", path.display())]
    #[diagnostic(help("give the path of a scenario file, for example scenarios/leafspring.toml"))]
    Unreadable {
        /// The path given.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The content is refused.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Invalid(Box<Invalid>),
}

/// What is wrong with a scenario's content, and where.
#[derive(Debug, Error, Diagnostic)]
#[error("{file}:{line}: {message}")]
pub struct Invalid {
    /// The file's name as the user gave it.
    pub file: String,
    /// Line of the fault, from 1.
    pub line: usize,
    /// What is wrong: the key, its value, and why it cannot be.
    pub message: String,
    /// What to write instead.
    #[help]
    pub remedy: Option<String>,
    #[source_code]
    text: NamedSource<String>,
    #[label("here")]
    span: SourceSpan,
}

/// A fault that knows its place in the text, but not yet the name of the key there.
#[derive(Debug)]
pub(super) struct Fault {
    span: Range<usize>,
    message: String,
    remedy: Option<String>,
}

impl Fault {
    /// `message` says what is wrong with the value at `span`, `remedy` what to write instead.
    pub(super) fn new(span: Range<usize>, message: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { span, message: message.into(), remedy: Some(remedy.into()) }
    }

    /// Adds file, line, key and value.
    pub(super) fn locate(self, file: &str, text: &str) -> ScenarioError {
        let start = self.span.start.min(text.len());
        let end = self.span.end.clamp(start, text.len());
        let line = text.as_bytes()[..start].iter().filter(|&&b| b == b'\n').count() + 1;
        let message = match subject(text, start..end) {
            Some(subject) => format!("{subject}: {}", self.message),
            None => self.message,
        };
        ScenarioError::Invalid(Box::new(Invalid {
            file: file.to_owned(),
            line,
            message,
            remedy: self.remedy,
            text: NamedSource::new(file, text.to_owned()),
            span: (start..end).into(),
        }))
    }
}

impl From<toml::de::Error> for Fault {
    fn from(error: toml::de::Error) -> Self {
        // serde speaks of Rust's types; the reader of a TOML file has numbers and whole numbers.
        let message = error
            .message()
            .replace("expected usize", "expected a whole number, 0 or more")
            .replace("expected u64", "expected a whole number, 0 or more")
            .replace("expected f64", "expected a number")
            .replace("expected a tuple of size 2", "expected two numbers: [low, high]")
            .replace("tuple of size 2", "two numbers: [low, high]");
        let remedy = remedy_for(&message);
        Self { span: error.span().unwrap_or(0..0), message, remedy }
    }
}

/// For an unknown key, the nearest of the keys that would be right.
fn remedy_for(message: &str) -> Option<String> {
    let mut quoted = message.split('`').skip(1).step_by(2);
    let unknown = message.starts_with("unknown field").then(|| quoted.next()).flatten()?;
    let known: Vec<&str> = quoted.collect();
    Some(match closest(unknown, known.iter().copied()) {
        Some(guess) => format!("did you mean `{guess}`?"),
        None => "remove it, or use one of the keys listed".to_owned(),
    })
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
