//! Model files: what `identify --out` and `gap --out` write, `simulate` runs and `gap --model` diagnoses.
//!
//! One JSON object. Numbers have as many digits as they need to be read back as the same numbers.
//!
//! | key | content |
//! |---|---|
//! | `schema` | `switchback/model/1`; another number is another format |
//! | `kind` | which form `model` has: `switched`, `curves` or `points` |
//! | `part` | `identified`, `nominal` or `augmented` |
//! | `rig` | name of the rig |
//! | `method` | method of `identify`; null for models of `gap` |
//! | `input`, `output` | labels with units, e.g. `displacement [mm]` |
//! | `sample_time` | seconds |
//! | `identified_on` | the working `interval`; range of the input `v`; `largest_step`, its largest change from one sample to the next; `reversals`, the smallest and the largest travel between two of them, null where there are not two; the `threshold` below which a move back is none; `records` with `name`, `use` and `samples` |
//! | `effects` | what was added to the nominal model: `effect` and its `parameters` (`name`, `value`, `ci90`, `unit`) in the user's units |
//! | `system` | for the reader, not read back: `order`, `delay`, `a`, `b` and the borders `descending` and `ascending` as pairs `[v, u]`, `A(q⁻¹) y(t) = Σ bᵢ u(t−delay−i)`, i from 1 |
//! | `model` | what runs, by `kind`: [`PortableModel`] (`switched`), [`Curves`] (`curves`), [`Points`] (`points`) |
//! | `version` | version of the program that wrote it |

mod causal;
mod curves;
mod described;
mod domain;
mod file;
mod make;
mod points;
mod read;
mod run;
mod series;
mod units;

pub use causal::NotCausal;
pub use curves::{Curves, plain};
pub use described::Described;
pub use domain::Domain;
pub use file::{Added, Header, ModelFile, SCHEMA, System};
pub use make::{diagnosed, identified};
pub use points::Points;
pub use read::{ModelError, of_text, read};
pub use run::Run;
pub use series::{Banded, RecordSeries, Series, diagnosed_series, identified_series};
pub use switchback_diagnose::PortableModel;
pub use units::UnitError;
pub use units::same_unit;
