//! `series.csv`: measured and simulated outputs of every record.

use super::Run;
use crate::diagnosis::Report;
use crate::identification::Identification;
use crate::input::json_file::JsonError;
use crate::output::{csv_cell, number};
use std::fmt::Write;
use std::path::Path;
use switchback_diagnose::PortableModel;
use switchback_model::rig::{Rig, RigRecord};

/// Runs of models over records, and what was measured there.
///
/// ```text
/// record,use,t,v,y,RUN,…,RUN_band,…
/// ```
///
/// Times start at zero in every record. Before the first counted sample a run is the measured output. A run is empty where its model has none;
/// its band is half the width of the 95 % band around it for a measured output, empty where the errors of the model are not known.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What the runs are called.
    pub names: Vec<String>,
    /// The records, in the order of the rig.
    pub records: Vec<RecordSeries>,
}

/// One record.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordSeries {
    /// Its name.
    pub record: String,
    /// `fit` or `holdout`.
    pub usage: String,
    /// Seconds.
    pub t: Vec<f64>,
    /// The input.
    pub v: Vec<f64>,
    /// The measured output.
    pub y: Vec<f64>,
    /// The runs, one for each of the names.
    pub runs: Vec<Option<Banded>>,
}

/// A run and the half-width of its band.
#[derive(Debug, Clone, PartialEq)]
pub struct Banded {
    /// One output a sample.
    pub y: Vec<f64>,
    /// Half the width of the 95 % band.
    pub band: Option<Vec<f64>>,
}

impl Banded {
    fn new(y: Vec<f64>, ends: Option<(&[f64], &[f64])>) -> Self {
        let half = |(low, high): (&[f64], &[f64])| {
            low.iter().zip(high).map(|(low, high)| short(0.5 * (high - low))).collect()
        };
        Self { y, band: ends.map(half) }
    }
}

/// Of a diagnosis: `nominal` is the model under diagnosis, empty where it has no prediction, `augmented` the same with what was found.
pub fn diagnosed_series(report: &Report) -> Series {
    let models = report.diagnosis.models.as_ref();
    let banded = |model: &PortableModel, number: usize, record: &RigRecord| {
        let run = model.banded(number, record.record.v(), record.record.y());
        let ends = model.has_covariance().then_some((&run.low[..], &run.high[..]));
        let ends = ends.map(|(low, high)| (low.to_vec(), high.to_vec()));
        Banded::new(run.y, ends.as_ref().map(|(low, high)| (&low[..], &high[..])))
    };
    let runs = |number: usize, record: &RigRecord| {
        let nominal = models.and_then(|m| m.nominal.as_ref()).map(|model| banded(model, number, record));
        let nominal = nominal.or_else(|| record.predicted.clone().map(|y| Banded::new(y, None)));
        vec![nominal, models.map(|m| banded(&m.augmented, number, record))]
    };
    Series::of(&report.rig, &["nominal", "augmented"], runs)
}

/// Of an identification: `simulated`, empty where the model has no run.
pub fn identified_series(rig: &Rig, identification: &Identification) -> Series {
    let model = super::identified(rig, identification);
    let band = |record: &RigRecord| -> Option<Run> {
        let run = model.as_ref()?.run(record.record.v(), Some(record.record.y()))?;
        model.as_ref()?.system.has_covariance().then_some(run)
    };
    Series::of(rig, &["simulated"], |number, record| {
        let simulated = identification.runs[number].as_ref().map(|run| run.simulated.clone());
        let band = simulated.as_ref().and_then(|_| band(record));
        vec![simulated.map(|y| Banded::new(y, band.as_ref().map(|run| (&run.low[..], &run.high[..]))))]
    })
}

impl Series {
    fn of(rig: &Rig, names: &[&str], runs: impl Fn(usize, &RigRecord) -> Vec<Option<Banded>>) -> Self {
        let record = |(number, record): (usize, &RigRecord)| RecordSeries {
            record: record.name.clone(),
            usage: record.usage.name().to_owned(),
            t: (0..record.record.len()).map(|t| stamp(t, rig.sample_time)).collect(),
            v: record.record.v().to_vec(),
            y: record.record.y().to_vec(),
            runs: runs(number, record),
        };
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        Self { names, records: rig.records.iter().enumerate().map(record).collect() }
    }

    /// The file.
    pub fn text(&self) -> String {
        let bands: Vec<String> = self.names.iter().map(|name| format!("{name}_band")).collect();
        let mut text = format!("record,use,t,v,y,{},{}\n", self.names.join(","), bands.join(","));
        let cell = |text: &mut String, column: Option<&Vec<f64>>, t: usize| {
            let _ = match column {
                Some(column) => write!(text, ",{}", number(column[t])),
                None => write!(text, ","),
            };
        };
        for record in &self.records {
            let name = quoted(&csv_cell(&record.record));
            for (t, (v, y)) in record.v.iter().zip(&record.y).enumerate() {
                let (at, v, y) = (number(record.t[t]), number(*v), number(*y));
                let _ = write!(text, "{name},{},{at},{v},{y}", record.usage);
                for run in &record.runs {
                    cell(&mut text, run.as_ref().map(|run| &run.y), t);
                }
                for run in &record.runs {
                    cell(&mut text, run.as_ref().and_then(|run| run.band.as_ref()), t);
                }
                text.push('\n');
            }
        }
        text
    }

