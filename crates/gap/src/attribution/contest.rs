//! Which effects explain what the nominal model misses: a cheap look at every law, then the promising ones to
//! convergence, border knots placed anew, and a second effect where the first leaves much.

use crate::attribution::SIGNIFICANT;
use crate::attribution::explain::Explanation;
use crate::attribution::search::{Question, advance, finish, from_scratch, looks};
use crate::attribution::starts::Known;
use crate::effect::Effect;
use crate::nominal::knots::detail;
use crate::records::campaign::Campaign;
use crate::settings::Settings;
use crate::workers::Workers;

/// What is to be explained, and with what.
pub(crate) struct Attribution<'a, W> {
    pub(crate) campaign: &'a Campaign,
    pub(crate) settings: &'a Settings,
    pub(crate) nominal: &'a Explanation,
    /// The nominal model with border knots placed from the data: what effects are added to.
    pub(crate) detailed: &'a Explanation,
    pub(crate) workers: &'a W,
}

/// How many effects are fitted to convergence at least as far as their looks go, and the penalised deviance found elsewhere that
/// the winner has to beat to be of any use.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Contest {
    pub(crate) finished: usize,
    pub(crate) to_beat: Option<f64>,
}

/// Share of the best gain that makes an effect promising, and how many are fitted to convergence at least.
const PROMISING: f64 = 0.15;
const FINISHED: usize = 4;
/// Laws of one effect fitted to convergence at most, and the share of its best gain that a further one needs.
const LAWS: usize = 2;
const LAW: f64 = 0.6;
/// How far behind the leader, as a share of its gain and in penalised deviance at least, a law goes on to convergence.
const BEHIND: f64 = 0.3;
const NEAR: f64 = 100.0;
/// As many times what its first rounds gained a law may be behind and still go on.
const STRIDES: f64 = 3.0;
/// Candidates whose knots are placed anew at most where none follows a detail, and the share of the best gain that they need.
const REPLACED: usize = 3;
const RIVAL: f64 = 0.85;
/// Share of an effect's gain that details of the borders gain without it, from which it rides on them.
const RIDES: f64 = 0.9;

