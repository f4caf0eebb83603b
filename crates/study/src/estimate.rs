//! How long work will take, and whether that is too long to begin unasked.

use miette::Diagnostic;
use switchback_io::threads::Threads;
use thiserror::Error;

/// Something would take longer than a day, and nobody said that it may.
#[derive(Debug, Error, Diagnostic)]
#[error("this would take about {0}")]
#[diagnostic(help("ask for less, or give --yes to run it all the same"))]
pub struct TooLong(String);

const DAY: f64 = 86_400.0;

/// Lets work go on that takes so many seconds of one thread, unless that is more than a day on those at hand; where it is and is allowed, the
/// estimate is returned.
///
/// # Errors
/// [`TooLong`] with the estimate.
pub fn permit(seconds: f64, threads: Threads, is_allowed: bool) -> Result<Option<String>, TooLong> {
    let count = threads.at_once();
    let seconds = seconds / count as f64;
    if seconds <= DAY {
        return Ok(None);
    }
    let threads = if count == 1 { "1 thread".to_owned() } else { format!("{count} threads") };
    let estimate = format!("{} on {threads}", reported(seconds));
    if is_allowed { Ok(Some(estimate)) } else { Err(TooLong(estimate)) }
}

/// A time above a day, to the digits that an estimate is good for.
fn reported(seconds: f64) -> String {
    let units = [(365.25 * DAY, "years"), (DAY, "days"), (3600.0, "hours")];
    // Two of a unit at least: "400 days" rather than "1 years".
    let (size, unit) = units.into_iter().find(|(size, _)| seconds >= 2.0 * size).unwrap_or(units[2]);
    format!("{:.0} {unit}", seconds / size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_day_is_free_and_more_is_reported_in_sensible_units() {
        let permit = |is_allowed, days: f64| permit(days * DAY, Threads(Some(1)), is_allowed);
        assert!(permit(false, 1.0).is_ok_and(|estimate| estimate.is_none()));
        assert!(permit(true, 1e9).is_ok_and(|estimate| estimate.is_some()));
        let refused = |days| permit(false, days).unwrap_err().to_string();
        assert_eq!(refused(1.5), "this would take about 36 hours on 1 thread");
        assert_eq!(refused(400.0), "this would take about 400 days on 1 thread");
        assert_eq!(refused(1100.0), "this would take about 3 years on 1 thread");
    }
}
