//! Model files: what `identify --out` and `gap --out` write, `simulate` runs and `gap --model` diagnoses.
//!
//! One JSON object. Numbers have as many digits as they need to be read back as the same numbers.
//! `docs/schemas/model-1.json` says what each key holds.

mod causal;
mod curves;
mod described;
mod domain;
mod file;
mod machine;
mod make;
mod points;
mod read;
mod run;
mod series;
mod series_log;
mod simulate;
mod system;
mod units;

pub use causal::NotCausal;
pub use curves::Curves;
pub(crate) use curves::plain;
pub use described::Described;
pub use domain::Domain;
pub(crate) use file::Added;
pub use file::Header;
pub use file::ModelFile;
pub use file::schema;
pub use machine::Machine;
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
pub use switchback_table::WRITES_LOGS;
pub use system::System;
pub use units::UnitError;
pub use units::same_unit;
