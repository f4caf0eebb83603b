//! The unit in a label.

/// The unit in a label, `N` in `force [N]`; empty where there is none.
pub fn unit(label: &str) -> &str {
    label.split_once('[').and_then(|(_, rest)| rest.split_once(']')).map_or("", |(unit, _)| unit.trim())
}
