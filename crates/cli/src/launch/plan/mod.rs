//! How long a study takes in parts, before it is run: constants measured on this machine, and what follows from them for any number of parts.
//!
//! ```text
//! time of a part = start + pieces × cost + bytes out × cost of writing
//! time of merge  = start + bytes in × cost of reading + bytes added × cost of adding + report
//! ```
//!
//! Parts leave sums that are added up, two by two: of the bytes that merge reads those are added that the whole has no more. A piece is a batch of replicates, which costs noise samples × cost + cells × cost, or a rig of an examination. All times are those of one
//! thread of a machine like this one, with nothing else on it.

mod clock;
mod examination;
mod study;
mod words;

pub use examination::measure as measure_examination;
pub use study::measure as measure_study;
pub use words::{to_json, to_text};

use serde::Serialize;

/// What was measured.
#[derive(Debug, Clone, Serialize)]
pub struct Costs {
    /// What a piece is: `batch`, or `rig`.
    pub piece: &'static str,
    /// How many there are in all.
    pub pieces: usize,
    /// Seconds until the first piece is begun, or the first part is read.
    pub start: f64,
    /// Seconds of a piece.
    pub per_piece: f64,
    /// Standard error of that, for pieces that differ.
    pub per_piece_error: f64,
    /// What they are made of.
    pub of_a_piece: Vec<Ingredient>,
    /// Seconds to make a byte of a part, hash it and write it.
    pub per_byte_out: f64,
    /// Seconds to read a byte of a part and check it.
    pub per_byte_in: f64,
    /// Seconds to add a byte of sums to others.
    pub per_byte_added: f64,
    /// Seconds to make the report, with the sums that are kept beside it.
    pub report: f64,
    /// Bytes of working memory that a part takes.
    pub memory: f64,
}

/// Something that a piece consists of.
#[derive(Debug, Clone, Serialize)]
pub struct Ingredient {
    /// What it is.
    pub name: &'static str,
    /// How many of it a piece has.
    pub count: f64,
    /// Seconds of each.
    pub seconds: f64,
}

/// A part, as far as its time and size go.
#[derive(Debug, Clone, Copy)]
pub struct Share {
    /// Pieces that it runs.
    pub pieces: usize,
    /// Bytes that it leaves.
    pub bytes: f64,
}

/// What is known of a study in parts.
pub struct Plan<'a> {
    /// What was measured.
    pub costs: Costs,
    /// The parts, of which there are so many.
    pub shares: Box<dyn Fn(usize) -> Vec<Share> + 'a>,
    /// Bytes of all parts once they are added up.
    pub whole: f64,
}

/// A study in a number of parts.
#[derive(Debug, Clone, Serialize)]
pub struct Forecast {
    /// How many parts.
    pub tasks: usize,
    /// Seconds of the longest.
    pub longest: f64,
    /// Seconds of merge.
    pub merge: f64,
    /// Seconds until the report is there, if all parts run at once.
    pub at_once: f64,
    /// Seconds of processor time of all parts and of merge.
    pub processor: f64,
    /// Bytes that all parts leave.
    pub disk: f64,
}

/// Twice as many tasks that save less than this share of the time are not worth it.
const WORTH: f64 = 0.1;

/// More tasks are not looked at.
const MOST: usize = 1 << 20;

