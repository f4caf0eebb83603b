//! JSON, and errors that say what is wrong where.

use super::kinds;
use super::terms::Terms;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::Path;

/// Something in a JSON file is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JsonError {
    /// File, line and column.
    pub place: String,
    /// The fault and its remedy.
    pub message: String,
    /// Whether the file is JSON all the same.
    pub is_json: bool,
}

/// The value that a JSON text describes. `path` is what messages call the file.
///
/// # Errors
/// A text that is no JSON, or whose value is no `T`: then with the keys that lead to what does not fit.
pub fn parse<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T, JsonError> {
    let fail = |error: &serde_json::Error, message: String, is_json| JsonError {
        place: format!("{}:{}:{}", path.display(), error.line().max(1), error.column().max(1)),
        message,
        is_json,
    };
    serde_json::from_str::<Value>(text).map_err(|error| {
        let message = if text.trim().is_empty() {
            "the file is empty".to_owned()
        } else {
            format!("this is no JSON: {}", syntax(&bare(&error)))
        };
        fail(&error, message, false)
    })?;
    let mut reader = serde_json::Deserializer::from_str(text);
    serde_path_to_error::deserialize(&mut reader).map_err(|error| {
        let keys = error.path().to_string();
        let reported = match bare(error.inner()) {
            // The reader of names calls any other value so.
            theirs if theirs == "expected value" => "one of the names known here was expected".to_owned(),
            theirs => Terms::Json.reported(&theirs),
        };
        let message = if keys == "." { reported } else { format!("`{keys}`: {reported}") };
        fail(error.inner(), message, true)
    })
}

/// What a file of this program is, where it is one: `a diagnosis`.
pub fn kind(text: &str) -> Option<&'static str> {
    kinds::of_json(&serde_json::from_str(text).ok()?)
}

/// The message without the place, which is reported before it.
fn bare(error: &serde_json::Error) -> String {
    let reported = error.to_string();
    reported.rsplit_once(" at line ").map_or(reported.as_str(), |(message, _)| message).to_owned()
}

fn syntax(message: &str) -> String {
    match message.strip_prefix("EOF while parsing ") {
        Some(what) => format!("the text ends within {}", what.replace("a value", "a value that is missing")),
        None => message.replace("expected ident", "a word that is none of true, false and null"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn what_does_not_fit_is_named_by_its_keys() {
        let reported = |text: &str| {
            parse::<BTreeMap<String, Vec<u32>>>(Path::new("a.json"), text).expect_err("no such value")
        };
        let error = reported("{\n\"a\": [1, -2]}");
        assert_eq!(error.message, "`a[1]`: expected a whole number, 0 or more, found `-2`");
        assert_eq!((error.place.as_str(), error.is_json), ("a.json:2:11", true));
        assert_eq!(reported("[]").message, "expected an object, found a list");
        assert_eq!(reported("").message, "the file is empty");
        assert!(reported("{\"a\": ").message.starts_with("this is no JSON: the text ends"));
    }
}
