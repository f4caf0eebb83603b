//! The table of a log's numbers.

use super::fault::Fault;
use super::records::Numbers;
use super::tree::{Group, Tree};
use crate::table::{Column, Place, Table, empty_column};
use std::path::Path;

/// Groups that are named in a note.
const SHOWN: usize = 8;

/// A table, and the group and channel of each of its columns.
pub(super) struct Columns {
    pub(super) table: Table,
    pub(super) origins: Vec<(usize, usize)>,
    /// Records of each group.
    rows: Vec<usize>,
}

impl Columns {
    /// Groups with their clocks; rows are records, each group's counted by itself. Of several groups those without a clock are left out.
    ///
    /// # Errors
    /// Where no group has records with numbers and a clock.
    pub(super) fn of(tree: &Tree, numbers: Vec<Numbers>, path: &Path) -> Result<Self, Fault> {
        let mut notes = notes(tree);
        let is_single = tree.is_single();
        let records = numbers.iter().map(|numbers| numbers.rows).collect();
        let mut taken: Vec<(usize, Numbers)> = Vec::new();
        let mut without_clock: Vec<&str> = Vec::new();
        let mut faults: Vec<String> = Vec::new();
        for (k, numbers) in numbers.into_iter().enumerate() {
            let group = &tree.groups[k];
            if let Some(fault) = numbers.broken.as_ref().filter(|_| !numbers.columns.is_empty()) {
                faults.push(broken(group, numbers.rows, fault));
            }
            let has_signal = numbers.columns.iter().any(|(channel, _)| Some(*channel) != group.clock);
            if numbers.rows == 0 || !has_signal {
                continue;
            }
            match group.clock.is_some() || is_single {
                true => taken.push((k, numbers)),
                false => without_clock.push(&group.name),
            }
        }
        notes.extend(some_of(faults));
        if !without_clock.is_empty() {
            let more = if without_clock.len() > SHOWN { ", …" } else { "" };
            without_clock.truncate(SHOWN);
            notes.push(format!("groups without a clock left out: {}{more}", without_clock.join(", ")));
        }
        if taken.is_empty() {
            let why = notes.get(1..).unwrap_or_default().join("; ");
            return Err(Fault::NoNumbers(if why.is_empty() { why } else { format!(" ({why})") }));
        }
        let rows = taken.iter().map(|(_, numbers)| numbers.rows).max().unwrap_or(0);
        let mut columns: Vec<Column> = Vec::new();
        let mut origins = Vec::new();
        for (k, numbers) in taken {
            let group = &tree.groups[k];
            let (clock, signals): (Vec<_>, Vec<_>) =
                numbers.columns.into_iter().partition(|(channel, _)| Some(*channel) == group.clock);
            for (channel, mut values) in clock.into_iter().chain(signals) {
                let of = &group.channels[channel];
                values.resize(rows, f64::NAN);
                columns.push(Column { values, ..empty_column(of.name.clone(), of.unit.clone()) });
                origins.push((k, channel));
            }
        }
        let table = Table {
            path: path.display().to_string(),
            columns,
            places: (1..=rows as u64).map(Place::Row).collect(),
            has_header: true,
            notes,
            ..Table::default()
        };
        Ok(Self { table, origins, rows: records })
    }

    /// The table of some of the channels, whose records are as many rows as there are then.
    pub(super) fn with_only(self, is_kept: impl Fn(usize, usize) -> bool) -> Table {
        let Self { mut table, origins, rows } = self;
        let mut kept = origins.iter().map(|(group, channel)| is_kept(*group, *channel));
        table.columns.retain(|_| kept.next().unwrap_or(false));
        let of_kept = origins.iter().filter(|(group, channel)| is_kept(*group, *channel));
        let rows = of_kept.map(|(group, _)| rows[*group]).max().unwrap_or(0);
        table.columns.iter_mut().for_each(|column| column.values.truncate(rows));
        table.places = (1..=rows as u64).map(Place::Row).collect();
        table
    }
}

/// Some faults of groups, and how many more there are.
fn some_of(mut faults: Vec<String>) -> Vec<String> {
    if faults.len() > SHOWN {
        let more = format!("{} more groups are broken", faults.len() - SHOWN);
        faults.truncate(SHOWN);
        faults.push(more);
    }
    faults
}

fn broken(group: &Group, rows: usize, fault: &Fault) -> String {
    match rows {
        0 => format!("`{}` left out: {fault}", group.name),
        _ => format!("`{}` is broken after record {rows} ({fault}): what precedes is used", group.name),
    }
}

/// What there is, and what of it is not read.
fn notes(tree: &Tree) -> Vec<String> {
    let channels: usize = tree.groups.iter().map(|group| group.channels.len()).sum();
    let mut notes = vec![format!("MDF {}, {channels} channels", tree.version)];
    if tree.is_unfinished {
        notes.push("its writer did not finish it: all records that are there are used".to_owned());
    }
    if let Some(fault) = &tree.broken {
        notes.push(format!(
            "the list of channels is broken after {channels} ({fault}): what precedes is used"
        ));
    }
    if !tree.left.is_empty() {
        let left: Vec<String> =
            tree.left.iter().map(|(left, count)| format!("{count} of {}", left.name())).collect();
        notes.push(format!("channels left out: {}", left.join(", ")));
    }
    notes
}
