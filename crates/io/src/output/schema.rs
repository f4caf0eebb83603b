//! JSON Schemas (draft 2020-12) of what is written, derived from the types that are serialised.

use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value, json};

/// The schema of an object as `T` is serialised; `title` is the name and version of its layout.
///
/// No object has a key that is not described. Descriptions are the documentation of types and fields, their first paragraph.
pub fn schema<T: JsonSchema>(title: &str) -> Schema {
    let settings = SchemaSettings::draft2020_12().for_serialize();
    let mut schema = settings
        .with_transform(RecursiveTransform(close))
        .with_transform(RecursiveTransform(plain))
        .into_generator()
        .into_root_schema_for::<T>();
    schema.insert("title".to_owned(), title.into());
    schema
}

/// The same of an object whose first key, `schema`, holds the name of its layout: as [`stamped`](super::stamped) writes it.
pub fn stamped_schema<T: JsonSchema>(title: &str) -> Schema {
    let mut schema = schema::<T>(title);
    stamp(schema.ensure_object(), title);
    schema
}

/// Adds the key; of several forms to each.
fn stamp(schema: &mut Map<String, Value>, title: &str) {
    if let Some(Value::Object(properties)) = schema.get_mut("properties") {
        let key = json!({ "description": "Name and version of this layout.", "const": title });
        properties.insert("schema".to_owned(), key);
    }
    if let Some(Value::Array(required)) = schema.get_mut("required") {
        required.insert(0, "schema".into());
    }
    if let Some(Value::Array(forms)) = schema.get_mut("anyOf") {
        forms.iter_mut().filter_map(Value::as_object_mut).for_each(|form| stamp(form, title));
    }
}

/// The text of a schema's file: indented, a list of words or numbers on one line.
pub fn schema_text(schema: &Schema) -> String {
    let indented = serde_json::to_string_pretty(schema).expect("a schema is JSON");
    let mut lines = indented.lines().peekable();
    let mut text = String::new();
    while let Some(line) = lines.next() {
        text.push_str(line);
        let opens = |line: &str| line.ends_with(['[', '{']);
        if line.ends_with('[') && lines.peek().is_some_and(|first| !opens(first)) {
            for item in lines.by_ref() {
                let item = item.trim_start();
                text.push_str(item);
                if item.starts_with(']') {
                    break;
                }
                text.push_str(if item.ends_with(',') { " " } else { "" });
            }
        }
        text.push('\n');
    }
    text
}

/// An object has the keys that are listed, and no other.
fn close(schema: &mut Schema) {
    if schema.get("properties").is_some() {
        schema.remove("unevaluatedProperties");
        schema.insert("additionalProperties".to_owned(), false.into());
    }
}

/// Without the width of numbers in memory and the values that readers take for missing keys; of a documentation the first paragraph.
fn plain(schema: &mut Schema) {
    schema.remove("format");
    schema.remove("default");
    if let Some(Value::String(description)) = schema.get_mut("description") {
        let first = description.split("\n\n").next().unwrap_or_default();
        *description = first.replace('\n', " ");
    }
}
