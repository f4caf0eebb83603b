//! `resources/model.json`: what the library reads.

use serde::{Deserialize, Serialize};
use std::fmt;
use switchback_model::step::Program;

/// The format that is written, and the only one that is read.
pub const SCHEMA: &str = "switchback/fmu/1";

/// The numbers of the variables.
pub mod references {
    use crate::fmi2::ValueReference;

    /// The input, a real.
    pub const V: ValueReference = 0;
    /// The output, a real.
    pub const Y: ValueReference = 1;
    /// Whether the input has left the working interval, a boolean.
    pub const OUTSIDE: ValueReference = 2;
    /// The border on which a run begins, an integer.
    pub const BORDER: ValueReference = 3;
    /// Samples by which the output is late, an integer.
    pub const OUTPUT_DELAY: ValueReference = 4;
    /// The first of the constants, reals.
    pub const CONSTANTS: ValueReference = 100;
}

/// A model with all that its functions answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Package {
    /// [`SCHEMA`].
    pub schema: String,
    /// Version of the program that wrote it.
    pub version: String,
    /// What `fmi2Instantiate` must be given.
    pub guid: String,
    /// Seconds between samples.
    pub sample_time: f64,
    /// The working interval of the input.
    pub interval: [f64; 2],
    /// The input that it begins with where none is set.
    pub start: f64,
    /// Constants, in the order of their numbers.
    pub constants: Vec<f64>,
    /// What runs.
    pub program: Program,
}

/// Why a file is no package.
#[derive(Debug)]
pub enum PackageError {
    /// It is in another format.
    Schema(String),
    /// It is no JSON, or its parts are others.
    Content(serde_json::Error),
    /// A number is out of its range.
    SampleTime(f64),
}

impl fmt::Display for PackageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Schema(found) => {
                write!(
                    f,
                    "resources/model.json has the format `{found}`, but this library reads `{SCHEMA}`: export the model again"
                )
            }
            Self::Content(error) => write!(f, "resources/model.json: {error}"),
            Self::SampleTime(found) => {
                write!(f, "resources/model.json: `sample_time` is {found}, but must be positive")
            }
        }
    }
}

impl std::error::Error for PackageError {}

#[derive(Deserialize)]
struct Peek {
    schema: Option<String>,
}

impl Package {
    /// Samples by which the output is late: 1 where it depends on the input of its own sample, which a step does not know yet.
    pub fn output_delay(&self) -> usize {
        usize::from(self.program.direct)
    }

    /// Reads it.
    ///
    /// # Errors
    /// [`PackageError`] where it is of another format or contradicts itself.
    pub fn from_json(text: &str) -> Result<Self, PackageError> {
        let peek: Peek = serde_json::from_str(text).map_err(PackageError::Content)?;
        match peek.schema {
            Some(schema) if schema == SCHEMA => {}
            other => return Err(PackageError::Schema(other.unwrap_or_default())),
        }
        let package: Self = serde_json::from_str(text).map_err(PackageError::Content)?;
        match package.sample_time > 0.0 && package.sample_time.is_finite() {
            true => Ok(package),
            false => Err(PackageError::SampleTime(package.sample_time)),
        }
    }

    /// Writes it.
    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("finite numbers and words are JSON")
    }
}
