//! What a model costs that could run in real time.

use super::{CausalAlternative, Flag};
use switchback_identify::PlusMinus;
use switchback_identify::free::Model;
use switchback_model::reversal::LookAhead;

/// Why a model could not run in real time, with the unit of its input; empty if it could.
pub(crate) fn obstacles(model: &Model, unit: &str) -> Vec<String> {
    if model.is_causal() {
        return Vec::new();
    }
    let mut reasons = Vec::new();
    let ahead = -1 - model.structure().delay;
    if ahead > 0 {
        reasons.push(format!("it weighs the input {ahead} sample(s) ahead"));
    }
    if model.basis().is_switched() {
        match model.rule().looks_ahead() {
            LookAhead::Never => {}
            LookAhead::OneSample if model.structure().delay >= 0 => {}
            LookAhead::OneSample => {
                reasons.push("the sample after a reversal shows when between samples it falls".to_owned());
            }
            LookAhead::UntilConfirmed => reasons.push(format!(
                "it dates a reversal back once the input has moved by {}",
                format!("{} {unit}", PlusMinus::new(model.rule().threshold, f64::NAN).value).trim()
            )),
        }
    }
    reasons
}

impl CausalAlternative {
    /// Shows the price.
    pub(super) fn flag(&self, obstacles: &[String]) -> Flag {
        let why = format!("this model could not run in real time ({})", obstacles.join("; "));
        match &self.held_out {
            Some(held_out) => {
                let price = held_out.lead();
                let fits = format!(
                    "the best that could, `--causal`, reaches {:.1} % of fit on the held-out records against {:.1} %",
                    held_out.fit_percent, held_out.own_fit_percent
                );
                let price_in_words = match held_out.excess {
                    Some(excess) if excess.low <= 0.0 && excess.high >= 0.0 => {
                        "no difference beyond chance".to_owned()
                    }
                    _ if price < 0.0 => format!("{:.1} points better", -price),
                    _ => format!("a price of {price:.1} points"),
                };
                Flag::new("not_causal", price, format!("{why}; {fits}, {price_in_words}"))
            }
            None => Flag {
                kind: "not_causal",
                figure: None,
                text: format!(
                    "{why}; `--causal` gives the best that could, at a price that only a held-out record would show"
                ),
            },
        }
    }
}
