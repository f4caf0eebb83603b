//! The staircase on observers whose curves are known.

use super::*;
use crate::examination::uniform;

/// Guess rate of all observers.
const GUESS: f64 = 0.01;

/// Runs a staircase on an observer; the sizes reached are up to a third off the ones asked for.
fn observed(found_at: impl Fn(f64) -> f64, draws: usize, seed: u64) -> (Conclusion, usize) {
    let mut staircase = Staircase::new(GUESS);
    for k in 0..draws {
        let conclusion = staircase.conclusion();
        if conclusion.is_settled() {
            return (conclusion, k);
        }
        let off = 0.6 * (uniform(seed, 2 * k as u64) - 0.5);
        let size = (staircase.next_size() * off.exp()).min(LARGEST);
        staircase.push(size, uniform(seed, 2 * k as u64 + 1) < found_at(size));
    }
    (staircase.conclusion(), draws)
}

/// An observer drawn from the prior, off the nodes of the grid.
fn drawn(seed: u64) -> Psychometric {
    let uniform = |k: u64| uniform(seed, 1_000 + k);
    let between = |low: f64, high: f64, k: u64| low * (high / low).powf(uniform(k));
    let lapse = if uniform(3) < 0.5 { 0.1 * uniform(4) } else { 0.1 + 0.9 * uniform(4) };
    Psychometric { threshold: between(0.25, 8.0, 1), slope: between(2.0, 10.0, 2), lapse, guess: GUESS }
}

/// Mean, and how many there are.
fn mean(values: &[f64]) -> (f64, usize) {
    (values.iter().sum::<f64>() / values.len() as f64, values.len())
}

/// The oracle: over observers of all kinds, fresh faults at the size stated are found nine times in ten, and the interval holds the size
/// that is wanted as often as it says.
#[test]
fn what_is_stated_holds_for_observers_of_all_kinds() {
    for draws in [6, 16] {
        let (mut rates, mut covered, mut beyond) = (Vec::new(), Vec::new(), Vec::new());
        for seed in 0..300 {
            let observer = drawn(seed);
            let (conclusion, _) = observed(|size| observer.found(size), draws, seed);
            rates.extend(conclusion.size.map(|size| observer.found(size)));
            let wanted = observer.size_for(SHARE).filter(|size| *size <= LARGEST).unwrap_or(f64::INFINITY);
            // The grid knows a threshold to half a step of a quarter octave.
            let [low, high] = [conclusion.interval[0] / 1.09, conclusion.interval[1] * 1.09];
            covered.push(f64::from(u8::from((low..=high).contains(&wanted))));
            if conclusion.is_beyond() {
                beyond.push(f64::from(u8::from(wanted.is_infinite())));
            }
        }
        let ((rate, stated), (coverage, _), (right, never)) = (mean(&rates), mean(&covered), mean(&beyond));
        assert!(stated >= 30 && never >= 60, "{draws} draws: {stated} sizes, {never} beyond");
        assert!((0.87..=0.93).contains(&rate), "{draws} draws: {rate} found at {stated} sizes stated");
        assert!((0.87..=0.99).contains(&coverage), "{draws} draws: {coverage} covered");
        assert!(right >= 0.93, "{draws} draws: {right} of {never} beyond");
    }
}

/// Mean found rate at the size stated, over runs on one observer, and the share of runs that state one.
fn rate_at_stated(found_at: impl Fn(f64) -> f64, draws: usize) -> (f64, f64) {
    let runs = 60;
    let stated = (0..runs).filter_map(|seed| observed(&found_at, draws, 77 + seed).0.size);
    let rates: Vec<f64> = stated.map(&found_at).collect();
    let (rate, count) = mean(&rates);
    (rate, count as f64 / runs as f64)
}

