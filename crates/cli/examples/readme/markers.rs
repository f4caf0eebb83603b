//! Text between markers.

use std::collections::{BTreeMap, BTreeSet};

/// The text with the quotes put between their markers; `{}` in a marker stands for the quote's name. Shows which were quoted.
///
/// # Errors
/// What is wrong with the text: a name that there is no quote for, or a marker without its end.
pub(crate) fn filled(
    text: &str,
    (begin, end): (&str, &str),
    quotes: &BTreeMap<String, String>,
    quoted: &mut BTreeSet<String>,
) -> Result<String, String> {
    let (opening, closing) = begin.split_once("{}").unwrap_or((begin, ""));
    let (mut filled, mut rest) = (String::new(), text);
    while let Some(start) = rest.find(opening) {
        let named = &rest[start + opening.len()..];
        let length = named.find(closing).ok_or_else(|| format!("a marker `{opening}` has no end"))?;
        let (name, behind) = (&named[..length], &named[length + closing.len()..]);
        let quote = quotes.get(name).ok_or_else(|| format!("`{name}` is no figure that can be quoted"))?;
        let end = end.replace("{}", name);
        let stop = behind.find(&end).ok_or_else(|| format!("`{name}` has no `{end}`"))?;
        filled.push_str(&rest[..start]);
        filled.push_str(&begin.replace("{}", name));
        filled.push_str(quote);
        filled.push_str(&end);
        quoted.insert(name.to_owned());
        rest = &behind[stop + end.len()..];
    }
    Ok(filled + rest)
}
