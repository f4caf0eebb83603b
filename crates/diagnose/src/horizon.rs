//! How far ahead models predict, and what one gains over another there.

/// How far ahead models predict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Horizon {
    /// The next sample, given the measured ones before it and the colour of the errors.
    Step,
    /// So many samples, given the measured ones before them.
    Samples(usize),
    /// The whole record, given its beginning.
    FreeRun,
}

impl Horizon {
    /// Samples ahead; 0 for the whole record.
    pub(crate) fn samples(self) -> usize {
        match self {
            Self::Step => 1,
            Self::Samples(h) => h,
            Self::FreeRun => 0,
        }
    }

    /// The horizon so many samples ahead.
    pub(crate) fn of_samples(samples: usize) -> Self {
        match samples {
            0 => Self::FreeRun,
            1 => Self::Step,
            h => Self::Samples(h),
        }
    }
}

/// What a model gains over another at one horizon, on the fit records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HorizonGain {
    /// How far ahead both predict.
    pub horizon: Horizon,
    /// Share of the mean square error that it saves; negative where it adds.
    pub share: f64,
    /// The same in units of its standard error, which comes from the errors themselves.
    pub certainty: f64,
}
