//! Parameters of effects in the user's units.

use super::Units;
use std::f64::consts::TAU;
use switchback_diagnose::FittedParameter;

/// Width of an interval from which a logarithm counts as undetermined.
const VAGUE: f64 = 10.0;

/// A fitted parameter as its user would state it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reported {
    /// Its name, logarithms undone.
    pub name: String,
    /// The estimate.
    pub value: f64,
    /// Its 90 % interval; NaN where the likelihood gives none.
    pub ci90: [f64; 2],
    /// Its unit; empty for a pure number.
    pub unit: String,
}

/// Turns shares of the stroke into input units, samples' logarithms into seconds, angles into frequencies.
///
/// Logarithmic parameters have intervals that are symmetric before they are undone.
pub fn reported(parameter: &FittedParameter, units: &Units) -> Reported {
    // A logarithm known no better than to a few units is not known.
    let logarithm = parameter.unit.starts_with("ln ");
    let [low, high] = match parameter.ci90 {
        [low, high] if logarithm && high - low > VAGUE => [f64::NAN; 2],
        ends => ends,
    };
    let ends = [low, parameter.value, high];
    let name = parameter.name;
    let scaled = |factor: f64, unit: String| (name.to_owned(), ends.map(|x| factor * x), unit);
    let (name, [low, value, high], unit) = match parameter.unit {
        "1" | "count" => scaled(1.0, String::new()),
        "strokes" => scaled(units.stroke, units.input.clone()),
        "strokes per sample" => scaled(units.stroke / units.sample_time, format!("{}/s", units.input)),
        "radians per sample" => {
            let frequency = 1.0 / (TAU * units.sample_time);
            ("frequency".to_owned(), ends.map(|x| x * frequency), "Hz".to_owned())
        }
        "ln samples" => {
            ("time_constant".to_owned(), ends.map(|x| x.exp() * units.sample_time), "s".to_owned())
        }
        "ln strokes" => (name.replace("log_", ""), ends.map(|x| x.exp() * units.stroke), units.input.clone()),
        "ln inverse variance" => {
            ("noise_sd".to_owned(), ends.map(|x| (-0.5 * x).exp()), "sd of y".to_owned())
        }
        "ln variance ratio" => (
            name.replace("log_ratio", "noise_ratio"),
            ends.map(|x| (0.5 * x).exp()),
            "sd of the equation error".to_owned(),
        ),
        "output units" => scaled(1.0, units.output.clone()),
        "per standard deviation of y" => scaled(1.0, "per sd of y".to_owned()),
        other => scaled(1.0, other.to_owned()),
    };
    Reported { name, value, ci90: [low, high], unit }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units() -> Units {
        Units { input: "V".into(), output: "um".into(), sample_time: 0.01, stroke: 20.0 }
    }

    fn fitted(name: &'static str, unit: &'static str, value: f64) -> FittedParameter {
        FittedParameter { name, unit, value, ci90: [0.9 * value, 1.1 * value] }
    }

    #[test]
    fn lengths_are_reported_in_input_units() {
        let play = reported(&fitted("play", "strokes", 0.1), &units());
        assert_eq!((play.name.as_str(), play.value, play.unit.as_str()), ("play", 2.0, "V"));
        assert!((play.ci90[1] - play.value - 0.2).abs() < 1e-12);
    }

    #[test]
    fn logarithms_are_undone() {
        let tau = reported(&fitted("log_tau", "ln samples", 100f64.ln()), &units());
        assert_eq!((tau.name.as_str(), tau.unit.as_str()), ("time_constant", "s"));
        assert!((tau.value - 1.0).abs() < 1e-12);
        assert!((tau.value / tau.ci90[0] - tau.ci90[1] / tau.value).abs() < 1e-9);
        let moving = reported(&fitted("log_ratio_moving", "ln variance ratio", 0.0), &units());
        assert_eq!((moving.name.as_str(), moving.value), ("noise_ratio_moving", 1.0));
    }

    #[test]
    fn angles_become_frequencies() {
        let omega = reported(&fitted("omega", "radians per sample", TAU / 10.0), &units());
        assert!((omega.value - 10.0).abs() < 1e-12 && omega.unit == "Hz");
    }
}
