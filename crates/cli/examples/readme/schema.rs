//! A JSON Schema as a table of keys.

use serde_json::Value;
use std::fmt::Write;

/// A row a key that has a description: its path, what it holds, what it says. Parts that occur in several places come behind, by their name.
pub(crate) fn table(schema: &Value) -> String {
    let mut text = "| key | holds | |\n|---|---|---|\n".to_owned();
    rows(schema, "", &mut text);
    for (name, part) in schema["$defs"].as_object().into_iter().flatten() {
        rows(part, &format!("*{name}*."), &mut text);
    }
    text
}

/// The keys below a schema; `path` is what stands before them.
fn rows(schema: &Value, path: &str, text: &mut String) {
    let is_object = |schema: &&Value| schema["properties"].is_object();
    let choices = schema["anyOf"].as_array();
    if let Some(list) = schema.get("items").filter(|items| items.is_object()) {
        let stem = path.strip_suffix('.').unwrap_or(path);
        return rows(list, &format!("{stem}[]."), text);
    }
    if let Some(one) = choices.and_then(|choices| choices.iter().find(is_object)) {
        return rows(one, path, text);
    }
    for (key, value) in schema["properties"].as_object().into_iter().flatten() {
        let reported = value["description"].as_str();
        if let Some(reported) = reported {
            let _ = writeln!(text, "| {path}`{key}` | {} | {} |", kind(value), reported.replace('|', "\\|"));
        }
        rows(value, &format!("{path}`{key}`."), text);
    }
}

/// What a value is, in a word or two.
fn kind(schema: &Value) -> String {
    let name = |kind: &str| match kind {
        "string" => "text".to_owned(),
        "boolean" => "yes or no".to_owned(),
        "integer" => "whole number".to_owned(),
        "array" => format!("list of {}", plural(&schema["items"])),
        other => other.to_owned(),
    };
    if let Some(part) = part(schema) {
        return format!("*{part}*");
    }
    if let Some(value) = schema.get("const") {
        return format!("`{value}`");
    }
    if let Some(choices) = schema["anyOf"].as_array() {
        let kinds: Vec<String> = choices.iter().map(kind).collect();
        return kinds.join(" or ");
    }
    match &schema["type"] {
        Value::Array(kinds) => {
            kinds.iter().filter_map(Value::as_str).map(name).collect::<Vec<_>>().join(" or ")
        }
        kind => kind.as_str().map(name).unwrap_or_default(),
    }
}

/// What the entries of a list are.
fn plural(items: &Value) -> String {
    match (part(items), items["type"].as_str()) {
        (Some(part), _) => format!("*{part}*"),
        (None, Some("string")) => "texts".to_owned(),
        (None, Some("array")) => "lists".to_owned(),
        (None, Some("object")) => "objects".to_owned(),
        (None, Some("integer")) => "whole numbers".to_owned(),
        (None, None) if items.get("anyOf").is_some() => "objects".to_owned(),
        _ => "numbers".to_owned(),
    }
}

/// The name of the part that a schema refers to.
fn part(schema: &Value) -> Option<&str> {
    schema["$ref"].as_str().and_then(|path| path.strip_prefix("#/$defs/"))
}
