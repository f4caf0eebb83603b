//! The records that a model was made from, and where another input stands among them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::records::dataset::Dataset;

/// The dataset's clock: its records, as far as slow changes follow them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Known {
    /// Samples of the dataset.
    pub(super) total: usize,
    /// Its travel, strokes.
    pub(super) travel: f64,
    /// Its records.
    pub(super) records: Vec<Placed>,
}

/// One record on the clock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Placed {
    /// Its name.
    pub(super) name: String,
    /// Whether it was fitted.
    pub(super) fit: bool,
    /// Its samples.
    pub(super) samples: usize,
    /// Sample of the dataset at which it starts.
    pub(super) clock: usize,
    /// Records before it.
    pub(super) before: usize,
    /// Strokes travelled before it.
    pub(super) travelled: f64,
    /// Print of its samples, by which it is known again.
    pub(super) print: String,
}

impl Known {
    pub(super) fn of(dataset: &Dataset, prints: &[String]) -> Self {
        let placed = |(scaled, print): (&crate::records::dataset::ScaledRecord, &String)| Placed {
            name: scaled.name.clone(),
            fit: scaled.is_fit(),
            samples: scaled.v.len(),
            clock: scaled.clock,
            before: scaled.before,
            travelled: scaled.travelled,
            print: print.clone(),
        };
        Self {
            total: dataset.total,
            travel: dataset.travel,
            records: dataset.scaled_records.iter().zip(prints).map(placed).collect(),
        }
    }

    /// The number of the record with these samples.
    pub(super) fn find(&self, v: &[f64], y: &[f64]) -> Option<usize> {
        let print = print(v, y);
        self.records.iter().position(|placed| placed.print == print)
    }
}

/// A print of a record's samples: FNV-1a over their bits, 64 of them.
///
/// G. Fowler, L. C. Noll, K.-P. Vo, D. Eastlake, "The FNV Non-Cryptographic Hash Algorithm". Two different records share one by chance
/// once in 10¹⁹; nobody gains by forging one.
pub(super) fn print(v: &[f64], y: &[f64]) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for byte in v.iter().chain(y).flat_map(|x| x.to_bits().to_le_bytes()) {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    }
    format!("{hash:016x}")
}
