//! One diagnosis of a rig, from its folder's records to the verdict, on all cores: some 17,700 samples, the whole library.

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use switchback::diagnosis::{Subject, examine};
use switchback::rig;

fn diagnosis(c: &mut Criterion) {
    let mut group = c.benchmark_group("diagnosis");
    group.sample_size(10);
    for name in ["leaf-spring", "leaf-spring-with-backlash"] {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/rigs").join(name).join("rig.toml");
        let rig = rig::read(&path).expect("shipped rigs are readable");
        group.bench_function(name, |b| {
            b.iter(|| {
                let subject = Subject::choose(rig.clone(), None).expect("a rig without model");
                black_box(examine(subject, &[]).expect("shipped rigs can be judged"))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, diagnosis);
criterion_main!(benches);
