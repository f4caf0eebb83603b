//! Fitting the verdict on records as the field has them to rigs whose cause is known, and what it is worth on rigs that it was not fitted to.

mod examples;

use examples::examples;

use crate::examination::field::score;
use crate::examination::{BaseVerdicts, Case, Expect, Measure, Rating, Reply, measures_table};
use crate::training::examples::Place;
use std::collections::HashSet;
use switchback_diagnose::Settings;
use switchback_diagnose::fitted::{
    Agreed, AgreedOn, CalibrateError, Example, FittedVerdict, OutOfFold, calibrate,
};

/// A fitted verdict beside what rules reach on the same rigs.
#[derive(Debug, Clone)]
pub struct Calibrated {
    /// The verdict.
    pub verdict: FittedVerdict,
    /// Measures of the field examination by rules.
    pub by_rules: Vec<Measure>,
    /// The same by the verdict alone, each rig predicted from others.
    pub out_of_fold: Vec<Measure>,
    /// The same as the program shows it: where all readings agree, what rules name.
    pub reported: Vec<Measure>,
}

/// Fits the verdict to judged rigs. `studies` and `command` say where they come from.
///
/// # Errors
/// [`CalibrateError`] where rigs of a kind are missing.
pub fn calibrated(cases: &[Case], origin: (&str, &[String])) -> Result<Calibrated, CalibrateError> {
    let (places, examples): (Vec<_>, Vec<_>) = examples(cases).into_iter().unzip();
    let (mut verdict, predicted) = calibrate(&examples, origin)?;
    let mut by_rules = cases.to_vec();
    for answer in by_rules.iter_mut().flat_map(|case| &mut case.answers) {
        answer.reply = answer.rules().clone();
    }
    let predicted: Vec<_> = places.into_iter().zip(examples.iter().zip(&predicted)).collect();
    let name_at = Settings::default().name_at;
    let mut by_fit = by_rules.clone();
    for ((case, answer), (example, p)) in &predicted {
        by_fit[*case].answers[*answer].reply = Reply::reported(&p.verdict(example, name_at), p.top());
    }
    let reported = |agreed: Agreed| {
        let mut reported = by_rules.clone();
        for ((case, answer), (example, p)) in &predicted {
            reported[*case].answers[*answer].reply =
                Reply::reported(&p.reported(example, agreed, name_at), p.top());
        }
        reported
    };
    // The verdict on a measured base is its own answer, if agreement is worth what it may be at most.
    let most = Agreed { right: examples.len(), of: examples.len() };
    let likely = |(_, (example, p)): &&(Place, (&Example, &OutOfFold))| {
        p.agreed_on(example).is_some_and(AgreedOn::counts)
    };
    let places = predicted.iter().filter(likely).map(|(place, _)| *place).collect();
    verdict.agreed = agreed(&reported(most), &places);
    let measures = |cases: &[Case]| score(cases, &Expect::new()).measures;
    Ok(Calibrated {
        by_rules: measures(&by_rules),
        out_of_fold: measures(&by_fit),
        reported: measures(&reported(verdict.agreed)),
        verdict,
    })
}

/// How often the cause reported is right, of the answers at some places, those that can be judged.
fn agreed(cases: &[Case], places: &HashSet<Place>) -> Agreed {
    let verdicts = BaseVerdicts::of(cases);
    let all = cases.iter().enumerate().flat_map(|(k, case)| (0..case.answers.len()).map(move |j| (k, j)));
    let asked = all.zip(verdicts.asked(cases)).filter(|(place, _)| places.contains(place));
    let rated = asked.filter_map(|(_, asked)| asked.rating());
    rated.fold(Agreed::default(), |Agreed { right, of }, rating| match rating {
        Rating::Exact | Rating::Class => Agreed { right: right + 1, of: of + 1 },
        Rating::Wrong => Agreed { right, of: of + 1 },
        Rating::Silent => Agreed { right, of },
    })
}

impl Calibrated {
    /// What is printed.
    pub fn summary(&self) -> String {
        let from = &self.verdict.provenance;
        format!(
            "{} diagnoses; log-loss {:.3} nats a diagnosis, each predicted from rigs with other bases and laws; by rules {:.3}, by shares alone {:.3}\n\n\
             by rules\n{}\nby the fitted verdict alone, out of fold\n{}\nas the program shows it, out of fold (of {} likely causes on which all readings agree {} are right)\n{}",
            from.examples,
            from.log_loss,
            from.log_loss_of_rules,
            from.log_loss_of_shares,
            measures_table(&self.by_rules),
            measures_table(&self.out_of_fold),
            self.verdict.agreed.of,
            self.verdict.agreed.right,
            measures_table(&self.reported),
        )
    }
}
