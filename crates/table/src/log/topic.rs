//! What a log that is written holds.

use std::collections::BTreeSet;

/// A topic: numbers at instants.
#[derive(Debug, Clone, PartialEq)]
pub struct LogTopic {
    /// Its name, as `/record`.
    pub name: String,
    /// When each message was, in nanoseconds.
    pub instants: Vec<u64>,
    /// What a message holds.
    pub fields: Vec<LogField>,
}

/// A number of every message.
#[derive(Debug, Clone, PartialEq)]
pub struct LogField {
    /// Its name: letters, digits and underscores.
    pub name: String,
    /// What stands behind it in the definition of messages: one line.
    pub comment: String,
    /// Its values, one a message; NaN where there is none.
    pub values: Vec<f64>,
}

impl LogTopic {
    /// Topics named after other things, each by a name of its own that ROS 2 allows.
    pub fn names<'a>(wanted: impl IntoIterator<Item = &'a str>) -> Vec<String> {
        let mut taken = BTreeSet::new();
        let of = |wanted: &str| {
            let letters = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
            let word: String = wanted.chars().map(letters).collect();
            let is_word = word.starts_with(|c: char| c.is_ascii_alphabetic());
            if is_word { format!("/{word}") } else { format!("/record_{word}") }
        };
        let mut own = |name: String| {
            let numbered = |k: usize| format!("{name}_{k}");
            let free =
                std::iter::once(name.clone()).chain((2..).map(numbered)).find(|name| !taken.contains(name));
            let free = free.unwrap_or(name);
            taken.insert(free.clone());
            free
        };
        wanted.into_iter().map(|wanted| own(of(wanted))).collect()
    }

    /// The name of its messages.
    #[cfg_attr(not(feature = "mcap"), allow(dead_code, reason = "no log is written"))]
    pub(super) fn kind(&self) -> String {
        let upper = |word: &str| word[..1].to_uppercase() + &word[1..];
        let words = self.name.split(['/', '_']).filter(|word| !word.is_empty());
        format!("switchback_msgs/msg/{}", words.map(upper).collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_topic_has_a_name_of_its_own() {
        let names = LogTopic::names(["run 1", "run-1", "2", "größe", "run_1_2"]);
        assert_eq!(names, ["/run_1", "/run_1_2", "/record_2", "/gr__e", "/run_1_2_2"]);
    }
}
