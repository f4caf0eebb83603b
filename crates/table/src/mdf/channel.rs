//! A channel of numbers, and why others are left out.

use super::conversion::{Conversion, Unconverted};
use super::number::Number;
use super::source::Block;
use std::rc::Rc;

/// A channel of numbers.
#[derive(Debug, Clone)]
pub(super) struct Channel {
    /// Its name in the table: that of the log, with the group's where several have it.
    pub(super) name: String,
    pub(super) unit: Option<String>,
    /// None of a clock whose times follow from the number of the record.
    pub(super) number: Option<Number>,
    pub(super) conversion: Rc<Conversion>,
    pub(super) validity: Validity,
}

/// Which of its values were measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Validity {
    All,
    None,
    /// Those of records in which a bit is not set: its byte, and its mask.
    Bit(usize, u8),
}

/// What a channel holds that is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Left {
    Words,
    Arrays,
    Formulas,
    Broken,
}

impl Left {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Words => "words or bytes",
            Self::Arrays => "arrays",
            Self::Formulas => "formulas",
            Self::Broken => "what cannot be read",
        }
    }
}

impl From<Unconverted> for Left {
    fn from(why: Unconverted) -> Self {
        match why {
            Unconverted::Formula => Self::Formulas,
            Unconverted::Unknown => Self::Broken,
        }
    }
}

/// What a channel is in its group.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Signal,
    /// Seconds of each record.
    Clock,
    /// Seconds by the number of the record.
    CountedClock,
}

impl Part {
    /// By the fields of a block `CN`; none where its values are in no record.
    pub(super) fn of(block: &Block) -> Option<Self> {
        const TIME: u8 = 1;
        match (block.u8(0), block.u8(1)) {
            (0, _) => Some(Self::Signal),
            (2, TIME) => Some(Self::Clock),
            (3, TIME) => Some(Self::CountedClock),
            (2, _) => Some(Self::Signal),
            _ => None,
        }
    }
}

impl Channel {
    /// By a block `CN` of records with so many bytes, and as many more for validity.
    pub(super) fn of(
        block: &Block,
        part: Part,
        [record, validity]: [usize; 2],
        (name, unit): (String, Option<String>),
        conversion: Rc<Conversion>,
    ) -> Result<Self, Left> {
        let kind = block.u8(2);
        let place = [u32::from(block.u8(3)), block.u32(4), block.u32(8)];
        let number = match part {
            Part::CountedClock => None,
            _ if kind > 5 => return Err(Left::Words),
            _ => Some(Number::of(kind, place, record).ok_or(Left::Broken)?),
        };
        let (flags, bit) = (block.u32(12), block.u32(16) as usize);
        let validity = match flags & 3 {
            0 => Validity::All,
            2 if bit / 8 < validity => Validity::Bit(record + bit / 8, 1 << (bit % 8)),
            2 => return Err(Left::Broken),
            _ => Validity::None,
        };
        Ok(Self { name, unit, number, conversion, validity })
    }

    /// Whether the log has words for some of its numbers.
    pub(super) fn may_be_word(&self) -> bool {
        matches!(*self.conversion, Conversion::Parts(..))
    }

    /// The value in a record, of which so many precede; NaN where none was measured.
    pub(super) fn value(&self, record: &[u8], precede: usize) -> f64 {
        let is_measured = match self.validity {
            Validity::All => true,
            Validity::None => false,
            Validity::Bit(byte, mask) => record[byte] & mask == 0,
        };
        let Some(number) = self.number else { return self.conversion.apply(precede as f64, true) };
        let value = self.conversion.apply(number.read(record), number.is_whole());
        // An infinite value is as useless as a missing one.
        if is_measured && value.is_finite() { value } else { f64::NAN }
    }
}
