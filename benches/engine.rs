//! What a sweep is made of: noise alone, the pass that sums over it, one cell's algebra, and all of it together.
//!
//! Second order, m = 8. `noise alone` is the floor; `pass` over it is the price of a sample (lag products, folds, edges);
//! `one cell` is what every further noise level, border, m, N or method costs; `leaf-spring sweep` is the study itself, a
//! sample of noise the unit in it too.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use switchback_benches::{experiment, noise, settings, spring, system};
use switchback_identify::excitation::Direction;
use switchback_identify::pulse::lanes::{LANES, Lane, LaneFit, LaneMethod, LaneSample, LaneStep, LaneTerms};
use switchback_identify::pulse::{Limit, PulseMethod, SecondOrder, StepMean};
use switchback_identify::simulation::{
    Grouping, LaneCross, LaneGroupedNoise, LaneMoments, LaneSuperposition, NoiseMoments, PeriodicDesign,
    periodic_response, superpose,
};
use switchback_noise::{BLOCK, NoisePass, NoisePlan, StreamId, WhiteNoise, Width};
use switchback_study::consistency;
use switchback_study::scenario::Scenario;

/// Points `m`.
const POINTS: usize = 8;

/// Standard deviation of the equation error.
const SIGMA: f64 = 0.2;

/// Samples of one replicate, a multiple of the block.
const SAMPLES: usize = 160 * BLOCK;

/// Replicates, a multiple of every width.
const REPLICATES: u32 = 16;

/// Normals that `noise alone` and `pass` draw.
const NORMALS: u64 = SAMPLES as u64 * REPLICATES as u64;

fn samples(c: &mut Criterion) {
    let width = Width::detect();
    let mut group = c.benchmark_group("engine, a sample");
    group.throughput(Throughput::Elements(NORMALS));
    let mut white = WhiteNoise::new(width, StreamId { seed: 1, experiment: 0, replicate: 0 });
    let mut block = vec![0.0; BLOCK * white.lanes()];
    group.bench_function("noise alone", |b| {
        b.iter(|| {
            for _ in 0..NORMALS as usize / block.len() {
                white.fill(&mut block);
                black_box(&mut block);
            }
        })
    });
    let period = experiment(Direction::Descendant, POINTS).period();
    let plan = NoisePlan {
        ar: system().a().to_vec(),
        ma: vec![],
        lags: 2,
        periods: vec![period],
        checkpoints: vec![SAMPLES / 100, SAMPLES / 10, SAMPLES],
        burn_in: 0,
    };
    let mut pass = NoisePass::new(plan, width).expect("the plan is valid");
    group.bench_function("pass", |b| {
        b.iter(|| {
            pass.run(1, 0, 0..REPLICATES, |_, record| {
                black_box(NoiseMoments::from_checkpoint(2, &record.head, &record.checkpoints[2], 0));
            })
        })
    });
    group.finish();
}

/// Groups of replicates that a cell takes in at once.
const ABREAST: usize = 4;

/// A few times eight replicates of one cell: statistics, estimates with their standard errors, control variate.
fn cell(c: &mut Criterion) {
    let design = PeriodicDesign::new(&experiment(Direction::Descendant, POINTS), &spring(), 2);
    let response = periodic_response(&system(), &design.u);
    let superposition = LaneSuperposition::new(&design, &response, SAMPLES);
    let grouping = Grouping::new(&design, SAMPLES);
    let replicate =
        |r: u32| NoiseMoments::from_samples(&noise(r, SAMPLES + 2), design.order, design.period());
    let mut moments = LaneMoments::zeros(design.order, design.period());
    (0..LANES).for_each(|lane| moments.set(lane, &replicate(lane as u32)));
    let grouped = LaneGroupedNoise::new(&grouping, &moments);
    let mut cross = LaneCross::default();
    superposition.cross(&grouped, &mut cross);
    let mut statistics: [_; ABREAST] = std::array::from_fn(|_| superposition.statistics());

    let finite = NoiseMoments::expected_over(system().a(), &[], design.order, design.period(), SAMPLES);
    let expected = superpose(&design, &response, SIGMA, &finite);
    let mean = system().static_gain() * spring().u_high();
    let paper =
        PulseMethod::Paper { experiment: &expected, step: StepMean { mean, samples: SAMPLES as f64 } };
    let limit = Limit::of(paper).expect("a solvable regression");
    let control = limit.lanes(SecondOrder::Whole);
    let method = LaneMethod::of(&paper);
    let step = LaneStep { mean: Lane::splat(mean), samples: SAMPLES as f64 };
    let mut fits: [LaneFit; ABREAST] = Default::default();
    let mut terms: [LaneTerms; ABREAST] = Default::default();

    let mut group = c.benchmark_group("engine, a cell of a replicate");
    group.throughput(Throughput::Elements(LANES as u64));
    group.bench_function("noise taken in, once an m and N", |b| {
        b.iter(|| LaneGroupedNoise::new(&grouping, black_box(&moments)))
    });
    group.bench_function("response taken in, once more a border", |b| {
        b.iter(|| superposition.cross(black_box(&grouped), &mut cross))
    });
    let cross = cross.clone();
    group.throughput(Throughput::Elements((ABREAST * LANES) as u64));
    group.bench_function("one cell", |b| {
        b.iter(|| {
            for statistics in &mut statistics {
                superposition.at((&grouped, &cross), black_box(SIGMA), statistics);
            }
            let parts: [_; ABREAST] = std::array::from_fn(|k| [&statistics[k]]);
            let samples: [_; ABREAST] =
                std::array::from_fn(|k| LaneSample { parts: &parts[k], step: Some(step) });
            method.fit(&samples, &mut fits);
            control.terms(&samples, &mut terms);
            black_box((&fits, &terms));
        })
    });
    group.finish();
}

/// Nobody watches.
struct Silent;

impl consistency::Progress for Silent {
    fn planned(&self, _: u64) {}
    fn advanced(&self, _: u64) {}
}

/// Replicates of the sweep: a whole number of lanes at every width.
const SWEEP_REPLICATES: u32 = 160;

/// The grid of the leaf-spring study (108 cells) with the paper's estimator, on one thread.
fn sweep(c: &mut Criterion) {
    let text = include_str!("../scenarios/leafspring.toml");
    let mut table: toml::Table = text.parse().expect("the committed scenario");
    table.remove("expect");
    table.insert("replicates".to_owned(), i64::from(SWEEP_REPLICATES).into());
    table["sweep"]["methods"] = vec!["paper-descendant"].into();
    let text = toml::to_string(&table).expect("it was TOML before");
    let scenario = Scenario::parse("leafspring.toml", &text).expect("a valid scenario");
    let longest = scenario.sweep().samples.last().copied().unwrap_or_default() as u64;
    let thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let mut group = c.benchmark_group("engine, a sample of the longest record");
    group.throughput(Throughput::Elements(longest * u64::from(SWEEP_REPLICATES)));
    group.bench_function("leaf-spring sweep", |b| {
        b.iter(|| {
            thread
                .install(|| consistency::run(black_box(&scenario), String::new(), &Silent))
                .expect("it runs")
        })
    });
    group.finish();
}

criterion_group! { name = benches; config = settings(); targets = samples, cell, sweep }
criterion_main!(benches);
