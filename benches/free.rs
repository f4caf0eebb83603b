//! The estimate from any record: in one shot, and by the parts that a sweep repeats.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use switchback_benches::{noise, settings, spring, system};
use switchback_identify::excitation::RandomLevels;
use switchback_identify::free::{Basis, Grid, Regression, Structure, one_shot};
use switchback_model::Record;
use switchback_model::linear::filter;
use switchback_model::reversal::ReversalRule;

/// Regression samples.
const SAMPLES: usize = 10_000;

fn free(c: &mut Criterion) {
    let (system, spring) = (system(), spring());
    let v = RandomLevels::new(spring.interval()).record_input(SAMPLES + 3, &mut ChaCha8Rng::seed_from_u64(1));
    let u = spring.output(&v, spring.u_low());
    let e = noise(0, v.len());
    let y: Vec<f64> =
        filter(system.a(), system.b(), &u, &[], 0.0, 0.0).iter().zip(&e).map(|(z, e)| z + 0.1 * e).collect();
    let knots: Vec<f64> = (0..9).map(|k| f64::from(k) / 4.0 - 1.0).collect();
    let grid = Grid {
        structure: Structure { order: 2, delay: 0 },
        basis: Basis::borders(knots.clone(), knots),
        rule: ReversalRule::EXACT,
    };
    let regression = Regression::new(&v, grid.clone(), &[SAMPLES]).expect("the drive excites the grid");
    let lags = regression.lag_products(&y, &y).remove(0);
    let moments = regression.moments(0, &lags, &regression.input_products(&y)[0]);
    let record = Record::new(v, y).expect("a record");

    let mut group = c.benchmark_group("free, n = 2, 9 knots");
    group.bench_function("estimate from moments", |b| {
        b.iter(|| regression.estimate(black_box(&moments)).expect("an estimate"))
    });
    group.throughput(Throughput::Elements(SAMPLES as u64));
    group.bench_function("one shot", |b| {
        b.iter(|| one_shot(&[black_box(&record)], &grid).expect("an estimate"))
    });
    group.bench_function("sums of a signal", |b| b.iter(|| regression.input_products(black_box(&e))));
    group.bench_function("lag products", |b| b.iter(|| regression.lag_products(black_box(&e), &e)));
    group.finish();
}

criterion_group! { name = benches; config = settings(); targets = free }
criterion_main!(benches);
