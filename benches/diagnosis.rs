//! What one diagnosis costs, from records in memory to the verdict, on one thread and with the whole library.
//!
//! Made rigs of the difficult kind (no order declared, two effects or none, borders that jump, some 20,000 samples; one of 200,000), then,
//! where `../shared/rigs` is there, measured ones. For each: processor seconds, the same in units of one dense least-squares solution of
//! 20,000 × 60 that is timed in the same run, passes over the samples, and the most memory that it held. `cargo bench --bench diagnosis`; words
//! that come first after `--` choose the rigs whose names contain one of them.

mod diagnosis {
    pub(crate) mod baseline;
    pub(crate) mod cost;
    pub(crate) mod rigs;
}

use diagnosis::baseline::least_squares_seconds;
use diagnosis::cost::{Cost, PEAK};
use diagnosis::rigs::{made, measured};
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PEAK;

fn main() {
    // What follows an option belongs to it: `cargo bench -- --baseline before` is for the other benches.
    let words: Vec<String> = std::env::args().skip(1).take_while(|word| !word.starts_with('-')).collect();
    // `cargo test --benches` runs it once, to see that it runs.
    let is_measured = std::env::args().any(|word| word == "--bench");
    let unit = least_squares_seconds();
    println!("one dense least-squares solution of 20,000 x 60: {:.1} ms of processor time", 1e3 * unit);
    println!(
        "{:28}{:>9}{:>10}{:>10}{:>9}{:>9}  verdict",
        "rig", "samples", "seconds", "in units", "passes", "peak MB"
    );
    let mut ten = Vec::new();
    let rigs = made(is_measured).into_iter().chain(if is_measured { measured() } else { Vec::new() });
    for rig in rigs.filter(|rig| words.is_empty() || words.iter().any(|word| rig.name.contains(word))) {
        let cost = Cost::of(&rig);
        println!("{}", cost.row(unit));
        if rig.counts {
            ten.push(cost.seconds / unit);
        }
    }
    ten.sort_by(f64::total_cmp);
    if let Some(worst) = ten.last() {
        let median = 0.5 * (ten[(ten.len() - 1) / 2] + ten[ten.len() / 2]);
        println!("{} measured rigs: median {median:.0}, worst {worst:.0} units", ten.len());
    }
}
