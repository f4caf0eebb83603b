//! Effects that no library of causes is expected to know: a diagnosis should say "none of these".

mod alternating_loops;
mod amplitude_damping;
mod branch_lag;
mod clock_jitter;
mod deadband;
mod dwell_sticking;
mod gain_noise;
mod heating;
mod intermittent_contact;
mod loop_size_memory;
mod maximum_memory;
mod output_gated_gain;
mod play_background;
mod proportional_noise;
mod random_telegraph;
mod switching_delay;
mod thermal_step;
mod varying_delay;

use crate::generate::law::Law;

/// The laws of a foreign effect; empty for a name that is none.
pub(super) fn laws_of(effect: &str) -> &'static [&'static dyn Law] {
    match effect {
        "alternating_loops" => &alternating_loops::LAWS,
        "amplitude_damping" => &amplitude_damping::LAWS,
        "branch_lag" => &branch_lag::LAWS,
        "clock_jitter" => &clock_jitter::LAWS,
        "deadband" => &deadband::LAWS,
        "dwell_sticking" => &dwell_sticking::LAWS,
        "gain_noise" => &gain_noise::LAWS,
        "heating" => &heating::LAWS,
        "intermittent_contact" => &intermittent_contact::LAWS,
        "loop_size_memory" => &loop_size_memory::LAWS,
        "maximum_memory" => &maximum_memory::LAWS,
        "output_gated_gain" => &output_gated_gain::LAWS,
        "play_background" => &play_background::LAWS,
        "proportional_noise" => &proportional_noise::LAWS,
        "random_telegraph" => &random_telegraph::LAWS,
        "switching_delay" => &switching_delay::LAWS,
        "thermal_step" => &thermal_step::LAWS,
        "varying_delay" => &varying_delay::LAWS,
        _ => &[],
    }
}
