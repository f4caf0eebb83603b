//! The bytes of records, in pieces, wherever they are: in one block or a list of them, compressed or not.

use super::fault::Fault;
use super::source::{HEAD, Head, Source};
use flate2::read::ZlibDecoder;
use std::io::{Read, Seek};

/// Bytes of an uncompressed block that are read at once.
const PIECE: u64 = 1 << 20;

/// Most bytes of a compressed block, before and after. Those of 4 MiB are recommended.
const LONGEST: u64 = 1 << 28;

/// Bytes of a compressed block before its contents.
const FIELDS: u64 = 24;

/// Pieces that are still to come.
pub(super) struct Pieces {
    /// Blocks, the next one last.
    blocks: Vec<u64>,
    copied: Option<Copied>,
    is_unfinished: bool,
}

/// A block that is being read.
struct Copied {
    block: u64,
    at: u64,
    end: u64,
    /// What is wrong after its last byte.
    fault: Option<Fault>,
}

impl Pieces {
    /// Those of a block with records, or of a list of blocks.
    pub(super) fn of(at: u64, is_unfinished: bool) -> Self {
        Self { blocks: vec![at], copied: None, is_unfinished }
    }

    /// The next one; none after the last, nor after a fault.
    pub(super) fn next<R: Read + Seek>(&mut self, source: &mut Source<R>) -> Option<Result<Vec<u8>, Fault>> {
        loop {
            let piece = match &mut self.copied {
                Some(copied) if copied.at < copied.end => {
                    let count = PIECE.min(copied.end - copied.at);
                    copied.at += count;
                    source.bytes(copied.block, copied.at - count, count).map(Some)
                }
                Some(copied) => {
                    let fault = copied.fault.take();
                    self.copied = None;
                    fault.map_or(Ok(None), Err)
                }
                None => {
                    let at = self.blocks.pop()?;
                    if at == 0 { Ok(None) } else { self.follow(source, at) }
                }
            };
            match piece {
                Ok(None) => {}
                Ok(Some(bytes)) => return Some(Ok(bytes)),
                Err(fault) => {
                    self.blocks.clear();
                    self.copied = None;
                    return Some(Err(fault));
                }
            }
        }
    }

    /// Looks at a block; gives the bytes of a compressed one.
    fn follow<R: Read + Seek>(&mut self, source: &mut Source<R>, at: u64) -> Result<Option<Vec<u8>>, Fault> {
        let head = source.head(at)?;
        match &head.id {
            b"DT" => self.copy(source, &head),
            b"DL" => {
                let links = source.body(&head)?.links;
                // The first one leads to the next list.
                let next = links.first().copied();
                self.blocks.extend(next);
                self.blocks.extend(links.into_iter().skip(1).rev());
                Ok(None)
            }
            b"HL" => {
                self.blocks.push(source.body(&head)?.link(0));
                Ok(None)
            }
            b"DZ" => self.inflate(source, &head).map(Some),
            b"DV" | b"LD" => Err(Fault::ByColumns),
            _ => Err(Fault::NotBlock { at, wanted: "of records" }),
        }
    }

    fn copy<R>(&mut self, source: &Source<R>, head: &Head) -> Result<Option<Vec<u8>>, Fault> {
        let Head { at, length, links, .. } = *head;
        // A writer that was interrupted has not stated how long its last block is.
        let is_open = self.is_unfinished && length <= HEAD;
        let end = if is_open { source.length } else { at.saturating_add(length) };
        let fault = (end > source.length).then_some(Fault::CutOff { at, length: source.length });
        let begin = at.checked_add(HEAD).and_then(|begin| begin.checked_add(links));
        let begin = begin.filter(|begin| *begin <= end).ok_or(Fault::Length { at, length })?;
        self.copied = Some(Copied { block: at, at: begin, end: end.min(source.length), fault });
        Ok(None)
    }

    fn inflate<R: Read + Seek>(&mut self, source: &mut Source<R>, head: &Head) -> Result<Vec<u8>, Fault> {
        let at = head.at;
        let fields = source.bytes(at, at + HEAD, FIELDS)?;
        let long = |k: usize| u64::from_le_bytes(fields[k..k + 8].try_into().unwrap_or_default());
        let (method, columns) = (fields[2], u32::from_le_bytes(fields[4..8].try_into().unwrap_or_default()));
        let [original, compressed] = [long(8), long(16)];
        if &fields[..2] == b"DV" {
            return Err(Fault::ByColumns);
        }
        if method > 1 {
            return Err(Fault::Compression { at, method });
        }
        if let Some(length) = [original, compressed].into_iter().find(|length| *length > LONGEST) {
            return Err(Fault::Length { at, length });
        }
        let begin = at + HEAD + FIELDS;
        let there = compressed.min(source.length.saturating_sub(begin));
        let bytes = source.bytes(at, begin, there)?;
        let mut inflated = Vec::new();
        // A byte more, so that the checksum behind the last is looked at.
        let ended = ZlibDecoder::new(&bytes[..]).take(original + 1).read_to_end(&mut inflated);
        if there < compressed {
            let fault = Fault::CutOff { at, length: source.length };
            if method == 1 {
                return Err(fault);
            }
            self.copied = Some(Copied { block: at, at: 0, end: 0, fault: Some(fault) });
            return Ok(inflated);
        }
        if ended.is_err() || inflated.len() as u64 != original {
            return Err(Fault::Damaged { at });
        }
        Ok(if method == 1 { by_rows(&inflated, columns as usize) } else { inflated })
    }
}

/// Rows of so many bytes, which were written column by column; what is left after the last whole row follows as it is.
fn by_rows(bytes: &[u8], columns: usize) -> Vec<u8> {
    let rows = bytes.len().checked_div(columns).unwrap_or(0);
    let (whole, rest) = bytes.split_at(rows * columns);
    let mut turned = Vec::with_capacity(bytes.len());
    for row in 0..rows {
        turned.extend((0..columns).map(|column| whole[column * rows + row]));
    }
    turned.extend_from_slice(rest);
    turned
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_become_rows() {
        assert_eq!(by_rows(b"adbecfXY", 3), b"abcdefXY");
        assert_eq!(by_rows(b"abc", 0), b"abc");
        assert_eq!(by_rows(b"abc", 7), b"abc");
        assert_eq!(by_rows(b"", 3), b"");
    }
}
