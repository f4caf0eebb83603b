//! Methods for the designed experiments, all on sufficient statistics: see [`PulseMethod`].
//!
//! Most methods are one linear (or, for the efficient one, one iterated) least squares over [`GroupedStatistics`], and differ in its columns
//! only; the instrumental one works on [`Folds`]. See each method for its own reference.

mod arrow;
mod cumulants;
mod data;
mod efficient;
mod excitation;
mod expansion;
mod experiments;
mod finite_sample;
mod fit;
mod folds;
mod grouped;
mod instrumental;
mod joint;
pub mod lanes;
mod layout;
mod level_rule;
mod linear_arx;
mod memoryless;
mod method;
mod paper;
mod score;
mod second_order;
mod solution;

pub use cumulants::Cumulants;
pub use data::PulseData;
pub use data::PulseDataError;
pub use data::StepMean;
pub(crate) use excitation::excitation;
pub use finite_sample::FiniteSampleTheory;
pub use fit::Estimated;
pub use fit::PulseFit;
pub use fit::PulseFitError;
pub use folds::Folds;
pub use grouped::GroupedStatistics;
pub use method::Limit;
pub use method::PulseMethod;
pub use method::SecondOrder;
pub use score::ErrorTerms;
pub use score::GroupSum;
pub use second_order::EquationNoise;
pub use second_order::ExpectedRecord;
