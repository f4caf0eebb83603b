//! JSON objects that say what they are.

use serde::Serialize;

/// An object behind the name and version of its layout.
#[derive(Serialize)]
struct Stamped<'a, T> {
    schema: &'a str,
    #[serde(flatten)]
    body: &'a T,
}

/// An object as JSON, indented, with a newline at its end; its first key is `schema`.
///
/// ```
/// # use switchback_io::output::stamped;
/// let text = stamped("switchback/rig/1", &serde_json::json!({"order": 2}));
/// assert_eq!(text, "{\n  \"schema\": \"switchback/rig/1\",\n  \"order\": 2\n}\n");
/// ```
///
/// # Panics
/// Where `body` is no object.
pub fn stamped(schema: &str, body: &impl Serialize) -> String {
    serde_json::to_string_pretty(&Stamped { schema, body }).expect("an object of numbers and strings is JSON")
        + "\n"
}
