//! Names out of a list.

use std::error::Error;
use std::fmt;
use strsim::jaro;

/// How alike two names must be for one to stand for the other, by the measure of Jaro: 0 for strangers, 1 for equals.
const ALIKE: f64 = 0.7;

/// A name that is in no list, with those that are.
///
/// ```text
/// [possible values: free, joint]
///
///   tip: a similar value exists: 'free'
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownName {
    known: Vec<&'static str>,
    similar: Option<&'static str>,
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[possible values: {}]", self.known.join(", "))?;
        match self.similar {
            Some(similar) => write!(f, "\n\n  tip: a similar value exists: '{similar}'"),
            None => Ok(()),
        }
    }
}

impl Error for UnknownName {}

/// The one of `all` whose name is `text`.
///
/// ```
/// use switchback_io::values::named;
/// let named = |text| named(text, &[1, 2], |number| if *number == 1 { "one" } else { "two" });
/// assert_eq!(named("two"), Ok(2));
/// assert!(named("twoo").unwrap_err().to_string().ends_with("tip: a similar value exists: 'two'"));
/// ```
///
/// # Errors
/// [`UnknownName`] with all names.
pub fn named<T: Copy>(text: &str, all: &[T], name: impl Fn(&T) -> &'static str) -> Result<T, UnknownName> {
    let found = all.iter().copied().find(|one| name(one) == text);
    found.ok_or_else(|| {
        let known: Vec<&str> = all.iter().map(name).collect();
        let alike = known.iter().map(|name| (jaro(text, name), *name)).filter(|(alike, _)| *alike > ALIKE);
        let similar = alike.max_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, name)| name);
        UnknownName { known, similar }
    })
}
