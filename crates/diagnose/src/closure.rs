//! How far the gap closes on held-out records.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::diagnosis::{Gap, RecordGap};
use crate::figure::Figure;
use crate::records::dataset::{Dataset, ScaledRecord};

/// Simulations of one record, dimensionless.
pub(crate) struct Simulated {
    pub(crate) number: usize,
    pub(crate) before: Vec<f64>,
    pub(crate) after: Vec<f64>,
}

/// Samples of one block of the bootstrap: longer than the memory of the errors.
const BLOCK: usize = 60;

/// Intervals over those of the bootstrap, which knows the noise in the records but not that of the fit: found on made rigs whose
/// seeds no report uses.
const FITTED: f64 = 1.1;

/// Sums over one block.
#[derive(Clone, Copy)]
struct Block {
    before: f64,
    after: f64,
    energy: f64,
    count: f64,
}

/// `G²` before and after, closure, and their intervals from a bootstrap over blocks of time.
///
/// `noise` is the variance of the noise in the output and its relative standard error.
pub(crate) fn measure(dataset: &Dataset, runs: &[Simulated], noise: (f64, f64), draws: (u64, usize)) -> Gap {
    let mut blocks = Vec::new();
    let mut per_record = Vec::new();
    for run in runs {
        let scaled = &dataset.scaled_records[run.number];
        let n = (scaled.y.len() - scaled.from).max(1) as f64;
        let own = blocks_of(scaled, run);
        let [before, after, energy] = [|b: &Block| b.before, |b: &Block| b.after, |b: &Block| b.energy]
            .map(|of| own.iter().map(of).sum::<f64>());
        let energy = energy.max(1e-300);
        blocks.extend(own);
        per_record.push(RecordGap {
            record: scaled.name.clone(),
            before: (before - n * noise.0) / energy,
            after: (after - n * noise.0) / energy,
            fit_before: 100.0 * (1.0 - (before / energy).sqrt()),
            fit_after: 100.0 * (1.0 - (after / energy).sqrt()),
            closure: None,
        });
    }
    let [before, after, closure] = figures(&blocks, noise, draws);
    Gap {
        before,
        after,
        closure: (before.ci90[0] > 0.0).then_some(closure),
        noise_floor: noise.0.max(0.0).sqrt() * dataset.y_scale,
        identified_anew: None,
        predictive_gain: 0.0,
        per_record,
    }
}

/// The closure of the gap on each record by itself, with its interval; none on a record where the gap's interval includes zero.
pub(crate) fn closures(
    dataset: &Dataset,
    runs: &[Simulated],
    noise: (f64, f64),
    draws: (u64, usize),
) -> Vec<Option<Figure>> {
    let of = |run: &Simulated| {
        let [before, _, closure] =
            figures(&blocks_of(&dataset.scaled_records[run.number], run), noise, draws);
        (before.ci90[0] > 0.0).then_some(closure)
    };
    runs.iter().map(of).collect()
}

fn blocks_of(scaled: &ScaledRecord, run: &Simulated) -> Vec<Block> {
    let from = scaled.from;
    let mean = scaled.y[from..].iter().sum::<f64>() / (scaled.y.len() - from).max(1) as f64;
    let square = |x: f64| x * x;
    let block = |start: usize| {
        let mut b = Block { before: 0.0, after: 0.0, energy: 0.0, count: 0.0 };
        for t in start..(start + BLOCK).min(scaled.y.len()) {
            b.before += square(scaled.y[t] - run.before[t]);
            b.after += square(scaled.y[t] - run.after[t]);
            b.energy += square(scaled.y[t] - mean);
            b.count += 1.0;
        }
        b
    };
    (from..scaled.y.len()).step_by(BLOCK).map(block).collect()
}

/// `G²` before, after, and the closure, with intervals from a bootstrap over the blocks.
fn figures(blocks: &[Block], noise: (f64, f64), draws: (u64, usize)) -> [Figure; 3] {
    let reported = |blocks: &mut dyn Iterator<Item = Block>, noise: f64| {
        let sum = blocks.fold(Block { before: 0.0, after: 0.0, energy: 1e-300, count: 0.0 }, |s, b| Block {
            before: s.before + b.before,
            after: s.after + b.after,
            energy: s.energy + b.energy,
            count: s.count + b.count,
        });
        let before = (sum.before - sum.count * noise) / sum.energy;
        let after = (sum.after - sum.count * noise) / sum.energy;
        [before, after, 1.0 - after / before]
    };
    let estimates = reported(&mut blocks.iter().copied(), noise.0);
    let mut rng = ChaCha8Rng::seed_from_u64(draws.0);
    let mut samples: [Vec<f64>; 3] = Default::default();
    for _ in 0..draws.1 {
        let drawn: Vec<Block> =
            (0..blocks.len()).map(|_| blocks[rng.random_range(0..blocks.len())]).collect();
        // Twelve uniforms make a normal deviate well enough for the error of the noise floor.
        let normal: f64 = (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
        let values = reported(&mut drawn.into_iter(), noise.0 * (1.0 + noise.1 * normal));
        samples.iter_mut().zip(values).for_each(|(s, v)| s.push(v));
    }
    let figure = |estimate: f64, mut draws: Vec<f64>| {
        draws.retain(|x| x.is_finite());
        draws.sort_by(f64::total_cmp);
        let at = |q: f64| match draws.len() {
            0 => estimate,
            n => draws[((n - 1) as f64 * q).round() as usize],
        };
        let [low, high] = [at(0.05).min(estimate), at(0.95).max(estimate)];
        Figure {
            estimate,
            ci90: [estimate - FITTED * (estimate - low), estimate + FITTED * (high - estimate)],
        }
    };
    let [before, after, closure] = estimates;
    let [drawn_before, drawn_after, drawn_closure] = samples;
    [figure(before, drawn_before), figure(after, drawn_after), figure(closure, drawn_closure)]
}
