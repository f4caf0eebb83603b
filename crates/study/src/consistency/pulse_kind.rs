//! The methods for pulse experiments, and what each looks at.

use switchback_identify::Method;
use switchback_identify::pulse::{PulseData, PulseMethod, StepMean};

/// A method for pulse experiments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PulseKind {
    PaperDescendant,
    PaperAscendant,
    Joint,
    Efficient,
    Instrumental,
    LinearArx,
    Memoryless,
}

impl PulseKind {
    /// The pulse method of that name; `free` is none.
    pub(super) fn of(method: Method) -> Option<Self> {
        match method {
            Method::PaperDescendant => Some(Self::PaperDescendant),
            Method::PaperAscendant => Some(Self::PaperAscendant),
            Method::Joint => Some(Self::Joint),
            Method::Efficient => Some(Self::Efficient),
            Method::Instrumental => Some(Self::Instrumental),
            Method::LinearArx => Some(Self::LinearArx),
            Method::Memoryless => Some(Self::Memoryless),
            Method::Free => None,
        }
    }

    /// The experiments it looks at, as indices into [`DIRECTIONS`](super::setup::DIRECTIONS).
    pub(super) fn experiments(self) -> &'static [usize] {
        match self {
            Self::PaperDescendant => &[0],
            Self::PaperAscendant => &[1],
            Self::Joint | Self::Efficient | Self::Instrumental | Self::LinearArx | Self::Memoryless => {
                &[0, 1]
            }
        }
    }

    /// Whether it uses the mean of a step experiment.
    pub(super) fn needs_step(self) -> bool {
        matches!(self, Self::PaperDescendant | Self::PaperAscendant)
    }

    /// Whether it works on the folds, and holds whatever the colour of the noise.
    pub(super) fn folds(self) -> bool {
        self == Self::Instrumental
    }

    /// Whether the model it fits holds the truth, so that its asymptotic theory applies.
    pub(super) fn models_hysteresis(self) -> bool {
        !matches!(self, Self::LinearArx | Self::Memoryless)
    }

    /// Hands the method its part of the data.
    pub(super) fn with_input<T>(
        self,
        data: &[PulseData; 2],
        steps: [StepMean; 2],
        run: impl FnOnce(PulseMethod<'_>) -> T,
    ) -> T {
        let both = [&data[0], &data[1]];
        run(match self {
            Self::PaperDescendant => PulseMethod::Paper { experiment: both[0], step: steps[0] },
            Self::PaperAscendant => PulseMethod::Paper { experiment: both[1], step: steps[1] },
            Self::Joint => PulseMethod::Joint { descendant: both[0], ascendant: both[1] },
            Self::Efficient => PulseMethod::Efficient(&both),
            Self::Instrumental => PulseMethod::Instrumental(&both),
            Self::LinearArx => PulseMethod::LinearArx(&both),
            Self::Memoryless => PulseMethod::Memoryless(&both),
        })
    }
}
