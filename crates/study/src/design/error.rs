//! Why there is no design.

use miette::Diagnostic;
use switchback_identify::excitation::ExcitationError;
use switchback_identify::pulse::PulseFitError;
use switchback_io::identification::IdentificationError;
use switchback_io::rig::RigError;
use thiserror::Error;

/// Why no experiment was designed. Each message says what to change.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum DesignError {
    /// Neither the experiments nor a rig are given.
    #[error("give --order, --interval and --rate, or --from RIG.toml")]
    Incomplete,
    /// A precision was asked for without a rig.
    #[error("`--precision` needs `--from RIG.toml`: how long to measure depends on the system and its noise")]
    #[diagnostic(help("measure a first plan without it, then `switchback design --from` that rig"))]
    PrecisionOfWhat,
    /// A number is none above zero.
    #[error("`{option}` is no positive number")]
    NotPositive {
        /// The option.
        option: &'static str,
    },
    /// Two options do not go together.
    #[error("the argument '{option}' cannot be used with '{other}'")]
    Exclusive {
        /// One.
        option: &'static str,
        /// The other.
        other: &'static str,
    },
    /// The rig to plan from cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Rig(#[from] RigError),
    /// The rig to plan from cannot be identified.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Identification(#[from] IdentificationError),
    /// A move of the free records is none that fits.
    #[error("`--amplitude`: the {which} move, {size}, {reason}")]
    #[diagnostic(help("give `--amplitude MIN,MAX` with 0 < MIN ≤ MAX ≤ {width}"))]
    Amplitude {
        /// `smallest` or `largest`.
        which: &'static str,
        /// The move given, input units.
        size: f64,
        /// Why it is none.
        reason: String,
        /// Width of the interval.
        width: f64,
    },
    /// The pulse experiments are too short.
    #[error(
        "`--periods {periods}` is too few: the first period settles the output, and every level must come back at least once more"
    )]
    #[diagnostic(help("give `--periods {minimum}` or more"))]
    TooFewPeriods {
        /// Periods given.
        periods: usize,
        /// The fewest allowed.
        minimum: usize,
    },
    /// An experiment is refused.
    #[error(transparent)]
    Excitation(#[from] ExcitationError),
    /// The system identified is none that an experiment can be planned for.
    #[error("{rig}: no experiment can be planned for the system identified from it: {reason}")]
    #[diagnostic(help(
        "give `--order`, check the rig with `switchback identify {rig}`, or design without it: `--order --interval --rate`"
    ))]
    NoSystem {
        /// The rig file.
        rig: String,
        /// What is wrong with the system.
        reason: String,
    },
    /// The experiments would not determine the system.
    #[error("{method} cannot identify this system from these experiments: {source}")]
    #[diagnostic(help("give a lower `--order`"))]
    NotExcited {
        /// The method planned for.
        method: &'static str,
        /// What it says.
        source: PulseFitError,
    },
    /// The actuator is too slow for one-sample visits.
    #[error(
        "the pulse experiments move {width} within one sample of {sample_time} s, at {needed}/s, but `--max-speed` is {limit}"
    )]
    #[diagnostic(help(
        "lower `--rate` to {rate} Hz or less, or narrow `--interval`; or play the free records alone with `--free-only`"
    ))]
    TooFast {
        /// The whole interval, input units.
        width: f64,
        /// Seconds between samples.
        sample_time: f64,
        /// Speed needed, input units a second.
        needed: String,
        /// Speed allowed.
        limit: f64,
        /// Highest rate at which the interval can be crossed within a sample, Hz.
        rate: String,
    },
    /// The free records end before the actuator has crossed the interval.
    #[error(
        "at `--max-speed {limit}` one stroke over the interval takes {stroke} s, but holdout.csv lasts {record} s and must run both borders from end to end"
    )]
    #[diagnostic(help("measure longer: give `--periods {periods}` or more"))]
    TooSlow {
        /// Speed allowed, input units a second.
        limit: f64,
        /// Seconds of one stroke.
        stroke: String,
        /// Seconds of the held-out record.
        record: String,
        /// Periods with which it would be long enough.
        periods: usize,
    },
    /// The dataset does not fit into the time given.
    #[error(
        "`--duration {given}` s is too short: {needed:.1} s are needed for {fewest} periods of each pulse experiment"
    )]
    #[diagnostic(help("give at least that, or fewer `--points`"))]
    TooShort {
        /// Seconds given.
        given: f64,
        /// Seconds needed.
        needed: f64,
        /// The fewest periods.
        fewest: usize,
    },
    /// The dataset is too long to be written.
    #[error(
        "each pulse experiment would have {samples:.3e} samples ({seconds:.3e} s), more than the {most:.0e} that a file should hold"
    )]
    #[diagnostic(help("ask for less `--precision`, or a shorter dataset"))]
    TooLong {
        /// Samples of each pulse experiment.
        samples: f64,
        /// Their duration.
        seconds: f64,
        /// The most allowed.
        most: f64,
    },
}
