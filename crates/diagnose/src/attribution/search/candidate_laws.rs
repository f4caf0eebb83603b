//! Laws that may explain more, and where a search for them begins.

use super::question::Question;
use crate::attribution::explain::{EffectTerm, assembled};
use crate::attribution::starts::{Known, Score, ScoreTest};
use crate::effects::{Scene, Variant};
use crate::likelihood::engine::NonlinearParameter;

/// One law of an effect added to what is known, and how promising it is.
pub(super) struct CandidateLaw {
    pub(super) law: Variant,
    /// What is known, then the law.
    pub(super) effect_terms: Vec<EffectTerm>,
    /// Gain in deviance at its best start by the score test; unknown where the test is blind to the law.
    pub(super) score: Option<f64>,
}

/// Starts of a law that are fitted, likeliest first by the score test.
const STARTS: usize = 5;
/// Laws of an effect that are screened, and the share of the best one's score that a further one needs.
const LAWS: usize = 4;
const LAW: f64 = 0.4;

/// The laws of one more effect on top of what is known, not tested yet. Empty where the records rule the effect out.
pub(super) fn candidate_laws(known: &Known<'_>, question: &Question) -> Vec<CandidateLaw> {
    let scene = Scene { dataset: known.dataset, fit: &known.hypothesis.fit, innovations: &known.innovations };
    ((question.effect.card().laws)(&scene).into_iter().enumerate())
        .filter_map(|(number, law)| Some((number, question.narrowed(number, law)?)))
        .map(|(number, law)| {
            let mut effect_terms = known.hypothesis.effect_terms.clone();
            effect_terms.push(EffectTerm::of(question.effect, (number, &law)));
            CandidateLaw { law, effect_terms, score: None }
        })
        .collect()
}

/// Whether the score test shows anything of an effect: a law of the noise moves weights, or far more than a chord can show; and a grid
/// is no start.
pub(super) fn are_tested(laws: &[CandidateLaw]) -> bool {
    laws.iter().all(|p| {
        p.law.grid.is_none() && p.effect_terms.last().is_none_or(|effect_term| !effect_term.effect.is_noise())
    })
}

/// Keeps the likeliest laws of one effect, the likeliest first.
pub(super) fn keep_likeliest(laws: &mut Vec<CandidateLaw>) {
    let score = |p: &CandidateLaw| p.score.unwrap_or(0.0);
    laws.sort_by(|x, y| score(y).total_cmp(&score(x)));
    let least = LAW * laws.first().map_or(0.0, score);
    laws.retain(|p| score(p) >= least);
    laws.truncate(LAWS);
}

/// What the score test says of a law.
pub(super) struct Tested {
    score: Option<f64>,
    /// The likeliest first.
    starts: Vec<Vec<NonlinearParameter>>,
}

impl CandidateLaw {
    /// The likeliest starts: by the test, and by what is left where a filter moves poles.
    pub(super) fn tested(&self, test: &ScoreTest<'_>) -> Tested {
        let build = |values: &[f64]| assembled(&self.effect_terms, values);
        let mut scored: Vec<(Score, Vec<NonlinearParameter>)> = self
            .law
            .starts
            .iter()
            .map(|nonlinear| (test.score(&build, nonlinear), nonlinear.clone()))
            .collect();
        let score = scored.iter().map(|(score, _)| score.most()).max_by(f64::total_cmp);
        if let Some(valley) = self.law.valley {
            let alone = |score: &Score| score.refitted.unwrap_or(score.linear);
            scored.sort_by(|x, y| alone(&y.0).total_cmp(&alone(&x.0)));
            let mut seen = Vec::new();
            scored.retain(|(_, nonlinear)| {
                let new = !seen.contains(&valley(nonlinear));
                seen.push(valley(nonlinear));
                new
            });
        }
        scored.sort_by(|x, y| y.0.linear.total_cmp(&x.0.linear));
        if scored.len() > STARTS && scored.iter().all(|(score, _)| score.refitted.is_some()) {
            // The best by the test, then the best of the others by what is left.
            scored[1..].sort_by(|x, y| y.0.refitted.unwrap_or(0.0).total_cmp(&x.0.refitted.unwrap_or(0.0)));
            scored.truncate(STARTS + 1);
        } else {
            scored.truncate(STARTS);
        }
        Tested { score, starts: scored.into_iter().map(|s| s.1).collect() }
    }

    /// Takes over what the test said.
    pub(super) fn keep(&mut self, tested: Tested) {
        self.score = tested.score;
        self.law.climbs = self.law.climbs.min(tested.starts.len());
        self.law.starts = tested.starts;
    }

    /// Keeps the likeliest start alone.
    pub(super) fn shorten(&mut self) {
        self.law.climbs = self.law.climbs.min(1);
        self.law.starts.truncate(1);
    }
}
