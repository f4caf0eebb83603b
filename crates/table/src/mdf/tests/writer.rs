//! Logs, written block by block, what is referred to before what refers to it.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// A log so far.
pub(super) struct Writer(pub(super) Vec<u8>);

/// A channel's fields.
#[derive(Clone, Copy, Default)]
pub(super) struct Field<'a> {
    pub(super) name: &'a str,
    pub(super) unit: u64,
    pub(super) conversion: u64,
    /// Kind of channel, of synchronisation, and of its numbers.
    pub(super) kinds: [u8; 3],
    pub(super) bit: u8,
    pub(super) byte: u32,
    pub(super) bits: u32,
    pub(super) flags: u32,
    pub(super) validity: u32,
    pub(super) composition: u64,
}

/// A group's fields.
#[derive(Clone, Copy, Default)]
pub(super) struct Group<'a> {
    pub(super) name: &'a str,
    pub(super) id: u64,
    pub(super) count: u64,
    pub(super) flags: u16,
    pub(super) bytes: [u32; 2],
}

/// How records are compressed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Packing {
    None,
    Deflated,
    /// Of rows with so many bytes.
    Turned(usize),
}

impl Writer {
    pub(super) fn new(id: &str, version: &str) -> Self {
        let mut bytes = format!("{id:8}{version:8}{:16}", "test").into_bytes();
        bytes.resize(64, 0);
        let mut writer = Self(bytes);
        writer.block("HD", &[0; 6], &[0; 32]);
        writer
    }

    pub(super) fn block(&mut self, id: &str, links: &[u64], data: &[u8]) -> u64 {
        self.0.resize(self.0.len().next_multiple_of(8), 0);
        let at = self.0.len() as u64;
        self.0.extend(b"##");
        self.0.extend(id.as_bytes());
        self.0.extend([0; 4]);
        for long in [(24 + 8 * links.len() + data.len()) as u64, links.len() as u64].iter().chain(links) {
            self.0.extend(long.to_le_bytes());
        }
        self.0.extend(data);
        at
    }

    pub(super) fn text(&mut self, text: &str) -> u64 {
        self.block("TX", &[], format!("{text}\0").as_bytes())
    }

    pub(super) fn conversion(&mut self, kind: u8, links: &[u64], values: &[f64]) -> u64 {
        let mut data = vec![kind, 0, 0, 0];
        data.extend((links.len() as u16).to_le_bytes());
        data.extend((values.len() as u16).to_le_bytes());
        data.extend([0; 16]);
        data.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self.block("CC", &[&[0; 4], links].concat(), &data)
    }

    /// Channels in this order; where the first one is.
    pub(super) fn channels(&mut self, fields: &[Field<'_>]) -> u64 {
        let mut next = 0;
        for field in fields.iter().rev() {
            let name = self.text(field.name);
            let mut data = [&field.kinds[..], &[field.bit]].concat();
            for word in [field.byte, field.bits, field.flags, field.validity] {
                data.extend(word.to_le_bytes());
            }
            data.resize(72, 0);
            let links = [next, field.composition, name, 0, field.conversion, 0, field.unit, 0];
            next = self.block("CN", &links, &data);
        }
        next
    }

    pub(super) fn group(&mut self, next: u64, channels: u64, group: Group<'_>) -> u64 {
        let name = self.text(group.name);
        let mut data = [group.id.to_le_bytes(), group.count.to_le_bytes()].concat();
        data.extend(group.flags.to_le_bytes());
        data.resize(24, 0);
        data.extend(group.bytes.iter().flat_map(|bytes| bytes.to_le_bytes()));
        self.block("CG", &[next, channels, name, 0, 0, 0], &data)
    }

    pub(super) fn data(&mut self, next: u64, groups: u64, records: u64, id_bytes: u8) -> u64 {
        self.block("DG", &[next, groups, records, 0], &[id_bytes, 0, 0, 0, 0, 0, 0, 0])
    }

    /// Records in a list of blocks with so many bytes each.
    pub(super) fn records(&mut self, records: &[u8], packing: Packing, most: usize) -> u64 {
        let blocks: Vec<u64> = records.chunks(most).map(|part| self.packed(part, packing)).collect();
        let half = blocks.len() / 2;
        // Two lists, so that one leads to the other.
        let second = self.block("DL", &[&[0], &blocks[half..]].concat(), &[0; 8]);
        let first = self.block("DL", &[&[second], &blocks[..half]].concat(), &[0; 8]);
        self.block("HL", &[first], &[0; 8])
    }

    pub(super) fn packed(&mut self, records: &[u8], packing: Packing) -> u64 {
        let (method, columns) = match packing {
            Packing::None => return self.block("DT", &[], records),
            Packing::Deflated => (0, 0),
            Packing::Turned(columns) => (1, columns),
        };
        let rows = records.len().checked_div(columns).unwrap_or(0);
        let turned = |k: usize| {
            if k < rows * columns { records[(k % rows) * columns + k / rows] } else { records[k] }
        };
        let turned: Vec<u8> = (0..records.len()).map(turned).collect();
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(&turned).expect("memory");
        let packed = encoder.finish().expect("memory");
        let mut data = [b"DT", &[method, 0][..], &(columns as u32).to_le_bytes()].concat();
        data.extend((records.len() as u64).to_le_bytes());
        data.extend((packed.len() as u64).to_le_bytes());
        data.extend(packed);
        self.block("DZ", &[], &data)
    }

    /// Lets a link of a block lead to another.
    pub(super) fn link(&mut self, block: u64, link: usize, at: u64) {
        let place = block as usize + 24 + 8 * link;
        self.0[place..place + 8].copy_from_slice(&at.to_le_bytes());
    }

    /// The whole log, whose first data are there.
    pub(super) fn finish(mut self, data: u64) -> Vec<u8> {
        self.link(64, 0, data);
        self.0
    }
}
