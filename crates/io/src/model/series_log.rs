//! `series.mcap`: the same as `series.csv`, as a log for viewers of robots' logs.

use super::series::{RecordSeries, Series};
use crate::output::visible;
use std::io;
use switchback_table::{LogField, LogTopic, log_bytes};

/// Nanoseconds of a second.
const SECOND: f64 = 1e9;

impl Series {
    /// The file: a topic a record, whose messages hold the input, the measured output, each run, what was measured beyond it, and its band. What there
    /// is not is NaN. Labels of input and output stand in the definition of messages.
    ///
    /// # Errors
    /// Where the program was built without the feature `mcap`.
    pub fn log(&self, labels: [&str; 2]) -> io::Result<Vec<u8>> {
        let names = LogTopic::names(self.records.iter().map(|record| record.record.as_str()));
        let topic = |(name, record)| self.topic(name, record, labels);
        let topics: Vec<LogTopic> = names.into_iter().zip(&self.records).map(topic).collect();
        log_bytes(&topics)
    }

    fn topic(&self, name: String, record: &RecordSeries, [input, output]: [&str; 2]) -> LogTopic {
        let field = |name: &str, comment: String, values: Vec<f64>| {
            // A definition is read line by line.
            let comment = visible(&comment).replace(['\n', '\r'], " ");
            LogField { name: name.to_owned(), comment, values }
        };
        let mut fields = vec![
            field("input", input.to_owned(), record.v.clone()),
            field("measured", output.to_owned(), record.y.clone()),
        ];
        for (run, banded) in self.names.iter().zip(&record.runs) {
            let nothing = || vec![f64::NAN; record.y.len()];
            let y = banded.as_ref().map_or_else(nothing, |banded| banded.y.clone());
            let residual = record.y.iter().zip(&y).map(|(measured, y)| measured - y).collect();
            let band = banded.as_ref().and_then(|banded| banded.band.clone()).unwrap_or_else(nothing);
            fields.push(field(run, output.to_owned(), y));
            fields.push(field(&format!("{run}_residual"), format!("measured less {run}"), residual));
            fields.push(field(&format!("{run}_band"), "half the width of its 95 % band".to_owned(), band));
        }
        let instants = record.t.iter().map(|t| (t * SECOND).round() as u64).collect();
        LogTopic { name, instants, fields }
    }
}
