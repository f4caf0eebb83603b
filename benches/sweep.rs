//! A small sweep from the scenario to the result table: pulse methods, and `free`.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use switchback_benches::settings;
use switchback_study::consistency;
use switchback_study::scenario::Scenario;

/// Nobody watches.
struct Silent;

impl consistency::Progress for Silent {
    fn planned(&self, _: u64) {}
    fn advanced(&self, _: u64) {}
}

/// Two borders' worth of cells in some tens of milliseconds.
fn scenario(methods: &str) -> Scenario {
    let text = format!(
        r#"study = "consistency"
question = "How long does it take?"
seed = 1
replicates = 40
[system]
a = [-1.2, 0.45]
b = [0.15, 0.10]
interval = [-1.0, 1.0]
[[border]]
name = "spring"
kind = "leaf_spring"
stiffness = 1.0
friction = 0.3
[sweep]
noise = [0.05, 0.2]
samples = [1000, 3000]
points = [5]
methods = {methods}
"#
    );
    Scenario::parse("sweep.toml", &text).expect("a valid scenario")
}

fn sweeps(c: &mut Criterion) {
    let mut group = c.benchmark_group("sweep, 40 replicates, N = 3000");
    for (name, methods) in [
        ("pulse methods", r#"["paper-descendant", "paper-ascendant", "joint", "efficient"]"#),
        ("free", r#"["free"]"#),
    ] {
        let scenario = scenario(methods);
        group.bench_function(name, |b| {
            b.iter(|| consistency::run(black_box(&scenario), String::new(), &Silent).expect("it runs"))
        });
    }
    group.finish();
}

criterion_group! { name = benches; config = settings(); targets = sweeps }
criterion_main!(benches);
