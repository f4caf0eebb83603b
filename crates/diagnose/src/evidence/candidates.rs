//! Candidates of every effect, and what each would change in the run.

use super::candidate::{Candidate, Candidates};
use super::context::{Context, Signal, difference};
use super::lines::strongest_line;
use super::setting::Setting;
use super::shapes::Shapes;
use switchback_model::system::{LAWS, Quantity, Term};

/// Effects without a law of a [`System`](switchback_model::system::System).
const WITHOUT_LAW: [&str; 4] = ["input_delay", "periodic_disturbance", "border_resolution", "slack"];

/// Effects that have candidates, in a fixed order.
pub(super) fn effects() -> Vec<&'static str> {
    let mut all: Vec<&'static str> = Vec::new();
    for effect in LAWS.iter().map(|law| law.effect()).chain(WITHOUT_LAW) {
        if !all.contains(&effect) {
            all.push(effect);
        }
    }
    all
}

/// Those of every effect at a base.
pub(super) fn candidates(
    context: &Context<'_>,
    (runs, errors): (&Signal, &Signal),
    setting: &Setting,
) -> Candidates {
    let mut out = Candidates::default();
    for law in LAWS {
        for values in law.starts(&context.scale) {
            let term = Term { law, values };
            let column = out.add(context.change(runs, &term));
            out.all.push(Candidate { effect: law.effect(), columns: vec![column], term: Some(term) });
        }
    }
    delays(&mut out, context, runs);
    slow_sensor(&mut out, context);
    let shapes = Shapes { context, setting };
    shapes.operator(&mut out);
    shapes.slow(&mut out);
    shapes.sensor(&mut out);
    lines(&mut out, context, errors);
    finer_borders(&mut out, context, runs);
    out
}

/// A sample earlier, one later, two later, and shares of these.
fn delays(out: &mut Candidates, context: &Context<'_>, runs: &Signal) {
    let now = Quantity::Delay.value(context.base);
    let moved = [1.0, 2.0, -1.0].map(|more| {
        let later = context.runs(&Quantity::Delay.set(context.base, now + more));
        out.add(difference(&later, runs, 1.0))
    });
    out.group("input_delay", vec![moved[0]]);
    out.group("input_delay", moved[..2].to_vec());
    out.group("input_delay", vec![moved[2]]);
}

/// Polynomials of the time, and the time within each record.
fn slow_sensor(out: &mut Candidates, context: &Context<'_>) {
    let signal = |of: &dyn Fn(usize, usize) -> f64| -> Signal {
        let records = context.stretches.iter().enumerate();
        records.map(|(k, s)| (0..s.v.len()).map(|t| of(k, t)).collect()).collect()
    };
    let clock = |k: usize, t: usize| context.stretches[k].span.clock(t) - 0.5;
    let cubic: Vec<usize> = (1..=3).map(|power| out.add(signal(&|k, t| clock(k, t).powi(power)))).collect();
    out.group("sensor_drift", cubic);
    let within = out.add(signal(&|k, t| t as f64 / context.stretches[k].v.len() as f64 - 0.5));
    out.group("sensor_drift", vec![within]);
    let fading = out.add(signal(&|_, t| (-(t as f64) / 300.0).exp()));
    out.group("sensor_drift", vec![fading]);
}

/// The strongest line of the error, with a phase of its own in each of the longest records.
fn lines(out: &mut Candidates, context: &Context<'_>, errors: &Signal) {
    const RECORDS: usize = 4;
    let Some(line) = strongest_line(errors) else { return };
    let mut longest: Vec<usize> = (0..errors.len()).collect();
    longest.sort_by_key(|k| std::cmp::Reverse(errors[*k].len()));
    let mut columns = Vec::new();
    for &k in longest.iter().take(RECORDS) {
        for phase in [0.0, std::f64::consts::FRAC_PI_2] {
            let mut signal: Signal = context.stretches.iter().map(|s| vec![0.0; s.v.len()]).collect();
            let wave = |t: usize| libm::cos(line * t as f64 - phase);
            signal[k].iter_mut().enumerate().for_each(|(t, x)| *x = wave(t));
            columns.push(out.add(signal));
        }
    }
    out.group("periodic_disturbance", columns);
}

/// A knot more in the middle of each of the widest cells of either border.
fn finer_borders(out: &mut Candidates, context: &Context<'_>, runs: &Signal) {
    const CELLS: usize = 24;
    let (low, high) = context.base.borders.range();
    let knots = context.base.borders.count() as f64 / 2.0;
    let fine = context.base.borders.refined(0.5 * (high - low) / (knots - 1.0).max(1.0));
    let system = switchback_model::system::System { borders: fine, ..context.base.clone() };
    let mut all: Vec<usize> = (0..system.borders.count()).collect();
    let every = all.len().div_ceil(2 * CELLS).max(1);
    all.retain(|k| k % every == 0);
    let columns = all
        .into_iter()
        .map(|k| {
            let knot = Quantity::Knot(k);
            let step = knot.step(&system, &context.scale);
            let moved = knot.set(&system, knot.value(&system) + step);
            out.add(difference(&context.runs(&moved), runs, 1.0 / step))
        })
        .collect();
    out.group("border_resolution", columns);
}
