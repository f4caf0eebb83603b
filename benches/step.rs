//! One step of an exported model: in C, compiled by the system's compiler, and in the FMU's library.
//!
//! `cargo bench --bench step -- --page`, in the workspace's root, measures in processor time, which what else the machine does touches little, and
//! puts the figures into `docs/export.md`, between its markers.

use std::fs;
use std::hint::black_box;
use std::process::Command;
use std::sync::Arc;

use cpu_time::ProcessTime;
use criterion::{Criterion, Throughput, criterion_group};
use libloading::Library;
use switchback_benches::{settings, spring, system};
use switchback_fmu::{Instance, Package, SCHEMA, references};
use switchback_model::hysteresis::Branch;
use switchback_model::step::{
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

/// Something that is measured: what runs it, which model, and a run of [`SAMPLES`] steps.
struct Case {
    by: &'static str,
    model: &'static str,
    run: Box<dyn FnMut()>,
}

fn cases() -> Vec<Case> {
    let v = input();
    let mut cases = Vec::new();
    for (name, model) in models() {
        let folder = tempfile::tempdir().expect("a folder");
        match compiled(&model, folder.path()) {
            Some(library) => {
                type Over = unsafe extern "C" fn(*const f64, *mut f64, i32);
                let (v, mut y) = (v.clone(), vec![0.0; SAMPLES]);
                let run = move || {
                    // SAFETY: the function of `compiled`, which has this signature.
                    let over = unsafe { library.get::<Over>(b"over") }.expect("it is there");
                    // SAFETY: as many inputs as there is room for outputs.
                    unsafe { over(black_box(v.as_ptr()), y.as_mut_ptr(), SAMPLES as i32) }
                };
                cases.push(Case { by: "C", model: name, run: Box::new(run) });
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
        let v = v.clone();
        let run = move || {
            let mut instance = fresh.clone();
            instance.enter_initialization().and_then(|()| instance.exit_initialization()).expect("in turn");
            for (t, v) in black_box(&v).iter().enumerate() {
                instance.set_real(references::V, *v).expect("a number");
                instance.step(t as f64 * 1e-3, 1e-3).expect("a sample");
                black_box(instance.real(references::Y).expect("the output"));
            }
        };
        cases.push(Case { by: "FMU", model: name, run: Box::new(run) });
    }
    cases
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    for Case { by, model, mut run } in cases() {
        group.bench_function(format!("{by}, {model}"), |b| b.iter(&mut run));
    }
    group.finish();
}

/// Runs of which the fastest counts: others are slowed down by what shares the caches.
const RUNS: usize = 200;

/// Nanoseconds of processor time of a step.
fn nanoseconds(run: &mut dyn FnMut()) -> f64 {
    run();
    let timed = |_| {
        let begun = ProcessTime::now();
        run();
        begun.elapsed().as_secs_f64()
    };
    1e9 * (0..RUNS).map(timed).fold(f64::INFINITY, f64::min) / SAMPLES as f64
}

/// Two digits, in nanoseconds or microseconds.
fn reported(nanoseconds: f64) -> String {
    let (value, unit) = if nanoseconds < 1000.0 { (nanoseconds, "ns") } else { (1e-3 * nanoseconds, "µs") };
    if value < 10.0 { format!("{value:.1} {unit}") } else { format!("{value:.0} {unit}") }
}

/// Puts the figures into the page.
fn write_page() {
    let place = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/export.md");
    let page = fs::read_to_string(place).expect("a page");
    let (begin, end) = ("<!-- step: figures -->\n", "<!-- end of figures -->");
    let (before, rest) = page.split_once(begin).expect("the marker that begins the figures");
    let (_, after) = rest.split_once(end).expect("the marker that ends them");
    let mut table =
        String::from("| a step, 16 knots a border, order 2 | by | processor time |\n|---|---|--:|\n");
    for Case { by, model, mut run } in cases() {
        table += &format!("| {model} | {by} | {} |\n", reported(nanoseconds(&mut *run)));
    }
    let machine = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = machine.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let cores = std::thread::available_parallelism().map_or(1, |cores| cores.get());
    let machine = model.map_or("an unknown processor", |(_, name)| name);
    table += &format!(
        "\nThe fastest of {RUNS} runs of {SAMPLES} steps; {machine}, {cores} cores. Command: `cargo bench --bench step -- --page`.\n"
    );
    fs::write(place, format!("{before}{begin}{table}{end}{after}")).expect("it can be written");
}

criterion_group! { name = benches; config = settings(); targets = steps }

fn main() {
    if std::env::args().any(|word| word == "--page") {
        return write_page();
    }
    benches();
    Criterion::default().configure_from_args().final_summary();
}
