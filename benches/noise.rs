//! The noise: white normals in lanes beside the ziggurat of `rand_distr` over the same cipher, and the pass
//! that consumes them.
//!
//! Times are per normal (one sample of one replicate), so that `pass` over `white` at the same width is the
//! cost of everything but the noise.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use switchback_noise::{BLOCK, NoisePass, NoisePlan, StreamId, WhiteNoise, Width};

/// Samples of one replicate, a multiple of the block.
const SAMPLES: usize = 160 * BLOCK;

/// Replicates, a multiple of every width.
const REPLICATES: u32 = 16;

fn settings() -> Criterion {
    Criterion::default()
        .sample_size(30)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2))
}

fn white(c: &mut Criterion) {
    let mut group = c.benchmark_group("white");
    let count = SAMPLES * REPLICATES as usize;
    group.throughput(Throughput::Elements(count as u64));
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut block = vec![0.0; BLOCK];
    group.bench_function("rand_distr ziggurat", |b| {
        b.iter(|| {
            for _ in 0..count / block.len() {
                block.iter_mut().for_each(|x| *x = StandardNormal.sample(&mut rng));
                black_box(&mut block);
            }
        })
    });
    for width in Width::available() {
        let mut noise = WhiteNoise::new(width, StreamId { seed: 1, experiment: 0, replicate: 0 });
        let mut block = vec![0.0; BLOCK * noise.lanes()];
        group.bench_function(format!("lanes = {}", noise.lanes()), |b| {
            b.iter(|| {
                for _ in 0..count / block.len() {
                    noise.fill(&mut block);
                    black_box(&mut block);
                }
            })
        });
    }
    group.finish();
}

/// Second-order noise, as for a leaf spring: folds of one design (m = 8, s = 2), and of a sweep over m with
/// its step experiments.
fn pass(c: &mut Criterion) {
    let mut group = c.benchmark_group("pass");
    group.throughput(Throughput::Elements(SAMPLES as u64 * u64::from(REPLICATES)));
    for (name, periods) in [("T = 22", vec![22]), ("T = 1, 14, 22, 38", vec![1, 14, 22, 38])] {
        for width in Width::available() {
            let plan = NoisePlan {
                ar: vec![-1.5, 0.7],
                ma: vec![],
                lags: 2,
                periods: periods.clone(),
                checkpoints: vec![SAMPLES / 10, SAMPLES],
                burn_in: 0,
            };
            let mut pass = NoisePass::new(plan, width).expect("the plan is valid");
            group.bench_function(format!("{name}, lanes = {}", width.lanes()), |b| {
                b.iter(|| {
                    pass.run(1, 0, 0..REPLICATES, |_, record| {
                        black_box(record);
                    })
                })
            });
        }
    }
    group.finish();
}

criterion_group! { name = benches; config = settings(); targets = white, pass }
criterion_main!(benches);
