//! The columns of a table as evenly sampled signals: which are time, input and output, what the clock shows, what interrupts it.

mod causality;
mod clock;
mod clock_source;
mod counter;
mod counters;
mod derived;
mod even;
mod faults;
mod guess;
mod input_form;
mod instants;
mod measured;
mod names;
mod offer;
mod pace;
mod pairs;
mod rates;
mod relations;
mod request;
mod resample;
mod sampling;
mod select;
mod settle;
mod spelling;
mod spikes;
mod taken;
#[cfg(test)]
mod tests;
mod time_of_day;
mod two_part_stamps;
mod words;

pub use clock_source::ClockSource;
pub use input_form::InputForm;
pub use measured::Measured;
pub use names::Between;
pub use names::ColumnNames;
pub use names::NO_TIME;
pub use names::Sampling;
pub use request::Request;
pub use resample::Resampled;
pub use sampling::rounded;
pub use select::Selection;
pub use spikes::warnings as spikes;
