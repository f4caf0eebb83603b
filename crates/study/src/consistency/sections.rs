//! What the replicates of a cell left behind: sums, by section.

use super::control_sums::{ControlShape, ControlSums, PairOfErrors};
use super::interval_ends::IntervalEnds;
use serde::{Deserialize, Serialize};
use switchback_identify::pulse::ErrorTerms;
use switchback_identify::pulse::lanes::LANES;
use switchback_identify::statistics::{ErrorSums, IntervalCounts, LaneErrors, LaneSums, ReplicateError};

/// Replicates are kept in so many sections, so that any figure drawn from several cells can be jackknifed: two for each lane.
pub(super) const SECTIONS: usize = 2 * LANES;

/// Failed replicates that are kept by number; the rest are only counted.
const KEPT_FAILURES: usize = 100;

/// The section of a replicate: they take turns, so that a study may go on at any number.
pub(super) fn section(replicate: usize) -> usize {
    replicate % SECTIONS
}

/// A replicate without an estimate.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Failure {
    pub(super) replicate: usize,
    pub(super) reason: String,
}

/// How many replicates were run, and which of them have no estimate.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Runs {
    /// Replicates run, failed ones included.
    pub(super) replicates: usize,
    pub(super) failed: usize,
    /// The first of them, by number.
    pub(super) failures: Vec<Failure>,
}

impl Runs {
    pub(super) fn fail(&mut self, replicate: u32, reason: String) {
        self.failed += 1;
        if self.failures.len() < KEPT_FAILURES {
            self.failures.push(Failure { replicate: replicate as usize, reason });
        }
    }

    fn merge(&mut self, other: &Self) {
        self.replicates += other.replicates;
        self.failed += other.failed;
        self.failures.extend(other.failures.iter().cloned());
        self.failures.sort_by_key(|failure| failure.replicate);
        self.failures.truncate(KEPT_FAILURES);
    }
}

/// What one record gives: the errors of all parameters with the standard errors that the method reports, and the errors' leading terms.
#[derive(Debug, Clone)]
pub(super) struct Outcome {
    pub(super) errors: Vec<(f64, f64)>,
    pub(super) terms: ErrorTerms,
}

impl Outcome {
    fn parameter(&self, k: usize, first_order_variance: Option<f64>) -> ReplicateError {
        let (error, se) = self.errors[k];
        let (first_order, second_order) = (Some(self.terms.first[k]), self.terms.second[k]);
        ReplicateError { error, se, first_order, second_order, first_order_variance }
    }
}

/// One section of a cell's replicates.
#[derive(Debug, Clone)]
pub(super) struct SectionSums {
    /// One a parameter.
    pub(super) parameters: Vec<ErrorSums>,
    /// One a parameter, of the replicates that were added since the section was taken.
    intervals: Vec<IntervalCounts>,
    /// Likewise.
    pub(super) runs: Runs,
}

impl SectionSums {
    /// Adds a replicate and its antithetic partner, if there is one, given the exact variances of the first-order terms where they are known.
    pub(super) fn push_pair(&mut self, own: &Outcome, mirrored: Option<&Outcome>, variances: Option<&[f64]>) {
        for k in 0..own.errors.len() {
            let variance = variances.map(|variances| variances[k]);
            let replicate = own.parameter(k, variance);
            self.intervals[k].push(replicate.error, replicate.se);
            self.parameters[k].push_pair(replicate, mirrored.map(|mirrored| mirrored.parameter(k, variance)));
        }
    }

    /// Adds what a replicate reports one parameter.
    pub(super) fn push_parameter(&mut self, k: usize, replicate: ReplicateError) {
        self.intervals[k].push(replicate.error, replicate.se);
        self.parameters[k].push(replicate);
    }
}

/// All sections of a cell's replicates.
///
/// Every section adds its replicates one after the other, by number: a run that stops anywhere and goes on has the bits of one that did not.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CellSums {
    /// Sections 0 to 7, and 8 to 15.
    halves: [LaneSums; 2],
    /// One a parameter, of all sections: counts add up exactly, in any order.
    intervals: Vec<IntervalCounts>,
    /// Of a method of others.
    foreign: Option<ForeignSums>,
    pub(super) runs: Runs,
}

/// What is kept of a method of others besides.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ForeignSums {
    pub(super) controls: ControlSums,
    /// One a parameter.
    pub(super) ends: Vec<IntervalEnds>,
}

impl ForeignSums {
    fn new(shape: ControlShape) -> Self {
        let ends = vec![IntervalEnds::default(); shape.parameters];
        Self { controls: ControlSums::new(shape, SECTIONS), ends }
    }

    fn merge(&mut self, other: &Self) {
        self.controls.merge(&other.controls);
        self.ends.iter_mut().zip(&other.ends).for_each(|(into, from)| into.merge(from));
    }

    /// Appends all that is in it.
    pub(super) fn write(&self, bytes: &mut Vec<u8>) {
        self.controls.write(bytes);
        self.ends.iter().for_each(|ends| ends.write(bytes));
    }

