//! The parameters of an effect as it is told: those that were searched for, and those read off the data or the fit.

use crate::attribution::explain::Explanation;
use crate::diagnosis::FittedParameter;
use crate::effect::Effect;
use crate::records::campaign::Campaign;

/// The parameters of one effect of an explanation, given by its number, as fitted beside the others; `intervals` are those of all own
/// parameters of the explanation.
///
/// What a user would measure comes first: the step of a lattice, the limits of a sensor, the share of outliers and their size, the
/// time constant of a lag.
pub(super) fn parameters(
    campaign: &Campaign,
    (explanation, number): (&Explanation, usize),
    intervals: &[[f64; 2]],
) -> Vec<FittedParameter> {
    let effect = explanation.parts[number].effect;
    let own = explanation.own_of(number);
    let searched = explanation.fit.own[own.clone()].iter().zip(&intervals[own]);
    let name = |name: &'static str| match (effect, name) {
        // A law of falling friction that fitted one that rises.
        (Effect::RateDependence, "stribeck_speed") => "speed_scale",
        (_, name) => name,
    };
    let searched = searched.map(|(o, ci90)| FittedParameter {
        name: name(o.name),
        unit: o.unit,
        value: o.value,
        ci90: *ci90,
    });
    let lag = searched.clone().find(|own| effect == Effect::ExtraPole && own.name == "pole");
    let told_first = lag.as_ref().and_then(time_constant).into_iter();
    told_first.chain(read_off(campaign, explanation, effect)).chain(searched).collect()
}

/// `ln τ` of a lag with the pole `p = exp(−1/τ)`, `τ` in samples; nothing where the pole is none of a lag.
fn time_constant(pole: &FittedParameter) -> Option<FittedParameter> {
    let logarithm = |p: f64| -(-p.ln()).ln();
    let is_of_a_lag = pole.value > 0.0 && pole.value < 1.0;
    is_of_a_lag.then(|| FittedParameter {
        name: "log_tau",
        unit: "ln samples",
        value: logarithm(pole.value),
        ci90: pole.ci90.map(logarithm),
    })
}

/// What is no own parameter of a law: nothing searches for it.
fn read_off(campaign: &Campaign, explanation: &Explanation, effect: Effect) -> Vec<FittedParameter> {
    let assembly = &explanation.fit.assembly;
    let known = |name, unit, value| FittedParameter { name, unit, value, ci90: [f64::NAN; 2] };
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
        let pole = |value: f64, half: f64| FittedParameter {
            name: "pole",
            unit: "1",
            value,
            ci90: [value - half, value + half],
        };
        let of = |tau: f64| (-1.0 / tau).exp();
        let tau = time_constant(&pole(of(10.0), 0.005)).expect("a lag");
        assert!((tau.value.exp() - 10.0).abs() < 1e-9);
        let ends = tau.ci90.map(|end| of(end.exp()) - of(10.0));
        assert!((ends[0] + 0.005).abs() < 1e-9 && (ends[1] - 0.005).abs() < 1e-9, "{ends:?}");
        assert!(time_constant(&pole(-0.3, 0.1)).is_none() && time_constant(&pole(1.0, 0.1)).is_none());
        // An interval that reaches a pole that forgets nothing ends nowhere.
        assert!(time_constant(&pole(0.999, 0.01)).is_some_and(|tau| tau.ci90[1].is_nan()));
    }
}
