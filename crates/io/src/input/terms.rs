//! What the readers of TOML and JSON stumble over, without the names of Rust's types.

/// What a file's format calls its parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Terms {
    Toml,
    Json,
}

impl Terms {
    fn object(self) -> &'static str {
        match self {
            Self::Toml => "a table",
            Self::Json => "an object",
        }
    }

    fn key(self) -> &'static str {
        match self {
            Self::Toml => "key",
            Self::Json => "field",
        }
    }

    /// A reader's message in the words of somebody who writes such files.
    pub(super) fn reported(self, message: &str) -> String {
        let message = message.trim_end();
        let kinds = ["invalid type: ", "invalid value: ", "invalid length "];
        let contrast = kinds.into_iter().find_map(|kind| {
            let (found, wanted) = message.strip_prefix(kind)?.split_once(", expected ")?;
            let found = if kind.contains("length") { entries(found) } else { self.found(found) };
            Some(format!("expected {}, found {found}", self.wanted(wanted)))
        });
        if let Some(reported) = contrast {
            return reported;
        }
        let key = self.key();
        if let Some(name) = message.strip_prefix("missing field ") {
            return match self {
                Self::Toml => format!("missing key {name}"),
                Self::Json => format!("there is no field {name}"),
            };
        }
        for (theirs, ours) in [("unknown field", "unknown"), ("duplicate field", "duplicate")] {
            if let Some(rest) = message.strip_prefix(theirs) {
                return format!(
                    "{ours} {key}{}",
                    rest.replace("there are no fields", &format!("no {key} is known here"))
                );
            }
        }
        if let Some(rest) = message.strip_prefix("unknown variant ") {
            return rest.replacen(", expected", " is not known here, expected", 1);
        }
        if message == "wanted string or table" || message.starts_with("wanted exactly 1 element") {
            return "expected one of the names known here, as text".to_owned();
        }
        if message.starts_with("data did not match any variant") {
            return "the value is of no kind that can stand here".to_owned();
        }
        message.to_owned()
    }

    /// What was found, as serde calls it.
    fn found(self, theirs: &str) -> String {
        // A whole number that fits no type.
        let theirs = theirs.trim_end_matches(" as i128").trim_end_matches(" as u128");
        let bare = ["integer ", "floating point ", "boolean ", "character ", "string "];
        if let Some(value) = bare.into_iter().find_map(|kind| theirs.strip_prefix(kind)) {
            return value.to_owned();
        }
        match theirs {
            "map" => self.object().to_owned(),
            "sequence" => "a list".to_owned(),
            "null" | "unit value" | "Option value" => "null".to_owned(),
            other if other.ends_with("variant") || other.ends_with("struct") => "something else".to_owned(),
            other => other.to_owned(),
        }
    }

    /// What was wanted, by the name of a type of Rust or as serde describes it.
    fn wanted(self, theirs: &str) -> String {
        let reported = match theirs {
            "f64" | "f32" => "a number",
            "usize" | "u8" | "u16" | "u32" | "u64" | "u128" | "nonzero u64" => "a whole number, 0 or more",
            "isize" | "i8" | "i16" | "i32" | "i64" | "i128" => "a whole number",
            "a boolean" => "true or false",
            "a string" | "str" | "string" => "text",
            "a sequence" => "a list",
            "a map" => self.object(),
            "unit" => "nothing",
            "variant identifier" | "field identifier" => "one of the names known here",
            other if other.starts_with("enum ") => "one of the names known here",
            other if other.starts_with("struct ") => self.object(),
            other => return self.counted(other).unwrap_or_else(|| other.to_owned()),
        };
        reported.to_owned()
    }

    /// `a tuple of size 3`, `an array of length 3`, `tuple variant X with 3 elements` and the like.
    fn counted(self, theirs: &str) -> Option<String> {
        let is_list = theirs.contains("tuple") || theirs.contains("array");
        let count: usize = theirs.split(' ').find_map(|word| word.parse().ok()).filter(|_| is_list)?;
        Some(match (self, count) {
            (Self::Toml, 2) => "two numbers, [low, high]".to_owned(),
            (_, count) => format!("a list of {count} entries"),
        })
    }
}

fn entries(count: &str) -> String {
    if count == "1" { "1 entry".to_owned() } else { format!("{count} entries") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_type_of_rust_is_named() {
        for (theirs, ours) in [
            ("invalid type: null, expected struct Peek", "expected an object, found null"),
            (
                "invalid type: floating point `2.5`, expected usize",
                "expected a whole number, 0 or more, found `2.5`",
            ),
            ("invalid value: integer `-1`, expected u32", "expected a whole number, 0 or more, found `-1`"),
            ("invalid type: string \"x\", expected isize", "expected a whole number, found \"x\""),
            (
                "invalid type: sequence, expected struct variant BorderColumn::Bristle",
                "expected an object, found a list",
            ),
            ("invalid length 1, expected a tuple of size 2", "expected a list of 2 entries, found 1 entry"),
            ("invalid value: integer `99` as i128, expected i64", "expected a whole number, found `99`"),
            ("wanted string or table", "expected one of the names known here, as text"),
            ("unknown variant `x`, expected `a` or `b`", "`x` is not known here, expected `a` or `b`"),
            ("unknown field `x`, there are no fields", "unknown field `x`, no field is known here"),
            ("missing field `a`", "there is no field `a`"),
        ] {
            assert_eq!(Terms::Json.reported(theirs), ours);
        }
        assert_eq!(
            Terms::Toml.reported("invalid type: map, expected f64"),
            "expected a number, found a table"
        );
    }
}
