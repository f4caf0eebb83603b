//! Effects that no library of causes is expected to know: a diagnosis should say "none of these".

mod alternating_loops;
mod amplitude_damping;
mod dwell_sticking;
mod intermittent_contact;
mod loop_size_memory;
mod output_gated_gain;
mod proportional_noise;
mod switching_delay;
mod thermal_step;

use crate::generate::law::Law;

/// The laws of a foreign effect; empty for a name that is none.
pub(super) fn laws_of(effect: &str) -> &'static [&'static dyn Law] {
    match effect {
        "alternating_loops" => &alternating_loops::LAWS,
        "amplitude_damping" => &amplitude_damping::LAWS,
        "dwell_sticking" => &dwell_sticking::LAWS,
        "intermittent_contact" => &intermittent_contact::LAWS,
        "loop_size_memory" => &loop_size_memory::LAWS,
        "output_gated_gain" => &output_gated_gain::LAWS,
        "proportional_noise" => &proportional_noise::LAWS,
        "switching_delay" => &switching_delay::LAWS,
        "thermal_step" => &thermal_step::LAWS,
        _ => &[],
    }
}
