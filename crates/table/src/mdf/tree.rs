//! The groups of a log and their channels.

use super::channel::{Channel, Left, Part};
use super::conversion::{Conversion, Unconverted};
use super::fault::Fault;
use super::source::{Block, Source};
use crate::table::unit;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::{Read, Seek};
use std::rc::Rc;

/// Most channels of a log.
const MOST_CHANNELS: usize = 1 << 16;

/// What a log holds, without its data.
#[derive(Default)]
pub(super) struct Tree {
    /// Its version, `4.10`.
    pub(super) version: String,
    /// Whether its writer was interrupted.
    pub(super) is_unfinished: bool,
    pub(super) data: Vec<Data>,
    pub(super) groups: Vec<Group>,
    /// How many channels are left out.
    pub(super) left: BTreeMap<Left, usize>,
    /// Why no more groups came.
    pub(super) broken: Option<Fault>,
}

/// Records of one group, or of several among each other.
pub(super) struct Data {
    /// Where they are.
    pub(super) at: u64,
    /// Bytes of the number of a group before each record.
    pub(super) id_bytes: usize,
    /// Its groups, among all.
    pub(super) groups: Vec<usize>,
}

/// Channels with one clock.
pub(super) struct Group {
    pub(super) name: String,
    pub(super) id: u64,
    /// Bytes of a record without the number of its group; none where each states its own.
    pub(super) record: Option<usize>,
    /// Records, as stated.
    pub(super) count: u64,
    pub(super) channels: Vec<Channel>,
    /// Which channel is the clock.
    pub(super) clock: Option<usize>,
}

/// Texts and conversions that many channels share.
struct Reader<'a, R> {
    source: &'a mut Source<R>,
    tree: Tree,
    texts: HashMap<u64, String>,
    conversions: HashMap<u64, Converted>,
    /// Conversions that are parts of others; none for words.
    parts: HashMap<u64, Result<Option<Rc<Conversion>>, Unconverted>>,
    /// Blocks that stand in a list.
    seen: BTreeSet<u64>,
    channels: usize,
}

/// A conversion, and the unit of its values.
type Converted = (Result<Rc<Conversion>, Left>, Option<String>);

impl Tree {
    /// Reads all that is no data.
    ///
    /// # Errors
    /// A file that is no MDF 4, or is broken before its first group.
    pub(super) fn read<R: Read + Seek>(source: &mut Source<R>) -> Result<Self, Fault> {
        let start = source.bytes(0, 0, 64).map_err(|_| Fault::NotMdf)?;
        let is_unfinished = start.starts_with(b"UnFinMF ");
        if !(is_unfinished || start.starts_with(b"MDF     ")) {
            return Err(Fault::NotMdf);
        }
        let version = String::from_utf8_lossy(&start[8..16]).trim_matches(['\0', ' ']).to_owned();
        if !version.starts_with("4.") {
            return Err(Fault::Version(version));
        }
        let first = source.block(64, "HD")?.link(0);
        let tree = Self { version, is_unfinished, ..Self::default() };
        let mut reader = Reader {
            source,
            tree,
            texts: HashMap::new(),
            conversions: HashMap::new(),
            parts: HashMap::new(),
            seen: BTreeSet::new(),
            channels: 0,
        };
        let ended = reader.data(first);
        let mut tree = reader.tree;
        match ended {
            Err(fault) if tree.groups.iter().all(|group| group.channels.is_empty()) => return Err(fault),
            ended => tree.broken = ended.err(),
        }
        tree.name_apart();
        Ok(tree)
    }

    /// Whether only one group has channels.
    pub(super) fn is_single(&self) -> bool {
        self.groups.iter().filter(|group| !group.channels.is_empty()).count() == 1
    }

    /// Gives groups and channels names of their own.
    fn name_apart(&mut self) {
        let mut times: HashMap<String, usize> = HashMap::new();
        self.groups.iter().for_each(|group| *times.entry(group.name.clone()).or_default() += 1);
        for (k, group) in self.groups.iter_mut().enumerate() {
            if group.name.is_empty() || times[&group.name] > 1 {
                group.name = format!("group {}", k + 1);
            }
        }
        let is_single = self.is_single();
        let mut times: HashMap<String, usize> = HashMap::new();
        for group in &mut self.groups {
            if let Some(clock) = group.clock {
                let name = if is_single { "time".to_owned() } else { format!("{} time", group.name) };
                group.channels[clock].name = name;
            }
            group.channels.iter().for_each(|channel| *times.entry(channel.name.clone()).or_default() += 1);
        }
        let mut taken: HashMap<String, usize> = HashMap::new();
        for group in &mut self.groups {
            for channel in &mut group.channels {
                let several = times[&channel.name] > 1 && !is_single;
                let name =
                    if several { format!("{}.{}", group.name, channel.name) } else { channel.name.clone() };
                // Two of a name within a group are numbered.
                let count = taken.entry(name.clone()).and_modify(|count| *count += 1).or_insert(1);
                channel.name = if *count > 1 { format!("{name} {count}") } else { name };
            }
        }
    }
}

