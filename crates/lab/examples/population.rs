//! Looks at the population that a posterior is trained on:
//!
//! - `cargo run -p switchback-lab --release --example population -- table SEED COUNT [RIGS]`: how it is distributed, and what a rig costs
//! - `… -- sizes SEED COUNT [RIGS]`: sizes to first order beside those by identification
//! - `… -- write SEED FIRST COUNT FOLDER [RIGS]`: rigs as folders
//! - `… -- pairs SEED COUNT` and `… -- write-pairs SEED FIRST COUNT FOLDER`: the same of a machine beside its simulator, the column `y_sim`
//!
//! `RIGS` is the folder of measured rigs, `../shared/rigs` if nothing is said.

#![allow(clippy::disallowed_methods, reason = "an example reads its arguments")]

use cpu_time::ProcessTime;
use miette::{IntoDiagnostic, miette};
use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;
use switchback_io::output::{OutputFolder, note, print};
use switchback_io::rig::artefacts;
use switchback_lab::examination::measured_rigs;
use switchback_lab::population::{
    MeasuredBases, TrainingRig, TrainingTruth, draw, draw_pair, pair_summary, summary,
};
use switchback_model::rig::Rig;

const USAGE: &str = "table|sizes SEED COUNT [RIGS], write SEED FIRST COUNT FOLDER [RIGS], pairs SEED COUNT, or write-pairs SEED FIRST COUNT FOLDER";

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
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["table", seed, count, rest @ ..] => table(number(seed)?, number(count)?, &bases(rest)?),
        ["sizes", seed, count, rest @ ..] => sizes(number(seed)?, number(count)?, &bases(rest)?),
        ["write", seed, first, count, folder, rest @ ..] => {
            let range = (number(first)?, number(count)?);
            write_rigs(number(seed)?, range, Path::new(folder), &bases(rest)?)
        }
        ["pairs", seed, count] => pairs(number(seed)?, number(count)?),
        ["write-pairs", seed, first, count, folder] => {
            write_pairs(number(seed)?, (number(first)?, number(count)?), Path::new(folder))
        }
        _ => Err(miette!("{USAGE}")),
    }
}

fn number(word: &str) -> miette::Result<u64> {
    word.parse().map_err(|_| miette!("`{word}` is no number; {USAGE}"))
}

fn bases(rest: &[&str]) -> miette::Result<MeasuredBases> {
    let folder = Path::new(rest.first().copied().unwrap_or("../shared/rigs"));
    if !folder.is_dir() {
        note(&format!("NO MEASURED BASES: there is no folder {}; made rigs only\n", folder.display()));
        return Ok(MeasuredBases::default());
    }
    let started = ProcessTime::now();
    let (bases, refused) = MeasuredBases::identified(measured_rigs(folder)?);
    for (name, reason) in refused {
        note(&format!("{name} is no base: {reason}\n"));
    }
    note(&format!(
        "{} bases identified in {:.1} s\n",
        bases.names().count(),
        started.elapsed().as_secs_f64()
    ));
    Ok(bases)
}

fn table(seed: u64, count: u64, bases: &MeasuredBases) -> miette::Result<()> {
    let started = ProcessTime::now();
    let mut truths: Vec<TrainingTruth> = Vec::new();
    let mut samples = 0;
    for rig in (0..count).filter_map(|index| draw(seed, index, bases)) {
        samples += rig.rig.records.iter().map(|r| r.record.len()).sum::<usize>();
        truths.push(rig.truth);
    }
    let spent = started.elapsed().as_secs_f64() / count as f64;
    let mean = samples as f64 / truths.len().max(1) as f64;
    print(&format!("{}{:.1} ms a rig of {mean:.0} samples on average\n", summary(&truths), 1e3 * spent))
}

fn sizes(seed: u64, count: u64, bases: &MeasuredBases) -> miette::Result<()> {
    let mut text = String::from("family,effect,law,first_order,identified\n");
    for rig in (0..count).filter_map(|index| draw(seed, index, bases)) {
        let (Some(first), Ok(identified)) = (rig.truth.effects.first(), rig.identified_size()) else {
            continue;
        };
        let family = rig.truth.family.name();
        let _ = writeln!(
            text,
            "{family},{},\"{}\",{:.3},{identified:.3}",
            first.effect, first.law, rig.truth.size
        );
    }
    print(&text)
}

fn pairs(seed: u64, count: u64) -> miette::Result<()> {
    let started = ProcessTime::now();
    let truths: Vec<_> =
        (0..count).filter_map(|index| draw_pair(seed, index)).map(|pair| pair.truth).collect();
    let spent = started.elapsed().as_secs_f64() / count as f64;
    print(&format!("{}{:.1} ms a pair\n", pair_summary(&truths), 1e3 * spent))
}

fn write_pairs(seed: u64, (first, count): (u64, u64), folder: &Path) -> miette::Result<()> {
    for index in first..first + count {
        let Some(pair) = draw_pair(seed, index) else { continue };
        write_folder(&pair.rig, format!("{:#?}\n", pair.truth), &folder.join(format!("pair-{index}")))?;
    }
    Ok(())
}

fn write_folder(rig: &Rig, truth: String, place: &Path) -> miette::Result<()> {
    let mut files = artefacts(rig);
    files.add("truth.txt", truth);
    OutputFolder::claim(place, false).into_diagnostic()?.commit(&files).into_diagnostic()
}

fn write_rigs(
    seed: u64,
    (first, count): (u64, u64),
    folder: &Path,
    bases: &MeasuredBases,
) -> miette::Result<()> {
    for index in first..first + count {
        let Some(drawn) = draw(seed, index, bases) else { continue };
        write_folder(&drawn.rig, truth(&drawn), &folder.join(format!("rig-{index}")))?;
    }
    Ok(())
}

fn truth(TrainingRig { truth, is_given, .. }: &TrainingRig) -> String {
    let mut text = format!(
        "{}, base {}, order {}, {} borders, noise {:.2} % of the output's sd, {}\n",
        truth.family.name(),
        truth.base,
        truth.order,
        truth.borders,
        100.0 * truth.noise,
        if *is_given { "a model is given (y_sim)" } else { "no model is given" },
    );
    let _ = writeln!(text, "{}: size {:.2}", truth.kind.name(), truth.size);
    for e in &truth.effects {
        let _ =
            writeln!(text, "  {} ({}), {:.4} {}, size {:.2}", e.effect, e.law, e.magnitude, e.unit, e.size);
    }
    let _ = writeln!(text, "by itself it has: {}", truth.own.join(", "));
    text
}
