//! Noise: the floor of every study, beside the ziggurat of `rand_distr`, and the pass that consumes it.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use switchback_estimator::simulation::noise::{BLOCK, StreamId, WhiteNoise, Width};

fn white(c: &mut Criterion) {
    let mut group = c.benchmark_group("white");
    let count = 16 * BLOCK * 16;
    group.throughput(Throughput::Elements(count as u64));
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut out = vec![0.0; BLOCK * 16];
    group.bench_function("rand_distr", |b| {
        b.iter(|| {
            for _ in 0..count / out.len() {
                out.iter_mut().for_each(|x| *x = StandardNormal.sample(&mut rng));
                black_box(&mut out);
            }
        })
    });
    for width in Width::available() {
        let mut noise = WhiteNoise::new(width, StreamId { seed: 1, experiment: 0, replicate: 0 });
        let mut out = vec![0.0; BLOCK * noise.lanes()];
        group.bench_function(format!("lanes{}", noise.lanes()), |b| {
            b.iter(|| {
                for _ in 0..count / out.len() {
                    noise.fill(&mut out);
                    black_box(&mut out);
                }
            })
        });
    }
    group.finish();
}

criterion_group! { name = benches; config = Criterion::default().sample_size(20).measurement_time(std::time::Duration::from_secs(1)).warm_up_time(std::time::Duration::from_millis(300)); targets = white }
criterion_main!(benches);
