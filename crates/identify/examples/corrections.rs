//! Where the paper must be read with care: each point as a number, without noise, so that any digit is the point's own.
//!
//! `cargo run --example corrections` prints the table that docs/METHODS.md quotes. The machine is a leaf spring behind a first- or second-order system.

#![allow(clippy::disallowed_macros, reason = "an example prints")]

use nalgebra::{DMatrix, SymmetricEigen};
use std::fmt::Write;
use switchback_identify::excitation::{Direction, PulseExperiment, StepExperiment};
use switchback_identify::pulse::{PulseData, PulseMethod, StepMean};
use switchback_model::Record;
use switchback_model::hysteresis::{Branch, Interval, LeafSpring, SwitchedHysteresis};
use switchback_model::linear::{LinearSystem, filter};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

#[allow(dead_code, reason = "another example includes this file")]
fn main() -> Outcome<()> {
    print!("{}", table()?);
    Ok(())
}

/// A row a point: what goes wrong, and what is done here.
pub fn table() -> Outcome<String> {
    let spring = spring(0.0)?;
    let mut text = "| point | read literally | done here |\n|---|---|---|\n".to_owned();
    let rows = [
        spacing(&spring)?,
        window(&spring)?,
        transient(&spring)?,
        sign(&spring)?,
        beginning(&spring),
        shift(&spring)?,
    ];
    for [point, literally, here] in rows {
        let _ = writeln!(text, "| {point} | {literally} | {here} |");
    }
    Ok(text)
}

/// A leaf spring on [−1, 1], its borders raised by `shift`.
fn spring(shift: f64) -> Outcome<SwitchedHysteresis> {
    use switchback_model::hysteresis::{Line, StraightLines};
    let interval = Interval::new(-1.0, 1.0)?;
    if shift == 0.0 {
        return Ok(SwitchedHysteresis::new(interval, Box::new(LeafSpring::constant(1.0, 0.5)?))?);
    }
    let line = |offset| Line { slope: 1.0, offset: offset + shift };
    Ok(SwitchedHysteresis::new(interval, Box::new(StraightLines::new(line(0.5), line(-0.5))?))?)
}

fn second_order() -> Outcome<LinearSystem> {
    Ok(LinearSystem::new(vec![-1.2, 0.45], vec![0.15, 0.10])?)
}

/// `s = n = 1`: visits on adjacent samples are reached by a rise, and `u` lands on the wrong border.
fn spacing(spring: &SwitchedHysteresis) -> Outcome<[String; 3]> {
    let experiment = PulseExperiment::evenly_spaced(spring.interval(), Direction::Descendant, 4, 1)?;
    let error = |experiment: &PulseExperiment| {
        let u = spring.output(&experiment.record_input(experiment.period()), spring.u_low());
        let miss = |j: usize| {
            let wanted = spring.border(Branch::Descending, experiment.levels()[j]);
            (u[1 + experiment.visit_phase(j)] - wanted).abs() / spring.span()
        };
        (0..experiment.points()).map(miss).fold(0.0, f64::max)
    };
    let adjacent = experiment.clone().with_spacing_unmasked(1)?;
    Ok([
        "spacing s = n, at n = 1: largest error of u at a visit, over u_M − u_m".to_owned(),
        format!("{:.2}", error(&adjacent)),
        format!("{:.2}, by s = max(n, 2)", error(&experiment)),
    ])
}

/// Excitation over 4n samples: so many samples cannot span all directions.
fn window(spring: &SwitchedHysteresis) -> Outcome<[String; 3]> {
    let (system, points) = (second_order()?, 8);
    let n = system.order();
    let experiment = PulseExperiment::evenly_spaced(spring.interval(), Direction::Descendant, points, n)?;
    let period = experiment.period();
    let v = experiment.record_input(40 * period);
    let u = spring.output(&v, spring.u_low());
    let rest = system.static_gain() * spring.u_low();
    let y = filter(system.a(), system.b(), &u, &[], rest, spring.u_low());
    let held = system.static_gain() * spring.u_high();
    let regressor = |t: usize| -> Vec<f64> {
        let lags = (1..=n).map(|i| y[t - i] - held);
        let visits = experiment
            .levels()
            .iter()
            .flat_map(|level| (1..=n).map(|i| f64::from(u8::from(v[t - i] == *level))));
        lags.chain(visits).collect()
    };
    let least = |samples: usize, from: usize| {
        let rows: Vec<f64> = (from..from + samples).flat_map(regressor).collect();
        let rows = DMatrix::from_row_slice(samples, n * (points + 1), &rows);
        SymmetricEigen::new(rows.transpose() * &rows / samples as f64).eigenvalues.min().max(0.0)
    };
    // The last periods, where nothing is left of the beginning.
    let from = 30 * period + 1;
    let best = (from..from + period).map(|from| least(4 * n, from)).fold(0.0, f64::max);
    Ok([
        format!(
            "excitation over 4n samples, at n = 2, m = {points}: least eigenvalue of the information in {} directions",
            n * (points + 1)
        ),
        format!("{:.0} at best: {} samples", if best < 1e-12 { 0.0 } else { best }, 4 * n),
        format!("{:.1e} over a period of {period}", least(period, from)),
    ])
}

