//! The data a verb works on: files of measurements and how to read them, or one rig file.

use crate::options::Quiet;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;
use switchback_io::rig::{Between, ColumnNames, Loaded, Request, RigError, Survey};
use switchback_io::values::positive;

/// Files of measurements and how to read them, or one rig file.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct DataArgs {
    /// Files of measurements (CSV in any dialect; .mat, .mcap, .mf4 and .parquet if built with the features `matlab`, `mcap`, `mdf` and `parquet`), one a record; or one rig file (rig.toml).
    #[arg(required = true, value_name = "DATA")]
    data: Vec<PathBuf>,

    /// Column of the input, by name (its unit may be left out) or number [default: guessed from the header]
    #[arg(long, value_name = "COLUMN", help_heading = "Data")]
    input: Option<String>,

    /// Column of the output.
    #[arg(long, value_name = "COLUMN", help_heading = "Data")]
    output: Option<String>,

    /// Column of the time: in seconds, in the unit of its header, or ISO 8601; `none` for rows that are even whatever it says.
    #[arg(long, value_name = "COLUMN", help_heading = "Data")]
    time: Option<String>,

    /// Seconds between samples [default: from the time column]
    #[arg(long, value_name = "SECONDS", value_parser = positive, conflicts_with = "rate", help_heading = "Data", allow_negative_numbers = true)]
    sample_time: Option<f64>,

    /// Samples a second, instead of --sample-time.
    #[arg(long, value_name = "HZ", value_parser = positive, help_heading = "Data", allow_negative_numbers = true)]
    rate: Option<f64>,

    /// What models are judged on: a share of every record, at its end, or a file [default: the last third of a single file, else the
    /// last file]
    #[arg(long, value_name = "SHARE|FILE", help_heading = "Data", allow_negative_numbers = true)]
    holdout: Option<String>,

    /// Bring uneven rows to even ones, and slow signals to the rows of others: on straight lines, or the last value held [default where it
    /// stands alone: linear]
    #[arg(long, value_name = "HOW", num_args = 0..=1, default_missing_value = "linear", value_parser = between(), help_heading = "Data")]
    resample: Option<Between>,
}

/// Reads `hold` and `linear`.
pub(crate) fn between() -> impl TypedValueParser<Value = Between> {
    let names = Between::ALL.map(Between::name);
    PossibleValuesParser::new(names).map(|name| Between::named(&name).unwrap_or(Between::Linear))
}

impl DataArgs {
    /// Reads the rig; what was inferred is reported on stderr unless asked to be quiet. `verb` is the command's name, for remedies.
    ///
    /// # Errors
    /// [`RigError`] with all that is wrong.
    pub(crate) fn load(&self, verb: &str, quiet: Quiet) -> Result<(Request, Loaded), RigError> {
        let request = self.request();
        let loaded = request.load(verb)?;
        quiet.note(&loaded.reported.to_string());
        Ok((request, loaded))
    }

    /// The same where only a rig file is wanted: long files are looked at part by part.
    ///
    /// # Errors
    /// [`RigError`] with all that is wrong.
    pub(crate) fn survey(&self, verb: &str, quiet: Quiet) -> Result<(Request, Survey), RigError> {
        let request = self.request();
        let survey = request.survey(verb)?;
        quiet.note(&survey.reported.to_string());
        Ok((request, survey))
    }

    /// The same columns, clock and rates for other files; nothing of these is held out.
    pub(crate) fn of(&self, files: &[PathBuf]) -> Self {
        Self { data: files.to_vec(), holdout: None, ..self.clone() }
    }

    fn request(&self) -> Request {
        let Self { data, input, output, time, sample_time, rate, holdout, resample } = self.clone();
        let columns = ColumnNames { time, input, output };
        Request { data, columns, sample_time, rate, holdout, resample }
    }
}
