//! The parameters of an effect as it is told: those that were searched for, and those read off the data or the fit.

use crate::campaign::Campaign;
use crate::diagnosis::FittedParameter;
use crate::effect::Effect;
use crate::explain::Explanation;

/// The parameters of one effect of an explanation, given by its number, as fitted beside the others.
///
/// What a user would measure comes first: the step of a lattice, the limits of a sensor, the share of outliers and their size, the
/// time constant of a lag.
pub(super) fn parameters(
    campaign: &Campaign,
    explanation: &Explanation,
    number: usize,
) -> Vec<FittedParameter> {
    let own = explanation.own(number);
    let searched =
        own.clone().map(|(own, se)| FittedParameter { name: own.name, unit: own.unit, value: own.value, se });
    let effect = explanation.parts[number].effect;
    let lag = own.clone().find(|(own, _)| effect == Effect::ExtraPole && own.name == "pole");
    let time_constant = lag.and_then(|(pole, se)| time_constant(pole.value, se));
    time_constant.into_iter().chain(read_off(campaign, explanation, effect)).chain(searched).collect()
}

/// `ln τ` of a lag with the pole `p = exp(−1/τ)`, `τ` in samples; nothing where the pole is none of a lag.
fn time_constant(pole: f64, se: f64) -> Option<FittedParameter> {
    let rate = -pole.ln();
    let logarithm =
        || FittedParameter { name: "log_tau", unit: "ln samples", value: -rate.ln(), se: se / (pole * rate) };
    (pole > 0.0 && pole < 1.0).then(logarithm)
}

/// What is no own parameter of a law: nothing searches for it.
fn read_off(campaign: &Campaign, explanation: &Explanation, effect: Effect) -> Vec<FittedParameter> {
    let assembly = &explanation.fit.assembly;
    let known = |name, unit, value| FittedParameter { name, unit, value, se: f64::NAN };
    let level = |name, y: f64| known(name, "output units", campaign.y_mean + campaign.y_scale * y);
    match effect {
        Effect::SensorQuantisation => {
            let step =
                assembly.noise.lattice.map(|step| known("step", "output units", campaign.y_scale * step));
            step.into_iter().collect()
        }
        Effect::Outliers => {
            let told = |(share, ratio): (f64, f64)| {
                [known("share", "1", share), known("ratio", "sd of the other errors", ratio)]
            };
            assembly.noise.mixture.into_iter().flat_map(told).collect()
        }
        Effect::SensorSaturation => {
            let limits =
                assembly.saturation.iter().flat_map(|s| [("lower_limit", s.low), ("upper_limit", s.high)]);
            let knee = |sign: f64| if sign > 0.0 { "upper_knee" } else { "lower_knee" };
            let knees = assembly.curve.knees.iter().map(|k| (knee(k.sign), k.level));
            limits.chain(knees).filter(|(_, y)| y.is_finite()).map(|(name, y)| level(name, y)).collect()
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pole_is_a_time_constant() {
        let tau = |pole: f64| time_constant(pole, 0.0).map(|p| p.value.exp());
        assert!(tau((-0.1f64).exp()).is_some_and(|tau| (tau - 10.0).abs() < 1e-9));
        assert_eq!((tau(-0.3), tau(1.0)), (None, None));
    }

    #[test]
    fn its_error_is_the_slope_times_that_of_the_pole() {
        let at = |pole: f64| time_constant(pole, 1e-3).expect("a lag");
        let slope = (at(0.9 + 1e-6).value - at(0.9 - 1e-6).value) / 2e-6;
        assert!((at(0.9).se / 1e-3 / slope - 1.0).abs() < 1e-6);
    }
}
