//! Public benchmarks of nonlinear system identification, beside figures that others published.
//!
//! `cargo run --example benchmarks -- ../shared/rigs/field`: the folder holds `cascaded-tanks` (`est.csv` and `val.csv`: time, pump voltage, level; from
//! `dataBenchmark.csv`, <https://www.nonlinearbenchmark.org>), without which that benchmark is skipped. The Bouc–Wen oscillator is made here by its published equations. Writes `reports/benchmarks`.

mod bouc_wen;
mod closed_loop;
mod estimation;
mod oscillator;
mod signal;
mod tanks;

use std::path::Path;
use switchback_io::output::{Artefacts, OutputFolder};

fn main() -> miette::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "../shared/rigs/field".to_owned());
    let mut artefacts = Artefacts::default();
    let tanks = Path::new(&folder).join("cascaded-tanks");
    if tanks.is_dir() {
        artefacts.add("cascaded-tanks.txt", tanks::report(&tanks)?);
    } else {
        println!("skipped the cascaded tanks: there is no {}", tanks.display());
    }
    artefacts.add("bouc-wen.txt", oscillator::report()?);
    OutputFolder::claim(Path::new("reports/benchmarks"), false)?.commit(&artefacts)?;
    Ok(())
}
