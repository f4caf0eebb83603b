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
mod simulate;
mod system;
mod units;

pub use curves::Curves;
pub(crate) use curves::plain;
pub use described::Described;
pub use domain::Domain;
pub(crate) use file::Added;
pub use file::Header;
pub use file::ModelFile;
pub use make::diagnosed;
pub use make::identified;
pub(crate) use points::Points;
pub use read::ModelError;
pub use read::of_text;
pub use read::read;
pub use run::Run;
pub use series::Banded;
pub use series::RecordSeries;
pub use series::Series;
pub use series::diagnosed_series;
pub use series::identified_series;
pub(crate) use switchback_diagnose::PortableModel;
pub use system::System;
pub(crate) use units::UnitError;
pub(crate) use units::same_unit;
