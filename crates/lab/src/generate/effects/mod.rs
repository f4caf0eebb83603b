//! The effects a rig can be made with: one file an effect, one or more laws a file.
//!
//! A file's first law is the plain one. Every law obeys the contract of [`Law`]: magnitude zero changes nothing.

mod envelope;
mod foreign;
mod identity;
mod inertia;
pub(crate) mod motion;
mod position_ripple;
mod slack;

pub(crate) use identity::card;

use crate::generate::law::Law;

/// Declares the effects that a diagnosis is expected to know: of each its file, which is its name as well.
macro_rules! catalogue {
    ($($effect:ident,)*) => {
        $(mod $effect;)*

        /// The effects that a user can ask for by name and a diagnosis is expected to know.
        pub const EFFECTS: [&str; [$(stringify!($effect)),*].len()] = [$(stringify!($effect)),*];

        /// The laws of an effect, the plain one first; empty for a name that is no effect.
        pub fn laws_of(effect: &str) -> &'static [&'static dyn Law] {
            $(if effect == stringify!($effect) {
                return &$effect::LAWS;
            })*
            match effect {
                "inertia" => &inertia::LAWS,
                "position_ripple" => &position_ripple::LAWS,
                "slack" => &slack::LAWS,
                _ => foreign::laws_of(effect),
            }
        }
    };
}

// An effect is one line here and one file beside this one. `cargo fmt` does not look into these files: see CONTRIBUTING.md.
catalogue! {
    input_delay,
    input_noise,
    backlash,
    gradual_transition,
    rate_dependence,
    creep,
    border_wear,
    stribeck,
    extra_pole,
    resonance,
    gain_drift,
    coloured_noise,
    output_noise,
    outliers,
    periodic_disturbance,
    sensor_drift,
    sensor_saturation,
    sensor_quantisation,
    sensor_nonlinearity,
    border_resolution,
    record_offset,
    step_change,
}

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

/// Effects with a name of their own that no diagnosis knows yet.
pub const UNNAMED: [&str; 3] = ["inertia", "position_ripple", "slack"];

/// Further effects that no library of causes is expected to know. Examinations draw from [`FOREIGN`] by position, so that these stand apart.
pub const FURTHER_FOREIGN: [&str; 9] = [
    "branch_lag",
    "clock_jitter",
    "deadband",
    "gain_noise",
    "heating",
    "maximum_memory",
    "play_background",
    "random_telegraph",
    "varying_delay",
];

/// Laws of an effect beyond [`laws_of`], from which examinations draw by position.
pub(crate) fn further_laws_of(effect: &str) -> &'static [&'static dyn Law] {
    match effect {
        "input_delay" => &input_delay::FURTHER_LAWS,
        "output_noise" => &output_noise::FURTHER_LAWS,
        _ => &[],
    }
}
