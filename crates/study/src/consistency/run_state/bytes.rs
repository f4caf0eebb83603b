//! A [`RunState`] as a file: a line of JSON that shows what it is of and how it is laid out, then the sums as little-endian numbers of 64 bits, counts of 32,
//! then the SHA-256 of all before.

use super::{Round, RunState, Snapshot};
use crate::Shard;
use crate::consistency::sections::{CellShape, CellSums, ForeignSums, Runs};
use crate::consistency::tally::{Node, Tally};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::ops::Range;
use switchback_identify::statistics::{IntervalCounts, LaneSums};
use thiserror::Error;

/// What such a file begins with.
const BEGINNING: &[u8] = b"{\"schema\":\"switchback/sums/3\",";

/// What shows the sums of one study from those of another, or of other sources on another platform: they are never mixed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// SHA-256 of what the replicates are of: the scenario without their number.
    pub scenario: String,
    /// Which part of the replicates; nothing for all of them.
    pub part: String,
    /// SHA-256 of the sources of the study.
    pub program: String,
    /// Processor, system and mathematical library.
    pub platform: String,
}

#[derive(Serialize, Deserialize)]
struct Head {
    schema: String,
    origin: Origin,
    /// Replicates of a batch.
    batch: usize,
    /// Replicates of the round running.
    round: Range<usize>,
    /// By cell: whether it takes part in the round.
    active: Vec<bool>,
    /// By cell: its parameters.
    shape: Vec<usize>,
    /// By cell: linear and quadratic controls, and whether replicates have partners; nothing without methods of others.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    controls: Vec<Option<(usize, usize, bool)>>,
    /// Versions of the methods of others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    versions: Option<Vec<String>>,
    nodes: Vec<NodeHead>,
}

#[derive(Serialize, Deserialize)]
struct NodeHead {
    replicates: Range<usize>,
    /// By cell.
    runs: Vec<Runs>,
}

const HASH: usize = 32;

impl Snapshot<'_> {
    /// The file.
    pub fn to_bytes(&self, origin: &Origin) -> Vec<u8> {
        let Self { round, tally, .. } = self;
        let head = |node: &Node| NodeHead {
            replicates: node.range.clone(),
            runs: node.cells.iter().map(|cell| cell.runs.clone()).collect(),
        };
        let head = Head {
            schema: "switchback/sums/3".to_owned(),
            origin: origin.clone(),
            batch: tally.batches().size(),
            round: round.replicates.clone(),
            active: round.active.clone(),
            shape: tally.shape().iter().map(|shape| shape.parameters).collect(),
            controls: controls(tally.shape()),
            versions: self.versions.map(<[String]>::to_vec).filter(|versions| !versions.is_empty()),
            nodes: tally.nodes().iter().map(head).collect(),
        };
        let mut bytes = serde_json::to_vec(&head).expect("names and numbers are JSON");
        bytes.push(b'\n');
        for cell in tally.nodes().iter().flat_map(|node| &node.cells) {
            cell.halves().iter().for_each(|half| half.write(&mut bytes));
            let counts = cell.intervals().iter().flat_map(|counts| counts.below.iter().chain(&counts.above));
            bytes.extend(counts.flat_map(|count| count.to_le_bytes()));
            cell.foreign().into_iter().for_each(|foreign| foreign.write(&mut bytes));
        }
        let hash = Sha256::digest(&bytes);
        bytes.extend_from_slice(&hash);
        bytes
    }
}

/// Why a file gives no standing of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Unusable {
    /// It is no such file.
    #[error("holds something else")]
    Foreign,
    /// It was cut or changed.
    #[error("is not as it was written")]
    Damaged,
    /// It is of another scenario, or another part of it.
    #[error("is of another scenario, or another part of it")]
    OtherScenario,
    /// Other sources made it, or these on another platform.
    #[error("was made by another version of the program, or on another platform")]
    OtherProgram,
    /// A method of others had another version.
    #[error("is of another version of a method that the scenario names")]
    OtherMethod,
    /// It has more replicates than the scenario asks for.
    #[error("has more replicates than are asked for")]
    TooMany,
}

