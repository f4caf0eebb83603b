//! What the draws of an effect come to.

use super::staircase::is_certain;
use super::{Answer, Conclusion, Draw, LARGEST, Search};
use crate::examination::Reply;
use crate::generate::InjectedFault;
use std::collections::BTreeMap;

/// What is known of one effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The effect.
    pub effect: &'static str,
    /// Its draws, in order.
    pub draws: Vec<Draw>,
    /// What they say, whatever was reached.
    pub conclusion: Conclusion,
    /// The probability that at the largest size that was reached less than nine in ten are found.
    pub beyond_reached: f64,
    /// The probability that the next fault of that size is found.
    pub found_next: f64,
    /// What share is found there at most, with a probability of 0.95.
    pub found_at_most: f64,
    /// Diagnoses of records without any fault that show it.
    pub without_fault: usize,
}

/// From which size on an effect is found.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// From this size on nine in ten are found.
    From(f64),
    /// Up to this size they are not.
    NotUpTo(f64),
    /// The draws do not show.
    Undecided,
    /// None was put in, for this reason.
    NotInjected(String),
}

/// How often an effect was answered as what.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Answers {
    /// By its name.
    pub named: usize,
    /// In a class or a shortlist.
    pub in_class: usize,
    /// All draws that were diagnosed.
    pub of: usize,
}

impl Answers {
    /// By name, or in a class or a shortlist.
    pub(crate) fn found(self) -> usize {
        self.named + self.in_class
    }
}

impl Finding {
    pub(super) fn of(search: &Search, bare: &[Reply]) -> Self {
        let (draws, staircase) = (search.draws.clone(), &search.staircase);
        let reached = diagnosed(&draws).map(|(fault, _)| fault.size).fold(0.0, f64::max).min(LARGEST);
        Self {
            effect: search.effect,
            draws,
            conclusion: staircase.conclusion(),
            beyond_reached: staircase.beyond(reached),
            found_next: staircase.predicted(reached),
            found_at_most: staircase.found_at_most(reached),
            without_fault: bare.iter().filter(|reply| reply.listed().contains(&search.effect)).count(),
        }
    }

    /// Every fault that was put in, with what was said.
    pub fn diagnosed(&self) -> impl Iterator<Item = (&InjectedFault, &Answer)> {
        diagnosed(&self.draws)
    }

    /// Largest size that was reached; 0 where nothing was put in.
    pub(crate) fn reached(&self) -> f64 {
        self.diagnosed().map(|(fault, _)| fault.size).fold(0.0, f64::max)
    }

    /// From which size on it is found. What laws and records did not reach is not said anything of.
    pub fn outcome(&self) -> Outcome {
        let reached = self.reached();
        let last_refusal = self.draws.iter().rev().find_map(|draw| match draw {
            Draw::Refused(reason) => Some(reason.clone()),
            Draw::Diagnosed { .. } => None,
        });
        match (self.conclusion.size, last_refusal) {
            (_, Some(reason)) if reached == 0.0 => Outcome::NotInjected(reason),
            (Some(size), _) if size <= reached => Outcome::From(size),
            _ if is_certain(self.beyond_reached) => Outcome::NotUpTo(LARGEST.min(reached)),
            _ => Outcome::Undecided,
        }
    }

    /// Answers to faults with a size in `[low, high)`.
    pub(crate) fn answers(&self, low: f64, high: f64) -> Answers {
        let mut answers = Answers::default();
        for (_, answer) in self.diagnosed().filter(|(fault, _)| (low..high).contains(&fault.size)) {
            answers.of += 1;
            match answer {
                Answer::Named => answers.named += 1,
                Answer::InClass => answers.in_class += 1,
                Answer::Other(_) => {}
            }
        }
        answers
    }

    /// The commonest answer to faults that were missed, and how often it was given; of equals the first by name.
    pub(crate) fn instead(&self) -> Option<(&str, usize)> {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for (_, answer) in self.diagnosed() {
            if let Answer::Other(reported) = answer {
                *counts.entry(reported).or_default() += 1;
            }
        }
        counts.into_iter().rev().max_by_key(|(_, count)| *count)
    }

    /// The fault whose size is closest to one, as a ratio.
    pub(crate) fn closest_to(&self, size: f64) -> Option<&InjectedFault> {
        let off = |fault: &InjectedFault| (fault.size / size).ln().abs();
        self.diagnosed().map(|(fault, _)| fault).min_by(|x, y| off(x).total_cmp(&off(y)))
    }
}

fn diagnosed(draws: &[Draw]) -> impl Iterator<Item = (&InjectedFault, &Answer)> {
    draws.iter().filter_map(|draw| match draw {
        Draw::Diagnosed { fault, answer } => Some((fault, answer)),
        Draw::Refused(_) => None,
    })
}
