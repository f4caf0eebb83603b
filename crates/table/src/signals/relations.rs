//! Which of several signals follow which, where no name says so.

use super::causality::{LOOKED_AT, Precedence, significant};
use super::derived::is_derived;
use super::guess;
use crate::table::Table;
use std::ops::Range;

/// Signals that are compared with each other, at most: their pairs grow with the square.
const MOST: usize = 40;
/// Signals that move slowly against their noise are compared once more as means of so many rows.
const SLOWER: usize = 10;
/// A relation by which an improvement is beyond doubt where another is not.
const STRONG: f64 = 0.3;
/// By how much one direction or pair must be better than another to be preferred.
const CLEARLY: f64 = 3.0;

/// How much the past of each of some signals improves the prediction of each other one.
pub(super) struct Relations {
    signals: Vec<usize>,
    /// Improvements, by the position of the signal that predicts and of the one that is predicted.
    gains: Vec<Vec<f64>>,
    /// What is beyond chance.
    least: f64,
    /// By position, whether a signal is computed from others.
    derived: Vec<bool>,
}

/// An input and an output that the data show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Pair {
    pub(super) input: usize,
    pub(super) output: usize,
    /// Other signals that take part, and may be meant instead.
    pub(super) others: Vec<usize>,
}

impl Relations {
    /// Of a piece of the table in which the signals move; none where there are too many of them or too few rows.
    pub(super) fn of(table: &Table, signals: &[usize]) -> Option<Self> {
        if signals.len() < 2 || signals.len() > MOST {
            return None;
        }
        let piece = liveliest(table, signals);
        let count = signals.len();
        let mut gains = vec![vec![0.0; count]; count];
        let mut fewest = usize::MAX;
        for a in 0..count {
            for b in a + 1..count {
                let both = together(table, [signals[a], signals[b]], piece.clone());
                let Some(precedence) = precedence(&both) else { continue };
                fewest = fewest.min(both[0].len());
                gains[a][b] = precedence.forward;
                gains[b][a] = precedence.backward;
            }
        }
        if fewest == usize::MAX {
            return None;
        }
        let (least, derived) = (significant(fewest), vec![false; count]);
        let mut relations = Self { signals: signals.to_vec(), gains, least, derived };
        relations.set_derived_apart(table, piece);
        Some(relations)
    }

    /// Leaves signals out that are computed from others, one after the other, as long as two are left.
    fn set_derived_apart(&mut self, table: &Table, piece: Range<usize>) {
        let column = |position: usize| &table.columns[self.signals[position]];
        let values = |position: usize| &column(position).values[piece.clone()];
        let positions = 0..self.signals.len();
        // A letter alone is the term of a controller beside another one only.
        let has_terms = positions.clone().filter(|position| guess::is_term(column(*position))).count() > 1;
        let is_named = |position: usize| {
            let column = column(position);
            guess::is_deviation(column) || has_terms && guess::is_term(column)
        };
        // What is called an error or is smaller than others is what was computed from them.
        let mut order: Vec<usize> = positions.collect();
        let rank = |k: usize| (!is_named(k), guess::quantity(column(k)) < guess::Quantity::Speed);
        order.sort_by(|a, b| {
            rank(*a).cmp(&rank(*b)).then(deviation(values(*a)).total_cmp(&deviation(values(*b))))
        });
        let mut derived = self.derived.clone();
        for position in order {
            let alive = self.connected(&derived);
            if alive.len() <= 2 {
                break;
            }
            let others: Vec<&[f64]> =
                alive.iter().filter(|other| **other != position).map(|other| values(*other)).collect();
            derived[position] =
                alive.contains(&position) && (is_named(position) || is_derived(values(position), &others));
        }
        if self.connected(&derived).len() >= 2 {
            self.derived = derived;
        }
    }

    /// Positions of the signals that predict another one or are predicted, but for some.
    fn connected(&self, but: &[bool]) -> Vec<usize> {
        let left = || (0..self.signals.len()).filter(|k| !but[*k]);
        let takes_part =
            |k: &usize| left().any(|other| self.gains[*k][other].max(self.gains[other][*k]) >= self.least);
        left().filter(takes_part).collect()
    }

    /// Positions of the connected signals that are not computed from others.
    fn alive(&self) -> Vec<usize> {
        self.connected(&self.derived)
    }

    /// Positions of all connected signals.
    fn all(&self) -> Vec<usize> {
        self.connected(&vec![false; self.signals.len()])
    }

    fn position(&self, signal: usize) -> Option<usize> {
        self.signals.iter().position(|known| *known == signal)
    }

    /// Signals that take part in what the data show.
    pub(super) fn moving_together(&self) -> Vec<usize> {
        self.all().into_iter().map(|position| self.signals[position]).collect()
    }