    /// What a file holds; `path` is what messages call it.
    ///
    /// # Errors
    /// Where a line is none of such a file, with its place.
    pub fn parse(path: &Path, text: &str) -> Result<Self, JsonError> {
        let fail = |line: u64, message: String| JsonError {
            place: format!("{}:{line}", path.display()),
            message,
            is_json: false,
        };
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let head = reader.headers().map_err(|error| fail(1, error.to_string()))?.clone();
        let head: Vec<&str> = head.iter().collect();
        let known = ["record", "use", "t", "v", "y"];
        let runs = head.len().saturating_sub(known.len()) / 2;
        let names: Vec<String> =
            head.iter().skip(known.len()).take(runs).map(|name| (*name).to_owned()).collect();
        let is_band = |k: usize| head[known.len() + runs + k] == format!("{}_band", names[k]);
        if !head.starts_with(&known)
            || runs == 0
            || head.len() != known.len() + 2 * runs
            || !(0..runs).all(is_band)
        {
            return Err(fail(1, "the columns are not record, use, t, v, y, runs and their bands".to_owned()));
        }
        let mut records: Vec<RecordSeries> = Vec::new();
        for row in reader.records() {
            let row = row
                .map_err(|error| fail(error.position().map_or(0, csv::Position::line), error.to_string()))?;
            let line = row.position().map_or(0, csv::Position::line);
            let number = |k: usize| -> Result<Option<f64>, JsonError> {
                match &row[k] {
                    "" => Ok(None),
                    cell => {
                        cell.parse().map(Some).map_err(|_| fail(line, format!("`{cell}` is not a number")))
                    }
                }
            };
            let measured = |k: usize| number(k)?.ok_or_else(|| fail(line, format!("`{}` is empty", head[k])));
            if records.last().is_none_or(|record| record.record != row[0]) {
                records.push(RecordSeries::empty(&row[0], &row[1], runs));
            }
            let record = records.last_mut().expect("one was just added where there was none");
            record.t.push(measured(2)?);
            record.v.push(measured(3)?);
            record.y.push(measured(4)?);
            for (k, run) in record.runs.iter_mut().enumerate() {
                let (y, half) = (number(known.len() + k)?, number(known.len() + runs + k)?);
                let Some(y) = y else { continue };
                let run = run.get_or_insert_with(|| Banded { y: Vec::new(), band: half.map(|_| Vec::new()) });
                run.y.push(y);
                run.band.iter_mut().zip(half).for_each(|(band, half)| band.push(half));
            }
            let length = record.t.len();
            let is_ragged = |run: &Banded| {
                run.y.len() != length || run.band.as_ref().is_some_and(|band| band.len() != length)
            };
            if record.runs.iter().flatten().any(is_ragged) {
                return Err(fail(line, "a run has gaps".to_owned()));
            }
        }
        Ok(Self { names, records })
    }
}

impl RecordSeries {
    fn empty(record: &str, usage: &str, runs: usize) -> Self {
        let (record, usage) = (record.to_owned(), usage.to_owned());
        Self { record, usage, t: Vec::new(), v: Vec::new(), y: Vec::new(), runs: vec![None; runs] }
    }
}

/// A time that carries no rounding errors of the product.
fn stamp(t: usize, sample_time: f64) -> f64 {
    let product = t as f64 * sample_time;
    format!("{product:.11e}").parse().unwrap_or(product)
}

/// Four digits of a width.
fn short(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// A cell of a CSV file.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series() -> Series {
        let run = |y: [f64; 2], band: Option<[f64; 2]>| {
            Some(Banded { y: y.to_vec(), band: band.map(|b| b.to_vec()) })
        };
        let record = |name: &str, runs: Vec<Option<Banded>>| RecordSeries {
            record: name.to_owned(),
            usage: "fit".to_owned(),
            t: vec![0.0, 0.1],
            v: vec![1.0 / 3.0, -2e-9],
            y: vec![1e300, -0.5],
            runs,
        };
        Series {
            names: vec!["nominal".to_owned(), "augmented".to_owned()],
            records: vec![
                record("a, \"b\"", vec![None, run([1.5, 2.5], Some([0.1, 0.2]))]),
                record("c", vec![run([0.0, 1.0], None), run([1.0, 2.0], Some([0.0, 0.1]))]),
            ],
        }
    }

    #[test]
    fn a_file_is_read_as_it_was_written() {
        let series = series();
        let read = Series::parse(Path::new("series.csv"), &series.text()).expect("it was just written");
        assert_eq!(read, series);
    }

    #[test]
    fn what_is_no_such_file_is_reported_with_its_line() {
        let text = series().text();
        let refused = |text: &str| Series::parse(Path::new("s.csv"), text).expect_err("it is none").place;
        assert_eq!(refused("record,use,t,v,y,nominal,augmented\n"), "s.csv:1");
        assert_eq!(refused(&text.replace(",2.5,", ",x,")), "s.csv:3");
        assert_eq!(refused(&text.replacen(",0.1,-0.000000002", ",,-0.000000002", 1)), "s.csv:3");
    }
}
