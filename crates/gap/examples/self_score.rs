//! Scores the diagnosis on random rigs with known causes: `self_score COUNT SEED [EFFECT]`.
//!
//! COUNT rigs a cause (every library effect, nothing, and foreign causes). Prints the confusion of causes, and the
//! rates that matter. SEED picks the rigs: tune on some seeds, report others.
#![allow(
    clippy::disallowed_macros,
    clippy::disallowed_methods,
    reason = "a command-line program prints and reads its arguments"
)]

use std::collections::BTreeMap;

use switchback_gap::workbench::{Cause, Foreign, specimen};
use switchback_gap::{Effect, Model, Settings, Status, diagnose};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let count: u64 = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(2);
    let seed: u64 = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(1);
    let only = arguments.next();
    let verbose = std::env::var("VERBOSE").is_ok();
    let mut causes = vec![Cause::Nothing; 3];
    causes.extend(Effect::ALL.iter().filter(|e| **e != Effect::BorderResolution).map(|e| Cause::Library(*e)));
    causes.extend(Foreign::ALL.map(Cause::Foreign));
    let mut confusion: BTreeMap<(String, String), u32> = BTreeMap::new();
    let mut tally = [0u32; 9];
    let mut calibration: Vec<(f64, bool)> = Vec::new();
    for (number, cause) in causes.iter().enumerate() {
        let name = match cause {
            Cause::Nothing => "none".to_string(),
            Cause::Library(e) => e.name().to_string(),
            Cause::Foreign(f) => format!("{f:?}"),
        };
        if only.as_ref().is_some_and(|o| !name.contains(o.as_str())) {
            continue;
        }
        for k in 0..count {
            let size = [1.0, 2.0, 0.5, 4.0][(k % 4) as usize];
            let rig_seed = seed * 1_000_003 + number as u64 * 1009 + k;
            let s = specimen(&[*cause], size, rig_seed);
            let begun = std::time::Instant::now();
            let d = match diagnose(&s.rig, Model::Identify, &Settings::default()) {
                Ok(d) => d,
                Err(e) => {
                    println!("{name} {rig_seed}: {e}");
                    continue;
                }
            };
            let answer = match d.verdict.status {
                Status::Named => d.verdict.effects.iter().map(|e| e.name()).collect::<Vec<_>>().join("+"),
                Status::Class => {
                    format!(
                        "class:{}",
                        d.verdict.class.iter().map(|e| e.name()).collect::<Vec<_>>().join("|")
                    )
                }
                Status::Ambiguous => {
                    format!(
                        "ambiguous:{}",
                        d.verdict.class.iter().map(|e| e.name()).collect::<Vec<_>>().join("|")
                    )
                }
                other => other.name().to_string(),
            };
            let named = d.verdict.status == Status::Named;
            let right = answer == name;
            match cause {
                Cause::Nothing => {
                    tally[0] += 1;
                    tally[1] += u32::from(answer != "none");
                }
                Cause::Library(e) => {
                    if s.surviving >= 0.8 {
                        tally[2] += 1;
                        tally[3] += u32::from(right);
                        let in_class = d.verdict.class.contains(e);
                        tally[4] += u32::from(right || in_class);
                    }
                }
                Cause::Foreign(_) => {
                    tally[5] += 1;
                    tally[6] += u32::from(named);
                }
            }
            if named {
                tally[7] += 1;
                tally[8] += u32::from(right);
            }
            if let Some(c) = d.candidates.first() {
                calibration.push((c.probability, c.effect.name() == name));
            }
            if verbose || !right {
                let top: Vec<String> = d
                    .candidates
                    .iter()
                    .take(3)
                    .map(|c| {
                        format!(
                            "{} {:.3} {:.0} c{:.2}",
                            c.effect,
                            c.probability,
                            c.bic,
                            c.closure.unwrap_or(f64::NAN)
                        )
                    })
                    .collect();
                println!(
                    "{name} #{rig_seed} size {:.2}: {answer} | none {:.3} unexplained {:.3} | {} | {:.2} s",
                    s.surviving,
                    d.probability_none,
                    d.probability_unexplained,
                    top.join(", "),
                    begun.elapsed().as_secs_f64(),
                );
            }
            *confusion.entry((name.clone(), answer)).or_default() += 1;
        }
    }
    println!("--- cause → answer");
    for ((cause, answer), n) in &confusion {
        println!("{cause:24} → {answer:40} {n}");
    }
    let share = |k: u32, n: u32| 100.0 * f64::from(k) / f64::from(n.max(1));
    println!("false alarms on nothing      {:5.1} % of {}", share(tally[1], tally[0]), tally[0]);
    println!("exact, surviving gap ≥ 0.8   {:5.1} % of {}", share(tally[3], tally[2]), tally[2]);
    println!("exact or in the class        {:5.1} %", share(tally[4], tally[2]));
    println!("named though foreign         {:5.1} % of {}", share(tally[6], tally[5]), tally[5]);
    println!("of the named, right          {:5.1} % of {}", share(tally[8], tally[7]), tally[7]);
    let mut error = 0.0;
    for bin in 0..10 {
        let inside: Vec<&(f64, bool)> =
            calibration.iter().filter(|(p, _)| ((p * 10.0) as usize).min(9) == bin).collect();
        if inside.is_empty() {
            continue;
        }
        let n = inside.len() as f64;
        let mean = inside.iter().map(|x| x.0).sum::<f64>() / n;
        let hit = inside.iter().filter(|x| x.1).count() as f64 / n;
        error += (mean - hit).abs() * n / calibration.len() as f64;
    }
    println!("calibration error of the top {error:5.3}");
}