impl Origin {
    /// The origin of a part of the round that a study stands at; of the whole study where no part is named.
    #[must_use]
    pub fn of_part(&self, shard: Option<Shard>, run_state: &RunState) -> Self {
        let Range { start, end } = run_state.round.replicates;
        let part = shard.map(|shard| format!("{shard} of replicates {start} to {end}"));
        Self { part: part.unwrap_or_default(), ..self.clone() }
    }
}

impl RunState {
    /// Reads a file into this standing, which is one of the same study before its first replicate.
    ///
    /// # Errors
    /// [`Unusable`] if the file is of another origin, or not as it was written.
    pub fn read(self, bytes: &[u8], origin: &Origin) -> Result<Self, Unusable> {
        let (head, mut sums) = parts(bytes)?;
        if (&head.origin.scenario, &head.origin.part) != (&origin.scenario, &origin.part) {
            return Err(Unusable::OtherScenario);
        }
        let tally = self.tally;
        let is_alike = head.shape.iter().copied().eq(tally.shape().iter().map(|shape| shape.parameters))
            && head.controls == controls(tally.shape());
        if head.origin != *origin || head.batch != tally.batches().size() || !is_alike {
            return Err(Unusable::OtherProgram);
        }
        let versions = head.versions.or_else(|| head.controls.is_empty().then(Vec::new));
        if self.versions.as_ref().zip(versions.as_ref()).is_some_and(|(own, found)| own != found) {
            return Err(Unusable::OtherMethod);
        }
        let mut filled = Tally::new(tally.batches(), tally.shape().to_vec());
        for NodeHead { replicates, runs } in head.nodes {
            let cell = |(runs, &CellShape { parameters, controls }): (Runs, &CellShape)| {
                let mut half = || LaneSums::read(parameters, &mut sums);
                let halves = [half()?, half()?];
                let intervals = (0..parameters).map(|_| counts(&mut sums)).collect::<Option<_>>()?;
                let foreign = match controls {
                    None => None,
                    Some(shape) => Some(ForeignSums::read(shape, &mut sums)?),
                };
                Some(CellSums::of(halves, intervals, foreign, runs))
            };
            let cells: Option<Vec<CellSums>> = runs.into_iter().zip(tally.shape()).map(cell).collect();
            filled.add(Node { range: replicates, cells: cells.ok_or(Unusable::Damaged)? });
        }
        let mut round = Round { replicates: head.round, active: head.active };
        let asked = self.round.replicates.end;
        // Without a precision to reach, a round may end elsewhere than was thought.
        if !self.in_rounds {
            if filled.end(0) > asked {
                return Err(Unusable::TooMany);
            }
            round.replicates.end = asked;
        }
        Ok(Self { round, tally: filled, in_rounds: self.in_rounds, versions: self.versions.or(versions) })
    }
}

/// The controls of cells as they are written; nothing where no cell has any.
fn controls(shape: &[CellShape]) -> Vec<Option<(usize, usize, bool)>> {
    let written = |shape: &CellShape| shape.controls.map(|c| (c.linear, c.quadratic, c.is_paired));
    if shape.iter().all(|shape| shape.controls.is_none()) {
        Vec::new()
    } else {
        shape.iter().map(written).collect()
    }
}

/// Where the truth lies in the intervals of a parameter, from the beginning of `bytes`; `None` where there is too little.
fn counts(bytes: &mut &[u8]) -> Option<IntervalCounts> {
    let mut counts = IntervalCounts::default();
    for count in counts.below.iter_mut().chain(&mut counts.above) {
        let (own, rest) = bytes.split_first_chunk()?;
        (*count, *bytes) = (u32::from_le_bytes(*own), rest);
    }
    Some(counts)
}

/// The head of a file, and its sums, if it is as it was written.
fn parts(bytes: &[u8]) -> Result<(Head, &[u8]), Unusable> {
    if !bytes.starts_with(BEGINNING) {
        return Err(Unusable::Foreign);
    }
    let whole = || {
        let (written, hash) = bytes.split_at_checked(bytes.len().checked_sub(HASH)?)?;
        let end = written.iter().position(|byte| *byte == b'\n')?;
        let is_whole = Sha256::digest(written).as_slice() == hash;
        is_whole.then_some((serde_json::from_slice(&written[..end]).ok()?, &written[end + 1..]))
    };
    whole().ok_or(Unusable::Damaged)
}
