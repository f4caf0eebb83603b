//! The Bouc–Wen benchmark, from force to displacement and turned round.

use crate::bouc_wen::BoucWen;
use crate::closed_loop::Trial;
use crate::estimation::{Benchmark, rms};
use crate::signal::Period;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use std::fmt::Write as _;
use switchback_identify::record::{Criterion, Effort, Stretch, fit};
use switchback_model::Record;
use switchback_model::reversal::ReversalRule;
use switchback_model::system::{Borders, LAWS, LinearPart, Quantity, Scale, Sensor, System, Term};

/// Samples of a period, samples a second, and steps of the integration in between.
const SAMPLES: usize = 8192;
const RATE: f64 = 750.0;
const STEPS: usize = 20;
/// Ends of the band of the force, Hz, and its root mean square, N.
const BAND: (f64, f64) = (5.0, 150.0);
const FORCE: f64 = 50.0;
/// Standard deviation of the noise of a measured displacement, mm, and measured periods.
const NOISE: f64 = 8e-3;
const PERIODS: usize = 4;
/// Periods of transient.
const TRANSIENT: usize = 3;
/// Turned round, the displacement is needed between samples, so many times as dense; beyond this frequency, Hz, it is taken for noise: of its own
/// there is less than a micrometre.
const DENSER: usize = 4;
const HIGHEST: f64 = 180.0;
/// Knots of a border.
const KNOTS: usize = 9;
/// Realisations of force and noise.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=3;

/// Force [N] of one period on fine steps, and the displacement [mm] at them.
struct Experiment {
    force: Period,
    displacement: Period,
}

impl Experiment {
    fn draw(rng: &mut ChaCha8Rng) -> Self {
        let force = Period::multisine(rng, SAMPLES * STEPS, (line(BAND.0), line(BAND.1)), FORCE);
        let metres = BoucWen::PUBLISHED.displacement(&force, STEP, TRANSIENT);
        Self { force, displacement: Period(metres.0.iter().map(|x| 1e3 * x).collect()) }
    }

    fn measured(&self, sd: f64, rng: &mut ChaCha8Rng) -> Period {
        let exact = self.displacement.every(STEPS);
        Period(exact.0.iter().map(|x| x + sd * rng.sample::<f64, _>(StandardNormal)).collect())
    }
}

const STEP: f64 = 1.0 / (RATE * STEPS as f64);
/// Samples of the turned record are so far apart, s.
const INTERVAL: f64 = 1.0 / (RATE * DENSER as f64);

/// Number of a line.
fn line(hertz: f64) -> usize {
    (hertz * SAMPLES as f64 / RATE).round() as usize
}

/// Errors on a period that no estimate sees, without noise.
pub(crate) fn report() -> miette::Result<String> {
    let mut text = format!(
        "Bouc–Wen oscillator: published equations and values, {SAMPLES} samples at {RATE} Hz, noise {:.0e} m; multisines of the\n\
         published band and size, their phases drawn here, so that figures compare within a few per cent only;\n\
         the displacement measured over one period, turned round over {PERIODS}\n\n\
         {:<62} {:>10}\n",
        1e-3 * NOISE,
        "model",
        "RMSE [m]"
    );
    let mut verdict = String::new();
    for seed in SEEDS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let (estimation, test) = (Experiment::draw(&mut rng), Experiment::draw(&mut rng));
        writeln!(text, "realisation {seed}").expect("a string takes all");
        let (rows, words) = direct(&estimation, &test, &mut rng)?;
        text.push_str(&rows);
        verdict = words;
        text.push_str(&turned(&estimation, &test, &mut rng));
    }
    Ok(format!(
        "{text}{:<62} {:>10}\n{:<62} {:>10}\n\ndiagnosis from force to displacement, last realisation:\n\n{verdict}",
        "published: linear", "1.7e-4", "published: best network", "7.5e-6",
    ))
}

