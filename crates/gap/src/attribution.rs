//! Which effects explain what the nominal model misses: a cheap look at every law, then the promising ones to
//! convergence, border knots placed anew, and a second effect where the first leaves much.

use crate::campaign::Campaign;
use crate::decide::SIGNIFICANT;
use crate::effect::Effect;
use crate::effects::Scene;
use crate::explain::Explanation;
use crate::omnibus::{Omnibus, omnibus};
use crate::score::innovations;
use crate::search::{finish, sketch};
use crate::settings::Settings;
use crate::workers::Workers;

/// What is to be explained, and with what.
pub(crate) struct Attribution<'a, W> {
    pub(crate) campaign: &'a Campaign,
    pub(crate) settings: &'a Settings,
    pub(crate) nominal: &'a Explanation,
    pub(crate) workers: &'a W,
}

/// Share of the best gain that makes an effect promising, and how many are fitted to convergence at least.
const PROMISING: f64 = 0.15;
const FINISHED: usize = 4;
/// Laws of one effect fitted to convergence at most, and the share of its best gain that a further one needs.
const LAWS: usize = 2;
const LAW: f64 = 0.6;
/// Candidates whose knots are placed anew at most, and the share of the best gain that they need.
const REPLACED: usize = 4;
const RIVAL: f64 = 0.4;
/// First effects that a second one is looked for on top of, and pairs fitted to convergence on each.
const SEEDS: usize = 2;
const PAIRS: usize = 2;
/// Deviance that must be left before a second effect is looked for, and that it must gain: in all, and as a share of what
/// the first gained. Laws are never exact, so a little is always left that some other effect can take.
pub(crate) const SECOND: f64 = 150.0;
const SECOND_SHARE: f64 = 0.12;

impl<W: Workers> Attribution<'_, W> {
    /// Every effect on its own, best first.
    pub(crate) fn singles(&self) -> Vec<Explanation> {
        let mut singles = self.on_top_of(self.nominal, &self.settings.effects, FINISHED);
        if self.gain(singles.first()) > 0.5 * SIGNIFICANT {
            singles = self.knots_placed_anew(singles);
        }
        singles
    }

    /// The best pair of effects, where the best single one leaves much that a second explains.
    pub(crate) fn pair(&self, singles: &[Explanation], left: f64) -> Option<Explanation> {
        let first = singles.first()?;
        let others: Vec<Effect> =
            self.settings.effects.iter().copied().filter(|e| *e != Effect::BorderResolution).collect();
        let pairs = singles.iter().take(SEEDS).flat_map(|seed| {
            let rest: Vec<Effect> = others.iter().copied().filter(|e| *e != seed.parts[0].effect).collect();
            self.on_top_of(seed, &rest, PAIRS)
        });
        let pair = pairs.min_by(|x, y| x.bic().total_cmp(&y.bic()))?.with_knots_refined(self.campaign);
        let gained = first.bic() - pair.bic();
        let after = omnibus(self.campaign, &pair.fit).map_or(left, |o: Omnibus| o.excess());
        let share = gained / self.gain(Some(first)).max(1.0);
        (gained > SECOND && share > SECOND_SHARE && after < 0.3 * left).then_some(pair)
    }

    /// Penalised deviance gained over the nominal model.
    fn gain(&self, explanation: Option<&Explanation>) -> f64 {
        explanation.map_or(0.0, |e| self.nominal.bic() - e.bic())
    }

    /// Each effect added to what is known, best first: all looked at, the promising ones fitted to convergence.
    fn on_top_of(&self, known: &Explanation, effects: &[Effect], finished: usize) -> Vec<Explanation> {
        let w = innovations(self.campaign, &known.fit, |t| t.is_fit());
        let scene = Scene { campaign: self.campaign, fit: &known.fit, innovations: &w };
        let mut looks = self.workers.map(effects, |&effect| sketch(&scene, known, effect));
        looks.retain(|laws| !laws.is_empty());
        looks.sort_by(|x, y| x[0].bic().total_cmp(&y[0].bic()));
        let gain = |e: &Explanation| known.bic() - e.bic();
        let most = looks.first().map_or(0.0, |laws| gain(&laws[0]));
        let mut promising: Vec<Explanation> = Vec::new();
        let mut done: Vec<Explanation> = Vec::new();
        for (rank, laws) in looks.into_iter().enumerate() {
            let best = gain(&laws[0]);
            if rank < finished || best > PROMISING * most.max(SIGNIFICANT) {
                promising.extend(laws.into_iter().filter(|law| gain(law) >= LAW * best).take(LAWS));
            } else {
                done.extend(laws.into_iter().take(1));
            }
        }
        done.extend(self.workers.map(&promising, |law| finish(self.campaign, known, law)));
        done.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
        // Several laws of one effect: the best counts.
        let mut seen: Vec<Option<Effect>> = Vec::new();
        done.retain(|e| {
            let effect = e.parts.last().map(|p| p.effect);
            let new = !seen.contains(&effect);
            seen.push(effect);
            new
        });
        done
    }

    /// The nominal fit placed its knots with the effect's trace in the residual: the rivals get theirs anew.
    fn knots_placed_anew(&self, singles: Vec<Explanation>) -> Vec<Explanation> {
        let most = self.gain(singles.first());
        let numbered: Vec<(usize, Explanation)> = singles.into_iter().enumerate().collect();
        let mut out = self.workers.map(&numbered, |(rank, single)| {
            let rival = *rank < REPLACED && self.gain(Some(single)) > SIGNIFICANT.max(RIVAL * most);
            if rival && single.parts[0].effect != Effect::BorderResolution {
                single.clone().with_knots_refined(self.campaign)
            } else {
                single.clone()
            }
        });
        out.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
        out
    }
}
