//! Processes of this machine, as /proc shows them.

use std::fs;

pub(crate) struct Process {
    pub(crate) id: u32,
    parent: u32,
    pub(crate) name: String,
}

/// All that can be seen.
pub(crate) fn all() -> Vec<Process> {
    let folders = fs::read_dir("/proc").into_iter().flatten().flatten();
    folders.filter_map(|folder| read(folder.file_name().to_str()?.parse().ok()?)).collect()
}

fn read(id: u32) -> Option<Process> {
    let stat = fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    // number (name) state parent …; the name may hold anything.
    let (before, after) = stat.rsplit_once(')')?;
    let name = before.split_once('(')?.1.to_owned();
    let parent = after.split_whitespace().nth(1)?.parse().ok()?;
    Some(Process { id, parent, name })
}

/// What descends from a process.
pub(crate) fn descendants(of: u32) -> Vec<Process> {
    let (mut found, mut others): (Vec<Process>, Vec<Process>) =
        all().into_iter().partition(|p| p.parent == of);
    let mut next = 0;
    while let Some(parent) = found.get(next).map(|p| p.id) {
        let (children, rest) = others.into_iter().partition(|p| p.parent == parent);
        (others, next) = (rest, next + 1);
        found.extend::<Vec<Process>>(children);
    }
    found
}

/// Whether a variable of a process's environment has a value.
pub(crate) fn has_variable(id: u32, name: &str, value: &str) -> bool {
    let wanted = format!("{name}={value}");
    let environment = fs::read(format!("/proc/{id}/environ")).unwrap_or_default();
    environment.split(|byte| *byte == 0).any(|variable| variable == wanted.as_bytes())
}

/// The number that a file holds.
pub(crate) fn number_in(file: &std::path::Path) -> Option<u32> {
    fs::read_to_string(file).ok()?.trim().parse().ok()
}

/// Ends a process at once.
pub(crate) fn kill(id: u32) {
    let _ = std::process::Command::new("kill").args(["-9", &id.to_string()]).status();
}

pub(crate) fn parent(id: u32) -> Option<u32> {
    Some(read(id)?.parent)
}