    /// The places that follow an input, where the output is none.
    pub(super) fn places_behind(&self, table: &Table, input: usize, output: usize) -> Vec<usize> {
        let Some(from) = self.position(input) else { return Vec::new() };
        let follows = |k: &usize| self.leads(from, *k);
        let is_place =
            |k: &usize| *k != output && guess::quantity(&table.columns[*k]) == guess::Quantity::Place;
        let behind = self.alive().into_iter().filter(follows).map(|k| self.signals[k]);
        behind.filter(is_place).collect()
    }

    /// Whether nothing in the data connects two signals, while others are clearly connected.
    pub(super) fn refutes(&self, a: usize, b: usize) -> bool {
        let (Some(a), Some(b)) = (self.position(a), self.position(b)) else { return false };
        let own = self.gains[a][b].max(self.gains[b][a]);
        let alive = self.alive();
        let between = || alive.iter().flat_map(|a| alive.iter().map(|b| self.gains[*a][*b]));
        own < self.least && between().any(|gain| gain >= STRONG.max(CLEARLY * self.least))
    }

    /// Whether the past of one of two signals says something of the other.
    pub(super) fn are_connected(&self, a: usize, b: usize) -> bool {
        let (Some(a), Some(b)) = (self.position(a), self.position(b)) else { return false };
        self.gains[a][b].max(self.gains[b][a]) >= self.least
    }

    /// Whether the past of `b` says much of `a`, and that of `a` nothing of `b`.
    pub(super) fn is_backward(&self, a: usize, b: usize) -> bool {
        let (Some(a), Some(b)) = (self.position(a), self.position(b)) else { return false };
        self.gains[a][b] < self.least && self.gains[b][a] >= STRONG.max(CLEARLY * self.least)
    }

    /// Whether the past of one signal improves the prediction of another, and more than the other way round.
    fn leads(&self, a: usize, b: usize) -> bool {
        let (forward, backward) = (self.gains[a][b], self.gains[b][a]);
        forward >= self.least && forward > CLEARLY * backward
    }

    /// The signal that all others follow, and the one that follows it as its response; none where several could be either.
    pub(super) fn pair(&self, table: &Table) -> Option<Pair> {
        let alive = self.alive();
        let by_order =
            |a: usize, b: usize| if self.gains[a][b] >= self.gains[b][a] { (a, b) } else { (b, a) };
        let (input, output) = match alive[..] {
            [] | [_] => return None,
            [a, b] => by_order(a, b),
            _ => {
                let is_led = |b: &usize| alive.iter().any(|a| self.leads(*a, *b));
                let mut first = alive.iter().copied().filter(|k| !is_led(k));
                let root = first.next().filter(|_| first.next().is_none());
                match root {
                    Some(root) => (root, self.response(table, root)?),
                    None => self.by_far()?,
                }
            }
        };
        Some(self.named(input, output))
    }

    /// What follows a signal that is known.
    pub(super) fn output_of(&self, table: &Table, input: usize) -> Option<Pair> {
        let input = self.position(input)?;
        Some(self.named(input, self.response(table, input)?))
    }

    /// What a signal that is known follows: the only one, or the one that leads all others that it follows.
    pub(super) fn input_of(&self, output: usize) -> Option<Pair> {
        let output = self.position(output)?;
        let led: Vec<usize> = self.alive().into_iter().filter(|k| self.leads(*k, output)).collect();
        let first = |k: &&usize| led.iter().all(|other| other == *k || self.leads(**k, *other));
        led.iter().find(first).map(|input| self.named(*input, output))
    }

    fn named(&self, input: usize, output: usize) -> Pair {
        let others = self.all().into_iter().filter(|k| *k != input && *k != output);
        Pair {
            input: self.signals[input],
            output: self.signals[output],
            others: others.map(|k| self.signals[k]).collect(),
        }
    }

    /// Of what follows a signal, that in its unit, else a place before a speed before a force or current, else what it predicts best; of some that
    /// are predicted about as well, the one that follows no other of them.
    fn response(&self, table: &Table, input: usize) -> Option<usize> {
        /// Share of the best improvement from which another one is about as good.
        const ABOUT: f64 = 0.7;
        let column = |position: usize| &table.columns[self.signals[position]];
        let unit = |position: usize| column(position).unit.as_ref();
        let gain = |k: &usize| self.gains[input][*k];
        let follows = |k: &usize| *k != input && gain(k) >= self.least && !self.leads(*k, input);
        let rank = |k: &usize| {
            let is_alike = unit(input).is_some() && unit(*k) == unit(input);
            (!is_alike, guess::quantity(column(*k)))
        };
        let mut following: Vec<usize> = self.alive().into_iter().filter(follows).collect();
        let first = following.iter().map(rank).min()?;
        following.retain(|k| rank(k) == first);
        let best = following.iter().map(gain).fold(0.0, f64::max);
        following.retain(|k| gain(k) >= ABOUT * best);
        let leads = |a: &usize, b: &usize| self.gains[*a][*b] > self.gains[*b][*a].max(self.least);
        let is_led = |k: &usize| following.iter().any(|other| leads(other, k));
        following.iter().copied().min_by(|a, b| is_led(a).cmp(&is_led(b)).then(gain(b).total_cmp(&gain(a))))
    }

