//! One step of an exported model: in C, compiled by the system's compiler, and in the FMU's library.

use std::fs;
use std::hint::black_box;
use std::process::Command;
use std::sync::Arc;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use libloading::Library;
use switchback_benches::{settings, spring, system};
use switchback_estimator::hysteresis::Branch;
use switchback_fmu::{Instance, Package, SCHEMA, references};
use switchback_step::{
    Beyond, Borders, Curve, Direction, Effects, Heading, Linear, Model, Play, Scale, Sensor, Transition,
    TransitionLaw, c,
};

/// Samples of a run.
const SAMPLES: usize = 10_000;

/// A leaf spring on sixteen knots a border, plain and with an effect that keeps the working point between them.
fn models() -> [(&'static str, Model); 2] {
    let spring = spring();
    let knots: Vec<f64> = (0..16).map(|k| f64::from(k) / 7.5 - 1.0).collect();
    let border = |branch| Curve {
        values: knots.iter().map(|v| spring.border(branch, *v)).collect(),
        knots: knots.clone(),
        beyond: Beyond::Holds,
    };
    let (a, b) = (system().a().to_vec(), system().b().to_vec());
    let plain = Model {
        input: Scale::NONE,
        output: Scale::NONE,
        late: 0.0,
        direction: Direction::Place { threshold: 0.0, play: Play::default(), between_borders: false },
        borders: Borders::Two {
            descending: border(Branch::Descending),
            ascending: border(Branch::Ascending),
        },
        effects: Effects::default(),
        linear: Linear { poles: Vec::new(), a, b, lag: 1, constant: 0.0, limit: None },
        sensor: Sensor::default(),
    };
    let transition = Transition { length: 0.2, shape: 1.0, reach: 2.4, law: TransitionLaw::Offset };
    let effects = Effects { transition: Some(transition), ..Effects::default() };
    [("plain", plain.clone()), ("gradual transition", Model { effects, ..plain })]
}

fn input() -> Vec<f64> {
    (0..SAMPLES).map(|t| t as f64).map(|t| 0.7 * (0.11 * t).sin() + 0.25 * (0.37 * t).sin()).collect()
}

/// The run of a header as a function of a shared library: `over(v, y, count)`.
fn compiled(model: &Model, folder: &std::path::Path) -> Option<Library> {
    let heading = Heading {
        name: "model".to_owned(),
        says: Vec::new(),
        input: "v".to_owned(),
        output: "y".to_owned(),
        sample_time: 1e-3,
        interval: [-1.0, 1.0],
    };
    fs::write(folder.join("model.h"), c(&model.program(), &heading)).ok()?;
    let over = "#include \"model.h\"\nvoid over(const double *v, double *y, int count) {\n    model_state s;\n    int t;\n    \
                model_start(&s, v[0], 0);\n    for (t = 0; t < count; ++t) y[t] = model_step(&s, v[t]);\n}\n";
    fs::write(folder.join("over.c"), over).ok()?;
    let library = folder.join("over.so");
    let flags = ["-std=c99", "-O2", "-shared", "-fPIC", "over.c", "-o", "over.so", "-lm"];
    Command::new("cc").args(flags).current_dir(folder).status().ok().filter(|status| status.success())?;
    // SAFETY: a library that was made just now, without code of its own at loading.
    unsafe { Library::new(library) }.ok()
}

fn steps(criterion: &mut Criterion) {
    let v = input();
    let mut group = criterion.benchmark_group("step");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    for (name, model) in models() {
        let folder = tempfile::tempdir().expect("a folder");
        match compiled(&model, folder.path()) {
            Some(library) => {
                type Over = unsafe extern "C" fn(*const f64, *mut f64, i32);
                // SAFETY: the function above.
                let over = unsafe { library.get::<Over>(b"over") }.expect("it is there");
                let mut y = vec![0.0; SAMPLES];
                group.bench_function(format!("C, {name}"), |b| {
                    // SAFETY: as many inputs as there is room for outputs.
                    b.iter(|| unsafe { over(black_box(v.as_ptr()), y.as_mut_ptr(), SAMPLES as i32) })
                });
            }
            None => eprintln!("SKIPPED: there is no C compiler `cc`"),
        }
        let package = Arc::new(Package {
            schema: SCHEMA.to_owned(),
            version: String::new(),
            guid: String::new(),
            sample_time: 1e-3,
            interval: [-1.0, 1.0],
            start: v[0],
            constants: Vec::new(),
            program: model.program(),
        });
        let fresh = Instance::new(package).expect("a whole program");
        group.bench_function(format!("FMU, {name}"), |b| {
            b.iter(|| {
                let mut instance = fresh.clone();
                instance
                    .enter_initialization()
                    .and_then(|()| instance.exit_initialization())
                    .expect("in turn");
                for (t, v) in black_box(&v).iter().enumerate() {
                    instance.set_real(references::V, *v).expect("a number");
                    instance.step(t as f64 * 1e-3, 1e-3).expect("a sample");
                    black_box(instance.real(references::Y).expect("the output"));
                }
            })
        });
    }
    group.finish();
}

criterion_group! { name = benches; config = settings(); targets = steps }
criterion_main!(benches);
