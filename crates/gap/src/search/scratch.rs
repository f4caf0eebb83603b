//! An effect with the dynamics identified anew.
//!
//! Where an effect rules the input, or the errors, the nominal `A` and `B` are those of another system: a pole of `A` stands for a lag
//! before the plant, or for errors that last; and no step leads from there to the right one.

use super::{RACE, Task, ahead, finish};
use crate::assembly::{Assembly, EquationColumn};
use crate::effect::Effect;
use crate::effects::{Scene, Variant, variants};
use crate::engine::Ground;
use crate::explain::{Explanation, Part, assembled};
use crate::knots::first_grid;
use crate::nominal::first_guess;
use crate::starts::Known;

/// An effect that may rule what the dynamics are identified from, everything identified anew with it. The knots of what is known
/// may follow the effect's trace, or a jump that is there: an even grid is tried beside them.
pub(crate) fn from_scratch(known: &Known<'_>, effect: Effect) -> Option<Explanation> {
    let (campaign, fit) = (known.campaign, &known.explanation.fit);
    let scene = Scene { campaign, fit, innovations: &known.innovations };
    let grids = [first_grid(campaign), fit.grid.clone()];
    let tried = |(number, law): (usize, Variant)| {
        let parts = vec![Part::of(effect, (number, &law))];
        let build = |values: &[f64]| assembled(&parts, values);
        let fits = grids.iter().filter_map(|grid| {
            let task = Task { ground: Ground { campaign, grid, known: None }, build: &build, held: 0 };
            let guessed = law.starts.iter().filter_map(|own| {
                let assembly = task.assembly(own);
                let rules = may_rule(&assembly);
                let start =
                    rules.then(|| first_guess(campaign, grid, fit.linear.a.len(), &assembly).ok())??;
                task.held(own, &start, 1)
            });
            ahead(guessed, |fit| task.from(fit).together(&fit.own, &fit.linear, RACE))
        });
        let explained =
            fits.map(|fit| Explanation { parts: parts.clone(), fit, set_back: 0.0, held_out: 0.0 });
        explained.min_by(|x, y| x.bic().total_cmp(&y.bic()))
    };
    let laws = variants(effect, &scene).into_iter().enumerate();
    let best = laws.filter_map(tried).min_by(|x, y| x.bic().total_cmp(&y.bic()))?;
    Some(finish(campaign, 0, &best))
}

/// Whether what an assembly adds may rule the input or the errors: columns beside the borders, a loop that closes, a slow lag, a
/// delay, errors that last, a line.
fn may_rule(assembly: &Assembly) -> bool {
    /// A polynomial's value at one, below which its slowest root is slow.
    const SLOW: f64 = 0.25;
    let closes = assembly.wear.as_ref().is_some_and(|wear| wear.coefficients.iter().any(|c| *c != 0.0));
    let lag: f64 = assembly.denominator.iter().sum();
    let lags = assembly.denominator.len() > 1 && lag < SLOW;
    let lasts = 1.0 + assembly.noise.ar.iter().sum::<f64>() < SLOW;
    let rings = assembly.equation_columns.iter().any(|c| matches!(c, EquationColumn::Line { .. }));
    let delays = assembly.delay > 0.0;
    !assembly.border_columns.is_empty() || closes || lags || delays || lasts || rings
}
