//! Fitting the verdict on records as the field has them to rigs whose cause is known, and what it is worth on rigs that it was not fitted to.

mod examples;

pub use examples::examples;

use crate::examination::{Measure, Reply, measures_table};
use crate::field::{Case, Expect, score};
use switchback_gap::fitted::{CalibrateError, FittedVerdict, calibrate};
use switchback_gap::{Effect, Settings};

/// A fitted verdict beside what rules reach on the same rigs.
#[derive(Debug, Clone)]
pub struct Calibrated {
    /// The verdict.
    pub verdict: FittedVerdict,
    /// Measures of the field examination by rules.
    pub by_rules: Vec<Measure>,
    /// The same by the verdict, each rig predicted from others.
    pub out_of_fold: Vec<Measure>,
    /// The same by both: what rules name, unless the verdict that knows neither base nor law, or a simulator, puts another cause first.
    pub agreed: Vec<Measure>,
}

/// Fits the verdict to judged rigs. `studies` and `command` say where they come from.
///
/// # Errors
/// [`CalibrateError`] where rigs of a kind are missing.
pub fn calibrated(cases: &[Case], origin: (&str, &[String])) -> Result<Calibrated, CalibrateError> {
    let (places, examples): (Vec<_>, Vec<_>) = examples(cases).into_iter().unzip();
    let (verdict, predicted) = calibrate(&examples, origin)?;
    let mut by_rules = cases.to_vec();
    for answer in by_rules.iter_mut().flat_map(|case| &mut case.answers) {
        answer.reply = answer.rules().clone();
    }
    let (mut by_fit, mut agreed) = (by_rules.clone(), by_rules.clone());
    let name_at = Settings::default().name_at;
    for (((case, answer), example), predicted) in places.into_iter().zip(&examples).zip(&predicted) {
        by_fit[case].answers[answer].reply =
            Reply::told(&predicted.verdict(example, name_at), predicted.top());
        let reply = &mut agreed[case].answers[answer].reply;
        if let Some(cause) = reply.named().and_then(Effect::from_name) {
            reply.rivalled(predicted.rivals(example, cause).into_iter().map(Effect::name));
        }
    }
    let measures = |cases: &[Case]| score(cases, &Expect::default()).measures;
    Ok(Calibrated {
        verdict,
        by_rules: measures(&by_rules),
        out_of_fold: measures(&by_fit),
        agreed: measures(&agreed),
    })
}

impl Calibrated {
    /// What is printed.
    pub fn summary(&self) -> String {
        let from = &self.verdict.provenance;
        format!(
            "{} diagnoses; log-loss {:.3} nats a diagnosis, each predicted from rigs with other bases and laws; by rules {:.3}, by shares alone {:.3}\n\n\
             by rules\n{}\nby the fitted verdict, out of fold\n{}\nby both, as the program tells it\n{}",
            from.examples,
            from.log_loss,
            from.log_loss_of_rules,
            from.log_loss_of_shares,
            measures_table(&self.by_rules),
            measures_table(&self.out_of_fold),
            measures_table(&self.agreed),
        )
    }
}
