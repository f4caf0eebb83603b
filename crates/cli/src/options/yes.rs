//! `--yes`

use super::{Quiet, Threads};
use miette::Diagnostic;
use switchback_io::output::note;
use thiserror::Error;

/// Whether what takes days is run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct Yes {
    /// Run it even if it is estimated to take longer than a day
    #[arg(long)]
    pub yes: bool,
}

/// Something would take longer than a day, and nobody said that it may.
#[derive(Debug, Error, Diagnostic)]
#[error("this would take about {0}")]
#[diagnostic(help("ask for less, or give --yes to run it all the same"))]
pub struct TooLong(String);

const DAY: f64 = 86_400.0;

impl Yes {
    /// Lets work go on that takes so many seconds of one thread, unless that is more than a day on those at hand; where it is and is allowed,
    /// the estimate is reported on stderr.
    ///
    /// # Errors
    /// [`TooLong`] with the estimate.
    pub fn permit(self, seconds: f64, threads: Threads, quiet: Quiet) -> Result<(), TooLong> {
        let count = threads.at_once();
        let seconds = seconds / count as f64;
        if seconds <= DAY {
            return Ok(());
        }
        let threads = if count == 1 { "1 thread".to_owned() } else { format!("{count} threads") };
        let estimate = format!("{} on {threads}", reported(seconds));
        if !self.yes {
            return Err(TooLong(estimate));
        }
        if !quiet.quiet {
            note(&format!("this takes about {estimate}\n"));
        }
        Ok(())
    }
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
        let one = Threads { threads: Some(1) };
        let permit = |yes, days: f64| Yes { yes }.permit(days * DAY, one, Quiet { quiet: true });
        assert!(permit(false, 1.0).is_ok());
        assert!(permit(true, 1e9).is_ok());
        let refused = |days| permit(false, days).unwrap_err().to_string();
        assert_eq!(refused(1.5), "this would take about 36 hours on 1 thread");
        assert_eq!(refused(400.0), "this would take about 400 days on 1 thread");
        assert_eq!(refused(1100.0), "this would take about 3 years on 1 thread");
    }
}
