//! The effects a rig can be made with: one file an effect, one or more laws a file.
//!
//! A file's first law is the plain one. Every law obeys the contract of [`Law`]: magnitude zero changes nothing.

mod backlash;
mod border_resolution;
mod border_wear;
mod coloured_noise;
mod creep;
mod envelope;
mod extra_pole;
mod foreign;
mod gain_drift;
mod gradual_transition;
mod input_delay;
mod input_noise;
mod motion;
mod outliers;
mod output_noise;
mod periodic_disturbance;
mod rate_dependence;
mod resonance;
mod sensor_drift;
mod sensor_nonlinearity;
mod sensor_quantisation;
mod sensor_saturation;
mod stribeck;

use crate::law::Law;

/// The identity card of a law: the five methods that hold constants.
macro_rules! card {
    ($effect:literal, $name:literal, $stage:ident, $unit:expr, $limit:literal) => {
        fn effect(&self) -> &'static str {
            $effect
        }
        fn name(&self) -> &'static str {
            $name
        }
        fn stage(&self) -> crate::law::Stage {
            crate::law::Stage::$stage
        }
        fn unit(&self) -> &'static str {
            $unit
        }
        fn limit(&self) -> f64 {
            $limit
        }
    };
}
pub(crate) use card;

/// The effects that a user can ask for by name and a diagnosis is expected to know.
pub const EFFECTS: [&str; 20] = [
    "input_delay",
    "input_noise",
    "backlash",
    "gradual_transition",
    "rate_dependence",
    "creep",
    "border_wear",
    "stribeck",
    "extra_pole",
    "resonance",
    "gain_drift",
    "coloured_noise",
    "output_noise",
    "outliers",
    "periodic_disturbance",
    "sensor_drift",
    "sensor_saturation",
    "sensor_quantisation",
    "sensor_nonlinearity",
    "border_resolution",
];

/// Effects that no library of causes is expected to know.
pub const FOREIGN: [&str; 9] = [
    "alternating_loops",
    "amplitude_damping",
    "dwell_sticking",
    "intermittent_contact",
    "loop_size_memory",
    "output_gated_gain",
    "proportional_noise",
    "switching_delay",
    "thermal_step",
];

/// The laws of an effect, the plain one first; empty for a name that is no effect.
pub fn laws_of(effect: &str) -> &'static [&'static dyn Law] {
    match effect {
        "input_delay" => &input_delay::LAWS,
        "input_noise" => &input_noise::LAWS,
        "backlash" => &backlash::LAWS,
        "gradual_transition" => &gradual_transition::LAWS,
        "rate_dependence" => &rate_dependence::LAWS,
        "creep" => &creep::LAWS,
        "border_wear" => &border_wear::LAWS,
        "stribeck" => &stribeck::LAWS,
        "extra_pole" => &extra_pole::LAWS,
        "resonance" => &resonance::LAWS,
        "gain_drift" => &gain_drift::LAWS,
        "coloured_noise" => &coloured_noise::LAWS,
        "output_noise" => &output_noise::LAWS,
        "outliers" => &outliers::LAWS,
        "periodic_disturbance" => &periodic_disturbance::LAWS,
        "sensor_drift" => &sensor_drift::LAWS,
        "sensor_saturation" => &sensor_saturation::LAWS,
        "sensor_quantisation" => &sensor_quantisation::LAWS,
        "sensor_nonlinearity" => &sensor_nonlinearity::LAWS,
        "border_resolution" => &border_resolution::LAWS,
        other => foreign::laws_of(other),
    }
}
