//! The weights by which likelihoods of fits join a posterior's probabilities (`posterior::Weights`):
//!
//! `cargo run --example likelihoods -- SEED COUNT`: makes so many rigs of which eight in ten have an effect, one nothing and one an effect that is in no
//! library, diagnoses them, and maximises the likelihood of their causes.

#![allow(clippy::disallowed_methods, reason = "an example reads its arguments")]

use miette::{IntoDiagnostic, miette};
use rayon::prelude::*;
use std::fmt::Write;
use std::process::ExitCode;
use switchback_diagnose::posterior::{Likelihoods, Probabilities, Weights};
use switchback_diagnose::{Effect, Model, Settings, diagnose};
use switchback_io::output::{note, print};
use switchback_lab::generate::{EFFECTS, FOREIGN, MakeRig, RequestedFault, laws_of};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            note(&format!("error: {error}\n"));
            ExitCode::from(2)
        }
    }
}

fn run() -> miette::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [seed, count] = &words[..] else { return Err(miette!("give SEED COUNT")) };
    let (seed, count): (u64, u64) = (seed.parse().into_diagnostic()?, count.parse().into_diagnostic()?);
    let examples: Vec<Example> =
        (0..count).into_par_iter().filter_map(|number| Example::of(seed, number)).collect();
    print(&table(&examples))
}

/// What was put into a rig.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Truth {
    Effect(Effect),
    Nothing,
    Foreign,
}

/// A diagnosis and the truth.
struct Example {
    truth: Truth,
    likelihoods: Likelihoods,
}

/// Surviving sizes, in standard deviations of the noise, which take turns.
const SIZES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

impl Example {
    /// Of the rig of a number; none where no model joins likelihoods.
    fn of(seed: u64, number: u64) -> Option<Self> {
        let (turn, place) = (number as usize / 10, number as usize % 10);
        let size = SIZES[(turn + place) % SIZES.len()];
        let of = |names: &[&str], k: usize| {
            let name = names[k % names.len()];
            let law = k / names.len() % laws_of(name).len();
            RequestedFault::with_law(name, law, size).ok()
        };
        let recipe = MakeRig::new(seed.wrapping_mul(1_000_003).wrapping_add(number));
        let (recipe, truth) = match place {
            8 => (recipe, Truth::Nothing),
            9 => (recipe.with(of(&FOREIGN, turn)?), Truth::Foreign),
            _ => {
                let k = 8 * turn + place;
                let effect = Effect::from_name(EFFECTS[k % EFFECTS.len()])?;
                (recipe.with(of(&EFFECTS, k)?), Truth::Effect(effect))
            }
        };
        let rig = recipe.make().ok()?.rig;
        let diagnosis = diagnose(&rig, Model::Identify, &Settings::default()).ok()?;
        Some(Self { truth, likelihoods: diagnosis.classification?.likelihoods? })
    }

    fn probability(&self, after: &Probabilities) -> f64 {
        match self.truth {
            Truth::Nothing => after.none,
            Truth::Foreign => {
                after.none_of_these
                    + after.causes.iter().filter(|(e, _)| e.is_none()).map(|(_, p)| p).sum::<f64>()
            }
            Truth::Effect(effect) => {
                after.causes.iter().filter(|(e, _)| *e == Some(effect)).map(|(_, p)| p).sum()
            }
        }
    }

    fn log_score(&self, weights: &Weights) -> f64 {
        self.probability(&self.likelihoods.joined(weights)).max(LEAST).ln()
    }

    /// Whether an effect is as likely as a name asks for, and whether it is true.
    fn named(&self, weights: &Weights) -> Option<bool> {
        let after = self.likelihoods.joined(weights);
        let (effect, p) = after.causes.iter().max_by(|x, y| x.1.total_cmp(&y.1))?;
        (*p >= NAMED).then(|| effect.is_some_and(|effect| self.truth == Truth::Effect(effect)))
    }
}

const LEAST: f64 = 1e-9;
const NAMED: f64 = 0.95;

fn table(examples: &[Example]) -> String {
    let total = |weights: &Weights| examples.iter().map(|example| example.log_score(weights)).sum::<f64>();
    let mut all = Vec::new();
    for temper in [0.05, 0.1, 0.2, 0.4, 0.8, 1.6] {
        for complexity in [0.0, 4.0, 8.0, 12.0, 16.0, 24.0] {
            for doubt in [0.01, 0.02, 0.03, 0.04, 0.05, 0.07, 0.1] {
                for refuted in [0.1, 0.3, 0.5, 0.7, 0.9] {
                    let weights = Weights { temper, complexity, doubt, refuted };
                    all.push((weights, total(&weights)));
                }
            }
        }
    }
    let (best, most) = all.iter().copied().max_by(|x, y| x.1.total_cmp(&y.1)).expect("a grid has points");
    // Twice the logarithm of the likelihood ratio is χ² with one degree of freedom.
    let near: Vec<Weights> =
        all.iter().filter(|(_, log)| 2.0 * (most - log) < 3.84).map(|(weights, _)| *weights).collect();
    let each = |w: &Weights| [w.temper, w.complexity, w.doubt, w.refuted];
    let n = examples.len().max(1) as f64;
    let mut out = String::new();
    let before: f64 =
        examples.iter().map(|e| e.probability(&e.likelihoods.before).max(LEAST).ln()).sum::<f64>() / n;
    let _ = writeln!(out, "{} diagnoses; log score before the fits {before:.3}", examples.len());
    for (k, name) in ["temper", "complexity", "doubt", "refuted"].into_iter().enumerate() {
        let values = near.iter().map(|w| each(w)[k]);
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let _ = writeln!(out, "{name:<11}{:>6} [{low}, {high}]", each(&best)[k]);
    }
    let program = Weights::FITTED;
    let _ = writeln!(
        out,
        "log score with these {:.3}, with those of the program {:.3}",
        most / n,
        total(&program) / n
    );
    for (words, weights) in [("these", best), ("those of the program", program)] {
        let named: Vec<bool> = examples.iter().filter_map(|example| example.named(&weights)).collect();
        let right = named.iter().filter(|is_true| **is_true).count();
        let effects = examples.iter().filter(|e| matches!(e.truth, Truth::Effect(_))).count();
        let _ = writeln!(
            out,
            "with {words} {right} of {effects} effects are named, and {} names are wrong",
            named.len() - right
        );
    }
    out
}
