//! Verdicts that no probability gives.

use crate::verdict::answer::{Status, Verdict, naming_nothing};
use crate::verdict::odds::Odds;

/// The verdict where no gap is resolved on the judged records and no candidate explains what remains of the error.
pub(crate) fn unresolved(odds: &Odds) -> Verdict {
    naming_nothing(Status::None, None, odds.none + odds.unexplained)
}

/// The verdict where the model describes the fit records but not the held-out ones: none of the candidates is the cause.
/// `ratio` is how many times as much the model errs there, in root mean square.
pub(crate) fn held_out_differs(odds: &Odds, ratio: f64) -> Verdict {
    let unexplained = naming_nothing(Status::Unexplained, None, odds.none + odds.unexplained);
    Verdict { held_out_error_ratio: Some(ratio), ..unexplained }
}

/// The verdict where identifying the model anew closes as much of the gap as any cause; `verdict` is that which shows one.
pub(crate) fn parameters_are_off(verdict: &Verdict) -> Verdict {
    naming_nothing(Status::Refit, None, verdict.probability)
}
