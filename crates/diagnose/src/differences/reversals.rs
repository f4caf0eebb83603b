//! Fits of systems on many knots, and with a law that moves reversals.

use switchback_identify::record::{Chord, Criterion, Effort, Stretch, fit};
use switchback_model::system::{Quantity, Scale, System};

/// Least moves tried, as shares of the median move of the input between samples: to report, to rank candidates, and in between.
const LEAST_MOVES: [f64; 3] = [1.0 / 512.0, 1.0 / 4.0, 1.0 / 64.0];
/// Share of the deviance that a move must gain, and most moves.
const LEAST_GAIN: f64 = 1e-3;
const MOST_MOVES: usize = 60;
/// Fit of everything else after such a move.
const AFTER_A_MOVE: Effort = Effort { iterations: 3, tolerance: 1e-3 };

/// The chord's part of a fit to the end.
const BEFORE_THE_END: Effort = Effort { iterations: 12, tolerance: 1e-5 };

/// [`fit`] with derivatives by knots taken at the start alone: knots are many, and the run is linear in them at any linear part. A fit to the end goes on from
/// there with all derivatives anew.
pub(super) fn fit_on_knots(
    start: &System,
    quantities: &[Quantity],
    stretches: &[Stretch],
    context: (&Criterion, &Scale),
    effort: Effort,
) -> (System, f64) {
    let (knots, others) = knots_and_others(quantities);
    if knots.is_empty() || others.is_empty() {
        return fit(start, quantities, stretches, context, effort);
    }
    let chord = Chord::of(start, &knots, stretches, context);
    if effort != Effort::FINAL {
        return chord.fit(start, &others, effort);
    }
    let (near, _) = chord.fit(start, &others, BEFORE_THE_END);
    fit(&near, quantities, stretches, context, effort)
}

fn knots_and_others(quantities: &[Quantity]) -> (Vec<Quantity>, Vec<Quantity>) {
    quantities.iter().partition(|q| matches!(q, Quantity::Knot(_)))
}

/// [`fit_on_knots`], and where a free quantity moves reversals a search by finite moves of it.
///
/// A play moves reversals by whole samples: the deviance is a sawtooth over it, and a derivative leads to the foot of the nearest tooth alone. Moves either
/// way, from that of the input between two samples on and halved where neither gains, each followed by a fit, cross the teeth: the pattern search of
/// R. Hooke, T. A. Jeeves, J. ACM 8 (1961), doi 10.1145/321062.321069.
pub(super) fn fit_across_reversals(
    start: &System,
    quantities: &[Quantity],
    stretches: &[Stretch],
    context: (&Criterion, &Scale),
    effort: Effort,
) -> (System, f64) {
    let (mut system, mut deviance) = fit_on_knots(start, quantities, stretches, context, effort);
    let scale = context.1;
    let precision = [Effort::FINAL, Effort::SEARCH].iter().position(|known| *known == effort).unwrap_or(2);
    let least_move = LEAST_MOVES[precision] * scale.speed;
    let (knots, others) = knots_and_others(quantities);
    for quantity in quantities.iter().filter(|q| moves_reversals(start, **q)) {
        let mut reach = scale.speed;
        let derivatives_at =
            |system: &System| (!knots.is_empty()).then(|| Chord::of(system, &knots, stretches, context));
        let mut chord = derivatives_at(&system);
        for _ in 0..MOST_MOVES {
            if reach < least_move {
                break;
            }
            let value = quantity.value(&system);
            let tried = [value - reach, value + reach].map(|value| quantity.set(&system, value));
            let sound = tried.iter().filter(|moved| moved.is_sound(scale));
            let fits = sound.map(|moved| match &chord {
                Some(chord) => chord.fit(moved, &others, AFTER_A_MOVE),
                None => fit(moved, quantities, stretches, context, AFTER_A_MOVE),
            });
            match fits.min_by(|x, y| x.1.total_cmp(&y.1)) {
                Some((best, least)) if least < (1.0 - LEAST_GAIN) * deviance => {
                    (system, deviance) = (best, least);
                    chord = derivatives_at(&system);
                }
                _ => reach *= 0.5,
            }
        }
        (system, deviance) = fit(&system, quantities, stretches, context, effort);
    }
    (system, deviance)
}

/// Fit of everything else at a value within an interval: a deviance as large as the samples are many is known far below the quantile.
const AT_A_VALUE: Effort = Effort { iterations: 5, tolerance: 1e-5 };

/// The quantile of χ² with one degree of freedom at 95 %, and the normal one.
const WITHIN: f64 = 3.84;
const Z95: f64 = 1.96;
/// Precision of the ends of an interval: as a share of the median move of the input between samples, and of the distance to the end.
const PRECISION: [f64; 2] = [1.0 / 1024.0, 1.0 / 32.0];

/// Estimate and standard error of a quantity that moves reversals: the middle of the values around the present one at which the profile deviance, all other free
/// quantities fitted again, lies within the quantile of χ² of the least, and half their range over the normal quantile. Between two teeth the deviance is nearly
/// flat, at each of them it jumps: a second derivative shows neither. Where its lower bound is among these values it is the estimate.
///
/// W. Q. Meeker, L. A. Escobar, The American Statistician 49 (1995), doi 10.1080/00031305.1995.10476112.
pub(super) fn profiled(
    system: &System,
    quantity: Quantity,
    free: &[Quantity],
    stretches: &[Stretch],
    context: (&Criterion, &Scale),
) -> (f64, f64) {
    let value = quantity.value(system);
    let others: Vec<Quantity> = free.iter().copied().filter(|q| *q != quantity).collect();
    let at = |value: f64| fit(&quantity.set(system, value), &others, stretches, context, AT_A_VALUE).1;
    let most = at(value) + WITHIN;
    let [precision, share] = PRECISION;
    let precision = precision * context.1.speed;
    let end = |side: f64| {
        let (mut inside, mut step) = (0.0, precision);
        let is_inside = |distance: f64| {
            let there = value + side * distance;
            there > 0.0 && at(there) <= most
        };
        while step < context.1.travel && is_inside(inside + step) {
            inside += step;
            step *= 2.0;
        }
        while step > f64::max(precision, share * inside) {
            step *= 0.5;
            inside += if is_inside(inside + step) { step } else { 0.0 };
        }
        value + side * (inside + 0.5 * step)
    };
    let (low, high) = (end(-1.0), end(1.0));
    if low <= precision && at(0.0) <= most {
        return (0.0, high / Z95);
    }
    (0.5 * (low + high), 0.5 * (high - low) / Z95)
}

/// Whether a quantity is one of a law that moves reversals.
pub(super) fn moves_reversals(system: &System, quantity: Quantity) -> bool {
    match quantity {
        Quantity::Value(term, _) => system.terms[term].law.moves_reversals(),
        _ => false,
    }
}
