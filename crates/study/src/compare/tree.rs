//! Where two JSON values differ by more than rounding.

use serde_json::{Map, Value};

/// A place where two values differ.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Change {
    /// The keys that lead there, the outermost first; entries of a list by what names them.
    pub(super) path: Vec<String>,
    /// There in the first value; none where it has nothing there.
    pub(super) from: Option<Value>,
    /// There in the second.
    pub(super) to: Option<Value>,
}

/// Keys whose values name an entry of a list.
const NAMES: [&str; 9] = ["case", "border", "name", "what", "series", "subject", "over", "group", "samples"];

/// Longest text of a value that is shown.
const LONG: usize = 60;

impl Change {
    /// The last key.
    pub(super) fn key(&self) -> &str {
        self.path.last().map_or("", String::as_str)
    }

    /// On a line: `summaries, a: verdict, "consistent" → "inconsistent"`.
    pub(super) fn line(&self) -> String {
        let shown = |value: &Option<Value>| match value {
            None | Some(Value::Null) => "none".to_owned(),
            Some(value) => {
                let text = value.to_string();
                let short: String = text.chars().take(LONG).collect();
                if short.len() < text.len() { short + "…" } else { text }
            }
        };
        format!("{}, {} → {}", self.path.join(": "), shown(&self.from), shown(&self.to))
    }
}

/// All places where two values differ, numbers by more than this share of themselves.
pub(super) fn changes(one: &Value, other: &Value, rounding: f64) -> Vec<Change> {
    let mut walk = Walk { rounding, path: Vec::new(), found: Vec::new() };
    walk.value(Some(one), Some(other));
    walk.found
}

struct Walk {
    rounding: f64,
    path: Vec<String>,
    found: Vec<Change>,
}

impl Walk {
    fn value(&mut self, one: Option<&Value>, other: Option<&Value>) {
        match (one, other) {
            (Some(Value::Object(one)), Some(Value::Object(other))) => self.object(one, other),
            (Some(Value::Array(one)), Some(Value::Array(other))) => self.list(one, other),
            (one, other) if self.is_same(one, other) => {}
            (one, other) => {
                self.found.push(Change { path: self.path.clone(), from: one.cloned(), to: other.cloned() })
            }
        }
    }

    fn object(&mut self, one: &Map<String, Value>, other: &Map<String, Value>) {
        let new = other.keys().filter(|key| !one.contains_key(*key));
        for key in one.keys().chain(new) {
            self.at(key.clone(), one.get(key), other.get(key));
        }
    }

    /// Entries that have names are compared by them, others by their places. A short list of numbers is a figure with its errors.
    fn list(&mut self, one: &[Value], other: &[Value]) {
        if let (Some(a), Some(b)) = (numbers(one), numbers(other))
            && a.len() == b.len()
        {
            if !self.is_same_figure(&a, &b) {
                let (from, to) = (Some(Value::from(one.to_vec())), Some(Value::from(other.to_vec())));
                self.found.push(Change { path: self.path.clone(), from, to });
            }
            return;
        }
        let names =
            |list: &[Value]| list.iter().enumerate().map(|(k, value)| name(k, value)).collect::<Vec<_>>();
        let (of_one, of_other) = (names(one), names(other));
        for (k, name) in of_one.iter().enumerate() {
            let twin = of_other.iter().position(|other| other == name);
            self.at(name.clone(), Some(&one[k]), twin.map(|twin| &other[twin]));
        }
        for (k, name) in of_other.iter().enumerate().filter(|(_, name)| !of_one.contains(name)) {
            self.at(name.clone(), None, Some(&other[k]));
        }
        if of_one.len() != of_other.len() {
            let count = |list: &[Value]| Some(Value::from(list.len()));
            self.path.push("number of entries".to_owned());
            self.found.push(Change { path: self.path.clone(), from: count(one), to: count(other) });
            self.path.pop();
        }
    }

    fn at(&mut self, key: String, one: Option<&Value>, other: Option<&Value>) {
        self.path.push(key);
        self.value(one, other);
        self.path.pop();
    }

    fn is_same(&self, one: Option<&Value>, other: Option<&Value>) -> bool {
        match (one.and_then(Value::as_f64), other.and_then(Value::as_f64)) {
            (Some(one), Some(other)) => (one - other).abs() <= self.rounding * one.abs().max(other.abs()),
            _ => one.filter(|value| !value.is_null()) == other.filter(|value| !value.is_null()),
        }
    }

    /// A figure near zero is rounded as its error is.
    fn is_same_figure(&self, one: &[f64], other: &[f64]) -> bool {
        let scale = one.iter().chain(other).fold(0.0, |most: f64, x| most.max(x.abs()));
        one.iter().zip(other).all(|(one, other)| (one - other).abs() <= self.rounding * scale)
    }
}

/// The numbers of a short list of nothing else.
fn numbers(list: &[Value]) -> Option<Vec<f64>> {
    let all: Option<Vec<f64>> = list.iter().map(Value::as_f64).collect();
    all.filter(|all| (1..=3).contains(&all.len()))
}

fn name(place: usize, value: &Value) -> String {
    let mut words = Vec::new();
    for key in NAMES {
        words.extend(value.get(key).into_iter().flat_map(words_of));
    }
    if words.is_empty() { (place + 1).to_string() } else { words.join(", ") }
}

fn words_of(value: &Value) -> Vec<String> {
    match value {
        Value::String(text) => vec![text.clone()],
        Value::Object(fields) => fields.values().flat_map(words_of).collect(),
        Value::Array(list) => list.iter().flat_map(words_of).collect(),
        Value::Null => Vec::new(),
        other => vec![other.to_string()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_differs_is_reported_at_its_place() {
        let one = json!({ "a": 1.0, "list": [{ "name": "x" }, { "name": "y", "n": 2 }], "removed": true });
        let other = json!({ "a": 1.0 + 1e-12, "list": [{ "name": "y", "n": 3 }], "new": null, "text": "t" });
        let mut lines: Vec<String> = changes(&one, &other, 1e-8).iter().map(Change::line).collect();
        // The order of keys is left to the reader of JSON.
        lines.sort();
        assert_eq!(
            lines,
            [
                "list: number of entries, 2 → 1",
                "list: x, {\"name\":\"x\"} → none",
                "list: y: n, 2 → 3",
                "removed, true → none",
                "text, none → \"t\"",
            ]
        );
    }

    #[test]
    fn a_figure_near_zero_is_rounded_as_its_error_is() {
        assert!(changes(&json!([1e-9, 1.0]), &json!([2e-9, 1.0]), 1e-8).is_empty());
        assert_eq!(changes(&json!([1e-7, 1.0]), &json!([2e-7, 1.0]), 1e-8).len(), 1);
        assert_eq!(changes(&json!([0, 1, 2, 3]), &json!([0, 1, 2, 4]), 1e-8).len(), 1);
    }
}
