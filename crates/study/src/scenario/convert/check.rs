//! Checks that several parts of a scenario need.

use crate::scenario::error::Fault;
use std::collections::HashSet;
use std::fmt::Display;
use std::hash::Hash;
use switchback_io::input::closest;
use toml::Spanned;

pub(super) fn positive(x: &Spanned<f64>) -> Result<f64, Fault> {
    let value = *x.get_ref();
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Fault::new(x.span(), "must be positive and finite", "write a number above 0"))
    }
}

/// A count within what can be run; `what` are counted.
pub(super) fn at_most(count: &Spanned<usize>, limit: usize, what: &str) -> Result<usize, Fault> {
    match *count.get_ref() {
        found if found <= limit => Ok(found),
        _ => Err(Fault::new(
            count.span(),
            format!("more than {limit} {what}"),
            format!("write {limit} or less"),
        )),
    }
}

/// A name stands in tables and pictures, on one line.
pub(super) fn in_one_line(name: &Spanned<String>) -> Result<(), Fault> {
    if name.get_ref().contains(char::is_control) {
        return Err(Fault::new(
            name.span(),
            "the name holds a control character",
            "write it in letters, on one line",
        ));
    }
    Ok(())
}

pub(super) fn non_empty<T>(list: &Spanned<Vec<T>>) -> Result<&[T], Fault> {
    match list.get_ref().as_slice() {
        [] => Err(Fault::new(list.span(), "the list is empty", "give at least one entry")),
        items => Ok(items),
    }
}

pub(super) fn distinct<'a, T: Eq + Hash + Display + 'a>(
    items: impl Iterator<Item = &'a Spanned<T>>,
) -> Result<(), Fault> {
    let mut seen = HashSet::new();
    for item in items {
        if !seen.insert(item.get_ref()) {
            return Err(Fault::new(item.span(), "given twice", "remove or rename one of them"));
        }
    }
    Ok(())
}

pub(super) fn unknown(name: &Spanned<String>, what: &str, valid: &[&str]) -> Fault {
    let guess = closest(name.get_ref(), valid.iter().copied());
    let guess = guess.map_or_else(String::new, |g| format!("did you mean \"{g}\"? "));
    Fault::new(name.span(), format!("no such {what}"), format!("{guess}valid: {}", valid.join(", ")))
}
