//! What a method of a sweep is called.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;
use switchback_identify::Method;

/// A method of a sweep: one of Switchback's, or one of others under the name that the scenario gives it. The serialised form is the name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MethodName {
    /// One of Switchback's.
    Own(Method),
    /// One of others.
    Foreign(ForeignName),
}

/// The name of a method of others: it stands in tables and names files.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ForeignName(Arc<str>);

/// Most letters of such a name.
const LONGEST: usize = 40;

impl ForeignName {
    /// What such a name may be.
    pub const RULE: &'static str =
        "up to 40 letters, digits, `-` and `_`, the first a letter or a digit, and none of Switchback's own";

    /// The name; `None` where it is too long, has other characters, or is one of Switchback's methods.
    pub fn new(name: &str) -> Option<Self> {
        let is_fit = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        let is_sound = name.len() <= LONGEST
            && name.starts_with(|c: char| c.is_ascii_alphanumeric())
            && name.chars().all(is_fit)
            && !Method::ALL.iter().any(|method| method.name().eq_ignore_ascii_case(name));
        is_sound.then(|| Self(name.into()))
    }

    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl MethodName {
    /// The name used in scenario files and results.
    pub fn name(&self) -> &str {
        match self {
            Self::Own(method) => method.name(),
            Self::Foreign(name) => name.as_str(),
        }
    }

    /// Whether it is a method of others.
    pub fn is_foreign(&self) -> bool {
        matches!(self, Self::Foreign(_))
    }

    /// The method of that name; `None` where it can be nobody's.
    pub fn from_name(name: &str) -> Option<Self> {
        let own = Method::from_name(name).map(Self::Own);
        own.or_else(|| ForeignName::new(name).map(Self::Foreign))
    }
}

impl From<Method> for MethodName {
    fn from(method: Method) -> Self {
        Self::Own(method)
    }
}

impl PartialEq<Method> for MethodName {
    fn eq(&self, method: &Method) -> bool {
        matches!(self, Self::Own(own) if own == method)
    }
}

impl fmt::Display for MethodName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl Serialize for MethodName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for MethodName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = <Cow<'de, str>>::deserialize(deserializer)?;
        let refusal = || de::Error::custom(format!("`{name}` is no name of a method: {}", ForeignName::RULE));
        Self::from_name(&name).ok_or_else(refusal)
    }
}

impl JsonSchema for MethodName {
    fn schema_name() -> Cow<'static, str> {
        "MethodName".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let own = generator.subschema_for::<Method>();
        let foreign = json_schema!({
            "description": "A method of others, by its name in the scenario.",
            "type": "string",
            "pattern": "^[A-Za-z0-9][A-Za-z0-9_-]{0,39}$",
        });
        json_schema!({ "description": "A method of a sweep.", "anyOf": [own, foreign] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back_and_no_other_is_taken() {
        for name in ["joint", "free", "sippy", "arx_2-b", "2sls"] {
            let method = MethodName::from_name(name).expect("a name");
            assert_eq!(method.is_foreign(), Method::from_name(name).is_none());
            let json = serde_json::to_string(&method).expect("a name serialises");
            assert_eq!(json, format!("\"{name}\""));
            assert_eq!(serde_json::from_str::<MethodName>(&json).expect("it reads back"), method);
        }
        let long = "x".repeat(LONGEST + 1);
        for name in ["", "../a", "a b", "Joint", "-a", "ä", long.as_str()] {
            assert!(MethodName::from_name(name).is_none(), "{name}");
        }
        assert_eq!(MethodName::from(Method::Joint), Method::Joint);
    }
}
