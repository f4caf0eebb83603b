//! The catalogue of effects a nominal model may lack, and the stages of the block diagram they sit in.

use std::fmt;

/// A stage of the block diagram `v → input → operator → dynamics → (disturbance) → sensor → y`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Stage {
    /// Between the recorded `v` and the operator.
    Input,
    /// The switched hysteresis itself.
    Operator,
    /// The linear part.
    Dynamics,
    /// What drives the output besides the input.
    Disturbance,
    /// Between the true output and the recorded `y`.
    Sensor,
}

impl Stage {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Operator => "operator",
            Self::Dynamics => "dynamics",
            Self::Disturbance => "disturbance",
            Self::Sensor => "sensor",
        }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// An effect that a nominal switched-hysteresis model lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Effect {
    /// The input acts later than recorded.
    InputDelay,
    /// The input that acts is the recorded one plus noise.
    InputNoise,
    /// Play between the recorded input and the operator.
    Backlash,
    /// The working point needs travel to pass from one border to the other.
    GradualTransition,
    /// The borders depend on the speed of the input.
    RateDependence,
    /// A slow after-effect of the operator's output.
    Creep,
    /// The loop between the borders narrows or widens as the rig works.
    BorderWear,
    /// Friction that falls as the speed rises from zero.
    Stribeck,
    /// A lag that the order of the model has no room for.
    ExtraPole,
    /// A lightly damped mode.
    Resonance,
    /// The gain of the linear part changes with time.
    GainDrift,
    /// The equation error is not white.
    ColouredNoise,
    /// White noise on the output besides the equation error.
    OutputNoise,
    /// Rare large errors.
    Outliers,
    /// A sinusoid of unknown frequency.
    PeriodicDisturbance,
    /// The sensor's zero moves.
    SensorDrift,
    /// The sensor clips.
    SensorSaturation,
    /// The sensor rounds.
    SensorQuantisation,
    /// The sensor's characteristic is curved.
    SensorNonlinearity,
    /// The borders have more detail than the grid they are tabulated on.
    BorderResolution,
}

impl Effect {
    /// Every effect, in the order of the block diagram.
    pub const ALL: [Self; 20] = [
        Self::InputDelay,
        Self::InputNoise,
        Self::Backlash,
        Self::GradualTransition,
        Self::RateDependence,
        Self::Creep,
        Self::BorderWear,
        Self::Stribeck,
        Self::ExtraPole,
        Self::Resonance,
        Self::GainDrift,
        Self::ColouredNoise,
        Self::OutputNoise,
        Self::Outliers,
        Self::PeriodicDisturbance,
        Self::SensorDrift,
        Self::SensorSaturation,
        Self::SensorQuantisation,
        Self::SensorNonlinearity,
        Self::BorderResolution,
    ];

    /// The name used in rig files and reports.
    ///
    /// ```
    /// # use switchback_gap::Effect;
    /// assert_eq!(Effect::GradualTransition.name(), "gradual_transition");
    /// assert!(Effect::ALL.iter().all(|e| Effect::from_name(e.name()) == Some(*e)));
    /// ```
    pub fn name(self) -> &'static str {
        match self {
            Self::InputDelay => "input_delay",
            Self::InputNoise => "input_noise",
            Self::Backlash => "backlash",
            Self::GradualTransition => "gradual_transition",
            Self::RateDependence => "rate_dependence",
            Self::Creep => "creep",
            Self::BorderWear => "border_wear",
            Self::Stribeck => "stribeck",
            Self::ExtraPole => "extra_pole",
            Self::Resonance => "resonance",
            Self::GainDrift => "gain_drift",
            Self::ColouredNoise => "coloured_noise",
            Self::OutputNoise => "output_noise",
            Self::Outliers => "outliers",
            Self::PeriodicDisturbance => "periodic_disturbance",
            Self::SensorDrift => "sensor_drift",
            Self::SensorSaturation => "sensor_saturation",
            Self::SensorQuantisation => "sensor_quantisation",
            Self::SensorNonlinearity => "sensor_nonlinearity",
            Self::BorderResolution => "border_resolution",
        }
    }

    /// The effect of that name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|e| e.name() == name)
    }

    /// Where in the block diagram the effect sits.
    pub fn stage(self) -> Stage {
        match self {
            Self::InputDelay | Self::InputNoise => Stage::Input,
            Self::Backlash
            | Self::GradualTransition
            | Self::RateDependence
            | Self::Creep
            | Self::BorderWear
            | Self::Stribeck
            | Self::BorderResolution => Stage::Operator,
            Self::ExtraPole | Self::Resonance | Self::GainDrift => Stage::Dynamics,
            Self::ColouredNoise | Self::OutputNoise | Self::Outliers | Self::PeriodicDisturbance => {
                Stage::Disturbance
            }
            Self::SensorDrift
            | Self::SensorSaturation
            | Self::SensorQuantisation
            | Self::SensorNonlinearity => Stage::Sensor,
        }
    }

    /// The effects that leave nearly the same trace in ordinary records.
    pub fn twins(self) -> &'static [Self] {
        match self {
            Self::InputDelay => &[Self::ExtraPole, Self::Resonance],
            Self::InputNoise => &[Self::Outliers, Self::ColouredNoise],
            Self::Backlash => &[Self::GradualTransition],
            Self::GradualTransition => &[Self::Backlash],
            Self::RateDependence => &[Self::Stribeck, Self::Creep],
            Self::Creep => &[Self::RateDependence, Self::ExtraPole],
            Self::BorderWear => &[Self::GainDrift],
            Self::Stribeck => &[Self::RateDependence],
            Self::ExtraPole => &[Self::InputDelay, Self::Resonance],
            Self::Resonance => &[Self::ExtraPole, Self::InputDelay],
            Self::GainDrift => &[Self::BorderWear],
            Self::ColouredNoise => &[Self::OutputNoise, Self::InputNoise],
            Self::OutputNoise => &[Self::ColouredNoise],
            Self::Outliers => &[Self::InputNoise],
            Self::SensorSaturation => &[Self::SensorNonlinearity],
            Self::SensorNonlinearity => &[Self::SensorSaturation],
            Self::PeriodicDisturbance
            | Self::SensorDrift
            | Self::SensorQuantisation
            | Self::BorderResolution => &[],
        }
    }

    /// Whether the effect's laws are supple enough to imitate others.
    pub(crate) fn is_supple(self) -> bool {
        matches!(
            self,
            Self::ColouredNoise
                | Self::GainDrift
                | Self::Resonance
                | Self::SensorDrift
                | Self::SensorNonlinearity
                | Self::BorderResolution
        )
    }

    /// Whether the effect follows a clock or has a phase of its own in every record, so that what was fitted need not hold
    /// in other records.
    pub(crate) fn is_of_its_record(self) -> bool {
        matches!(self, Self::BorderWear | Self::GainDrift | Self::SensorDrift | Self::PeriodicDisturbance)
    }

    /// Whether the effect changes only what is random, so that it moves no simulation error.
    pub fn is_noise(self) -> bool {
        matches!(self, Self::InputNoise | Self::ColouredNoise | Self::OutputNoise | Self::Outliers)
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