/// From force to displacement: not our class.
fn direct(
    estimation: &Experiment,
    test: &Experiment,
    rng: &mut ChaCha8Rng,
) -> miette::Result<(String, String)> {
    let metres = |x: &Period| x.0.iter().map(|x| 1e-3 * x).collect::<Vec<f64>>();
    let record = |of: &Experiment, x: &Period| {
        Record::new(of.force.every(STEPS).0, metres(x)).expect("finite and equally long")
    };
    let benchmark = Benchmark {
        name: "Bouc–Wen",
        sample_time: 1.0 / RATE,
        labels: ["force [N]", "displacement [m]"],
        estimation: record(estimation, &estimation.measured(NOISE, rng)),
        test: record(test, &test.displacement.every(STEPS)),
        skipped: 50,
    };
    let (rows, report) = benchmark.rows()?;
    Ok((rows, switchback_report::diagnosis::words(&report, None)))
}

/// From displacement to force, and the loop closed again by the mass: rows of both fits.
fn turned(estimation: &Experiment, test: &Experiment, rng: &mut ChaCha8Rng) -> String {
    let measured = estimation.measured(NOISE / (PERIODS as f64).sqrt(), rng);
    let v = measured.resampled(DENSER, line(HIGHEST)).0;
    let y = estimation.force.every(STEPS / DENSER).0;
    let scale = Scale::of(&immediate(), ReversalRule::EXACT, &[(&v, &y)]);
    let start = start(&v, &scale);
    let mut stretches = Stretch::all(&[(&v, &y)]);
    // The place between the borders at the first sample is not known.
    stretches[0].skipped = v.len() / 8;
    let criterion = Criterion { filter: Vec::new(), sd: 1.0 };
    let quantities = Quantity::coordinates(&start);
    let (by_force, _) = fit(&start, &quantities, &stretches, (&criterion, &scale), Effort::FINAL);
    let trial = |of: &Experiment, measured| Trial { force: of.force.clone(), interval: STEP, measured };
    let closed = trial(estimation, measured).fitted(&by_force, (INTERVAL, &scale));
    let judge = trial(test, test.displacement.every(STEPS));
    let mut rows = String::new();
    for (what, system) in [("force", Some(&by_force)), ("displacement", closed.as_ref())] {
        let errors = system.and_then(|system| judge.errors(system, INTERVAL));
        let error = errors.map_or(f64::NAN, |errors| 1e-3 * rms(errors.iter().copied()));
        let what = format!("turned round, loop closed: least squares of the {what}");
        writeln!(rows, "{what:<62} {error:>10.3e}").expect("a string takes all");
    }
    rows
}

fn immediate() -> LinearPart {
    LinearPart::new(&[], &[1.0], 0).expect("a gain of one").0
}

/// Straight borders, a gradual transition between them, a mass and a damper.
fn start(v: &[f64], scale: &Scale) -> System {
    let low = v.iter().copied().fold(f64::MAX, f64::min);
    let knot = |k: usize| low + scale.travel * k as f64 / (KNOTS - 1) as f64;
    let stiffness = 4.0 * scale.output / scale.travel;
    let border = |side: f64| -> Vec<(f64, f64)> {
        (0..KNOTS).map(|k| (knot(k), stiffness * knot(k) + 0.2 * side * scale.output)).collect()
    };
    let term = |effect: &str, name: &str| {
        let law = LAWS.iter().find(|law| (law.effect(), law.name()) == (effect, name)).expect("a law");
        let values = law.starts(scale).pop().expect("a start");
        Term { law: *law, values }
    };
    System {
        borders: Borders::new(&border(-1.0), &border(1.0)).expect("knots that rise"),
        linear: immediate(),
        sensor: Sensor::EXACT,
        terms: vec![
            term("gradual_transition", "relaxing"),
            term("inertia", "mass"),
            term("rate_dependence", "viscous"),
        ],
        rule: ReversalRule::EXACT,
    }
}
