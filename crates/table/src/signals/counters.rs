//! Signals as counters hold them: angles that wrap, signs in a bit, magnitudes beside a sign.

use super::select::Selection;
use crate::table::{Column, Table};

/// Sizes of a turn in degrees and radians, and of encoders and counters. Smaller ones are also those of commands that go back to zero.
const PERIODS: [f64; 8] = [360.0, std::f64::consts::TAU, 1024.0, 2048.0, 4096.0, 8192.0, 16_384.0, 65_536.0];
/// Bits in which devices keep a sign.
const SIGN_BITS: [u32; 6] = [7, 10, 11, 15, 23, 31];

/// Brings the input, the output and a prediction to what they mean, and says so.
pub(super) fn repair(table: &mut Table, selection: &Selection) -> Vec<String> {
    let signals = [Some(selection.input), selection.output, selection.prediction];
    let mut notes = Vec::new();
    for k in signals.into_iter().flatten() {
        let found = signed(&mut table.columns[k]).or_else(|| unwrapped(&mut table.columns[k]));
        notes.extend(found.or_else(|| with_sign(table, k)));
    }
    notes
}

fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Takes signs out of a bit: below it lie the positive numbers, and far from them the negative ones.
fn signed(column: &mut Column) -> Option<String> {
    let values = || column.values.iter().copied().filter(|value| value.is_finite());
    if !values().all(|value| value.fract() == 0.0 && value >= 0.0) {
        return None;
    }
    let (low, high) = ends(values());
    let found = SIGN_BITS.iter().find_map(|bit| {
        let half = f64::from(2.0_f32.powi(*bit as i32));
        let (_, positive) = ends(values().filter(|value| *value < half));
        let (least, _) = ends(values().filter(|value| *value >= half));
        // Both are small numbers; all between is empty, and one step leads from one to the other near zero.
        let is_far = |least: f64, gap: f64| low < 0.25 * half && gap > 0.5 * half && least.is_finite();
        if is_far(positive, half - positive) && high < 1.5 * half && least < 1.25 * half {
            return Some((*bit, half, false));
        }
        let whole = 2.0 * half;
        (is_far(positive, least - positive) && high < whole && high > 0.98 * whole)
            .then_some((*bit, half, true))
    });
    let (bit, half, is_complement) = found?;
    let size = |value: f64| match (value >= half, is_complement) {
        (false, _) => value,
        (true, true) => 2.0 * half - value,
        (true, false) => value - half,
    };
    if !is_continuous(&values().collect::<Vec<_>>(), half, size) {
        return None;
    }
    let label = column.label();
    let negative = column.values.iter().filter(|value| **value >= half).count();
    for value in column.values.iter_mut().filter(|value| **value >= half) {
        *value = if is_complement { *value - 2.0 * half } else { half - *value };
    }
    let what = if is_complement {
        format!("is a two's complement of {} bits", bit + 1)
    } else {
        format!("has its sign in bit {bit} ({half})")
    };
    Some(format!("`{label}` {what}: {negative} values are negative"))
}

/// Whether numbers of both signs are many, and small where the sign turns: two levels of a command are neither.
fn is_continuous(values: &[f64], half: f64, size: impl Fn(f64) -> f64) -> bool {
    const LEAST: usize = 4;
    let several = |is_negative: bool| {
        let mut sizes: Vec<u64> =
            values.iter().filter(|x| (**x >= half) == is_negative).map(|x| size(*x) as u64).collect();
        sizes.sort_unstable();
        sizes.dedup();
        sizes.len() >= LEAST
    };
    let (_, most) = ends(values.iter().map(|x| size(*x)));
    let turns = values.windows(2).filter(|pair| (pair[0] >= half) != (pair[1] >= half));
    let (near, all) = turns.fold((0, 0), |(near, all), pair| {
        (near + usize::from(size(pair[0]).min(size(pair[1])) <= 0.25 * most), all + 1)
    });
    several(true) && several(false) && 10 * near >= 9 * all
}

/// Continues an angle or counter over its ends.
fn unwrapped(column: &mut Column) -> Option<String> {
    let values: Vec<f64> = column.values.iter().copied().filter(|value| value.is_finite()).collect();
    let (low, high) = ends(values.iter().copied());
    let (period, wraps) =
        PERIODS.iter().find_map(|period| Some((*period, wraps(&values, (low, high), *period)?)))?;
    let label = column.label();
    let (mut turns, mut before) = (0.0, f64::NAN);
    for value in column.values.iter_mut().filter(|value| value.is_finite()) {
        let step = *value - before;
        turns -= if step.abs() > 0.5 * period { step.signum() } else { 0.0 };
        before = *value;
        *value += turns * period;
    }
    let shown = if period == std::f64::consts::TAU { "2π".to_owned() } else { period.to_string() };
    Some(format!("`{label}` wraps at {shown}, {wraps} times, and is continued there"))
}

