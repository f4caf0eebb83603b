//! A number within a record.

/// Where in a record a number stands, and its form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Number {
    /// Its first byte.
    offset: usize,
    bytes: usize,
    /// Bits before it.
    shift: u32,
    bits: u32,
    form: Form,
    is_big_endian: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Unsigned,
    Signed,
    Float,
}

impl Number {
    /// A number by the fields of its channel; none where it is no number, or does not fit into its record.
    pub(super) fn of(kind: u8, [shift, offset, bits]: [u32; 3], record: usize) -> Option<Self> {
        let form = match kind {
            0 | 1 => Form::Unsigned,
            2 | 3 => Form::Signed,
            4 | 5 => Form::Float,
            _ => return None,
        };
        let is_float = matches!(bits, 16 | 32 | 64) && shift == 0;
        if shift > 7 || !(1..=64).contains(&bits) || form == Form::Float && !is_float {
            return None;
        }
        let (offset, bytes) = (offset as usize, (shift + bits).div_ceil(8) as usize);
        let fits = offset.checked_add(bytes).is_some_and(|end| end <= record);
        let is_big_endian = kind % 2 == 1;
        fits.then_some(Self { offset, bytes, shift, bits, form, is_big_endian })
    }

    /// Whether all its values are whole.
    pub(super) fn is_whole(&self) -> bool {
        self.form != Form::Float
    }

    pub(super) fn read(&self, record: &[u8]) -> f64 {
        let bytes = &record[self.offset..self.offset + self.bytes];
        let join = |word: u128, byte: &u8| word << 8 | u128::from(*byte);
        let word = match self.is_big_endian {
            true => bytes.iter().fold(0, join),
            false => bytes.iter().rev().fold(0, join),
        };
        let unused = 64 - self.bits;
        // Bits above the number leave to the left.
        let word = ((word >> self.shift) as u64) << unused;
        match self.form {
            Form::Unsigned => (word >> unused) as f64,
            Form::Signed => (word.cast_signed() >> unused) as f64,
            Form::Float => match self.bits {
                16 => half((word >> unused) as u16),
                32 => widened(f32::from_bits((word >> unused) as u32)),
                _ => f64::from_bits(word),
            },
        }
    }
}

/// A number of IEEE 754 in 16 bits.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    sign * match exponent {
        0 => fraction * 2f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction / 1024.0) * 2f64.powi(exponent - 15),
    }
}

/// The number that was meant by one of seven digits: the shortest decimal that is read as it.
fn widened(x: f32) -> f64 {
    x.to_string().parse().unwrap_or(f64::from(x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_any_form_are_read() {
        let read = |kind, place, record: &[u8]| Number::of(kind, place, record.len()).map(|n| n.read(record));
        assert_eq!(read(0, [0, 1, 16], &[9, 0x34, 0x12]), Some(f64::from(0x1234)));
        assert_eq!(read(1, [0, 1, 16], &[9, 0x12, 0x34]), Some(f64::from(0x1234)));
        assert_eq!(read(2, [4, 0, 8], &[0xe0, 0x0f]), Some(-2.0));
        assert_eq!(read(0, [3, 0, 2], &[0b0001_0000]), Some(2.0));
        assert_eq!(read(3, [0, 0, 64], &(-7_i64).to_be_bytes()), Some(-7.0));
        assert_eq!(
            read(0, [7, 0, 64], &[0x80, 0, 0, 0, 0, 0, 0, 0, 0x7f]),
            Some((0xfe << 56 | 1_u64) as f64)
        );
        assert_eq!(read(4, [0, 0, 32], &0.1_f32.to_le_bytes()), Some(0.1));
        assert_eq!(read(5, [0, 0, 64], &0.3_f64.to_be_bytes()), Some(0.3));
        for (bits, x) in [(0x3c00_u16, 1.0), (0xc100, -2.5), (1, 2f64.powi(-24)), (0x7c00, f64::INFINITY)] {
            assert_eq!(read(4, [0, 0, 16], &bits.to_le_bytes()), Some(x));
        }
    }

    #[test]
    fn what_is_no_number_or_beyond_its_record_is_none() {
        let is_number = |kind, place| Number::of(kind, place, 8).is_some();
        assert!(is_number(0, [7, 0, 57]) && is_number(0, [0, 7, 8]));
        for (kind, place) in [
            (6, [0, 0, 8]),
            (0, [0, 0, 0]),
            (0, [0, 0, 65]),
            (0, [8, 0, 8]),
            (0, [1, 0, 64]),
            (0, [0, u32::MAX, 8]),
            (4, [0, 0, 24]),
            (4, [1, 0, 32]),
        ] {
            assert!(!is_number(kind, place), "{kind} {place:?}");
        }
    }
}
