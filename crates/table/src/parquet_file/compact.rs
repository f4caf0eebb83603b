//! Thrift's compact protocol, in which Parquet states what its parts are.

use std::io::Read;

/// Structures within structures.
const DEEPEST: usize = 64;

/// Kinds of values.
pub(super) const LIST: u8 = 9;
pub(super) const STRUCT: u8 = 12;

/// Values, one after the other.
pub(super) struct Compact<R> {
    source: R,
    /// Bytes read.
    pub(super) read: u64,
    /// Elements of lists that may still come: some take no bytes.
    left: u64,
}

/// What is done with a field, by its number and kind.
pub(super) type Take<'a, R> = &'a mut dyn FnMut(&mut Compact<R>, i16, u8) -> Result<(), Unread>;

/// Why a value cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unread {
    /// It ends too early, or is none.
    Broken,
    /// It states that more belongs to it than can be there.
    Untrue,
}

impl<R: Read> Compact<R> {
    /// Reads values whose lists have so many elements at most.
    pub(super) fn of(source: R, most: u64) -> Self {
        Self { source, read: 0, left: most }
    }

    fn byte(&mut self) -> Result<u8, Unread> {
        let mut byte = [0];
        self.source.read_exact(&mut byte).map_err(|_| Unread::Broken)?;
        self.read += 1;
        Ok(byte[0])
    }

    fn unsigned(&mut self) -> Result<u64, Unread> {
        let (mut number, mut shift) = (0, 0_u32);
        loop {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f).wrapping_shl(shift);
            if byte < 0x80 {
                return Ok(number);
            }
            shift = shift.wrapping_add(7);
        }
    }

    /// A whole number.
    pub(super) fn whole(&mut self) -> Result<i64, Unread> {
        let number = self.unsigned()?;
        Ok((number >> 1).cast_signed() ^ -(number & 1).cast_signed())
    }

    fn over(&mut self, bytes: u64) -> Result<(), Unread> {
        let read = std::io::copy(&mut self.source.by_ref().take(bytes), &mut std::io::sink());
        self.read += bytes;
        if read.is_ok_and(|read| read == bytes) { Ok(()) } else { Err(Unread::Broken) }
    }

    /// The kind of a list's elements, and how many they are.
    pub(super) fn list(&mut self) -> Result<(u8, u64), Unread> {
        let head = self.byte()?;
        let count = if head >> 4 == 15 { self.unsigned()? } else { u64::from(head >> 4) };
        self.elements(count)?;
        Ok((head & 15, count))
    }

    fn elements(&mut self, count: u64) -> Result<(), Unread> {
        self.left = self.left.checked_sub(count).ok_or(Unread::Untrue)?;
        Ok(())
    }

    /// The fields of a structure, each of which is taken.
    pub(super) fn fields(&mut self, take: Take<'_, R>) -> Result<(), Unread> {
        let mut number = 0_i16;
        loop {
            let head = self.byte()?;
            if head & 15 == 0 {
                return Ok(());
            }
            number = match head >> 4 {
                0 => self.whole()? as i16,
                further => number.checked_add(i16::from(further)).ok_or(Unread::Broken)?,
            };
            take(self, number, head & 15)?;
        }
    }

    /// Leaves out a value.
    pub(super) fn skip(&mut self, kind: u8) -> Result<(), Unread> {
        self.skip_within(kind, DEEPEST)
    }

    fn skip_within(&mut self, kind: u8, deeper: usize) -> Result<(), Unread> {
        let deeper = deeper.checked_sub(1).ok_or(Unread::Broken)?;
        match kind {
            // The kind of a truth is its value.
            1 | 2 => Ok(()),
            3 => self.over(1),
            4..=6 => self.unsigned().map(drop),
            7 => self.over(8),
            8 => self.unsigned().and_then(|length| self.over(length)),
            LIST | 10 => {
                let (kind, count) = self.list()?;
                (0..count).try_for_each(|_| self.skip_within(kind, deeper))
            }
            11 => {
                let count = self.unsigned()?;
                self.elements(count)?;
                let kinds = if count > 0 { self.byte()? } else { 0 };
                let mut pair = || {
                    self.skip_within(kinds >> 4, deeper).and_then(|()| self.skip_within(kinds & 15, deeper))
                };
                (0..count).try_for_each(|_| pair())
            }
            STRUCT => self.fields(&mut |source, _, kind| source.skip_within(kind, deeper)),
            13 => self.over(16),
            _ => Err(Unread::Broken),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_and_left_out() {
        // 1: -3; 2: "ab"; 4: [1, 2]; 5: {1: true}; 20: 300.
        let bytes = [0x15, 5, 0x18, 2, b'a', b'b', 0x29, 0x25, 2, 4, 0x1c, 0x11, 0, 5, 40, 0xd8, 4, 0];
        let mut found = Vec::new();
        let mut source = Compact::of(&bytes[..], 10);
        let read = source.fields(&mut |source, number, kind| {
            match kind {
                5 => found.push((number, source.whole()?)),
                kind => source.skip(kind)?,
            }
            Ok(())
        });
        assert_eq!((read, found, source.read), (Ok(()), vec![(1, -3), (20, 300)], bytes.len() as u64));
    }

    #[test]
    fn lists_that_are_too_long_and_values_within_values_end() {
        // Two thousand million truths, which take no bytes.
        let truths = [0xf1, 0xff, 0xff, 0xff, 0xff, 7];
        assert_eq!(Compact::of(&truths[..], 1000).skip(LIST), Err(Unread::Untrue));
        assert_eq!(Compact::of(&[0x1c; 1000][..], 1000).skip(STRUCT), Err(Unread::Broken));
        assert_eq!(Compact::of(&[0x18, 0xff, 0xff][..], 1000).skip(STRUCT), Err(Unread::Broken));
    }
}
