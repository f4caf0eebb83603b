//! Rig files: a campaign's `rig.toml` and one CSV a record, read and written.
//!
//! ```toml
//! name = "seal"
//! sample_time = 0.01           # s
//! order = 2                    # optional, else chosen from the data
//! interval = [-1.0, 1.0]       # optional, h_m and h_M, else the range of the records
//! input = "stroke [mm]"        # optional label and unit
//! output = "force [N]"
//!
//! [[record]]
//! file = "first.csv"           # beside rig.toml; columns t, v, y and optionally y_sim
//! role = "free"                # step_high | step_low | descendant | ascendant | free (the default)
//! use = "fit"                  # fit | holdout
//! ```

mod csv_error;
mod csv_read;
mod read;
mod sampling;
mod wire;
mod write;

pub use csv_error::{CsvError, CsvProblem};
pub use read::{RigError, read};
pub use write::{RIG_FILE, artefacts};
