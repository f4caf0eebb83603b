//! A key of a table, taken out.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Removes a key from a table and hands over its value.
pub(super) fn take<'i>(table: &mut DeTable<'i>, name: &str) -> Option<Spanned<DeValue<'i>>> {
    let key = table.keys().find(|k| k.get_ref() == name).cloned()?;
    table.remove(&key)
}
