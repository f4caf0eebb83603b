//! One sample of the machine's that no measurement can be, at any place: the table of differences must stay as it is without it.

use super::counting::rows;
use super::drive::uniform;
use super::examined;
use super::pair::{Kind, Pair};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;
use switchback_io::diagnosis::ReportedDifference;
use switchback_model::Record;

/// Sizes of the bad sample, in ranges of the output.
const SIZES: [f64; 3] = [10.0, 1e3, 1e6];

/// Compares pairs with a bad sample, sizes in turn, with the same pairs without, and prints what changes.
pub(crate) fn run(first: u64, count: u64) -> miette::Result<()> {
    let seeds: Vec<u64> = (first..first + count).collect();
    let one = |&seed: &u64| -> miette::Result<Option<String>> {
        let clean = Pair::draw(Kind::of(seed), seed).rig();
        let mut spoilt = clean.clone();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let record = &mut spoilt.records[usize::from(uniform(&mut rng, 0.0, 1.0) < 1.0 / 3.0)].record;
        let (v, mut y) = (record.v().to_vec(), record.y().to_vec());
        let (low, high) =
            y.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(*y), h.max(*y)));
        let at = uniform(&mut rng, 0.0, y.len() as f64) as usize;
        let size = SIZES[(seed % 3) as usize];
        y[at] += size * (high - low) * (uniform(&mut rng, 0.0, 1.0) - 0.5).signum();
        *record = Record::new(v, y).expect("as many finite values");
        let clean = rows(&examined(clean)?);
        let spoilt = match examined(spoilt) {
            Ok(report) => rows(&report),
            // A record that is refused for this sample answers the question of what is wrong with it.
            Err(refused) if refused.to_string().contains(&format!("at sample {at},")) => return Ok(None),
            Err(other) => return Err(other),
        };
        Ok(changed(&clean, &spoilt).map(|what| format!("{seed} {size:e} ranges at sample {at}: {what}")))
    };
    let found: Vec<Option<String>> = seeds.par_iter().map(one).collect::<miette::Result<_>>()?;
    let changed: Vec<&String> = found.iter().flatten().collect();
    changed.iter().for_each(|line| println!("{line}"));
    println!(
        "{} of {count} pairs with one bad sample keep their differences, each value within a standard error",
        count as usize - changed.len()
    );
    Ok(())
}

/// The first difference of two tables: another row, or a value that moves by more than its standard error.
fn changed(clean: &[ReportedDifference], spoilt: &[ReportedDifference]) -> Option<String> {
    let names = |rows: &[ReportedDifference]| -> Vec<String> {
        let mut names: Vec<String> = rows.iter().filter(|r| r.differs).map(|r| r.what.clone()).collect();
        names.sort();
        names
    };
    if names(clean) != names(spoilt) {
        return Some(format!("{:?} became {:?}", names(clean), names(spoilt)));
    }
    clean.iter().find_map(|row| {
        let other = spoilt.iter().find(|other| other.what == row.what)?;
        let stays = !row.differs || (other.in_b - row.in_b).abs() <= row.se;
        (!stays).then(|| format!("{} {:.5e} became {:.5e} ± {:.1e}", row.what, row.in_b, other.in_b, row.se))
    })
}
