//! The bytes of a log by their places, and its blocks.

use super::fault::Fault;
use std::io::{Read, Seek, SeekFrom};

/// Bytes of a block's id, length and number of links.
pub(super) const HEAD: u64 = 24;

/// Most bytes of a block that is no data: a list of two million blocks.
const LONGEST: u64 = 1 << 24;

/// Most bytes of a text that are read.
const LONGEST_TEXT: u64 = 1 << 16;

/// Most characters of a name or a unit.
const LONGEST_NAME: usize = 250;

/// A log of which each byte is read twice at most on average, so that blocks in a circle, or on top of each other, end.
pub(super) struct Source<R> {
    file: R,
    /// Bytes of the file.
    pub(super) length: u64,
    left: u64,
}

/// How a block begins.
pub(super) struct Head {
    pub(super) at: u64,
    pub(super) id: [u8; 2],
    /// Bytes of all of it.
    pub(super) length: u64,
    /// Bytes of its links.
    pub(super) links: u64,
}

/// A block: links to others, and fields.
pub(super) struct Block {
    pub(super) links: Vec<u64>,
    data: Vec<u8>,
}

impl<R: Read + Seek> Source<R> {
    pub(super) fn of(mut file: R) -> Result<Self, Fault> {
        let length = file.seek(SeekFrom::End(0))?;
        Ok(Self { file, length, left: 2 * length })
    }

    /// From now on all bytes may be read again.
    pub(super) fn again(&mut self) {
        self.left = 2 * self.length;
    }

    /// So many bytes of a block.
    pub(super) fn bytes(&mut self, block: u64, at: u64, count: u64) -> Result<Vec<u8>, Fault> {
        let cut_off = Fault::CutOff { at: block, length: self.length };
        if at.checked_add(count).is_none_or(|end| end > self.length) {
            return Err(cut_off);
        }
        self.left = self.left.checked_sub(count).ok_or(Fault::Overlap)?;
        self.file.seek(SeekFrom::Start(at))?;
        let mut bytes = Vec::new();
        self.file.by_ref().take(count).read_to_end(&mut bytes)?;
        if bytes.len() as u64 == count { Ok(bytes) } else { Err(cut_off) }
    }

    pub(super) fn head(&mut self, at: u64) -> Result<Head, Fault> {
        let bytes = self.bytes(at, at, HEAD)?;
        let of = |k: usize| u64::from_le_bytes(bytes[k..k + 8].try_into().unwrap_or_default());
        if !bytes.starts_with(b"##") {
            return Err(Fault::NotBlock { at, wanted: "of MDF 4" });
        }
        let (length, links) = (of(8), of(16).saturating_mul(8));
        Ok(Head { at, id: [bytes[2], bytes[3]], length, links })
    }

    /// The rest of a block that is no data.
    pub(super) fn body(&mut self, head: &Head) -> Result<Block, Fault> {
        let (at, length) = (head.at, head.length);
        let body = length.checked_sub(HEAD).filter(|body| *body >= head.links && *body <= LONGEST);
        let mut links = self.bytes(at, at + HEAD, body.ok_or(Fault::Length { at, length })?)?;
        // No more than the block's own bytes, which were read.
        let data = links.split_off(head.links as usize);
        let link = |bytes: &[u8]| u64::from_le_bytes(bytes.try_into().unwrap_or_default());
        Ok(Block { links: links.chunks_exact(8).map(link).collect(), data })
    }

    /// The block that must be at a place.
    pub(super) fn block(&mut self, at: u64, wanted: &'static str) -> Result<Block, Fault> {
        let head = self.head(at)?;
        if head.id != *wanted.as_bytes() {
            return Err(Fault::NotBlock { at, wanted });
        }
        self.body(&head)
    }

    /// A name or a unit: plain, or the `TX` of a comment in XML.
    pub(super) fn text(&mut self, at: u64) -> Result<String, Fault> {
        let head = self.head(at)?;
        let length = head.length.saturating_sub(HEAD).min(LONGEST_TEXT);
        let bytes = self.bytes(at, at + HEAD, length)?;
        let text = String::from_utf8_lossy(bytes.split(|byte| *byte == 0).next().unwrap_or_default());
        let text = match &head.id {
            b"TX" => text.into_owned(),
            b"MD" => marked(&text).unwrap_or_default(),
            _ => return Err(Fault::NotBlock { at, wanted: "TX" }),
        };
        Ok(text.trim().chars().take(LONGEST_NAME).collect())
    }
}

fn marked(text: &str) -> Option<String> {
    let document = roxmltree::Document::parse(text).ok()?;
    let node = document.descendants().find(|node| node.tag_name().name() == "TX")?;
    node.text().map(str::to_owned)
}

impl Block {
    /// Where a link leads; 0 where it leads nowhere.
    pub(super) fn link(&self, k: usize) -> u64 {
        self.links.get(k).copied().unwrap_or(0)
    }

    /// The bytes of a field; zeros where the block is too short for it.
    fn field<const N: usize>(&self, at: usize) -> [u8; N] {
        self.data.get(at..at + N).and_then(|bytes| bytes.try_into().ok()).unwrap_or([0; N])
    }

    pub(super) fn u8(&self, at: usize) -> u8 {
        self.field::<1>(at)[0]
    }

    pub(super) fn u16(&self, at: usize) -> u16 {
        u16::from_le_bytes(self.field(at))
    }

    pub(super) fn u32(&self, at: usize) -> u32 {
        u32::from_le_bytes(self.field(at))
    }

    pub(super) fn u64(&self, at: usize) -> u64 {
        u64::from_le_bytes(self.field(at))
    }

    /// So many numbers; none where the block is too short for them.
    pub(super) fn numbers(&self, at: usize, count: usize) -> Option<Vec<f64>> {
        let bytes = self.data.get(at..at + 8 * count)?;
        let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap_or_default());
        Some(bytes.chunks_exact(8).map(number).collect())
    }
}