    /// The pair whose one direction is better by far than all other pairs.
    fn by_far(&self) -> Option<(usize, usize)> {
        let alive = self.alive();
        let pairs = alive.iter().flat_map(|a| alive.iter().map(|b| (*a, *b))).filter(|(a, b)| a != b);
        let mut ranked: Vec<(f64, usize, usize)> = pairs.map(|(a, b)| (self.gains[a][b], a, b)).collect();
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (best, input, output) = *ranked.first()?;
        let next = ranked.iter().find(|(_, a, b)| (*a, *b) != (output, input) && (*a, *b) != (input, output));
        let is_clear = next.is_none_or(|(next, ..)| best > CLEARLY * next.max(self.least));
        (is_clear && self.leads(input, output)).then_some((input, output))
    }
}

/// What two signals say of each other, from row to row, or as means of some rows where they move slowly against their noise.
fn precedence(both: &[Vec<f64>; 2]) -> Option<Precedence> {
    let fine = Precedence::of(&both[0], &both[1])?;
    let strength = |found: &Precedence| found.forward.max(found.backward);
    if strength(&fine) >= STRONG {
        return Some(fine);
    }
    let [a, b] = [0, 1].map(|k| means(&both[k], SLOWER));
    let is_clearer =
        |slow: &Precedence| strength(slow) >= significant(a.len()).max(CLEARLY * strength(&fine));
    Some(Precedence::of(&a, &b).filter(is_clearer).unwrap_or(fine))
}

/// The rows in which the signals move most, as many as are looked at.
fn liveliest(table: &Table, signals: &[usize]) -> Range<usize> {
    /// Places that are tried.
    const TRIED: usize = 16;
    let rows = table.places.len();
    let values = |k: usize| &table.columns[k].values;
    let finite = |k: &usize| values(*k).iter().filter(|x| x.is_finite()).count().max(1);
    let fewest = signals.iter().map(finite).min().unwrap_or(rows).max(1);
    let len = (LOOKED_AT * (rows / fewest).clamp(1, 50)).min(rows);
    let starts = (0..TRIED).map(|k| k * (rows - len) / (TRIED - 1));
    let life = |start: usize| {
        let moved = |k: &usize| {
            let whole = deviation(values(*k));
            if whole > 0.0 { (deviation(&values(*k)[start..start + len]) / whole).min(1.0) } else { 0.0 }
        };
        signals.iter().map(moved).sum::<f64>()
    };
    let first = 0;
    if rows == len {
        return first..len;
    }
    let lively: Vec<(f64, usize)> = starts.map(|start| (life(start), start)).collect();
    let most = lively.iter().map(|(life, _)| *life).fold(0.0, f64::max);
    // The first that is nearly as good, so that a record that always moves is looked at from its beginning.
    let start = lively.iter().find(|(life, _)| *life >= 0.8 * most).map_or(0, |(_, start)| *start);
    start..start + len
}

/// Two signals at the rows of the one with fewer values, the other held between its own.
fn together(table: &Table, signals: [usize; 2], piece: Range<usize>) -> [Vec<f64>; 2] {
    let values = signals.map(|k| &table.columns[k].values[piece.clone()]);
    let [first, second] = values.map(|values| values.iter().filter(|x| x.is_finite()).count());
    let (at, of) = if first <= second { (0, 1) } else { (1, 0) };
    let mut both = [Vec::new(), Vec::new()];
    let mut last = f64::NAN;
    for (own, other) in values[at].iter().zip(values[of]) {
        last = if other.is_finite() { *other } else { last };
        if own.is_finite() && last.is_finite() {
            both[at].push(*own);
            both[of].push(last);
        }
    }
    both.map(|values| values.into_iter().take(LOOKED_AT).collect())
}

fn means(values: &[f64], every: usize) -> Vec<f64> {
    values.chunks_exact(every).map(|chunk| chunk.iter().sum::<f64>() / every as f64).collect()
}

/// The standard deviation of what was measured.
fn deviation(values: &[f64]) -> f64 {
    let finite = || values.iter().filter(|x| x.is_finite());
    let count = finite().count().max(1) as f64;
    let mean = finite().sum::<f64>() / count;
    (finite().map(|x| (x - mean).powi(2)).sum::<f64>() / count).sqrt()
}
