//! Numbers in little-endian bytes.

use super::error::PosteriorError;

/// Writes.
#[derive(Debug, Default)]
pub(super) struct Writer(pub Vec<u8>);

impl Writer {
    pub(super) fn count(&mut self, n: usize) {
        self.0.extend(u32::try_from(n).expect("posteriors are small").to_le_bytes());
    }
    pub(super) fn small(&mut self, n: usize) {
        self.0.extend(u16::try_from(n).expect("at most 65,535").to_le_bytes());
    }
    pub(super) fn byte(&mut self, n: u8) {
        self.0.push(n);
    }
    pub(super) fn text(&mut self, text: &str) {
        self.count(text.len());
        self.0.extend(text.as_bytes());
    }
    pub(super) fn number(&mut self, x: f32) {
        self.0.extend(x.to_le_bytes());
    }
    pub(super) fn numbers(&mut self, all: &[f32]) {
        self.count(all.len());
        all.iter().for_each(|x| self.number(*x));
    }
}

/// Reads what a [`Writer`] wrote.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }
    pub(super) fn damaged(&self, what: &'static str) -> PosteriorError {
        PosteriorError::Damaged { at: self.at, what }
    }
    fn take(&mut self, n: usize) -> Result<&'a [u8], PosteriorError> {
        let taken = self.at.checked_add(n).and_then(|end| self.bytes.get(self.at..end));
        let taken = taken.ok_or_else(|| self.damaged("the file ends too early"))?;
        self.at += n;
        Ok(taken)
    }
    /// A count of items that take at least so many bytes each: a count beyond the file is refused before anything is allocated.
    pub(super) fn count_of(&mut self, bytes_each: usize) -> Result<usize, PosteriorError> {
        let four = self.take(4)?;
        let n = u32::from_le_bytes([four[0], four[1], four[2], four[3]]) as usize;
        match n.checked_mul(bytes_each) {
            Some(all) if all <= self.bytes.len() - self.at => Ok(n),
            _ => Err(self.damaged("a count exceeds the file")),
        }
    }
    /// A count of what the file does not hold.
    pub(super) fn any_count(&mut self) -> Result<usize, PosteriorError> {
        Ok(self.version()? as usize)
    }
    pub(super) fn version(&mut self) -> Result<u32, PosteriorError> {
        let four = self.take(4)?;
        Ok(u32::from_le_bytes([four[0], four[1], four[2], four[3]]))
    }
    pub(super) fn small(&mut self) -> Result<usize, PosteriorError> {
        let two = self.take(2)?;
        Ok(usize::from(u16::from_le_bytes([two[0], two[1]])))
    }
    pub(super) fn byte(&mut self) -> Result<u8, PosteriorError> {
        Ok(self.take(1)?[0])
    }
    pub(super) fn text(&mut self) -> Result<String, PosteriorError> {
        let n = self.count_of(1)?;
        let bytes = self.take(n)?.to_vec();
        String::from_utf8(bytes).map_err(|_| self.damaged("a name is no UTF-8"))
    }
    pub(super) fn number(&mut self) -> Result<f32, PosteriorError> {
        let four = self.take(4)?;
        let x = f32::from_le_bytes([four[0], four[1], four[2], four[3]]);
        if x.is_finite() { Ok(x) } else { Err(self.damaged("a number is not finite")) }
    }
    pub(super) fn numbers(&mut self) -> Result<Vec<f32>, PosteriorError> {
        let n = self.count_of(4)?;
        (0..n).map(|_| self.number()).collect()
    }
    pub(super) fn is_at_end(&self) -> bool {
        self.at == self.bytes.len()
    }
}
