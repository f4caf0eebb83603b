//! What two sources can differ in.

/// What two sources differ in: a line of the table of differences.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Row {
    /// Nothing.
    Nothing,
    /// The sign of the gain.
    Sign,
    /// The stationary gain, output units per unit of the curves.
    Gain,
    /// A constant of the output, output units.
    Offset,
    /// Delay beyond the first sample, samples.
    Delay,
    /// The time constant of the same lag on both sides, the slowest on one of them, seconds.
    TimeConstant,
    /// Damping of the oscillation.
    Damping,
    /// Undamped frequency of the oscillation, radians a second.
    Frequency,
    /// Half the loop's mean width, output units.
    Friction,
    /// Mean slope of the middle between the borders, output units per input unit.
    Stiffness,
    /// How far the middle bends away from its line, output units.
    Curvature,
    /// Order of the linear part.
    Order,
    /// Standard deviation of the noise, output units.
    Noise,
    /// An effect of one side, or of both at different sizes.
    Effect,
}

impl Row {
    /// All rows.
    pub const ALL: [Self; 14] = [
        Self::Nothing,
        Self::Sign,
        Self::Gain,
        Self::Offset,
        Self::Delay,
        Self::TimeConstant,
        Self::Damping,
        Self::Frequency,
        Self::Friction,
        Self::Stiffness,
        Self::Curvature,
        Self::Order,
        Self::Noise,
        Self::Effect,
    ];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::Sign => "sign",
            Self::Gain => "gain",
            Self::Offset => "offset",
            Self::Delay => "delay",
            Self::TimeConstant => "time_constant",
            Self::Damping => "damping",
            Self::Frequency => "frequency",
            Self::Friction => "friction",
            Self::Stiffness => "stiffness",
            Self::Curvature => "curvature",
            Self::Order => "order",
            Self::Noise => "noise",
            Self::Effect => "effect",
        }
    }
}
