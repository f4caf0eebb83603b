//! Records, as numbers of channels.

use super::fault::Fault;
use super::pieces::Pieces;
use super::source::Source;
use super::tree::{Data, Group, Tree};
use std::collections::HashMap;
use std::io::{Read, Seek};

/// Most bytes of a record, which is kept whole.
const LONGEST: usize = 1 << 24;

/// Which channels are wanted: by group, and channel within it.
pub(super) type Wanted<'a> = &'a dyn Fn(usize, usize) -> bool;

/// What was read of a log.
pub(super) struct Records {
    /// One a group.
    pub(super) numbers: Vec<Numbers>,
    /// Whether nothing is left to be read.
    pub(super) is_whole: bool,
}

/// The numbers of a group.
#[derive(Default)]
pub(super) struct Numbers {
    /// Channels with their values, one a record.
    pub(super) columns: Vec<(usize, Vec<f64>)>,
    pub(super) rows: usize,
    /// Why no more records came.
    pub(super) broken: Option<Fault>,
}

/// Reads the records of the channels wanted, as long as a table of them has no more numbers than `most`.
pub(super) fn collect<R: Read + Seek>(
    source: &mut Source<R>,
    tree: &Tree,
    wanted: Wanted<'_>,
    most: usize,
) -> Records {
    source.again();
    let columns_of = |(k, group): (usize, &Group)| Numbers {
        columns: (0..group.channels.len()).filter(|c| wanted(k, *c)).map(|c| (c, Vec::new())).collect(),
        ..Numbers::default()
    };
    let mut numbers: Vec<Numbers> = tree.groups.iter().enumerate().map(columns_of).collect();
    let width: usize = numbers.iter().map(|group| group.columns.len()).sum();
    // Columns of a table are as long as the longest of them.
    let most = most / width.max(1);
    let mut is_whole = true;
    for data in &tree.data {
        if data.groups.iter().all(|group| numbers[*group].columns.is_empty()) {
            continue;
        }
        let mut reader = Reader { tree, numbers: &mut numbers, most, is_cut: false };
        let ended = reader.read(source, data);
        let is_cut = reader.is_cut;
        is_whole &= !is_cut;
        for group in &data.groups {
            let (of, numbers) = (&tree.groups[*group], &mut numbers[*group]);
            let misses = !is_cut && !tree.is_unfinished && (numbers.rows as u64) < of.count;
            let fewer = misses.then_some(Fault::Fewer(of.count));
            numbers.broken = ended.as_ref().err().cloned().or(fewer);
        }
    }
    Records { numbers, is_whole }
}

struct Reader<'a> {
    tree: &'a Tree,
    numbers: &'a mut [Numbers],
    /// Most records of a group.
    most: usize,
    /// Whether one has more.
    is_cut: bool,
}

impl Reader<'_> {
    fn read<R: Read + Seek>(&mut self, source: &mut Source<R>, data: &Data) -> Result<(), Fault> {
        let groups = self.by_id(data)?;
        let mut pieces = Pieces::of(data.at, self.tree.is_unfinished);
        let mut bytes: Vec<u8> = Vec::new();
        // Bytes of a record that are of no use.
        let mut skipped = 0;
        while let Some(piece) = pieces.next(source) {
            bytes.extend(piece?);
            let mut at = 0;
            loop {
                let now = skipped.min(bytes.len() - at);
                at += now;
                skipped -= now;
                let Some((group, begin)) = self.group(&groups, data, &bytes, at)? else { break };
                let Some(length) = self.tree.groups[group].record else {
                    let Some(stated) = bytes.get(begin..begin + 4) else { break };
                    let stated = u32::from_le_bytes(stated.try_into().unwrap_or_default());
                    (at, skipped) = (begin + 4, stated as usize);
                    continue;
                };
                let Some(record) = bytes.get(begin..begin + length) else { break };
                if !self.add(group, record) {
                    return Ok(());
                }
                at = begin + length;
            }
            bytes.drain(..at);
        }
        Ok(())
    }

    /// Groups by their numbers in records.
    fn by_id(&self, data: &Data) -> Result<HashMap<u64, usize>, Fault> {
        let groups = || data.groups.iter().map(|k| (self.tree.groups[*k].id, *k));
        let lengths = data.groups.iter().filter_map(|k| self.tree.groups[*k].record);
        if let Some(long) = lengths.max().filter(|length| *length > LONGEST) {
            return Err(Fault::RecordLength(long));
        }
        match (data.id_bytes, &data.groups[..]) {
            (0, [only]) if self.tree.groups[*only].record == Some(0) => Err(Fault::RecordLength(0)),
            (0, [only]) => Ok(HashMap::from([(0, *only)])),
            (1 | 2 | 4 | 8, _) => Ok(groups().collect()),
            _ => Err(Fault::Mixed),
        }
    }

    /// The group of the record that begins at a byte, and where its own bytes begin; none where they have not come yet.
    fn group(
        &self,
        groups: &HashMap<u64, usize>,
        data: &Data,
        bytes: &[u8],
        at: usize,
    ) -> Result<Option<(usize, usize)>, Fault> {
        let begin = at + data.id_bytes;
        let Some(id) = bytes.get(at..begin).filter(|_| at < bytes.len()) else {
            return Ok(None);
        };
        let id = id.iter().rev().fold(0, |id, byte| id << 8 | u64::from(*byte));
        let group = groups.get(&id).ok_or(Fault::RecordId(id))?;
        Ok(Some((*group, begin)))
    }

    /// Adds a record; says whether more are wanted.
    fn add(&mut self, group: usize, record: &[u8]) -> bool {
        let (of, numbers) = (&self.tree.groups[group], &mut self.numbers[group]);
        let is_counted = !self.tree.is_unfinished && of.count > 0;
        if is_counted && numbers.rows as u64 >= of.count {
            return true;
        }
        if numbers.rows >= self.most {
            self.is_cut = true;
            return false;
        }
        for (channel, values) in &mut numbers.columns {
            values.push(of.channels[*channel].value(record, numbers.rows));
        }
        numbers.rows += 1;
        true
    }
}
