//! The columns of a table as evenly sampled signals: which are time, input and output, what the clock shows, what interrupts it.

mod clock;
mod faults;
mod guess;
mod input_form;
mod measured;
mod names;
mod resample;
mod samples_needed;
mod sampling;
mod select;
mod spikes;
mod taken;

pub use input_form::InputForm;
pub use input_form::in_shell;
pub use measured::ClockSource;
pub use measured::Measured;
pub use measured::Request;
pub use names::ColumnNames;
pub use names::NO_TIME;
pub use names::Sampling;
pub use resample::Resampled;
pub use samples_needed::samples_needed;
pub use sampling::rounded;
pub use select::Selection;
pub use spikes::warnings as spikes;