/// The mean of a step response from its first sample on.
fn transient(spring: &SwitchedHysteresis) -> Outcome<[String; 3]> {
    let system = second_order()?;
    let samples = 200;
    let v = StepExperiment::high(spring.interval()).record_input(samples);
    let u = spring.output(&v, spring.u_low());
    let y = filter(system.a(), system.b(), &u, &[], system.static_gain() * spring.u_low(), spring.u_low());
    let wanted = system.static_gain() * spring.u_high();
    let error = |from: usize| {
        let mean = y[from..].iter().sum::<f64>() / (y.len() - from) as f64;
        (mean - wanted).abs() / (system.static_gain() * spring.span())
    };
    let settling = system.settling_samples(1e-6);
    Ok([
        format!("mean of {samples} samples of a step response: error over the step"),
        format!("{:.1e}", error(1)),
        format!("{:.0e}, without the first {settling}", error(1 + settling)),
    ])
}

/// The sign of c₁ in the ascendant experiment.
fn sign(spring: &SwitchedHysteresis) -> Outcome<[String; 3]> {
    let system = second_order()?;
    let experiment =
        PulseExperiment::evenly_spaced(spring.interval(), Direction::Ascendant, 4, system.order())?;
    let v = experiment.record_input(40 * experiment.period());
    let u = spring.output(&v, spring.u_high());
    let rest = system.static_gain() * spring.u_high();
    let y = filter(system.a(), system.b(), &u, &[], rest, spring.u_high());
    let data =
        PulseData::from_record(&Record::new(v, y)?, Branch::Ascending, system.order(), experiment.period())?;
    let step = StepMean { mean: system.static_gain() * spring.u_low(), samples: 1000.0 };
    let fit = PulseMethod::Paper { experiment: &data, step }.fit()?;
    let truth = system.normalised(spring.span());
    let ratio = fit.b[0].value / truth.b()[0];
    Ok([
        "c₁ in the ascendant experiment, with F̃(W₁) = +1: estimate of b₁ over its true value".to_owned(),
        format!("{:.2}, with the descendant's c₁ = −1/W₁", -ratio),
        format!("{ratio:.2}, with c₁ = +1/W₁"),
    ])
}

/// What `u` was before the input first moved.
fn beginning(spring: &SwitchedHysteresis) -> [String; 3] {
    let interval = spring.interval();
    let held = [interval.high(); 5];
    let loaded: Vec<f64> = [interval.low()].into_iter().chain(held).collect();
    let apart = |v: &[f64]| {
        let [low, high] = [spring.u_low(), spring.u_high()].map(|before| spring.output(v, before));
        (low[v.len() - 1] - high[v.len() - 1]).abs() / spring.span()
    };
    [
        "a record that begins at the satellite: how far u depends on what came before, over u_M − u_m"
            .to_owned(),
        format!("{:.0}", apart(&held)),
        format!("{:.0}, after one move that loads the border", apart(&loaded)),
    ]
}

/// A shift of both borders and an offset of the output.
fn shift(spring: &SwitchedHysteresis) -> Outcome<[String; 3]> {
    let (system, by) = (second_order()?, 0.3);
    let shifted = self::spring(by)?;
    let experiment =
        PulseExperiment::evenly_spaced(spring.interval(), Direction::Descendant, 4, system.order())?;
    let v = experiment.record_input(20 * experiment.period());
    let output = |spring: &SwitchedHysteresis, offset: f64| {
        let before = spring.u_low();
        let u = spring.output(&v, before);
        let y = filter(system.a(), system.b(), &u, &[], system.static_gain() * before, before);
        y.into_iter().map(|y| y + offset).collect::<Vec<_>>()
    };
    let (plain, moved) = (output(spring, 0.0), output(&shifted, -by * system.static_gain()));
    let apart = plain.iter().zip(&moved).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    Ok([
        format!("borders raised by {by}, and an offset of the output against it: difference of the records"),
        format!("{:.0}", if apart < 1e-12 { 0.0 } else { apart }),
        "said: no record separates them".to_owned(),
    ])
}
