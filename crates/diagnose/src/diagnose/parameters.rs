//! The parameters of an effect as it is reported: those that were searched for, and those read off the data or the fit.

use crate::attribution::explain::Hypothesis;
use crate::effects::Reading;
use crate::fitted_parameter::FittedParameter;
use crate::records::dataset::Dataset;

/// The parameters of one effect of a candidate, given by its number, as fitted beside the others; `intervals` are those of all nonlinear
/// parameters of the candidate.
///
/// What a user would measure comes first: the step of a quantisation grid, the limits of a sensor, the share of outliers and their size, the
/// time constant of a lag.
pub(super) fn parameters(
    dataset: &Dataset,
    (hypothesis, number): (&Hypothesis, usize),
    intervals: &[[f64; 2]],
) -> Vec<FittedParameter> {
    let card = hypothesis.effect_terms[number].effect.card();
    let reported = |name: &'static str| -> &'static str {
        card.renamed.iter().find(|renamed| renamed.0 == name).map_or(name, |renamed| renamed.1)
    };
    let nonlinear = hypothesis.nonlinear_of(number);
    let searched = hypothesis.fit.nonlinear[nonlinear.clone()].iter().zip(&intervals[nonlinear]);
    let searched: Vec<FittedParameter> = searched
        .map(|(o, ci90)| FittedParameter {
            name: reported(o.name),
            unit: o.unit,
            value: o.value,
            ci90: *ci90,
        })
        .collect();
    let first = (card.reported_first)(&Reading { dataset, fit: &hypothesis.fit, searched: &searched });
    first.into_iter().chain(searched).collect()
}
