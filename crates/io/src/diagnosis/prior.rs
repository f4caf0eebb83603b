//! `none=0.2,unexplained=0.1`

use switchback_diagnose::posterior::Prior;
use thiserror::Error;

/// A text that does not say how common causes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("give both shares, e.g. none=0.2,unexplained=0.1: above 0, and less than 1 together")]
pub struct NoPrior;

/// Parses how common it is that nothing is missing, and that the cause is none of the effects; the rest of the rigs have one of them.
///
/// ```
/// use switchback_io::diagnosis::prior;
/// let shares = prior("none=0.2,unexplained=0.1").unwrap();
/// assert!((shares.effect - 0.7).abs() < 1e-12);
/// assert!(prior("none=0.7,unexplained=0.3").is_err());
/// ```
///
/// # Errors
/// [`NoPrior`] with what to give instead.
pub fn prior(text: &str) -> Result<Prior, NoPrior> {
    let share = |name: &str| {
        let mut given =
            text.split(',').filter_map(|part| part.split_once('=')).filter(|(key, _)| key.trim() == name);
        let value = given.next().and_then(|(_, value)| value.trim().parse::<f64>().ok());
        value.filter(|x| *x > 0.0 && given.next().is_none()).ok_or(NoPrior)
    };
    let (none, none_of_these) = (share("none")?, share("unexplained")?);
    let effect = 1.0 - none - none_of_these;
    // Shares that sum to one leave nothing but rounding.
    if effect > 1e-9 && text.split(',').count() == 2 {
        Ok(Prior { effect, none, none_of_these })
    } else {
        Err(NoPrior)
    }
}