impl Plan<'_> {
    /// A study in so many parts.
    pub fn forecast(&self, tasks: usize) -> Forecast {
        let costs = &self.costs;
        let shares = (self.shares)(tasks);
        let part = |share: &Share| {
            costs.start + costs.per_piece * share.pieces as f64 + costs.per_byte_out * share.bytes
        };
        let disk: f64 = shares.iter().map(|share| share.bytes).sum();
        let added = (disk - self.whole).max(0.0);
        let merge = costs.start + costs.per_byte_in * disk + costs.per_byte_added * added + costs.report;
        let longest = shares.iter().map(part).fold(0.0, f64::max);
        let processor = shares.iter().map(part).sum::<f64>() + merge;
        Forecast { tasks, longest, merge, at_once: longest + merge, processor, disk }
    }

    /// Seconds of one run that is not cut into parts.
    pub fn of_one_run(&self) -> f64 {
        let Costs { start, per_piece, pieces, report, .. } = self.costs;
        start + per_piece * pieces as f64 + report
    }

    /// Powers of two, as far as there are pieces for so many parts.
    fn doublings(&self) -> impl Iterator<Item = usize> {
        let most = self.costs.pieces.clamp(1, MOST);
        (0..).map(|power| 1 << power).take_while(move |tasks| *tasks <= most)
    }

    /// The forecasts worth a look: powers of two up to where more tasks stop helping and once beyond, and the number asked for.
    pub fn table(&self, asked: usize) -> Vec<Forecast> {
        let enough = self.enough();
        let doublings = self.doublings().take_while(|tasks| *tasks <= 2 * enough);
        let mut tasks: Vec<usize> = doublings.chain([asked]).collect();
        tasks.sort_unstable();
        tasks.dedup();
        tasks.into_iter().map(|tasks| self.forecast(tasks)).collect()
    }

    /// From how many tasks on twice as many save less than a tenth of the time.
    pub fn enough(&self) -> usize {
        let time = |tasks| self.forecast(tasks).at_once;
        let helps = |tasks: &usize| time(2 * tasks) < (1.0 - WORTH) * time(*tasks);
        self.doublings().find(|tasks| !helps(tasks) || 2 * tasks > self.costs.pieces).unwrap_or(1)
    }

    /// The least number of tasks, each with a processor of its own, by which the report is there within so many seconds; `None` where no number is enough.
    pub fn within(&self, seconds: f64) -> Option<Forecast> {
        let is_enough = |tasks: &usize| self.forecast(*tasks).at_once <= seconds;
        let most = self.doublings().find(is_enough)?;
        let tasks = (most / 2 + 1..=most).find(is_enough)?;
        Some(self.forecast(tasks))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(pieces: usize) -> Plan<'static> {
        let costs = Costs {
            piece: "rig",
            pieces,
            start: 1.0,
            per_piece: 2.0,
            per_piece_error: 0.0,
            of_a_piece: Vec::new(),
            per_byte_out: 0.01,
            per_byte_in: 0.02,
            per_byte_added: 0.1,
            report: 3.0,
            memory: 0.0,
        };
        let shares = move |tasks: usize| {
            let of = |k: usize| (pieces + k) / tasks;
            (0..tasks).map(|k| Share { pieces: of(k), bytes: 10.0 }).collect()
        };
        Plan { costs, shares: Box::new(shares), whole: 10.0 }
    }

    #[test]
    fn a_forecast_adds_up() {
        let forecast = plan(10).forecast(3);
        // The longest part has four rigs, and ten bytes.
        assert!((forecast.longest - (1.0 + 8.0 + 0.1)).abs() < 1e-12);
        // Thirty bytes become ten.
        assert!((forecast.merge - (1.0 + 0.6 + 2.0 + 3.0)).abs() < 1e-12);
        assert!((forecast.at_once - (9.1 + 6.6)).abs() < 1e-12);
        assert!((forecast.processor - (3.0 + 20.0 + 0.3 + 6.6)).abs() < 1e-12);
        assert!((plan(10).of_one_run() - 24.0).abs() < 1e-12);
    }

    #[test]
    fn tasks_stop_helping_where_merging_them_takes_what_they_save() {
        let plan = plan(1000);
        let enough = plan.enough();
        let time = |tasks| plan.forecast(tasks).at_once;
        assert!(time(enough) < 0.9 * time(enough / 2) && time(2 * enough) > 0.9 * time(enough));
        // The best number is near: 2 · 1000/K against 1.2 · K.
        assert!((32..=64).contains(&enough), "{enough}");
        let found = plan.within(120.0).expect("it is possible");
        assert!(found.at_once <= 120.0 && time(found.tasks - 1) > 60.0);
        assert!(plan.within(50.0).is_none());
        assert!(plan.table(24).iter().any(|forecast| forecast.tasks == 24));
    }
}
