//! An effect with the dynamics identified anew.
//!
//! Where an effect rules the input, or the errors, the nominal `A` and `B` are those of another system: a pole of `A` stands for a lag
//! before the plant, or for errors that last; and no step leads from there to the right one.

use super::{Task, advance, finish};
use crate::attribution::explain::{EffectTerm, Hypothesis, assembled};
use crate::attribution::starts::Known;
use crate::effect::Effect;
use crate::effects::{Scene, Variant};
use crate::likelihood::design::Design;
use crate::likelihood::engine::{FitContext, NonlinearParameter};
use crate::model::augmented::{AugmentedModel, EquationColumn, Slow};
use crate::model::borders::Grid;
use crate::nominal::identify::first_guess;
use crate::nominal::knots::first_grid;

/// Starts, over all laws and both grids, that go on after the first round.
const RACED: usize = 4;

/// An effect that may rule what the dynamics are identified from, on top of what is known, everything identified anew with it: of
/// known effects the nonlinear parameters alone are taken over. The knots of what is known may follow the effect's trace, or a jump that is
/// there: an even grid is tried beside them.
pub(crate) fn reidentified(known: &Known<'_>, effect: Effect) -> Option<Hypothesis> {
    let (dataset, fit) = (known.dataset, &known.hypothesis.fit);
    let scene = Scene { dataset, fit, innovations: &known.innovations };
    let grids = [first_grid(dataset), fit.grid.clone()];
    let laws = (effect.card().laws)(&scene);
    // Where the likelihood has corners, a start that is a little off shows nothing about the rest.
    let smooth = laws.iter().enumerate().filter(|(_, law)| !law.search.is_by_pattern());
    let asked = smooth.flat_map(|law| grids.iter().map(move |grid| (law, grid)));
    let guessed = asked.flat_map(|((number, law), grid)| {
        let mut effect_terms = known.hypothesis.effect_terms.clone();
        effect_terms.push(EffectTerm::of(effect, (number, law)));
        let joined = |nonlinear: &Vec<NonlinearParameter>| {
            fit.nonlinear.iter().chain(nonlinear).copied().collect::<Vec<NonlinearParameter>>()
        };
        let starts = one_of_each_valley(law).into_iter().chain(&law.afresh).map(joined);
        starts
            .filter_map(move |nonlinear| guessed(known, &effect_terms, grid, &nonlinear))
            .collect::<Vec<_>>()
    });
    let mut field: Vec<Hypothesis> = guessed.collect();
    field.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
    let firsts = first_of_each_law(&field, |law| !laws[law].afresh.is_empty());
    let refined: Vec<Hypothesis> =
        firsts.into_iter().take(REFINED).map(|sketch| refined(known, sketch)).collect();
    field.extend(refined);
    field.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
    let mut raced: Vec<Hypothesis> =
        field.iter().take(RACED).map(|sketch| advance(dataset, 0, sketch)).collect();
    raced.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
    let finished = raced.iter().map(|sketch| finish(dataset, 0, sketch).named_by_its_signs());
    finished.into_iter().find(Hypothesis::is_sound)
}

/// The middle start of every valley; all starts where none are known.
fn one_of_each_valley(law: &Variant) -> Vec<&Vec<NonlinearParameter>> {
    let Some(valley) = law.valley else { return law.starts.iter().collect() };
    let groups = law.starts.chunk_by(|one, next| valley(one) == valley(next));
    groups.map(|group| &group[group.len() / 2]).collect()
}

/// The first sketch of every law that is asked for.
fn first_of_each_law(field: &[Hypothesis], is_asked: impl Fn(usize) -> bool) -> Vec<&Hypothesis> {
    let added = |sketch: &Hypothesis| sketch.effect_terms.last().map_or(0, |effect_term| effect_term.law.1);
    let mut firsts: Vec<&Hypothesis> = Vec::new();
    for sketch in field {
        let law = added(sketch);
        if is_asked(law) && firsts.iter().all(|first| added(first) != law) {
            firsts.push(sketch);
        }
    }
    firsts
}

/// Laws of which the likeliest sketch is refined, and by how many of its small steps a parameter is moved.
const REFINED: usize = 3;
const STEPS: [f64; 3] = [100.0, 50.0, 25.0];

/// Nonlinear parameters moved one at a time, everything else identified anew each time: where `A` takes a drift for a slow pole unless
/// nearly all of it is reported, no joint step leads to the right one.
fn refined(known: &Known<'_>, sketch: &Hypothesis) -> Hypothesis {
    let moved = |from: &Hypothesis, j: usize, steps: f64| {
        let mut nonlinear = from.fit.nonlinear.clone();
        let o = &mut nonlinear[j];
        o.value = (o.value + steps * o.step).clamp(o.low, o.high);
        guessed(known, &sketch.effect_terms, &sketch.fit.grid, &nonlinear)
    };
    let mut best = sketch.clone();
    for (steps, j) in
        STEPS.into_iter().flat_map(|steps| (0..sketch.fit.nonlinear.len()).map(move |j| (steps, j)))
    {
        let both = [-steps, steps].into_iter().filter_map(|steps| moved(&best, j, steps));
        if let Some(better) = both.into_iter().find(|moved| moved.bic() < best.bic()) {
            best = better;
        }
    }
    best
}

/// What a law explains at a start of its nonlinear parameters, the rest identified anew: none where it rules nothing there.
fn guessed(
    known: &Known<'_>,
    effect_terms: &[EffectTerm],
    grid: &Grid,
    nonlinear: &[NonlinearParameter],
) -> Option<Hypothesis> {
    let dataset = known.dataset;
    let build = |values: &[f64]| assembled(effect_terms, values);
    let values: Vec<f64> = nonlinear.iter().map(|o| o.value).collect();
    let augmented = Some(build(&values)).filter(may_rule)?;
    let design = Design::like(Some(known.hypothesis.fit.near()), dataset, grid, &augmented);
    let start = first_guess(&design, known.hypothesis.fit.linear.a.len()).ok()?;
    let task = Task { context: FitContext { dataset, grid, known: Some(&design) }, build: &build, fixed: 0 };
    let fit = task.fixed(nonlinear, &start, 1)?.set_aside(known.hypothesis.fit.near());
    let set_back = known.hypothesis.set_back;
    Some(Hypothesis { effect_terms: effect_terms.to_vec(), fit, set_back, held_out: 0.0 })
        .filter(Hypothesis::is_sound)
}

/// Whether what an augmented model adds may rule the input or the errors: columns beside the borders, a loop that closes, a gain that
/// changes, a slow lag, a delay, errors that last, a line, a trend, a zero of each record.
fn may_rule(augmented: &AugmentedModel) -> bool {
    /// A polynomial's value at one, below which its slowest root is slow.
    const SLOW: f64 = 0.25;
    let closes = augmented.wear.as_ref().is_some_and(Slow::changes);
    let changes = augmented.gain.as_ref().is_some_and(Slow::changes);
    let lag: f64 = augmented.denominator.iter().sum();
    let lags = augmented.denominator.len() > 1 && lag < SLOW;
    let lasts = 1.0 + augmented.noise.ar.iter().sum::<f64>() < SLOW;
    let of_time = |c: &EquationColumn| {
        matches!(
            c,
            EquationColumn::Line { .. } | EquationColumn::Trend { .. } | EquationColumn::Offset { .. }
        )
    };
    let follows_time = augmented.equation_columns.iter().any(of_time);
    let delays = augmented.delay > 0.0;
    !augmented.border_columns.is_empty() || closes || changes || lags || delays || lasts || follows_time
}
