//! A TOML file, and errors that point into it.

use super::terms::Terms;
use super::{FileError, TextKind, closest, read_text};
use miette::{Diagnostic, NamedSource, SourceSpan};
use serde::de::DeserializeOwned;
use std::ops::Range;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The text of a TOML file and where it came from.
#[derive(Debug, Clone)]
pub struct TomlFile {
    path: PathBuf,
    text: String,
}

/// Something in a TOML file is wrong: what, where, and the remedy.
#[derive(Debug, Error, Diagnostic)]
#[error(transparent)]
#[diagnostic(transparent)]
pub struct TomlError(Box<Located>);

/// Boxed, because it carries the file's text and errors should be cheap to pass up.
#[derive(Debug, Error, Diagnostic)]
#[error("{path}:{line}:{column}: {message}")]
struct Located {
    path: String,
    line: usize,
    column: usize,
    message: String,
    #[source_code]
    source_code: NamedSource<String>,
    #[label("here")]
    span: SourceSpan,
    #[help]
    remedy: String,
}

impl TomlFile {
    /// Reads the file's text; parsing comes with [`parse`](Self::parse).
    ///
    /// # Errors
    /// [`FileError`] if it cannot be read as text.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        Ok(Self { path: path.to_owned(), text: read_text(path, TextKind::Settings)? })
    }

    /// A file given as text; `path` is what messages call it.
    pub fn from_text(path: &Path, text: &str) -> Self {
        Self { path: path.to_owned(), text: text.to_owned() }
    }

    /// Where the file lies.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its text, without a byte order mark.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Deserialises the file. `T` should deny unknown fields and wrap in [`toml::Spanned`] whatever is checked later.
    ///
    /// # Errors
    /// [`TomlError`] at the first thing that is no TOML or does not fit `T`.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, TomlError> {
        toml::from_str(&self.text).map_err(|error| {
            let (message, remedy) = self.explain(&error);
            self.error(error.span().unwrap_or(0..0), message, remedy)
        })
    }

    /// The same, going on after what is wrong: a line that does not fit is reported, taken out, and the rest read again, so that all such lines
    /// are reported at once. The value lacks what stood in them; it is none where the file is no TOML.
    pub(crate) fn parse_all<T: DeserializeOwned>(&self) -> (Option<T>, Vec<TomlError>) {
        let mut rest = self.text.clone();
        let mut problems = Vec::new();
        loop {
            let error = match toml::from_str(&rest) {
                Ok(value) => return (Some(value), problems),
                Err(error) => error,
            };
            let (message, remedy) = self.explain(&error);
            let span = error.span().unwrap_or(0..0);
            problems.push(self.error(span.clone(), message, remedy));
            let start = rest[..span.start].rfind('\n').map_or(0, |newline| newline + 1);
            let end =
                rest[span.end.max(span.start)..].find('\n').map_or(rest.len(), |newline| span.end + newline);
            let taken = &rest[start..end];
            if rest.parse::<toml::Table>().is_err() || !taken.contains('=') || taken.contains("[[") {
                return (None, problems);
            }
            // Blanks keep all other places where they were; a letter may be of several bytes.
            let blank = " ".repeat(taken.len());
            rest.replace_range(start..end, &blank);
        }
    }

    /// What the TOML reader's error means to the file's writer, and what to do about it.
    pub fn explain(&self, error: &toml::de::Error) -> (String, String) {
        (Terms::Toml.reported(error.message()), self.remedy(error.message()))
    }

    /// An error at a place of this file. `message` says what is wrong there, `remedy` what to do about it.
    pub fn error(
        &self,
        span: Range<usize>,
        message: impl Into<String>,
        remedy: impl Into<String>,
    ) -> TomlError {
        let start = span.start.min(self.text.len());
        let before = &self.text[..start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let path = self.path.display().to_string();
        // A table's span covers all of its lines; its first line says enough.
        let end = self.text[start..].find('\n').map_or(self.text.len(), |newline| start + newline);
        TomlError(Box::new(Located {
            line: 1 + before.matches('\n').count(),
            column: 1 + before[line_start..].chars().count(),
            message: message.into(),
            source_code: NamedSource::new(&path, self.text.clone()).with_language("toml"),
            path,
            span: (start..span.end.clamp(start, end)).into(),
            remedy: remedy.into(),
        }))
    }

    /// The line on which a place of this file lies, from 1.
    pub(crate) fn line(&self, span: &Range<usize>) -> usize {
        1 + self.text[..span.start.min(self.text.len())].matches('\n').count()
    }

    /// What to do about an error of the TOML reader.
    fn remedy(&self, message: &str) -> String {
        let mut quoted = message.split('`').skip(1).step_by(2);
        match (message, quoted.next()) {
            _ if self.text.trim_start().starts_with('{') => {
                "this looks like JSON; a TOML file is wanted, one `key = value` a line".to_owned()
            }
            (unknown, Some(word)) if unknown.starts_with("unknown") => match closest(word, quoted) {
                Some(meant) => format!("did you mean `{meant}`?"),
                None => "remove it or use one of the names listed".to_owned(),
            },
            (missing, Some(word)) if missing.starts_with("missing field") => format!("add `{word} = …`"),
            _ => "correct the value here; text stands in double quotes, numbers without quotes".to_owned(),
        }
    }
}

impl TomlError {
    /// Line of the error, from 1.
    pub fn line(&self) -> usize {
        self.0.line
    }
}
