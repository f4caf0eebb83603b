//! Does a diagnosis find what was put in, and nothing where nothing was?
//!
//! Two made rigs, diagnosed as a user would have them diagnosed. They are always the same ones, whatever the seed: a verdict is a probability, wrong
//! on one rig in some dozens, and no seed may decide whether this check passes. The play that is found must be the one put in, within the
//! interval reported, stretched from 90 % to the false alarm of a check.

use super::chance::Tail;
use super::figure::Figure;
use crate::generate::{Family, MadeRig, MakeRig, RequestedFault};
use miette::{IntoDiagnostic, miette};
use statrs::distribution::{ContinuousCDF, Normal};
use switchback_diagnose::{Diagnosis, Effect, Settings};
use switchback_io::diagnosis::{Reported, Subject, Units, examine, reported};

/// Seeds of the rigs, those that the repository ships (`scenarios/rigs`).
const WITH_BACKLASH: u64 = 11;
const WITHOUT: u64 = 7;

/// Makes both rigs, diagnoses them.
pub(super) fn figures(_seed: u64) -> miette::Result<Vec<Figure>> {
    let with = Diagnosed::made(WITH_BACKLASH, Some("backlash"))?;
    let without = Diagnosed::made(WITHOUT, None)?;
    judge(&with, &without)
}

/// What a diagnosis of one rig with a play and of one without a cause said.
fn judge(with: &Diagnosed, without: &Diagnosed) -> miette::Result<Vec<Figure>> {
    Ok(vec![
        Figure::word("cause where a play was put in", with.named(), "backlash"),
        Figure::word("cause where nothing was put in", without.named(), "none"),
        with.play()?,
    ])
}

/// A made rig and its diagnosis.
struct Diagnosed {
    made: MadeRig,
    diagnosis: Diagnosis,
}

impl Diagnosed {
    fn made(seed: u64, effect: Option<&str>) -> miette::Result<Self> {
        let mut recipe = MakeRig::new(seed).family(Family { order: Some(2), shape: None });
        if let Some(effect) = effect {
            recipe = recipe.with(RequestedFault::plain(effect, 2.0).into_diagnostic()?);
        }
        let made = recipe.make().into_diagnostic()?;
        let subject = Subject::choose(made.rig.clone(), None)?;
        let diagnosis = examine(subject, &Settings::default())?.diagnosis;
        Ok(Self { made, diagnosis })
    }

    /// The effects named, or else how the verdict stands.
    fn named(&self) -> String {
        let verdict = &self.diagnosis.verdict;
        let names: Vec<&str> = verdict.effects.iter().map(|effect| effect.name()).collect();
        if names.is_empty() { verdict.status.name().to_owned() } else { names.join(", ") }
    }

    /// The play found beside the one put in, in input units.
    fn play(&self) -> miette::Result<Figure> {
        let Self { made: MadeRig { rig, key, .. }, diagnosis } = self;
        let truth = key.effects.first().and_then(|effect| effect.length(key.interval));
        let candidate = diagnosis.candidates.iter().find(|candidate| candidate.effect == Effect::Backlash);
        let parameter = candidate.and_then(|c| c.parameters.iter().find(|p| p.name == "play"));
        let (Some(truth), Some(parameter)) = (truth, parameter) else {
            return Err(miette!("the diagnosis shows no play, or the maker put none in"));
        };
        let Reported { value, ci90: [low, high], .. } = reported(parameter, &Units::of(rig));
        // From the 5 % on each side of a 90 % interval to those of a check with one figure that chance moves.
        let stretch = Tail::of(1).normal() / Normal::standard().inverse_cdf(0.95);
        let range = (truth - stretch * (high - value), truth + stretch * (value - low));
        Ok(Figure::within("play found, input units", value, truth, range))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::selftest::tests::{all_hold, some_fail};

    #[test]
    fn the_play_is_found_and_nothing_else() {
        let mut with = Diagnosed::made(WITH_BACKLASH, Some("backlash")).expect("diagnosed");
        let without = Diagnosed::made(WITHOUT, None).expect("diagnosed");
        all_hold(&judge(&with, &without).expect("a play"));
        // What would be reported by a diagnosis that finds nothing, everything, or another size.
        some_fail(&judge(&with, &with).expect("a play"), "cause where nothing was put in");
        with.made.key.effects[0].magnitude *= 1.05;
        some_fail(&judge(&with, &without).expect("a play"), "play found, input units");
        with.diagnosis.verdict.effects = vec![Effect::Creep];
        some_fail(&judge(&with, &without).expect("a play"), "cause where a play was put in");
        assert!(judge(&without, &without).is_err(), "a rig without a play has none to show");
    }
}
