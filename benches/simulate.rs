//! Simulation sample by sample: the operator (2.3), the difference equation, the noise in the open; and one period in closed form.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use switchback_benches::{experiment, noise, settings, spring, system};
use switchback_identify::excitation::Direction;
use switchback_identify::simulation::{PeriodicDesign, periodic_response};
use switchback_model::linear::filter;

/// Samples of a record.
const SAMPLES: usize = 20_000;

fn records(c: &mut Criterion) {
    let (system, spring) = (system(), spring());
    let v = experiment(Direction::Descendant, 8).record_input(SAMPLES);
    let u = spring.output(&v, spring.u_low());
    let mut group = c.benchmark_group("simulate");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    group.bench_function("operator", |b| b.iter(|| spring.output(black_box(&v), 0.0)));
    group.bench_function("filter, n = 2", |b| {
        b.iter(|| filter(system.a(), system.b(), black_box(&u), &[], 0.0, 0.0))
    });
    group.bench_function("noise, n = 2", |b| b.iter(|| noise(black_box(1), SAMPLES)));
    group.finish();
}

fn periods(c: &mut Criterion) {
    let design = PeriodicDesign::new(&experiment(Direction::Descendant, 8), &spring(), 2);
    let system = system();
    c.bench_function("periodic response, T = 22", |b| {
        b.iter(|| periodic_response(&system, black_box(&design.u)))
    });
}

criterion_group! { name = benches; config = settings(); targets = records, periods }
criterion_main!(benches);
