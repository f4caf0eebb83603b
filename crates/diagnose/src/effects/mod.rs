//! The library of effects: one file an effect, which holds its card ([`Card`]) with everything that the diagnosis knows about it, its laws,
//! what it leaves in the data and what it is confused with.
//!
//! An effect is a handful of [`Variant`]s: laws that physics offers for the same cause, each a function from nonlinear
//! parameters to changes of an [`AugmentedModel`](crate::model::augmented::AugmentedModel). The same augmented model is fitted
//! ([`crate::likelihood::engine`]) and simulated ([`crate::simulation::simulate`]), and effects compose by being applied one after the
//! other.

mod card;
mod law;
mod speed;

use card::known;
pub(crate) use card::{Card, Follows, Reading, Room};
pub(crate) use law::{Apply, Naming, Scene, Search, Sound, Variant};

use crate::likelihood::engine::{Fit, NonlinearParameter};
use crate::records::dataset::Dataset;

/// Declares the effects: of each its key, its file, which is its name as well, and what it changes.
macro_rules! catalogue {
    ($($effect:ident in $file:ident: $changes:literal,)*) => {
        $(mod $file;)*

        /// An effect that a nominal switched-hysteresis model lacks.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Effect {
            $(#[doc = $changes] $effect,)*
        }

        impl Effect {
            /// Every effect, in the order of the catalogue.
            pub const ALL: [Self; [$(stringify!($effect)),*].len()] = [$(Self::$effect),*];

            /// The name used in rig files and reports.
            ///
            /// ```
            /// # use switchback_diagnose::Effect;
            /// assert_eq!(Effect::GradualTransition.name(), "gradual_transition");
            /// assert!(Effect::ALL.iter().all(|e| Effect::from_name(e.name()) == Some(*e)));
            /// ```
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$effect => stringify!($file),)*
                }
            }

            /// What its file says of it.
            pub(crate) fn card(self) -> &'static Card {
                match self {
                    $(Self::$effect => &$file::CARD,)*
                }
            }
        }

        /// What each effect changes by the catalogue, and its file.
        #[cfg(test)]
        const TITLES: [(&str, &str); Effect::ALL.len()] =
            [$(($changes, include_str!(concat!(stringify!($file), ".rs")))),*];
    };
}

// An effect is one line here and one file beside this one. `cargo fmt` does not look into these files: see CONTRIBUTING.md.
catalogue! {
    InputDelay in input_delay: "The input acts later than recorded.",
    InputNoise in input_noise: "The input that acts is the recorded one plus noise.",
    Backlash in backlash: "Play between the recorded input and the operator.",
    GradualTransition in gradual_transition: "The working point needs travel to pass from one border to the other.",
    RateDependence in rate_dependence: "The borders depend on the speed of the input.",
    Creep in creep: "A slow after-effect of the operator's output.",
    BorderWear in border_wear: "The loop between the borders narrows or widens as the rig works.",
    Stribeck in stribeck: "Friction that falls as the speed rises from zero.",
    ExtraPole in extra_pole: "A lag that the order of the model has no room for.",
    Resonance in resonance: "A lightly damped mode.",
    GainDrift in gain_drift: "The gain of the linear part changes with time.",
    ColouredNoise in coloured_noise: "The equation error is not white.",
    OutputNoise in output_noise: "White noise on the output besides the equation error.",
    Outliers in outliers: "Rare large errors.",
    PeriodicDisturbance in periodic_disturbance: "A sinusoid of unknown frequency.",
    SensorDrift in sensor_drift: "The sensor's zero moves.",
    SensorSaturation in sensor_saturation: "The sensor clips.",
    SensorQuantisation in sensor_quantisation: "The sensor rounds.",
    SensorNonlinearity in sensor_nonlinearity: "The sensor's characteristic is curved.",
    BorderResolution in border_resolution: "The borders have more detail than the grid they are tabulated on.",
    RecordOffset in record_offset: "The sensor's zero differs from record to record.",
    StepChange in step_change: "The gain or the distance of the borders changes at one instant.",
}

pub(crate) use border_resolution::refinement;

/// Whether a pole of `A` dies away in no record: it follows a drift, and a lag has taken its place.
fn outlasts_the_records(fit: &Fit) -> bool {
    let longest = fit.longest_record() as f64;
    fit.linear.poles().into_iter().any(|pole| pole.norm() > (-1.0 / longest.max(1.0)).exp())
}

/// Typical speed of the free records, strokes per sample: the median of the moves.
fn typical_speed(dataset: &Dataset) -> f64 {
    let mut speeds: Vec<f64> = dataset
        .fit()
        .filter(|t| !t.is_pulsed())
        .flat_map(|t| t.v.windows(2).map(|w| (w[1] - w[0]).abs()))
        .filter(|s| *s > 0.0)
        .collect();
    if speeds.is_empty() {
        return 0.1;
    }
    let middle = speeds.len() / 2;
    *speeds.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Numbers of the records that are fitted.
fn fitted_scaled_records(dataset: &Dataset) -> Vec<usize> {
    dataset.scaled_records.iter().enumerate().filter(|(_, t)| t.is_fit()).map(|(i, _)| i).collect()
}

/// A parameter with its bounds; the derivative step is a thousandth of the range unless given.
fn parameter(
    name: &'static str,
    unit: &'static str,
    value: f64,
    bounds: (f64, f64),
    step: f64,
) -> NonlinearParameter {
    NonlinearParameter { name, unit, value, low: bounds.0, high: bounds.1, step }
}

#[cfg(test)]
mod tests;
