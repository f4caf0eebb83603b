//! From the numbers of a record to those that were measured.

use super::source::Block;
use std::rc::Rc;

/// A conversion, of the kinds that give numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Conversion {
    Same,
    /// P₁ + P₂x.
    Linear([f64; 2]),
    /// (P₁x² + P₂x + P₃)/(P₄x² + P₅x + P₆).
    Rational([f64; 6]),
    /// Keys and values, in the order of the keys: on straight lines between, else the value of the nearest key.
    Table {
        points: Vec<[f64; 2]>,
        is_interpolated: bool,
    },
    /// From, to, value; and the value elsewhere.
    Ranges(Vec<[f64; 3]>, f64),
    /// From, to, and the conversion there; and the one elsewhere. None where a word stands for the numbers.
    Parts(Vec<([f64; 2], Option<Rc<Self>>)>, Option<Rc<Self>>),
}

/// Why numbers cannot be converted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unconverted {
    Formula,
    /// A kind that is not known, or one whose block is broken.
    Unknown,
}

/// What a link of a conversion leads to: another one, or none for words.
pub(super) type Follow<'a> = &'a mut dyn FnMut(u64) -> Result<Option<Rc<Conversion>>, Unconverted>;

impl Conversion {
    /// The conversion of a block `CC`; `part` gives what its links lead to.
    pub(super) fn of(block: &Block, part: Follow<'_>) -> Result<Self, Unconverted> {
        let (kind, count) = (block.u8(0), usize::from(block.u16(6)));
        let values = block.numbers(24, count).ok_or(Unconverted::Unknown)?;
        let links = || block.links.get(4..).unwrap_or_default();
        let last = values.last().copied().ok_or(Unconverted::Unknown);
        Ok(match kind {
            0 => Self::Same,
            1 => Self::Linear(first(&values)?),
            2 => Self::Rational(first(&values)?),
            3 => return Err(Unconverted::Formula),
            4 | 5 if values.len() >= 2 => {
                let points = values.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
                Self::Table { points, is_interpolated: kind == 4 }
            }
            6 => {
                let ranges = values.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect();
                Self::Ranges(ranges, if values.len() % 3 == 1 { last? } else { f64::NAN })
            }
            7 => Self::parts(values.iter().map(|key| [*key, *key]), links(), part)?,
            8 => Self::parts(values.chunks_exact(2).map(|pair| [pair[0], pair[1]]), links(), part)?,
            _ => return Err(Unconverted::Unknown),
        })
    }

    /// Where only words stand for the numbers, these are taken as they are.
    fn parts(
        ranges: impl ExactSizeIterator<Item = [f64; 2]>,
        links: &[u64],
        part: Follow<'_>,
    ) -> Result<Self, Unconverted> {
        let mut of = |k: usize| links.get(k).map_or(Ok(None), |link| part(*link));
        let elsewhere = of(ranges.len())?;
        let parts = ranges.enumerate().map(|(k, range)| Ok((range, of(k)?)));
        let parts = parts.collect::<Result<Vec<_>, _>>()?;
        let is_words = elsewhere.is_none() && parts.iter().all(|(_, part)| part.is_none());
        Ok(if is_words { Self::Same } else { Self::Parts(parts, elsewhere) })
    }

    /// A number, converted; NaN where there is none. Ranges of whole numbers include their ends, others do not include the upper one.
    pub(super) fn apply(&self, x: f64, is_whole: bool) -> f64 {
        let is_within =
            |low: f64, high: f64| low <= x && (x < high || x == high && (is_whole || low == high));
        match self {
            Self::Same => x,
            Self::Linear([p1, p2]) => p1 + p2 * x,
            Self::Rational([p1, p2, p3, p4, p5, p6]) => {
                (p1 * x * x + p2 * x + p3) / (p4 * x * x + p5 * x + p6)
            }
            Self::Table { points, is_interpolated } => looked_up(points, x, *is_interpolated),
            Self::Ranges(ranges, other) => {
                let found = ranges.iter().find(|[low, high, _]| is_within(*low, *high));
                found.map_or(*other, |[.., value]| *value)
            }
            Self::Parts(parts, elsewhere) => {
                let part = parts.iter().find(|([low, high], _)| is_within(*low, *high));
                let part = part.map_or(elsewhere, |(_, part)| part);
                part.as_ref().map_or(f64::NAN, |part| part.apply(x, is_whole))
            }
        }
    }
}

fn first<const N: usize>(values: &[f64]) -> Result<[f64; N], Unconverted> {
    values.get(..N).and_then(|values| values.try_into().ok()).ok_or(Unconverted::Unknown)
}

fn looked_up(points: &[[f64; 2]], x: f64, is_interpolated: bool) -> f64 {
    if x.is_nan() {
        return f64::NAN;
    }
    let right = points.partition_point(|[key, _]| *key <= x);
    let (left, right) = (right.checked_sub(1).map(|k| points[k]), points.get(right));
    match (left, right) {
        (None, None) => f64::NAN,
        (Some([_, value]), None) => value,
        (None, Some([_, value])) => *value,
        (Some([low, below]), Some([high, above])) if is_interpolated => {
            below + (above - below) * (x - low) / (high - low)
        }
        // Halfway the lower key counts.
        (Some([low, below]), Some([high, above])) => {
            if x - low <= high - x {
                below
            } else {
                *above
            }
        }
    }
}