impl<W: Workers> Attribution<'_, W> {
    /// Every effect on its own, best first.
    pub(crate) fn singles(&self) -> Vec<Explanation> {
        let all: Vec<Question> = self.settings.effects.iter().map(|e| Question::open(*e)).collect();
        let mut singles = self.on_top_of(self.detailed, &all, Contest { finished: FINISHED, to_beat: None });
        if self.settings.consider_details() {
            self.compare_with_detail(&mut singles);
        }
        if self.gain(singles.first()) > 0.5 * SIGNIFICANT {
            singles = self.knots_placed_anew(singles);
        }
        singles
    }

    /// Effects that may rule the input or the errors, with the dynamics identified anew: those that come near the best of the
    /// singles.
    pub(crate) fn rulers_from_scratch(&self, singles: &[Explanation]) -> Vec<Explanation> {
        let known = Known::new(self.campaign, self.detailed);
        let asked: Vec<Effect> = self.rulers().collect();
        let found = self.workers.map(&asked, |effect| from_scratch(&known, *effect));
        let found: Vec<Explanation> = found.into_iter().flatten().filter(|s| self.considers(s)).collect();
        let most = found.iter().chain(singles).map(|s| self.gain(Some(s))).fold(0.0, f64::max);
        let rivals = found.into_iter().filter(|s| self.gain(Some(s)) > RIVAL * most).collect::<Vec<_>>();
        self.workers.map(&rivals, |single| self.placed_anew(single.clone()))
    }

    /// The effects considered that may leave nothing of what the dynamics are identified from: friction that rises or falls fast, a loop
    /// that closes, a gain that changes, a slow lag before the plant, errors that last, a line, a trend; and a delay, of which `B` takes
    /// whole samples.
    pub(crate) fn rulers(&self) -> impl Iterator<Item = Effect> {
        let considered = |e: &Effect| self.settings.effects.contains(e);
        Effect::ALL.into_iter().filter(|e| e.card().rules_dynamics).filter(considered)
    }

    /// Knots placed from the data are themselves the explanation that the grid was too coarse.
    fn compare_with_detail(&self, singles: &mut Vec<Explanation>) {
        let known = Explanation::detailed(self.detailed.fit.clone());
        let found = singles.iter_mut().find(|s| s.parts[0].effect.card().lies_in_the_grid);
        match found {
            Some(finer) if finer.bic() <= known.bic() => {}
            Some(finer) => *finer = known,
            None => singles.push(known),
        }
        singles.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
    }

    /// Whether all effects of an explanation are to be considered, each once: signs may have given a law the name of another.
    pub(crate) fn considers(&self, explanation: &Explanation) -> bool {
        let effects = explanation.effects();
        let is_new = |(number, effect): (usize, &Effect)| !effects[..number].contains(effect);
        effects.iter().all(|e| self.settings.effects.contains(e)) && effects.iter().enumerate().all(is_new)
    }

    /// Penalised deviance gained over the nominal model.
    pub(crate) fn gain(&self, explanation: Option<&Explanation>) -> f64 {
        explanation.map_or(0.0, |e| self.nominal.bic() - e.bic())
    }

    /// Each effect added to what is known, best first: all looked at, the promising ones fitted to convergence.
    pub(crate) fn on_top_of(
        &self,
        known: &Explanation,
        questions: &[Question],
        contest: Contest,
    ) -> Vec<Explanation> {
        let looks = looks(self.workers, &Known::new(self.campaign, known), questions);
        let gain = |e: &Explanation| known.bic() - e.bic();
        let most = looks.first().map_or(0.0, |look| look.gain);
        let mut promising: Vec<(Effect, Explanation)> = Vec::new();
        let mut done: Vec<(Effect, Explanation)> = Vec::new();
        let mut twins: Vec<Effect> = Vec::new();
        for (rank, look) in looks.into_iter().enumerate() {
            // A look may miss a narrow optimum: no twin of a promising effect is ruled out by it.
            let worth = rank < contest.finished
                || known.parts.is_empty()
                    && (look.gain > PROMISING * most.max(SIGNIFICANT) || twins.contains(&look.effect));
            if worth && look.gain > SIGNIFICANT {
                twins.extend(look.effect.twins());
            }
            let least = look.gain - (1.0 - LAW) * look.gain.abs();
            let laws = look.laws.into_iter().filter(|law| gain(law) >= least).take(LAWS);
            let laws = laws.map(|law| (look.effect, law));
            if worth { promising.extend(laws) } else { done.extend(laws.take(1)) }
        }
        done.extend(self.raced(known, &promising, contest.to_beat));
        let named = done.into_iter().map(|(asked, law)| (asked, law.named_by_its_signs()));
        let mut done: Vec<(Effect, Explanation)> =
            named.filter(|(_, law)| law.is_sound() && self.considers(law)).collect();
        done.sort_by(|x, y| x.1.bic().total_cmp(&y.1.bic()));
        // Several laws of one effect: the best counts. Alone, the best of each family of laws does: signs may give two families one
        // name, and held-out records choose between them.
        let is_alone = known.parts.is_empty();
        let mut seen: Vec<(Option<Effect>, Option<Effect>)> = Vec::new();
        done.retain(|(asked, law)| {
            let key = (is_alone.then_some(*asked), law.parts.last().map(|part| part.effect));
            let new = key.1.is_some() && !seen.contains(&key);
            seen.push(key);
            new
        });
        done.into_iter().map(|(_, e)| e).collect()
    }

    /// Some rounds for every law, then convergence for those that may still win, also against what was found elsewhere.
    fn raced(
        &self,
        known: &Explanation,
        promising: &[(Effect, Explanation)],
        to_beat: Option<f64>,
    ) -> Vec<(Effect, Explanation)> {
        let held = known.fit.own.len();
        let mut field: Vec<&(Effect, Explanation)> = promising.iter().collect();
        // The longest first, so that nobody waits for them at the end.
        field.sort_by_key(|(_, law)| !law.has_corners());
        let mut race: Vec<Runner> = self.workers.map(&field, |(effect, sketch)| {
            let law = advance(self.campaign, held, sketch);
            Runner { effect: *effect, advanced: sketch.bic() - law.bic(), law }
        });
        race.sort_by(|x, y| x.law.bic().total_cmp(&y.law.bic()));
        let Some(leader) = race.first() else { return Vec::new() };
        let reach = (BEHIND * (known.bic() - leader.law.bic())).max(NEAR);
        let ahead = leader.law.bic().min(to_beat.unwrap_or(f64::INFINITY));
        let near = |runner: &Runner| runner.law.bic() - ahead < reach.max(STRIDES * runner.advanced);
        let leads = near(leader);
        self.workers.map(&race, |runner| {
            let may_win = near(runner) || leads && leader.effect.twins().contains(&runner.effect);
            let law = if may_win { finish(self.campaign, held, &runner.law) } else { runner.law.clone() };
            (runner.effect, law)
        })
    }

    /// The nominal fit placed its knots with the effect's trace in the residual: the rivals get theirs anew.
    ///
    /// Where details of the borders matter beside an effect, the effect alone is the one on an even grid.
    fn knots_placed_anew(&self, singles: Vec<Explanation>) -> Vec<Explanation> {
        let most = self.gain(singles.first());
        // Where knots follow a detail, every effect has what they gain.
        let replaced = if self.has_details() { singles.len() } else { REPLACED };
        let numbered: Vec<(usize, Explanation)> = singles.into_iter().enumerate().collect();
        let mut out = self.workers.map(&numbered, |(rank, single)| {
            let is_grid = single.parts[0].effect.card().lies_in_the_grid;
            let rival = *rank < replaced && self.gain(Some(single)) > SIGNIFICANT.max(RIVAL * most);
            match (is_grid, rival) {
                (true, _) => single.clone(),
                (false, true) => self.placed_anew(single.clone()),
                (false, false) if self.has_details() => single.clone().set_back(SIGNIFICANT),
                (false, false) => single.clone(),
            }
        });
        out.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
        out
    }

    /// Whether the nominal model lacks details of the borders.
    fn has_details(&self) -> bool {
        self.nominal.fit.grid != self.detailed.fit.grid
    }

    /// An effect alone, border knots placed anew: none follow details, which are an effect of their own.
    fn placed_anew(&self, single: Explanation) -> Explanation {
        self.without_details(single.with_knots_refined(self.campaign))
    }

    /// Border knots placed anew, and none that follow details where those are no candidate.
    pub(crate) fn knots_refined(&self, explanation: Explanation) -> Explanation {
        match self.settings.consider_details() {
            true => explanation.with_knots_refined(self.campaign),
            false => self.placed_anew(explanation),
        }
    }

    /// The explanation on an even grid, where the details that its knots follow are material.
    pub(crate) fn without_details(&self, single: Explanation) -> Explanation {
        match self.evenly(&single) {
            Some(even) if even.bic() - single.bic() > detail(self.campaign) => even,
            _ => single,
        }
    }

    /// The explanation on an even grid: a smooth one where the effect gains little that details of the borders do not. Elsewhere
    /// smooth borders may seem rough because the own parameters are a little off.
    fn evenly(&self, single: &Explanation) -> Option<Explanation> {
        let even = single.on_an_even_grid(self.campaign)?;
        let gained_by_details = self.gain(Some(self.detailed));
        match gained_by_details > RIDES * self.gain(Some(&even)) {
            true => single.on_a_smooth_grid(self.campaign),
            false => Some(even),
        }
    }
}

/// A law after its first rounds.
struct Runner {
    effect: Effect,
    law: Explanation,
    /// Penalised deviance that the first rounds gained.
    advanced: f64,
}
