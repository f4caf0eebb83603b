//! Whether the sizes that `switchback gap --power` states hold: fresh faults of these sizes, with laws, parameters and noise that the statement has
//! not seen, must be found nine times in ten.
//!
//! ```text
//! cargo run --release --example power_check -- RIG.toml EFFECT,… DRAWS FRESH
//! ```

use rayon::prelude::*;
use std::env;
use std::path::Path;
use switchback::options::Quiet;
use switchback::progress::Meter;
use switchback_diagnose::Settings;
use switchback_io::rig;
use switchback_lab::examination::scramble;
use switchback_lab::generate::{EFFECTS, Precision};
use switchback_lab::power::{Context, Draw, Outcome, Plan, measure};

/// Fresh faults have seeds of their own.
const FRESH: u64 = 0x0046_5245_5348;

/// A fresh fault counts where its size is this close to the one stated.
const CLOSE: f64 = 0.1;

fn main() -> miette::Result<()> {
    let words: Vec<String> = env::args().skip(1).collect();
    let [file, listed, draws, fresh] = &words[..] else {
        eprintln!("usage: power_check RIG.toml EFFECT,… DRAWS FRESH");
        return Ok(());
    };
    let rig = rig::read(Path::new(file))?;
    let effects = EFFECTS.into_iter().filter(|known| listed.split(',').any(|name| name == *known)).collect();
    let plan = Plan { effects, draws: draws.parse().unwrap_or(6), seed: 1 };
    let context = Context::new(&rig, None, Settings::default(), file)?;
    let meter = Meter::counting("diagnoses", Quiet::default());
    let power = measure(&context, &plan, &meter, || ())?;
    meter.finish();
    let fresh: usize = fresh.parse().unwrap_or(40);
    let (mut all_found, mut all) = (0, 0);
    for finding in &power.findings {
        let Outcome::From(size) = finding.outcome() else {
            println!("{:22} states no size: {:?}", finding.effect, finding.outcome());
            continue;
        };
        let seed = scramble(FRESH, plan.seed_of(finding.effect));
        let one = |k: usize| context.draw(Precision::FINE, (finding.effect, size), scramble(seed, k as u64));
        let drawn: Vec<Draw> = (0..fresh).into_par_iter().with_max_len(1).map(one).collect();
        let close = drawn.iter().filter_map(|draw| match draw {
            Draw::Diagnosed { fault, answer } if (fault.size / size - 1.0).abs() < CLOSE => {
                Some(answer.is_found())
            }
            _ => None,
        });
        let answers: Vec<bool> = close.collect();
        let found = answers.iter().filter(|found| **found).count();
        println!(
            "{:22} from {size:.2} {:?}: {found} of {} fresh ones found",
            finding.effect,
            finding.conclusion.interval,
            answers.len()
        );
        (all_found, all) = (all_found + found, all + answers.len());
    }
    println!("all: {all_found} of {all}");
    Ok(())
}
