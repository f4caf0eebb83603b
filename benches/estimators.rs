//! Each pulse method on the sufficient statistics of a record, and the superposition that makes them.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use switchback_benches::{experiment, noise, settings, spring, system};
use switchback_identify::excitation::Direction;
use switchback_identify::pulse::{PulseData, PulseMethod, StepMean};
use switchback_identify::simulation::{NoiseMoments, PeriodicDesign, periodic_response, superpose};

/// Samples behind the statistics; the methods' time does not depend on it.
const SAMPLES: usize = 3000;

/// A descendant or ascendant experiment before its noise is added.
struct Prepared {
    design: PeriodicDesign,
    response: Vec<f64>,
    noise: NoiseMoments,
}

fn prepare(direction: Direction, points: usize, replicate: u32) -> Prepared {
    let design = PeriodicDesign::new(&experiment(direction, points), &spring(), 2);
    let response = periodic_response(&system(), &design.u);
    let noise = NoiseMoments::from_samples(&noise(replicate, SAMPLES + 2), 2, design.period());
    Prepared { design, response, noise }
}

impl Prepared {
    fn data(&self) -> PulseData {
        superpose(&self.design, &self.response, 0.1, &self.noise)
    }
}

fn statistics(c: &mut Criterion) {
    let mut group = c.benchmark_group("superpose");
    for points in [4, 16] {
        let prepared = prepare(Direction::Descendant, points, 0);
        group.bench_function(BenchmarkId::new("m", points), |b| b.iter(|| black_box(&prepared).data()));
    }
    group.finish();
}

fn methods(c: &mut Criterion) {
    let mut group = c.benchmark_group("estimators");
    for points in [4, 16] {
        let descendant = prepare(Direction::Descendant, points, 0).data();
        let ascendant = prepare(Direction::Ascendant, points, 1).data();
        let both = [&descendant, &ascendant];
        let mean = system().static_gain() * spring().u_high();
        let step = StepMean { mean, samples: SAMPLES as f64 };
        for (name, method) in [
            ("paper", PulseMethod::Paper { experiment: &descendant, step }),
            ("joint", PulseMethod::Joint { descendant: &descendant, ascendant: &ascendant }),
            ("efficient", PulseMethod::Efficient(&both)),
            ("linear-arx", PulseMethod::LinearArx(&both)),
            ("memoryless", PulseMethod::Memoryless(&both)),
        ] {
            group.bench_function(BenchmarkId::new(name, format!("m = {points}")), |b| {
                b.iter(|| black_box(&method).fit().expect("a solvable regression"))
            });
        }
    }
    group.finish();
}

criterion_group! { name = benches; config = settings(); targets = statistics, methods }
criterion_main!(benches);
