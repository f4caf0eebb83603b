//! What a message holds, by the definition that a log carries: `ros2msg`.

use std::collections::HashMap;

/// Most bytes of a name: ROS 2 allows 255 of a topic.
pub(super) const LONGEST_NAME: usize = 255;

/// A number's form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
}

/// What a field holds once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Element {
    Number(Number),
    Text,
    /// Another message, by its name.
    Message(String),
}

/// How often a field holds it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Repeat {
    Once,
    Times(usize),
    /// As often as stands before it.
    Counted,
}

/// A field of a message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) element: Element,
    pub(super) repeat: Repeat,
}

/// The fields of a message and of those within it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Definition {
    pub(super) fields: Vec<Field>,
    parts: HashMap<String, Vec<Field>>,
}

impl Definition {
    /// None where a line is no field, a name is too long to be one, or a message within has no definition.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let is_rule = |line: &str| line.len() > 3 && line.chars().all(|letter| letter == '=');
        let mut definition = Self::default();
        let mut part: Option<String> = None;
        for line in text.lines().map(|line| line.split('#').next().unwrap_or_default().trim()) {
            if line.is_empty() || is_rule(line) {
                continue;
            }
            if let Some(name) = line.strip_prefix("MSG:") {
                let name = short(name.trim());
                definition.parts.insert(name.clone(), Vec::new());
                part = Some(name);
                continue;
            }
            let Some(field) = field(line)? else { continue };
            match &part {
                None => definition.fields.push(field),
                Some(name) => definition.parts.get_mut(name)?.push(field),
            }
        }
        let is_known = |field: &Field| match &field.element {
            Element::Message(name) => definition.parts.contains_key(name),
            _ => true,
        };
        let all = definition.fields.iter().chain(definition.parts.values().flatten());
        let is_whole = !definition.fields.is_empty() && all.into_iter().all(is_known);
        is_whole.then_some(definition)
    }

    /// The fields of a message within.
    pub(super) fn part(&self, name: &str) -> &[Field] {
        self.parts.get(name).map_or(&[], Vec::as_slice)
    }
}

/// `std_msgs/msg/Header` and `std_msgs/Header` are one; the package counts.
fn short(name: &str) -> String {
    name.replace("/msg/", "/")
}

/// A field; none within where the line is a constant.
fn field(line: &str) -> Option<Option<Field>> {
    let (kind, rest) = line.split_once(char::is_whitespace)?;
    let name = rest.split_whitespace().next().filter(|name| name.len() <= LONGEST_NAME)?;
    if name.contains('=') || rest.split_whitespace().nth(1).is_some_and(|word| word.starts_with('=')) {
        return Some(None);
    }
    let (kind, repeat) = match kind.split_once('[') {
        None => (kind, Repeat::Once),
        Some((kind, size)) => match size.trim_end_matches(']') {
            "" => (kind, Repeat::Counted),
            size if size.starts_with("<=") => (kind, Repeat::Counted),
            size => (kind, Repeat::Times(size.parse().ok()?)),
        },
    };
    let kind = kind.split("<=").next()?;
    let element = match kind {
        "bool" | "byte" | "uint8" | "octet" => Element::Number(Number::U8),
        "char" | "int8" => Element::Number(Number::I8),
        "uint16" => Element::Number(Number::U16),
        "int16" => Element::Number(Number::I16),
        "uint32" => Element::Number(Number::U32),
        "int32" => Element::Number(Number::I32),
        "uint64" => Element::Number(Number::U64),
        "int64" => Element::Number(Number::I64),
        "float32" => Element::Number(Number::F32),
        "float64" => Element::Number(Number::F64),
        "string" => Element::Text,
        "time" | "duration" => Element::Message("builtin_interfaces/Time".to_owned()),
        "Header" => Element::Message("std_msgs/Header".to_owned()),
        other => Element::Message(short(other)),
    };
    Some(Some(Field { name: name.to_owned(), element, repeat }))
}