impl<R: Read + Seek> Reader<'_, R> {
    /// A block of a list, which stands in one only.
    fn listed(&mut self, at: u64, wanted: &'static str) -> Result<Block, Fault> {
        if self.seen.insert(at) { self.source.block(at, wanted) } else { Err(Fault::Overlap) }
    }

    fn data(&mut self, mut next: u64) -> Result<(), Fault> {
        while next != 0 {
            let block = self.listed(next, "DG")?;
            next = block.link(0);
            self.tree.data.push(Data {
                at: block.link(2),
                id_bytes: usize::from(block.u8(0)),
                groups: Vec::new(),
            });
            self.groups(block.link(1))?;
        }
        Ok(())
    }

    fn groups(&mut self, mut next: u64) -> Result<(), Fault> {
        while next != 0 {
            let block = self.listed(next, "CG")?;
            next = block.link(0);
            let [values, validity] = [block.u32(24), block.u32(28)];
            let states_own = block.u16(16) & 1 == 1;
            if let Some(data) = self.tree.data.last_mut() {
                data.groups.push(self.tree.groups.len());
            }
            let name = self.text(block.link(2)).unwrap_or_default();
            self.tree.groups.push(Group {
                name,
                id: block.u64(0),
                record: (!states_own).then_some(values as usize + validity as usize),
                count: block.u64(8),
                channels: Vec::new(),
                clock: None,
            });
            if !states_own {
                self.channels(block.link(1), [values as usize, validity as usize])?;
            }
        }
        Ok(())
    }

    /// Channels of a list, each followed by those that it is made of.
    fn channels(&mut self, first: u64, record: [usize; 2]) -> Result<(), Fault> {
        let mut next = vec![first];
        while let Some(at) = next.pop() {
            if at == 0 {
                continue;
            }
            let block = self.listed(at, "CN")?;
            self.channels += 1;
            if self.channels > MOST_CHANNELS {
                return Err(Fault::Channels(MOST_CHANNELS));
            }
            next.push(block.link(0));
            let composition = match block.link(1) {
                0 => None,
                at => self.source.head(at).ok().map(|head| head.id),
            };
            if composition == Some(*b"CN") {
                next.push(block.link(1));
            }
            let channel = match composition {
                Some(id) if id != *b"CN" => Err(Left::Arrays),
                _ => self.channel(&block, record),
            };
            let Some(group) = self.tree.groups.last_mut() else { return Ok(()) };
            match channel {
                Ok((channel, part)) => {
                    if part != Part::Signal && group.clock.is_none() {
                        group.clock = Some(group.channels.len());
                    }
                    group.channels.push(channel);
                }
                Err(left) => *self.tree.left.entry(left).or_default() += 1,
            }
        }
        Ok(())
    }

    fn channel(&mut self, block: &Block, record: [usize; 2]) -> Result<(Channel, Part), Left> {
        let part = Part::of(block).ok_or(Left::Words)?;
        let (conversion, other) = self.conversion(block.link(4));
        let unit =
            Some(self.text(block.link(6)).unwrap_or_default()).filter(|unit| !unit.is_empty()).or(other);
        let unit = unit.filter(|unit| unit != "-");
        let unit = match part {
            Part::Signal => unit,
            // Times are in seconds, whatever else is said.
            _ => Some(unit.filter(|unit| unit::seconds(unit).is_some()).unwrap_or_else(|| "s".to_owned())),
        };
        let name = self.text(block.link(2)).ok_or(Left::Broken)?;
        Ok((Channel::of(block, part, record, (name, unit), conversion?)?, part))
    }

    /// A text, however often it is referred to; none where there is none.
    fn text(&mut self, at: u64) -> Option<String> {
        if at == 0 {
            return None;
        }
        if let Some(text) = self.texts.get(&at) {
            return Some(text.clone());
        }
        let text = self.source.text(at).unwrap_or_default();
        self.texts.insert(at, text.clone());
        Some(text)
    }

    /// A conversion, however often it is referred to.
    fn conversion(&mut self, at: u64) -> Converted {
        if at == 0 {
            return (Ok(Rc::new(Conversion::Same)), None);
        }
        if let Some(known) = self.conversions.get(&at) {
            return known.clone();
        }
        let block = self.source.block(at, "CC").ok();
        let unit = block.as_ref().and_then(|block| self.text(block.link(1))).filter(|unit| !unit.is_empty());
        let conversion = match block {
            None => Err(Left::Broken),
            Some(block) => {
                Conversion::of(&block, &mut |link| self.part(link)).map(Rc::new).map_err(Left::from)
            }
        };
        self.conversions.insert(at, (conversion.clone(), unit.clone()));
        (conversion, unit)
    }

    /// What a link of a conversion leads to: none for words, or a conversion, which has no parts of its own.
    fn part(&mut self, at: u64) -> Result<Option<Rc<Conversion>>, Unconverted> {
        if let Some(known) = self.parts.get(&at) {
            return known.clone();
        }
        let head = if at == 0 { None } else { self.source.head(at).ok() };
        let part = head.filter(|head| head.id == *b"CC").map(|head| {
            let block = self.source.body(&head).map_err(|_| Unconverted::Unknown)?;
            Conversion::of(&block, &mut |_| Err(Unconverted::Unknown)).map(Rc::new)
        });
        let part = part.transpose();
        self.parts.insert(at, part.clone());
        part
    }
}
