//! Rigs: a dataset's files of measurements, described by a `rig.toml` or by the command line, read and written.
//!
//! ```toml
//! name = "seal"
//! sample_time = 0.01           # s; may be left out where a time column shows it
//! order = 2                    # optional, else chosen from the data
//! interval = [-1.0, 1.0]       # optional, h_m and h_M, else the range of the records
//! input = "stroke [mm]"        # optional label and unit, else those of the column
//! output = "force [N]"
//! columns = { time = "time", input = "stroke", output = "force" }   # optional, else guessed from the header
//! resample = "linear"          # optional: bring uneven rows to even ones, on straight lines ("hold": the last value)
//!
//! [[record]]
//! file = "first.csv"           # beside rig.toml
//! role = "free"                # step_high | step_low | descendant | ascendant | free (the default)
//! use = "fit"                  # fit | holdout
//! holdout = 0.3                # optional: this share of it, at its end, is held out
//! columns = { input = "pos" }  # optional: names in this file that are not those above
//! ```

mod assemble;
mod check;
mod cut;
mod divided;
mod doubts;
mod frame;
mod manifest;
mod plan;
mod plausibility;
mod problem;
mod quantity;
mod read;
mod reported;
mod request;
mod run_state;
mod series;
mod survey;
mod wire;
mod write;

pub use assemble::Loaded;
pub(crate) use cut::is_rest_of;
pub use frame::Frame;
pub use frame::load_frames;
pub use manifest::manifest;
pub use plan::HELD_OUT;
pub use plan::Plan;
pub use plan::PlannedRecord;
pub use problem::RigError;
pub use problem::RigProblem;
pub use read::load;
pub use read::load_plan;
pub use read::read;
pub use reported::Reported;
pub use request::Request;
pub use series::InputSeries;
pub use series::read_input;
pub use survey::Survey;
pub use switchback_table::signals::Between;
pub use switchback_table::signals::ColumnNames;
pub use switchback_table::signals::InputForm;
pub use switchback_table::signals::NO_TIME;
pub use switchback_table::signals::Sampling;
pub use switchback_table::table::Cells;
pub use write::RIG_FILE;
pub use write::artefacts;
