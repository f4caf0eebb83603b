//! The rounds of all effects.

use super::{Context, Finding, Plan, PowerError, Search};
use crate::examination::Reply;
use rayon::prelude::*;
use switchback_study::consistency::Progress;

/// What was found of every effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Power {
    /// What was asked for.
    pub plan: Plan,
    /// Diagnoses of records without a fault.
    pub bare: Vec<Reply>,
    /// One an effect, as listed in the plan.
    pub findings: Vec<Finding>,
}

/// A cause may be reported in at most 3 % of records without any (the field examination's bound), most often one of three; this counts as much as one
/// draw.
const GUESS: f64 = 0.01;

/// Diagnoses without fault, then round by round with; `started` is called after the first.
///
/// # Errors
/// [`PowerError`] where records without a fault give no diagnosis.
pub fn measure(
    context: &Context<'_>,
    plan: &Plan,
    progress: &impl Progress,
    started: impl FnOnce(),
) -> Result<Power, PowerError> {
    progress.planned(plan.diagnoses() as u64);
    let bare = without_fault(context, plan, progress, started)?;
    let guess = |effect: &&'static str| {
        let reported = bare.iter().filter(|reply| reply.listed().contains(effect)).count();
        // Below the share that is sought; an effect that is reported so often is reported as such.
        ((reported as f64 + GUESS) / (bare.len() as f64 + 1.0)).min(0.8)
    };
    let searches = plan.effects.iter().map(|effect| Search::new(effect, guess(effect), plan)).collect();
    let searches = rounds(context, plan, searches, progress);
    let findings = searches.iter().map(|search| Finding::of(search, &bare)).collect();
    Ok(Power { plan: plan.clone(), bare, findings })
}

fn without_fault(
    context: &Context<'_>,
    plan: &Plan,
    progress: &impl Progress,
    started: impl FnOnce(),
) -> Result<Vec<Reply>, PowerError> {
    let one = |number: usize| {
        let reply = context.bare(plan.seed_of_bare(number));
        progress.advanced(1);
        reply
    };
    let first = one(0)?;
    started();
    let others: Vec<_> = (1..plan.draws).into_par_iter().with_max_len(1).map(one).collect();
    std::iter::once(Ok(first)).chain(others).collect()
}

/// A draw for every effect that needs one, until none does or the budget is spent. Which effects have draws in a round depends on what is
/// known after the one before, never on who was faster.
fn rounds(
    context: &Context<'_>,
    plan: &Plan,
    mut searches: Vec<Search>,
    progress: &impl Progress,
) -> Vec<Search> {
    let mut left = plan.budget();
    loop {
        let needy = searches.iter_mut().filter(|search| !search.is_done(plan));
        let round: Vec<&mut Search> = needy.take(left).collect();
        if round.is_empty() {
            return searches;
        }
        left -= round.len();
        round.into_par_iter().with_max_len(1).for_each(|search| {
            search.step(context);
            progress.advanced(1);
        });
    }
}