    /// Takes what [`write`](Self::write) appended from the beginning of `bytes`; `None` where there is too little.
    pub(super) fn read(shape: ControlShape, bytes: &mut &[u8]) -> Option<Self> {
        let controls = ControlSums::read((shape, SECTIONS), bytes)?;
        let ends = (0..shape.parameters).map(|_| IntervalEnds::read(bytes)).collect::<Option<_>>()?;
        Some(Self { controls, ends })
    }
}

/// What the sums of a cell hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CellShape {
    pub(super) parameters: usize,
    /// Of a method of others.
    pub(super) controls: Option<ControlShape>,
}

impl CellSums {
    pub(super) fn new(shape: CellShape) -> Self {
        let CellShape { parameters, controls } = shape;
        Self {
            halves: [0, 1].map(|_| LaneSums::new(parameters)),
            intervals: vec![IntervalCounts::default(); parameters],
            foreign: controls.map(ForeignSums::new),
            runs: Runs::default(),
        }
    }

    /// Puts together what [`halves`](Self::halves), [`intervals`](Self::intervals), [`foreign`](Self::foreign) and `runs` hold.
    pub(super) fn of(
        halves: [LaneSums; 2],
        intervals: Vec<IntervalCounts>,
        foreign: Option<ForeignSums>,
        runs: Runs,
    ) -> Self {
        Self { halves, intervals, foreign, runs }
    }

    /// What is kept of a method of others besides.
    pub(super) fn foreign(&self) -> Option<&ForeignSums> {
        self.foreign.as_ref()
    }

    /// Adds the controls and errors of a replicate to a section.
    pub(super) fn push_controls(&mut self, section: usize, controls: &[f64], errors: PairOfErrors<'_>) {
        let Some(sums) = &mut self.foreign else { return };
        sums.controls.push(section, controls, errors);
        let own = errors.own.into_iter().flatten().zip(errors.se.into_iter().flatten());
        sums.ends.iter_mut().zip(own).for_each(|(ends, (error, se))| ends.push(*error, *se));
    }

    pub(super) fn halves(&self) -> &[LaneSums; 2] {
        &self.halves
    }

    /// Where the truth lies in the intervals, one a parameter.
    pub(super) fn intervals(&self) -> &[IntervalCounts] {
        &self.intervals
    }

    /// Adds whole groups of eight replicates of the same sections, of which this is the first.
    pub(super) fn add_all(&mut self, first: u32, truth: &[f64], errors: &[LaneErrors<'_>]) {
        self.halves[half(first)].add_all(truth, errors);
        errors.iter().for_each(|e| IntervalCounts::add(&mut self.intervals, truth, e, &[true; LANES]));
    }

    /// Adds those of eight replicates that are chosen.
    pub(super) fn add(&mut self, first: u32, truth: &[f64], errors: LaneErrors<'_>, chosen: &[bool; LANES]) {
        self.halves[half(first)].add(truth, errors, chosen);
        IntervalCounts::add(&mut self.intervals, truth, &errors, chosen);
    }

    /// A section's sums as they stand, without the counts.
    pub(super) fn section(&self, section: usize) -> SectionSums {
        SectionSums {
            parameters: self.halves[section / LANES].lane(section % LANES),
            intervals: vec![IntervalCounts::default(); self.intervals.len()],
            runs: Runs::default(),
        }
    }

    /// Puts back what [`section`](Self::section) gave, with more replicates in it.
    pub(super) fn put_section(&mut self, section: usize, sums: &SectionSums) {
        self.halves[section / LANES].set_lane(section % LANES, &sums.parameters);
        self.count(&sums.intervals);
        self.runs.merge(&sums.runs);
    }

    fn count(&mut self, intervals: &[IntervalCounts]) {
        self.intervals.iter_mut().zip(intervals).for_each(|(into, from)| into.merge(from));
    }

    /// Adds the sums of other replicates, section for section.
    pub(super) fn merge(&mut self, other: &Self) {
        self.halves.iter_mut().zip(&other.halves).for_each(|(into, from)| into.merge(from));
        self.count(&other.intervals);
        if let Some((into, from)) = self.foreign.as_mut().zip(other.foreign.as_ref()) {
            into.merge(from);
        }
        self.runs.merge(&other.runs);
    }

    /// The sums over all sections, or over all but one, one a parameter.
    pub(super) fn parameters(&self, without: Option<usize>) -> Vec<ErrorSums> {
        let mut all = vec![ErrorSums::default(); self.halves[0].parameters()];
        for section in (0..SECTIONS).filter(|section| Some(*section) != without) {
            let sums = self.section(section).parameters;
            all.iter_mut().zip(&sums).for_each(|(into, from)| into.merge(from));
        }
        all
    }
}

/// Which half of the sections eight replicates belong to, of which this is the first.
fn half(first: u32) -> usize {
    first as usize / LANES % 2
}
