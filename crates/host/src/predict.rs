//! The predictions of an FMU for every record of a rig.

use crate::error::FmuError;
use crate::map::Map;
use crate::messages::Job;
use crate::process::{self, Ended, Outcome};
use std::path::Path;
use std::time::Duration;
use switchback_io::input::regular;
use switchback_model::rig::Rig;

/// An FMU and how it is run.
#[derive(Debug, Clone)]
pub struct Simulator<'a> {
    /// The archive.
    pub fmu: &'a Path,
    /// Which of its variables are the input and the output.
    pub map: Map,
    /// It is given up where nothing happens for so long.
    pub patience: Duration,
}

/// The rig with the FMU's outputs as predictions of all its records.
///
/// # Errors
/// [`FmuError`] where it is no co-simulation FMU 2.0 for this platform, has not the variables, crashes, refuses, or does not return.
pub fn predictions(mut rig: Rig, simulator: &Simulator<'_>) -> Result<Rig, FmuError> {
    let fmu = simulator.fmu;
    // What can be read only once, or never ends, is no archive.
    regular(fmu).map_err(|error| {
        FmuError::new(fmu, error, "give a co-simulation FMU of FMI 2.0, as simulators export it")
    })?;
    let job = Job {
        map: simulator.map.clone(),
        labels: [rig.input_label.clone(), rig.output_label.clone()],
        sample_time: rig.sample_time,
        inputs: rig.records.iter().map(|record| record.record.v().to_vec()).collect(),
    };
    let outcome = process::run(fmu, &job, simulator.patience).map_err(|error| {
        FmuError::new(
            fmu,
            format!("its process does not run: {error}"),
            "free some space, or set TMPDIR to another folder",
        )
    })?;
    let names: Vec<&str> = rig.records.iter().map(|record| record.name.as_str()).collect();
    let runs = simulator.outputs(outcome, &names)?;
    for (record, y) in rig.records.iter_mut().zip(runs) {
        record.predicted = Some(y);
    }
    Ok(rig)
}

impl Simulator<'_> {
    /// The outputs of all records, or why there are none.
    fn outputs(&self, outcome: Outcome, names: &[&str]) -> Result<Vec<Vec<f64>>, FmuError> {
        let Outcome { ended, said, printed } = outcome;
        let stopped = |why: &str| {
            let place = said.at.map_or_else(String::new, |(record, sample)| {
                let name = names.get(record).unwrap_or(&"?");
                format!("in the record {name}, at sample {sample} or soon after, ")
            });
            let remedy = format!(
                "try it in the simulator that exported it, with a step of the records' sample time; `--patience SECONDS` waits longer than {} s",
                self.patience.as_secs_f64()
            );
            FmuError::new(self.fmu, format!("{place}{why}{}", last_words(&printed)), remedy)
        };
        match (&said.why, ended) {
            (Some((why, Some(remedy))), _) => Err(FmuError::new(self.fmu, why, remedy)),
            (Some((why, None)), _) => Err(stopped(why)),
            (None, _) if said.runs.len() == names.len() => Ok(said.runs),
            (None, Ended::Silent) => {
                let patience = self.patience.as_secs_f64();
                Err(stopped(&format!("it did not return within {patience} s and was ended")))
            }
            (None, Ended::Itself(how)) => Err(stopped(&format!("it crashed ({how})"))),
        }
    }
}

/// The last lines of what the FMU printed.
fn last_words(printed: &str) -> String {
    let last: Vec<&str> = printed.lines().filter(|line| !line.trim().is_empty()).collect();
    let last = &last[last.len().saturating_sub(3)..];
    if last.is_empty() { String::new() } else { format!("; it said: {}", last.join(" / ")) }
}