/// How often values wrap at a period: they fill it from end to end, jump from one end to the other, and move by little elsewhere.
fn wraps(values: &[f64], (low, high): (f64, f64), period: f64) -> Option<usize> {
    /// Share of the period within which both ends are met, and that other steps stay below.
    const NEAR: f64 = 0.1;
    let from_zero = low >= 0.0 && low < NEAR * period && high <= period && high > (1.0 - NEAR) * period;
    let about_zero = low >= -0.5 * period
        && low < (NEAR - 0.5) * period
        && high <= 0.5 * period
        && high > (0.5 - NEAR) * period;
    if !from_zero && !about_zero {
        return None;
    }
    let steps = || values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let jumps = steps().filter(|step| *step > 0.5 * period).count();
    let others = steps().filter(|step| *step <= 0.5 * period).fold(0.0, f64::max);
    let least = steps().filter(|step| *step > 0.5 * period).fold(f64::INFINITY, f64::min);
    let is_clear = least > period - others.max(NEAR * period) - NEAR * period && others < 0.4 * period;
    let moves = steps().filter(|step| (f64::MIN_POSITIVE..=0.5 * period).contains(step)).count();
    (jumps >= 2 && moves > jumps && is_clear && 20 * jumps < values.len()).then_some(jumps)
}

/// Words for a negative sign, in lower case.
const NEGATIVE: [&str; 18] = [
    "-",
    "n",
    "neg",
    "negative",
    "minus",
    "d",
    "discharge",
    "discharging",
    "down",
    "rev",
    "reverse",
    "ccw",
    "l",
    "left",
    "out",
    "backward",
    "back",
    "b",
];

/// Gives a magnitude the sign that another column says in words: it turns where the magnitude is near zero.
fn with_sign(table: &mut Table, signal: usize) -> Option<String> {
    let values = &table.columns[signal].values;
    let (low, high) = ends(values.iter().copied());
    if low < 0.0 || low > 0.1 * high || high <= 0.0 {
        return None;
    }
    let (sign, minus) = table.columns.iter().find_map(|column| {
        let ([first, second], true) = (&column.words[..], column.codes.len() == values.len()) else {
            return None;
        };
        let turns: Vec<usize> = (1..values.len())
            .filter(|&row| {
                column.codes[row] != column.codes[row - 1]
                    && column.codes[row] > 0
                    && column.codes[row - 1] > 0
            })
            .collect();
        let at_turns: Vec<f64> = turns.iter().map(|&row| values[row].min(values[row - 1])).collect();
        let near = at_turns.iter().filter(|value| **value <= 0.1 * high).count();
        let reaches = |code: u8| {
            let own = values.iter().zip(&column.codes).filter(|(_, other)| **other == code);
            ends(own.map(|(value, _)| *value)).1 > 0.3 * high
        };
        let is_sign = turns.len() >= 2 && 20 * near >= 19 * turns.len() && reaches(1) && reaches(2);
        let is_negative = |word: &str| NEGATIVE.contains(&word.to_lowercase().as_str());
        let minus = if is_negative(first) && !is_negative(second) { 1 } else { 2 };
        is_sign.then_some((column.clone(), minus))
    })?;
    let column = &mut table.columns[signal];
    for (value, code) in column.values.iter_mut().zip(&sign.codes) {
        *value *= if *code == minus { -1.0 } else { 1.0 };
    }
    let words = [&sign.words[usize::from(minus) - 1], &sign.words[2 - usize::from(minus)]];
    Some(format!(
        "`{}` is a magnitude, and `{}` its sign: `{}` is taken as negative, `{}` as positive",
        column.label(),
        sign.label(),
        words[0],
        words[1]
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::empty_column;

    fn column(values: Vec<f64>) -> Column {
        Column { values, ..empty_column("x".to_owned(), None) }
    }

    fn swing() -> Vec<f64> {
        (0..2000).map(|k| 300.0 * (0.01 * f64::from(k)).sin()).collect()
    }

    #[test]
    fn wraps_are_continued_and_nothing_else_is() {
        for period in [360.0, std::f64::consts::TAU, 4096.0] {
            let angle: Vec<f64> = swing().iter().map(|x| x / 200.0 * period).collect();
            for low in [0.0, -0.5 * period] {
                let mut wrapped = column(angle.iter().map(|x| (x - low).rem_euclid(period) + low).collect());
                assert!(unwrapped(&mut wrapped).is_some(), "{period}");
                let off = wrapped.values[0] - angle[0];
                assert!(wrapped.values.iter().zip(&angle).all(|(found, x)| (found - x - off).abs() < 1e-9));
            }
        }
        for plain in [swing(), (0..2000).map(|k| if k % 40 < 20 { 0.0 } else { 360.0 }).collect()] {
            assert_eq!(unwrapped(&mut column(plain)), None);
        }
    }

    #[test]
    fn signs_are_taken_out_of_bits() {
        let whole: Vec<f64> = swing().iter().map(|x| x.round()).collect();
        for bit in [10, 15] {
            let half = f64::from(2.0_f32.powi(bit));
            let size = 0.5 * half / 600.0;
            let scaled: Vec<f64> = whole.iter().map(|x| (x * size.min(1.0)).round()).collect();
            let mut magnitude = column(scaled.iter().map(|x| if *x < 0.0 { half - x } else { *x }).collect());
            assert!(signed(&mut magnitude).is_some_and(|note| note.contains("sign in bit")));
            assert_eq!(magnitude.values, scaled);
            let mut complement = column(scaled.iter().map(|x| x.rem_euclid(2.0 * half)).collect());
            assert!(signed(&mut complement).is_some_and(|note| note.contains("two's complement")));
            assert_eq!(complement.values, scaled);
        }
        assert_eq!(signed(&mut column((0..500).map(f64::from).collect())), None);
    }
}
