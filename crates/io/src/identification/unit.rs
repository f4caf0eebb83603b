//! The unit in a label.

/// The unit in a label, `N` in `force [N]`; empty where there is none.
pub fn unit(label: &str) -> &str {
    let within = label.split_once('[').and_then(|(_, rest)| rest.split_once(']'));
    // `position[2]` is the third of several alike.
    let is_unit = |unit: &&str| !unit.is_empty() && !unit.bytes().all(|byte| byte.is_ascii_digit());
    within.map(|(unit, _)| unit.trim()).filter(is_unit).unwrap_or_default()
}
