//! What tables and verdicts need to know of a cell, whatever ran its replicates.

use super::controls::ControlPlan;
use super::sections::CellSums;
use crate::results::{Group, Series};
use switchback_identify::statistics::KnownControl;
use switchback_noise::NoisePlan;

/// One cell of a sweep: a curve at one number of samples.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CellSpec {
    pub(super) series: Series,
    /// `N`.
    pub(super) samples: usize,
    pub(super) parameters: Vec<ParameterName>,
    /// One a parameter.
    pub(super) truth: Vec<f64>,
}

/// What theory says of a cell, one entry a parameter; nothing where the method's model does not hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct CellTheory {
    /// Standard deviations at `N`.
    pub(super) sd: Option<Vec<f64>>,
    /// Biases at `N`, to second order in the noise; nothing where that is not worked out.
    pub(super) bias: Option<Vec<f64>>,
    /// The Cramér–Rao bound at `N`, as standard deviations.
    pub(super) bound: Option<Vec<f64>>,
    /// The mean of the control variate, where it is not zero.
    pub(super) control: Option<Vec<f64>>,
    /// The chance that the first-order part of an error lies within 1.96 of its standard deviations.
    pub(super) coverage: Option<Vec<f64>>,
    /// Of a method of others: the controls, and the noise that they are sums of.
    pub(super) controls: Option<(ControlPlan, NoisePlan)>,
}

impl CellTheory {
    /// What is known of the control variate of a parameter.
    pub(super) fn known(&self, k: usize) -> KnownControl {
        let at = |values: &Option<Vec<f64>>| values.as_ref().map(|values| values[k]);
        KnownControl {
            mean: at(&self.control).unwrap_or(0.0),
            first_order_variance: at(&self.sd).map(|sd| sd * sd),
            first_order_coverage: at(&self.coverage),
        }
    }
}

/// What a parameter is called, and with whom it is judged.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ParameterName {
    pub(super) name: String,
    pub(super) group: Group,
    pub(super) v: Option<f64>,
}

/// The cells of a workload, an entry a cell in both.
#[derive(Debug)]
pub(super) struct ActiveCells<'a> {
    pub(super) active: &'a [bool],
    pub(super) sums: &'a mut [CellSums],
}

impl ParameterName {
    /// The names of `a₁…aₙ`, `b₁…bₙ` and of the points of the given borders, in this order.
    pub(super) fn all(order: usize, borders: &[(Group, &[f64])]) -> Vec<Self> {
        let coefficients = |letter: char, group| {
            (1..=order).map(move |i| Self { name: format!("{letter}{i}"), group, v: None })
        };
        let points = borders.iter().flat_map(|&(group, positions)| {
            let label = if group == Group::Descending { "desc" } else { "asc" };
            positions.iter().enumerate().map(move |(j, &v)| Self {
                name: format!("F_{label}(V{})", j + 1),
                group,
                v: Some(v),
            })
        });
        coefficients('a', Group::A).chain(coefficients('b', Group::B)).chain(points).collect()
    }
}
