//! Whoever estimates for a method of others.

use super::design::Design;
use std::fmt::Debug;
use thiserror::Error;

/// The outputs of both experiments of a design in one replicate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Records<'a> {
    /// Number of the replicate.
    pub replicate: u32,
    /// Whether its noise has the other sign.
    pub antithetic: bool,
    /// `y(t)` of the descendant and of the ascendant experiment, as long as their inputs.
    pub y: [&'a [f64]; 2],
}

/// Estimates of all parameters that were asked for, each with its standard error; that is no number where none is reported.
pub type Estimates = Vec<(f64, f64)>;

/// Whoever estimates: called from several threads.
pub trait ForeignEstimator: Debug + Send + Sync {
    /// Makes sure that it can be asked, and gives its version.
    ///
    /// # Errors
    /// [`ForeignError`] if it cannot.
    fn begin(&self) -> Result<String, ForeignError>;

    /// Estimates from each of some records of a design; why not, where there is no estimate.
    fn estimate(&self, design: &Design, records: &[Records<'_>]) -> Vec<Result<Estimates, String>>;

    /// Lets go of all that it needs to be asked; it may be asked again.
    fn end(&self) {}
}

/// Why a method of others cannot be asked.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("method `{method}`: {why}; {remedy}")]
pub struct ForeignError {
    /// Its name.
    pub method: String,
    /// What is wrong.
    pub why: String,
    /// What to do.
    pub remedy: String,
}

/// What was answered as estimates, if it is that.
///
/// # Errors
/// In words, what is wrong with it: another number of figures, one that is not finite, a negative standard error.
pub fn checked(
    design: &Design,
    estimate: &[Option<f64>],
    se: Option<&[Option<f64>]>,
) -> Result<Estimates, String> {
    let names = &design.parameters;
    for (what, count) in
        [("estimates", estimate.len()), ("standard errors", se.map_or(names.len(), <[_]>::len))]
    {
        if count != names.len() {
            return Err(format!("it gave {count} {what} of {} parameters", names.len()));
        }
    }
    let parameter = |(k, name): (usize, &String)| {
        let value = estimate[k].filter(|x| x.is_finite());
        let value = value.ok_or_else(|| format!("its estimate of {name} is no number"))?;
        match se.and_then(|se| se[k]) {
            Some(se) if se < 0.0 => Err(format!("its standard error of {name} is negative")),
            Some(se) if se.is_finite() => Ok((value, se)),
            _ => Ok((value, f64::NAN)),
        }
    };
    names.iter().enumerate().map(parameter).collect()
}
