//! The fit records, with everything that does not depend on a model's structure worked out once.

use super::basis::{Basis, Spacing, place_knots};
use super::cells::Cells;
use super::error::FreeError;
use super::problem::{Segment, Structure};
use super::rules::rules;
use super::settings::{InputMap, Settings};
use switchback_model::hysteresis::{Branch, Interval};
use switchback_model::record::Record;
use switchback_model::reversal::SensorNoise;
use switchback_model::reversal::{Branches, ReversalRule};

/// Samples, spread over the records, on which structures are compared: two hundred for each coefficient of the largest one tried. The fit that is
/// kept uses all samples.
const SEARCH_SAMPLES: usize = 8000;

/// Blocks that the fit records are cut into; each is left out once.
pub(super) const FOLDS: usize = 10;

/// The records and their branches.
#[derive(Debug)]
pub(super) struct Data<'a> {
    pub(super) records: Vec<(&'a Record, Branches)>,
    pub(super) interval: Interval,
    pub(super) rule: ReversalRule,
    pub(super) noise: SensorNoise,
}

/// Hats of every sample of every record, for one basis.
#[derive(Debug)]
pub(super) struct Featured<'a> {
    pub(super) basis: Basis,
    records: Vec<(&'a Record, usize, Cells)>,
}

impl<'a> Data<'a> {
    /// Finds the threshold, the branches and the interval. Records whose input never moves are left out.
    pub(super) fn new(records: &[&'a Record], settings: &Settings) -> Result<Self, FreeError> {
        if records.is_empty() {
            return Err(FreeError::NoRecords);
        }
        let noise = records
            .iter()
            .map(|r| SensorNoise::of(r.v()))
            .max_by(|x, y| x.threshold.total_cmp(&y.threshold))
            .ok_or(FreeError::NoRecords)?;
        let rule = rules(noise, settings)[0];
        let records: Vec<_> =
            records.iter().filter_map(|&record| Some((record, Branches::of(record.v(), rule)?))).collect();
        let values = || records.iter().flat_map(|(r, _)| r.v().iter().copied());
        let range =
            Interval::new(values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let Ok(range) = range else { return Err(FreeError::NoMotion { threshold: rule.threshold }) };
        if records.iter().all(|(r, _)| r.y().iter().all(|y| *y == r.y()[0])) {
            return Err(FreeError::ConstantOutput);
        }
        Ok(Self { records, interval: settings.interval.unwrap_or(range), rule, noise })
    }

    /// The same records with reversals by another rule.
    pub(super) fn with_rule(&self, rule: ReversalRule) -> Self {
        let again = |(record, branches): &(&'a Record, Branches)| {
            (*record, Branches::of(record.v(), rule).unwrap_or_else(|| branches.clone()))
        };
        Self { records: self.records.iter().map(again).collect(), rule, ..*self }
    }

    /// A basis with `knots` knots a curve, placed by where the records go.
    pub(super) fn basis(&self, map: InputMap, knots: usize) -> Basis {
        let values = |wanted: Option<Branch>| -> Vec<f64> {
            let visited = |(record, branches): &(&Record, Branches)| {
                let labelled = record.v().iter().zip(branches.labels()).skip(branches.first_known());
                labelled.filter(|(_, b)| wanted.is_none_or(|w| w == **b)).map(|(v, _)| *v).collect::<Vec<_>>()
            };
            self.records.iter().flat_map(visited).collect()
        };
        let place = |branch, spacing| place_knots(&values(branch), self.interval, knots, spacing);
        match map {
            InputMap::Linear => Basis::linear(self.interval),
            InputMap::Static => Basis::curve(place(None, Spacing::Even)),
            InputMap::Borders => {
                let [descending, ascending] = [Branch::Descending, Branch::Ascending]
                    .map(|branch| place(Some(branch), Spacing::DenseEnds));
                Basis::borders(descending, ascending)
            }
        }
    }

    /// Hats of every sample.
    pub(super) fn featured(&self, basis: Basis) -> Featured<'a> {
        let hats = |(record, branches): &(&'a Record, Branches)| {
            (*record, branches.first_known(), Cells::of(&basis, record.v(), branches))
        };
        Featured { records: self.records.iter().map(hats).collect(), basis }
    }
}

impl Featured<'_> {
    /// Everything that a structure can explain.
    pub(super) fn segments(&self, structure: Structure) -> Vec<Segment<'_>> {
        let whole = self
            .records
            .iter()
            .map(|(r, known, cells)| Segment::usable(structure, r.y(), cells, *known..r.len()));
        whole.flatten().collect()
    }

    /// Blocks of time of about equal length, none across records: `blocks` in all, or a few more. Of long records each block is only the first part, so
    /// that all of them have [`SEARCH_SAMPLES`] or a few more.
    ///
    /// A free run starts half a block before what counts, from outputs that were measured there: where blocks are short, the noise of these would outweigh the
    /// error of the model, and a larger order would win because it averages over more of them.
    pub(super) fn search_blocks(&self, structure: Structure, blocks: usize) -> Vec<Segment<'_>> {
        let total: usize = self.records.iter().map(|(r, ..)| r.len()).sum();
        let length = total.div_ceil(blocks).max(1);
        let share = (SEARCH_SAMPLES as f64 / total as f64).min(1.0);
        let mut out = Vec::new();
        for (record, known, cells) in &self.records {
            let count = (record.len() as f64 / length as f64).round().max(1.0) as usize;
            for j in 0..count {
                let (from, to) = (record.len() * j / count, record.len() * (j + 1) / count);
                let to = from + (share * (to - from) as f64).ceil() as usize;
                let run_in = ((0.5 * share * length as f64) as usize).min(from);
                let block = Segment::usable(structure, record.y(), cells, (from - run_in).max(*known)..to);
                out.extend(block.and_then(|block| block.counted_from(from)));
            }
        }
        out
    }
}
