//! Options of a call: each by its name, with its values as texts, which the library parses.

use crate::refusal::Refusal;
use pyo3::FromPyObject;
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::fmt::Display;
use switchback_io::threads::Threads;
use switchback_io::values::{named, whole};

/// Options by their names, as `sample_time`; a switch that is on has no value.
///
/// Each is asked for as the command line shows it, `--sample-time <SECONDS>`, and so do messages name it.
#[derive(Debug, FromPyObject)]
pub(crate) struct Options(BTreeMap<String, Vec<String>>);

impl Options {
    fn take(&mut self, option: &str) -> Option<Vec<String>> {
        let name = option.trim_start_matches('-').split(' ').next().unwrap_or_default();
        self.0.remove(&name.replace('-', "_"))
    }

    /// Whether a switch is on.
    pub(crate) fn switch(&mut self, option: &str) -> Result<bool, Refusal> {
        match self.take(option).as_deref() {
            None => Ok(false),
            Some([]) => Ok(true),
            Some([value, ..]) => {
                let message =
                    format!("unexpected value '{value}' for '{option}' found; no more were expected");
                Err(Refusal::new(message))
            }
        }
    }

    /// The value of an option that may be left out.
    pub(crate) fn value<T, E: Display>(
        &mut self,
        option: &str,
        parse: impl Fn(&str) -> Result<T, E>,
    ) -> Result<Option<T>, Refusal> {
        let Some(values) = self.take(option) else { return Ok(None) };
        match &values[..] {
            [] => Err(wanting(option)),
            [value] => match parse(value) {
                Ok(parsed) => Ok(Some(parsed)),
                Err(error) => Err(Refusal::new(format!("invalid value '{value}' for '{option}': {error}"))),
            },
            _ => Err(Refusal::new(format!("the argument '{option}' cannot be used multiple times"))),
        }
    }

    /// The same of an option that takes any text.
    pub(crate) fn text(&mut self, option: &str) -> Result<Option<String>, Refusal> {
        self.value(option, |text| Ok::<_, Infallible>(text.to_owned()))
    }

    /// The ones out of `all` that an option names.
    pub(crate) fn names<T: Copy>(
        &mut self,
        option: &str,
        all: &[T],
        name: impl Fn(&T) -> &'static str,
    ) -> Result<Vec<T>, Refusal> {
        let one = |value: &String| {
            let refuse = |error| Refusal::new(format!("invalid value '{value}' for '{option}'\n  {error}"));
            if value.is_empty() { Err(wanting(option)) } else { named(value, all, &name).map_err(refuse) }
        };
        match self.take(option).as_deref() {
            Some([]) => Err(wanting(option)),
            values => values.into_iter().flatten().map(one).collect(),
        }
    }

    /// The one out of `all` that an option names, where it is not left out.
    pub(crate) fn name<T: Copy>(
        &mut self,
        option: &str,
        all: &[T],
        name: impl Fn(&T) -> &'static str,
    ) -> Result<Option<T>, Refusal> {
        match self.names(option, all, name)?[..] {
            [] => Ok(None),
            [one] => Ok(Some(one)),
            _ => Err(Refusal::new(format!("the argument '{option}' cannot be used multiple times"))),
        }
    }

    /// The number of threads.
    pub(crate) fn threads(&mut self) -> Result<Threads, Refusal> {
        Ok(Threads(self.value("--threads <N>", whole(1..=Threads::MOST.into()))?))
    }

    /// What was given must have been asked for: else the two halves of this package do not agree.
    pub(crate) fn finish(self) -> Result<(), Refusal> {
        match self.0.keys().next() {
            None => Ok(()),
            Some(name) => Err(Refusal::new(format!("there is no option `{name}`"))),
        }
    }
}

/// An option that must not be left out.
pub(crate) fn required<T>(option: &str, value: Option<T>) -> Result<T, Refusal> {
    value.ok_or_else(|| {
        Refusal::new(format!("the following required arguments were not provided:\n  {option}"))
    })
}

fn wanting(option: &str) -> Refusal {
    Refusal::new(format!("a value is required for '{option}' but none was supplied"))
}
