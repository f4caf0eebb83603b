//! Free runs of any model.

use super::{ModelFile, Run, System};

impl ModelFile {
    /// Runs on an input. With measured outputs, one a sample, the first of them are the initial state, as in the command that wrote the
    /// model; without, the run begins at rest at the first input. None where the input runs along a border that the model does not know.
    ///
    /// # Panics
    /// If the input is empty or the outputs have another length.
    pub fn run(&self, v: &[f64], y: Option<&[f64]>) -> Option<Run> {
        let mut run = match &self.system {
            System::Switched(model) => {
                let run = model.simulate(v, y);
                let known = run.record.map(|name| {
                    format!("these are the samples of `{name}`, a record of the rig: slow changes keep its place among the records")
                });
                let known = known.filter(|_| model.follows_clock());
                Run {
                    y: run.y,
                    low: run.low,
                    high: run.high,
                    start: run.start,
                    fit_percent: run.fit_percent,
                    notes: run.notes.into_iter().chain(known).collect(),
                }
            }
            System::Curves(model) => model.run(v, y),
            System::Machine(model) => {
                let mut run = model.run(v, y);
                if model.follows_clock() {
                    run.notes
                        .push("slow changes run over this input as they ran over the records".to_owned());
                }
                run
            }
            System::Points(model) => model.run(v, y)?,
        };
        if !self.system.has_covariance() {
            run.notes.push(
                "the errors of the model's parameters are unknown: the band holds the noise only".to_owned(),
            );
        }
        if y.is_none() {
            run.notes.push(
                "the run begins at rest, as if the input had always been at its first value".to_owned(),
            );
        }
        Some(run)
    }
}
