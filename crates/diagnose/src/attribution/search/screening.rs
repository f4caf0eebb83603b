//! A cheap screening of every effect that may explain more.

use super::candidate_laws::{CandidateLaw, are_tested, candidate_laws, keep_likeliest};
use super::{Question, screen};
use crate::attribution::SIGNIFICANT;
use crate::attribution::explain::Hypothesis;
use crate::attribution::starts::Known;
use crate::effect::Effect;
use crate::workers::Workers;

/// One effect after a cheap screening: its laws, likeliest first, and the penalised deviance that the likeliest gains.
pub(crate) struct Screened {
    pub(crate) effect: Effect,
    pub(crate) gain: f64,
    pub(crate) laws: Vec<Hypothesis>,
}

/// Second effects screened beside a first, the most promising by the score test.
const SECONDS: usize = 6;
/// Share of the best score below which one start of an effect's likeliest law is screened, and the least score that shows so.
const HOPELESS: f64 = 0.1;
const TELLING: f64 = 10.0 * SIGNIFICANT;

/// The laws of one effect.
struct Entry {
    effect: Effect,
    /// The likeliest first.
    laws: Vec<CandidateLaw>,
}

impl Entry {
    /// The best score; unknown where the test is blind to a law.
    fn score(&self) -> Option<f64> {
        let scores: Option<Vec<f64>> = self.laws.iter().map(|law| law.score).collect();
        scores?.into_iter().max_by(f64::total_cmp)
    }

    /// One start of the likeliest law.
    fn shortened(mut self) -> Self {
        self.laws.truncate(1);
        self.laws.iter_mut().for_each(CandidateLaw::shorten);
        self
    }
}

/// Each effect screened, the most promising first. The score test orders and shortens; it rules out only seconds, far behind.
pub(crate) fn screened(workers: &impl Workers, known: &Known<'_>, questions: &[Question]) -> Vec<Screened> {
    let mut entries = tested(workers, known, questions);
    if !known.hypothesis.effect_terms.is_empty() {
        keep_promising(&mut entries);
    }
    // Of filters the test knows little where the dynamics are not solved for again, as in simulations.
    if !known.dataset.criterion.simulates() {
        entries = shortened_where_hopeless(entries);
    }
    let laws: Vec<(Effect, CandidateLaw)> = entries
        .into_iter()
        .flat_map(|entry| entry.laws.into_iter().map(move |law| (entry.effect, law)))
        .collect();
    let screened_laws = workers.map(&laws, |(_, law)| screen(known, law));
    let mut screened: Vec<Screened> = Vec::new();
    for ((effect, _), law) in laws.iter().zip(screened_laws) {
        let Some(law) = law else { continue };
        let gain = known.hypothesis.bic() - law.bic();
        match screened.iter_mut().find(|entry| entry.effect == *effect) {
            Some(entry) => {
                entry.gain = entry.gain.max(gain);
                entry.laws.push(law);
            }
            None => screened.push(Screened { effect: *effect, gain, laws: vec![law] }),
        }
    }
    for entry in &mut screened {
        entry.laws.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
    }
    screened.sort_by(|x, y| y.gain.total_cmp(&x.gain));
    screened
}

/// The laws of every effect that the records do not rule out, each with its likeliest starts.
fn tested(workers: &impl Workers, known: &Known<'_>, questions: &[Question]) -> Vec<Entry> {
    let mut laws = workers.map(questions, |question| candidate_laws(known, question));
    if let Some(test) = known.test() {
        let asked: Vec<&CandidateLaw> = laws.iter().filter(|laws| are_tested(laws)).flatten().collect();
        let mut found = workers.map(&asked, |law| law.tested(&test)).into_iter();
        for laws in laws.iter_mut().filter(|laws| are_tested(laws)) {
            laws.iter_mut().zip(&mut found).for_each(|(law, tested)| law.keep(tested));
            keep_likeliest(laws);
        }
    }
    let entries = questions.iter().zip(laws).map(|(question, laws)| Entry { effect: question.effect, laws });
    entries.filter(|entry| !entry.laws.is_empty()).collect()
}

/// Keeps the few most promising effects, and those that the test is blind to.
fn keep_promising(entries: &mut Vec<Entry>) {
    let score = |entry: &Entry| entry.score().unwrap_or(f64::INFINITY);
    entries.sort_by(|x, y| score(y).total_cmp(&score(x)));
    let blind = entries.iter().filter(|entry| entry.score().is_none()).count();
    entries.truncate(blind + SECONDS);
}

/// Shortens the entries of effects that score far below the best one.
fn shortened_where_hopeless(entries: Vec<Entry>) -> Vec<Entry> {
    let best = entries.iter().filter_map(Entry::score).fold(0.0, f64::max);
    let is_hopeless = |entry: &Entry| best > TELLING && entry.score().is_some_and(|s| s < HOPELESS * best);
    entries.into_iter().map(|entry| if is_hopeless(&entry) { entry.shortened() } else { entry }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::engine::{FitContext, fit};
    use crate::model::augmented::AugmentedModel;
    use crate::testing::{small_dataset, small_model};

    #[test]
    fn what_scores_far_below_the_best_gets_one_start_of_one_law() {
        let (dataset, grid) = small_dataset();
        let context = FitContext { dataset: &dataset, grid: &grid, known: None };
        let nominal =
            fit(context, &|_| AugmentedModel::default(), &[], &small_model(&grid), 10).expect("a fit");
        let nominal = Hypothesis::nominal(nominal);
        let known = Known::new(&dataset, &nominal);
        let shortened = |scores: [Option<f64>; 2]| {
            let effects = [Effect::Backlash, Effect::Stribeck];
            let entries = effects.into_iter().zip(scores).map(|(effect, score)| {
                let mut laws = candidate_laws(&known, &Question::open(effect));
                assert!(laws.len() > 1 && laws[0].law.starts.len() > 1);
                laws.iter_mut().for_each(|law| law.score = score);
                Entry { effect, laws }
            });
            let is_short = |entry: &Entry| entry.laws.len() == 1 && entry.laws[0].law.starts.len() == 1;
            shortened_where_hopeless(entries.collect()).iter().map(is_short).collect::<Vec<bool>>()
        };
        assert_eq!(shortened([Some(9000.0), Some(800.0)]), [false, true]);
        assert_eq!(shortened([Some(9000.0), Some(1000.0)]), [false, false]);
        // Where nothing scores much, and where the test is blind, nothing is reported.
        assert_eq!(shortened([Some(300.0), Some(1.0)]), [false, false]);
        assert_eq!(shortened([Some(9000.0), None]), [false, false]);
    }
}
