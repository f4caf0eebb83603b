//! The parameters of an effect as it is told: those that were searched for, and those read off the data or the fit.

use crate::attribution::explain::Explanation;
use crate::effects::Reading;
use crate::fitted_parameter::FittedParameter;
use crate::records::campaign::Campaign;

/// The parameters of one effect of an explanation, given by its number, as fitted beside the others; `intervals` are those of all nonlinear
/// parameters of the explanation.
///
/// What a user would measure comes first: the step of a quantisation grid, the limits of a sensor, the share of outliers and their size, the
/// time constant of a lag.
pub(super) fn parameters(
    campaign: &Campaign,
    (explanation, number): (&Explanation, usize),
    intervals: &[[f64; 2]],
) -> Vec<FittedParameter> {
    let card = explanation.parts[number].effect.card();
    let told = |name: &'static str| -> &'static str {
        card.renamed.iter().find(|renamed| renamed.0 == name).map_or(name, |renamed| renamed.1)
    };
    let nonlinear = explanation.nonlinear_of(number);
    let searched = explanation.fit.nonlinear[nonlinear.clone()].iter().zip(&intervals[nonlinear]);
    let searched: Vec<FittedParameter> = searched
        .map(|(o, ci90)| FittedParameter { name: told(o.name), unit: o.unit, value: o.value, ci90: *ci90 })
        .collect();
    let first = (card.told_first)(&Reading { campaign, fit: &explanation.fit, searched: &searched });
    first.into_iter().chain(searched).collect()
}