#[test]
fn what_is_stated_holds_for_each_of_several_observers() {
    let of = |threshold, slope, lapse| Psychometric { threshold, slope, lapse, guess: GUESS };
    for observer in [of(2.0, 4.0, 0.02), of(1.0, 2.0, 0.0), of(3.0, 8.0, 0.05), of(0.5, 3.0, 0.01)] {
        let (rate, often) = rate_at_stated(|size| observer.found(size), 30);
        assert!((0.85..=0.97).contains(&rate) && often > 0.6, "{observer:?}: {rate}, stated in {often}");
    }
}

/// An effect of two laws, one found from a third of the size of the other, is no logistic curve.
#[test]
fn what_is_stated_holds_for_an_effect_of_two_laws() {
    let one = Psychometric { threshold: 1.0, slope: 5.0, lapse: 0.02, guess: GUESS };
    let other = Psychometric { threshold: 3.0, ..one };
    let (rate, often) = rate_at_stated(|size| 0.5 * (one.found(size) + other.found(size)), 30);
    assert!((0.85..=0.97).contains(&rate) && often > 0.6, "{rate}, stated in {often}");
}

#[test]
fn what_is_never_found_is_reported_so_after_a_few_draws() {
    let often_missed = Psychometric { threshold: 1.0, slope: 4.0, lapse: 0.9, guess: GUESS };
    let runs: Vec<_> = (0..40).map(|seed| observed(|s| often_missed.found(s), 24, seed)).collect();
    assert!(runs.iter().all(|(conclusion, _)| conclusion.is_beyond() && conclusion.size.is_none()));
    let draws: Vec<f64> = runs.iter().map(|(_, draws)| *draws as f64).collect();
    assert!(mean(&draws).0 < 6.0, "{draws:?}");
}

/// Of 20 that were all missed, fewer than one in seven are found: 0.86²⁰ = 0.05; without a prior that is the bound.
#[test]
fn how_often_a_fault_is_found_at_most_is_bounded_by_the_draws() {
    let mut staircase = Staircase::new(GUESS);
    assert!(staircase.found_at_most(LARGEST) > 0.97);
    (0..20).for_each(|_| staircase.push(LARGEST, false));
    let most = staircase.found_at_most(LARGEST);
    assert!((0.05..0.16).contains(&most), "{most}");
    assert!(staircase.found_at_most(1.0) <= most);
    assert!(staircase.beyond(LARGEST) > 0.99 && staircase.beyond(1.0) >= staircase.beyond(LARGEST));
}

#[test]
fn more_draws_make_the_interval_narrower() {
    let observer = Psychometric { threshold: 2.0, slope: 6.0, lapse: 0.0, guess: GUESS };
    let width = |draws: usize| {
        let mut staircase = Staircase::new(GUESS);
        for k in 0..draws {
            let size = staircase.next_size();
            staircase.push(size, uniform(5, k as u64) < observer.found(size));
        }
        let [low, high] = staircase.conclusion().interval;
        (high.min(100.0) / low).ln()
    };
    let [few, more, many] = [6, 30, 120].map(width);
    assert!(many < more && more < few, "{few} {more} {many}");
}

#[test]
fn nothing_is_stated_before_the_first_draw() {
    let staircase = Staircase::new(GUESS);
    let prior = staircase.conclusion();
    assert!(prior.size.is_none() && !prior.is_settled() && !prior.is_beyond());
    // Half of all effects have a lapse that allows nine in ten; not all of these reach it by the largest size.
    assert!((0.5..0.7).contains(&prior.beyond), "{}", prior.beyond);
    assert!(SIZES[1..SIZES.len() - 1].contains(&staircase.next_size()));
}

/// A posterior by hand: three curves left of the grid, one answer.
#[test]
fn an_answer_weighs_by_its_likelihood() {
    let mut staircase = Staircase::new(0.0);
    let before = staircase.weights.clone();
    staircase.push(2.0, true);
    let evidence: f64 = staircase.nodes.iter().zip(&before).map(|(n, w)| w * n.curve.found(2.0)).sum();
    for k in [0, 700, 1_469] {
        let expected = before[k] * staircase.nodes[k].curve.found(2.0) / evidence;
        assert!((staircase.weights[k] - expected).abs() < 1e-15);
    }
    assert!((staircase.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
}
