//! How often two recordings of one machine give the same diagnosis.
//!
//! `cargo run --example repeatability -- RIGS SEED COUNT`: halves every record of so many rigs of the training population, which stand on the
//! measured rigs of a folder, and of these measured rigs themselves, and diagnoses both halves. Writes `reports/repeatability`.

#![allow(clippy::disallowed_methods, reason = "an example reads its arguments")]

use miette::{IntoDiagnostic, miette};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;
use switchback_diagnose::{Candidate, Diagnosis, Effect, Model, Settings, Status, diagnose};
use switchback_io::output::{Artefacts, OutputFolder, note, print};
use switchback_lab::examination::measured_rigs;
use switchback_lab::population::{Kind, MeasuredBases, draw};
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord};

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
    let measured = measured_rigs(Path::new(rigs))?;
    let mut twice: Vec<Twice> = measured.par_iter().filter_map(|(name, rig)| Twice::of(name, rig)).collect();
    let (bases, _) = MeasuredBases::identified(measured);
    let drawn = (0..count).into_par_iter().filter_map(|number| draw(seed, number, &bases));
    let is_asked = |rig: &switchback_lab::population::TrainingRig| {
        rig.truth.kind == Kind::One && rig.truth.size >= LARGE && rig.rig.order.is_none()
    };
    let drawn = drawn.filter(is_asked).filter_map(|rig| {
        let without_model = |record: &RigRecord| RigRecord { predicted: None, ..record.clone() };
        let records = rig.rig.records.iter().map(without_model).collect();
        Twice::of(rig.truth.family.name(), &Rig { records, ..rig.rig.clone() })
    });
    twice.extend(drawn.collect::<Vec<Twice>>());
    let text = table(&twice);
    print(&text)?;
    let mut artefacts = Artefacts::default();
    artefacts.add("summary.txt", text);
    OutputFolder::claim(Path::new("reports/repeatability"), false)?.commit(&artefacts)?;
    Ok(())
}

/// Size from which a fault is asked for.
const LARGE: f64 = 2.0;

/// Both diagnoses of a machine.
struct Twice {
    /// Name of the measured rig, or of the family of rigs.
    of: String,
    halves: [Diagnosis; 2],
}

impl Twice {
    /// None where a half is too short, or gives no diagnosis.
    fn of(name: &str, rig: &Rig) -> Option<Self> {
        let half = |is_second: bool| {
            let cut = |record: &RigRecord| {
                let middle = record.record.len() / 2;
                let range = if is_second { middle..record.record.len() } else { 0..middle };
                let (v, y) = (record.record.v()[range.clone()].to_vec(), record.record.y()[range].to_vec());
                Some(RigRecord { record: Record::new(v, y).ok()?, predicted: None, ..record.clone() })
            };
            let records = rig.records.iter().map(cut).collect::<Option<Vec<_>>>()?;
            diagnose(&Rig { records, ..rig.clone() }, Model::Identify, &Settings::default()).ok()
        };
        Some(Self { of: name.to_owned(), halves: [half(false)?, half(true)?] })
    }

    /// The effects that both halves point at, where both do.
    fn causes(&self) -> Option<[Vec<Effect>; 2]> {
        let of = |diagnosis: &Diagnosis| {
            let verdict = &diagnosis.verdict;
            match verdict.status {
                Status::Named => Some(verdict.effects.clone()),
                Status::Class | Status::Ambiguous => Some(verdict.class.clone()),
                _ => None,
            }
        };
        Some([of(&self.halves[0])?, of(&self.halves[1])?])
    }

    /// Whether both causes share an effect, or effects that are confounded.
    fn has_one_cause(&self) -> Option<bool> {
        let [one, other] = self.causes()?;
        let alike = |x: &Effect, y: &Effect| x == y || x.confounded_effects().contains(y);
        Some(one.iter().any(|x| other.iter().any(|y| alike(x, y))))
    }

    /// The likeliest effect of both, with its fits, where it is the same.
    fn first(&self) -> Option<[&Candidate; 2]> {
        let of = |diagnosis: &Diagnosis| {
            let first = diagnosis.candidates.iter().max_by(|x, y| x.probability.total_cmp(&y.probability));
            first.map(|first| first.effect)
        };
        let effect = of(&self.halves[0]).filter(|effect| of(&self.halves[1]) == Some(*effect))?;
        let fit = |diagnosis: &'_ Diagnosis| diagnosis.candidates.iter().position(|c| c.effect == effect);
        let [one, other] = &self.halves;
        Some([&one.candidates[fit(one)?], &other.candidates[fit(other)?]])
    }

    /// For each parameter of an effect that does not change in time whether both values differ by no more than their intervals allow.
    fn parameters(&self) -> Vec<bool> {
        let Some([one, other]) = self.first().filter(|[one, _]| !CHANGES.contains(&one.effect.name())) else {
            return Vec::new();
        };
        let pairs = one.parameters.iter().zip(&other.parameters);
        let within = pairs.filter_map(|(x, y)| {
            let half = |ci: [f64; 2]| 0.5 * (ci[1] - ci[0]);
            // Not a number where the likelihood gives no interval.
            let allowed = half(x.ci90).hypot(half(y.ci90));
            (x.name == y.name && allowed > 0.0).then(|| (x.value - y.value).abs() <= allowed)
        });
        within.collect()
    }
}

/// Effects that happen once, or go on with time, differ between the halves of a record.
const CHANGES: [&str; 6] =
    ["gain_drift", "sensor_drift", "border_wear", "step_change", "record_offset", "creep"];

/// Counts of a family.
#[derive(Default)]
struct Counts {
    rigs: usize,
    both: usize,
    one_cause: usize,
    same_first: usize,
    parameters: usize,
    within: usize,
}

fn table(twice: &[Twice]) -> String {
    let mut counts: BTreeMap<&str, Counts> = BTreeMap::new();
    for twice in twice {
        for of in [twice.of.as_str(), "all"] {
            let counts = counts.entry(of).or_default();
            counts.rigs += 1;
            counts.both += usize::from(twice.causes().is_some());
            counts.one_cause += usize::from(twice.has_one_cause() == Some(true));
            counts.same_first += usize::from(twice.first().is_some());
            let parameters = twice.parameters();
            counts.parameters += parameters.len();
            counts.within += parameters.iter().filter(|within| **within).count();
        }
    }
    let mut out = format!(
        "{:<22} {:>4}  {:>16}  {:>10}  {:>15}  {:>20}\n",
        "recorded twice", "rigs", "cause from both", "one cause", "same likeliest", "parameters within"
    );
    for (of, c) in &counts {
        let share = |part: usize, all: usize| format!("{part}/{all}");
        let _ = writeln!(
            out,
            "{of:<22} {:>4}  {:>16}  {:>10}  {:>15}  {:>20}",
            c.rigs,
            share(c.both, c.rigs),
            share(c.one_cause, c.both),
            share(c.same_first, c.rigs),
            share(c.within, c.parameters)
        );
    }
    out.push_str(
        "cause from both: an effect, a class, or rivals. one cause: of these, those that share an effect, or confounded ones.\n\
         parameters within: of a likeliest effect that both have and that does not change in time, by both 90 % intervals together.\n",
    );
    out
}
