//! An identification, examined: beside simpler models, beside one for real time, and by its residuals.

use super::{
    Baseline, CausalAlternative, Examination, Flag, Identification, IdentificationError, Method, Request,
    identify_watched, residuals,
};
use crate::progress::Stages;
use rayon::prelude::*;
use switchback_model::rig::Rig;

/// Identifies a rig and examines the result: [`Identification::flags`] then holds every reservation, weightiest first.
///
/// Beside the identification asked for it makes, on the same terms, those of the simpler methods and, where the model looks ahead,
/// the one of a model that does not.
///
/// # Errors
/// [`IdentificationError`] if nothing can be identified, or if the result cannot simulate a single record.
pub fn examined_watched(
    rig: &Rig,
    request: Request,
    progress: &dyn Stages,
) -> Result<Identification, IdentificationError> {
    progress.begin("identifying");
    let mut found = identify_watched(rig, request, progress)?;
    let useless = residuals::worse_than_the_mean(rig, &found);
    refuse_useless(rig, &found, &useless)?;
    progress.begin("comparing with other models");
    let others = others(rig, request, &found, progress);
    let mut examination =
        Examination { innovations: residuals::innovations(rig, &found), ..Examination::default() };
    for (request, other) in others {
        let compared = Baseline::of(rig, &found, &other);
        if request.method == found.method {
            examination.causal =
                Some(CausalAlternative { identification: Box::new(other), held_out: compared });
        } else {
            examination.baselines.extend(compared);
        }
    }
    found.flags = flags(rig, &found, &examination, useless);
    found.examination = examination;
    Ok(found)
}

/// [`examined_watched`] by nobody.
#[cfg(test)]
pub(crate) fn examined(rig: &Rig, request: Request) -> Result<Identification, IdentificationError> {
    examined_watched(rig, request, &())
}

/// A model that no record bears out is no result.
pub(super) fn refuse_useless(
    rig: &Rig,
    found: &Identification,
    useless: &[Flag],
) -> Result<(), IdentificationError> {
    let simulated = found.runs.iter().flatten().count();
    if simulated == 0 || useless.len() < simulated {
        return Ok(());
    }
    let reported = useless.iter().map(|flag| flag.text.as_str()).collect::<Vec<_>>().join("; ");
    Err(IdentificationError::Useless { rig: rig.name.clone(), method: found.method, reported })
}

/// The identifications to compare with, those that the records allow.
fn others(
    rig: &Rig,
    request: Request,
    found: &Identification,
    progress: &dyn Stages,
) -> Vec<(Request, Identification)> {
    if lacks_holdout(rig) {
        return Vec::new();
    }
    let simpler: &[Method] = match request.method {
        Method::LinearArx => &[],
        Method::Memoryless => &[Method::LinearArx],
        Method::PaperDescendant
        | Method::PaperAscendant
        | Method::Joint
        | Method::Efficient
        | Method::Instrumental
        | Method::Free => &[Method::Memoryless, Method::LinearArx],
    };
    let mut requests: Vec<Request> = simpler.iter().map(|&method| Request { method, ..request }).collect();
    if !found.obstacles.is_empty() {
        requests.push(Request { causal: true, ..request });
    }
    let other = |request| Some((request, identify_watched(rig, request, progress).ok()?));
    let identified = requests.into_par_iter().map(other);
    identified.collect::<Vec<_>>().into_iter().flatten().collect()
}

/// Every reservation, weightiest first: runs that are useless, simpler models that do better, what the errors say, innovations that are not white, what
/// real time would cost, and what was found in passing.
fn flags(rig: &Rig, found: &Identification, examination: &Examination, useless: Vec<Flag>) -> Vec<Flag> {
    let no_holdout = lacks_holdout(rig).then(|| Flag {
        kind: "no_holdout",
        figure: None,
        text: "no record is held out, so the fit is only a fit to what was fitted".to_owned(),
    });
    let baseline = preferable(examination).and_then(|baseline| baseline.flag(found.method));
    let colour = examination.innovations.as_ref().and_then(residuals::colour);
    let causal = examination.causal.as_ref().map(|causal| causal.flag(&found.obstacles));
    let (notes, doubts): (Vec<Flag>, Vec<Flag>) = found.flags.iter().cloned().partition(Flag::is_a_note);
    let before = useless.into_iter().chain(no_holdout).chain(baseline);
    before.chain(doubts).chain(colour).chain(causal).chain(notes).collect()
}

/// The baseline that comes nearest to the identification, or surpasses it most.
fn preferable(examination: &Examination) -> Option<&Baseline> {
    examination.baselines.iter().max_by(|x, y| x.fit_percent.total_cmp(&y.fit_percent))
}

/// Whether nothing is held out, so that no fit figure proves anything.
fn lacks_holdout(rig: &Rig) -> bool {
    rig.holdout_records().next().is_none()
}
