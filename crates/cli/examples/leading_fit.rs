//! The coefficients by which a fit that leads joins a posterior's probabilities (`LeadingFit`):
//!
//! `cargo run --example leading_fit -- RIGS SEED COUNT`: draws so many rigs of the training population on the measured rigs of a folder, diagnoses
//! them, and maximises the likelihood of their causes: of those without a given model by the fits, of the others by the differences.

#![allow(clippy::disallowed_methods, reason = "an example reads its arguments")]

use miette::{IntoDiagnostic, miette};
use rayon::prelude::*;
use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;
use switchback_diagnose::posterior::{Classification, LeadingFit, Posterior};
use switchback_diagnose::{Model, Settings, diagnose};
use switchback_io::output::{note, print};
use switchback_lab::examination::measured_rigs;
use switchback_lab::population::{MeasuredBases, TrainingRig, draw};

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
    let [rigs, seed, count] = &words[..] else { return Err(miette!("give RIGS SEED COUNT")) };
    let (seed, count): (u64, u64) = (seed.parse().into_diagnostic()?, count.parse().into_diagnostic()?);
    let (bases, _) = MeasuredBases::identified(measured_rigs(Path::new(rigs))?);
    let drawn = (0..count).into_par_iter().filter_map(|number| draw(seed, number, &bases));
    let examples: Vec<Example> = drawn.filter_map(|rig| Example::of(&rig)).collect();
    let (given, own): (Vec<Example>, Vec<Example>) =
        examples.into_iter().partition(|example| example.is_given);
    print(&format!(
        "without a model\n{}\nbeside a model\n{}",
        table(&own, LeadingFit::OF_FITS),
        table(&given, LeadingFit::OF_DIFFERENCES)
    ))
}

/// What is known of a diagnosis: probabilities by evidence alone.
struct Example {
    /// Whether a model was given.
    is_given: bool,
    /// That of everything which is true of the rig.
    right: f64,
    /// The fit that leads, and whether its effect is true.
    leading: Option<(LeadingFit, bool)>,
}

impl Example {
    /// Of a rig whose records nobody designed.
    fn of(rig: &TrainingRig) -> Option<Self> {
        let model = if rig.is_given { Model::Predicted } else { Model::Identify };
        let classification = diagnose(&rig.rig, model, &Settings::default()).ok()?.classification?;
        let outcome = rig.outcome(rig.surviving_size())?;
        let names = rig.true_names();
        let is_true =
            |name: &str| name == outcome || outcome != Posterior::NONE_OF_THESE && names.contains(&name);
        let by_evidence = before(&classification);
        let right = by_evidence.iter().filter(|(name, _)| is_true(name)).map(|(_, p)| p).sum();
        let leading = classification.leading.map(|leading| (leading, is_true(leading.effect.name())));
        Some(Self { is_given: rig.is_given, right, leading })
    }

    /// The logarithm of the probability of what is true, by some coefficients.
    fn log_score(&self, coefficients: [f64; 2]) -> f64 {
        let Some((leading, is_true)) = &self.leading else { return self.right.max(LEAST).ln() };
        let leading = LeadingFit { coefficients, ..*leading };
        let more = leading.by_evidence * (leading.weight() - 1.0);
        let right = self.right + if *is_true { more } else { 0.0 };
        (right / (1.0 + more)).max(LEAST).ln()
    }
}

const LEAST: f64 = 1e-9;

/// All outcomes as they were before the fit joined them.
fn before(classification: &Classification) -> Vec<(&str, f64)> {
    let weight = classification.leading.map_or(1.0, |leading| leading.weight());
    let sum = classification.leading.map_or(1.0, |leading| 1.0 + leading.by_evidence * (weight - 1.0));
    let causes = classification.causes.iter().map(|cause| {
        let leads = classification.leading.is_some_and(|leading| Some(leading.effect) == cause.effect);
        (cause.name.as_str(), cause.probability * sum / if leads { weight } else { 1.0 })
    });
    let rest = [
        (Posterior::NOTHING, classification.none * sum),
        (Posterior::NONE_OF_THESE, classification.none_of_these * sum),
    ];
    causes.chain(rest).collect()
}

fn table(examples: &[Example], coefficients: [f64; 2]) -> String {
    let total = |coefficients| examples.iter().map(|example| example.log_score(coefficients)).sum::<f64>();
    let grid = |to: f64, step: f64| (0..=(to / step) as usize).map(move |k| k as f64 * step);
    let all: Vec<([f64; 2], f64)> = grid(16.0, 0.5)
        .flat_map(|beta| [5.0, 10.0, 20.0, 50.0, 100.0, 200.0].map(|large| [beta, large]))
        .map(|coefficients| (coefficients, total(coefficients)))
        .collect();
    let (best, most) = all.iter().copied().max_by(|x, y| x.1.total_cmp(&y.1)).expect("a grid has points");
    // Twice the logarithm of the likelihood ratio is χ² with one degree of freedom.
    let near = all.iter().filter(|(_, log)| 2.0 * (most - log) < 3.84);
    let range = |k: usize| {
        let values = near.clone().map(|(c, _)| c[k]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let n = examples.len().max(1) as f64;
    let mut out = String::new();
    let _ =
        writeln!(out, "{} diagnoses; log score by evidence alone {:.3}", examples.len(), total([0.0; 2]) / n);
    for (k, name) in ["beta", "c"].into_iter().enumerate() {
        let (low, high) = range(k);
        let _ = writeln!(out, "{name:<6} {:>5} [{low}, {high}]", best[k]);
    }
    let _ = writeln!(
        out,
        "log score with these {:.3}, with those of the program {:.3}",
        most / n,
        total(coefficients) / n
    );
    let leads = examples.iter().filter_map(|example| example.leading.as_ref());
    let clear: Vec<_> = leads.filter(|(fit, _)| fit.lead(coefficients[1]) > 0.3).collect();
    for (words, is_likely) in [("a fifth or more", true), ("less", false)] {
        let of: Vec<_> = clear.iter().filter(|(fit, _)| (fit.by_evidence >= 0.2) == is_likely).collect();
        let right = of.iter().filter(|(_, is_true)| *is_true).count();
        let _ = writeln!(
            out,
            "clear leads of effects with a probability of {words}: {right} of {} are right",
            of.len()
        );
    }
    out
}
