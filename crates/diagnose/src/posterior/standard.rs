//! Columns on one scale.

use super::bytes::{Reader, Writer};
use super::error::PosteriorError;

/// `z = clip((x − centre)/scale)` of every column, by its quantiles.
#[derive(Debug, Clone, PartialEq)]
pub struct Standard {
    /// Medians.
    pub centre: Vec<f32>,
    /// Spreads, positive.
    pub scale: Vec<f32>,
}

/// Standardised columns lie within this.
const CLIP: f64 = 4.0;

impl Standard {
    /// Standardised columns.
    pub fn of(&self, row: &[f64]) -> Vec<f64> {
        let one =
            |((x, c), s): ((&f64, &f32), &f32)| ((x - f64::from(*c)) / f64::from(*s)).clamp(-CLIP, CLIP);
        row.iter().zip(&self.centre).zip(&self.scale).map(one).collect()
    }

    pub(super) fn write(&self, out: &mut Writer) {
        out.numbers(&self.centre);
        out.numbers(&self.scale);
    }

    pub(super) fn read(from: &mut Reader<'_>, columns: usize) -> Result<Self, PosteriorError> {
        let (centre, scale) = (from.numbers()?, from.numbers()?);
        if centre.len() != columns || scale.len() != columns || scale.iter().any(|s| *s <= 0.0) {
            return Err(from.damaged("scales that fit no columns"));
        }
        Ok(Self { centre, scale })
    }
}
