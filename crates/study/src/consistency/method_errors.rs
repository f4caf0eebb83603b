//! The errors of methods of others, replicate by replicate: for whoever compares two of them.

use super::error::StudyError;
use super::execute::Progress;
use super::foreign_noise_group::{self, ForeignNoiseGroup};
use super::replicate_errors::ReplicateErrors;
use crate::foreign::ForeignEstimator;
use crate::results::{Group, Series};
use crate::scenario::Scenario;
use rayon::prelude::*;
use std::sync::Arc;

/// What the replicates of a cell gave.
#[derive(Debug, Clone, PartialEq)]
pub struct CellErrors {
    /// The curve that the cell is a point of.
    pub series: Series,
    /// `N`.
    pub samples: usize,
    /// Names of the parameters, and with whom they are judged.
    pub parameters: Vec<(String, Group)>,
    /// By their numbers.
    pub replicates: Vec<ReplicateErrors>,
}

/// The first replicates of every cell of the methods of others: setting, number of samples, method. The methods of a setting are asked in turns, a few
/// replicates at a time.
///
/// # Errors
/// [`StudyError`] if an experiment does not exist for some cell.
pub fn method_errors(
    scenario: &Scenario,
    estimators: &[Arc<dyn ForeignEstimator>],
    replicates: u32,
    progress: &dyn Progress,
) -> Result<Vec<CellErrors>, StudyError> {
    let groups = foreign_noise_group::plan(scenario, estimators, (0, 0))?;
    progress.planned(u64::from(replicates) * groups.len() as u64);
    Ok(groups.iter().flat_map(|group| of_group(group, scenario.seed(), replicates, progress)).collect())
}

/// Replicates that are asked for at once.
const HANDFUL: u32 = 8;

fn of_group(
    group: &ForeignNoiseGroup,
    seed: u64,
    replicates: u32,
    progress: &dyn Progress,
) -> Vec<CellErrors> {
    let firsts: Vec<u32> = (0..replicates).step_by(HANDFUL as usize).collect();
    let handful = |&first: &u32| {
        let range = first..replicates.min(first.saturating_add(HANDFUL));
        let count = range.len() as u64;
        let errors = group.errors(seed, range);
        progress.advanced(count);
        errors
    };
    let handfuls: Vec<Vec<Vec<ReplicateErrors>>> = firsts.par_iter().map(handful).collect();
    let mut cells: Vec<CellErrors> = group
        .specs()
        .map(|spec| CellErrors {
            series: spec.series,
            samples: spec.samples,
            parameters: spec
                .parameters
                .into_iter()
                .map(|parameter| (parameter.name, parameter.group))
                .collect(),
            replicates: Vec::with_capacity(replicates as usize),
        })
        .collect();
    for handful in handfuls {
        cells.iter_mut().zip(handful).for_each(|(cell, errors)| cell.replicates.extend(errors));
    }
    cells
}
