//! Successive halving: all laws are screened, the promising ones go on for some rounds, and those that may still win to convergence
//! (K. Jamieson and A. Talwalkar, "Non-stochastic best arm identification and hyperparameter optimization", 2016).

use super::{Attribution, SIGNIFICANT};
use crate::attribution::explain::Hypothesis;
use crate::attribution::search::{Question, advance, finish, screened};
use crate::attribution::starts::Known;
use crate::effect::Effect;
use crate::workers::Workers;

/// How many effects are fitted to convergence at least, in the order of the screening, and the penalised deviance found elsewhere that
/// the winner has to beat to be of any use.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Halving {
    pub(crate) finished: usize,
    pub(crate) to_beat: Option<f64>,
}

/// Share of the best gain that makes an effect promising.
const PROMISING: f64 = 0.15;
/// Laws of one effect fitted to convergence at most, and the share of its best gain that a further one needs.
const LAWS: usize = 2;
const LAW: f64 = 0.6;
/// How far behind the leader, as a share of its gain and in penalised deviance at least, a law goes on to convergence.
const BEHIND: f64 = 0.3;
const LEAST_REACH: f64 = 100.0;
/// As many times what its first rounds gained a law may be behind and still go on.
const STRIDES: f64 = 3.0;

impl<W: Workers> Attribution<'_, W> {
    /// Each effect added to what is known, best first: all screened, the promising ones fitted to convergence.
    pub(crate) fn on_top_of(
        &self,
        known: &Hypothesis,
        questions: &[Question],
        halving: Halving,
    ) -> Vec<Hypothesis> {
        let screened = screened(self.workers, &Known::new(self.dataset, known), questions);
        let gain = |e: &Hypothesis| known.bic() - e.bic();
        let most = screened.first().map_or(0.0, |entry| entry.gain);
        let mut promising: Vec<(Effect, Hypothesis)> = Vec::new();
        let mut done: Vec<(Effect, Hypothesis)> = Vec::new();
        let mut confounded_effects: Vec<Effect> = Vec::new();
        for (rank, entry) in screened.into_iter().enumerate() {
            // The screening may miss a narrow optimum: no confounded effect of a promising effect is ruled out by it.
            let worth = rank < halving.finished
                || known.effect_terms.is_empty()
                    && (entry.gain > PROMISING * most.max(SIGNIFICANT)
                        || confounded_effects.contains(&entry.effect));
            if worth && entry.gain > SIGNIFICANT {
                confounded_effects.extend(entry.effect.confounded_effects());
            }
            let least = entry.gain - (1.0 - LAW) * entry.gain.abs();
            let laws = entry.laws.into_iter().filter(|law| gain(law) >= least).take(LAWS);
            let laws = laws.map(|law| (entry.effect, law));
            if worth { promising.extend(laws) } else { done.extend(laws.take(1)) }
        }
        done.extend(self.halved(known, &promising, halving.to_beat));
        let named = done.into_iter().map(|(asked, law)| (asked, law.named_by_its_signs()));
        let mut done: Vec<(Effect, Hypothesis)> =
            named.filter(|(_, law)| law.is_sound() && self.considers(law)).collect();
        done.sort_by(|x, y| x.1.bic().total_cmp(&y.1.bic()));
        // Several laws of one effect: the best counts. Alone, the best of each family of laws does: signs may give two families one
        // name, and held-out records choose between them.
        let is_alone = known.effect_terms.is_empty();
        let mut seen: Vec<(Option<Effect>, Option<Effect>)> = Vec::new();
        done.retain(|(asked, law)| {
            let key =
                (is_alone.then_some(*asked), law.effect_terms.last().map(|effect_term| effect_term.effect));
            let new = key.1.is_some() && !seen.contains(&key);
            seen.push(key);
            new
        });
        done.into_iter().map(|(_, e)| e).collect()
    }

    /// Some rounds for every law, then convergence for those that may still win, also against what was found elsewhere.
    fn halved(
        &self,
        known: &Hypothesis,
        promising: &[(Effect, Hypothesis)],
        to_beat: Option<f64>,
    ) -> Vec<(Effect, Hypothesis)> {
        let fixed = known.fit.nonlinear.len();
        let mut queue: Vec<&(Effect, Hypothesis)> = promising.iter().collect();
        // The longest first, so that nobody waits for them at the end.
        queue.sort_by_key(|(_, law)| !law.has_corners());
        let mut field: Vec<AdvancedLaw> = self.workers.map(&queue, |(effect, sketch)| {
            let law = advance(self.dataset, fixed, sketch);
            AdvancedLaw { effect: *effect, gained: sketch.bic() - law.bic(), law }
        });
        field.sort_by(|x, y| x.law.bic().total_cmp(&y.law.bic()));
        let Some(leader) = field.first() else { return Vec::new() };
        let reach = (BEHIND * (known.bic() - leader.law.bic())).max(LEAST_REACH);
        let ahead = leader.law.bic().min(to_beat.unwrap_or(f64::INFINITY));
        let near = |advanced: &AdvancedLaw| advanced.law.bic() - ahead < reach.max(STRIDES * advanced.gained);
        let leads = near(leader);
        self.workers.map(&field, |advanced| {
            let may_win =
                near(advanced) || leads && leader.effect.confounded_effects().contains(&advanced.effect);
            let law = if may_win { finish(self.dataset, fixed, &advanced.law) } else { advanced.law.clone() };
            (advanced.effect, law)
        })
    }
}

/// A law after its first rounds.
struct AdvancedLaw {
    effect: Effect,
    law: Hypothesis,
    /// Penalised deviance that the first rounds gained.
    gained: f64,
}
