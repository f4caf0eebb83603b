//! What the sensor makes of the output, and its units.

use super::builder::{Builder, note, when};
use crate::step::model::{Bumps, Cubic, Knee, Scale, Sensor};
use crate::step::program::{Procedure, Statement, Variable};

/// Newton steps at most, the size of one, and where they end.
const STEPS: usize = 40;
const LONGEST: f64 = 1.0;
const DONE: f64 = 1e-12;
/// Least slope of the inverse that a step relies on.
const FLATTEST: f64 = 0.05;

/// The procedure `read_out(sensed)`: sets the output.
pub(super) fn procedure(b: &mut Builder, (sensor, scale): (&Sensor, &Scale), output: Variable) -> Procedure {
    let sensed = b.local("sensed");
    let mut body = Vec::new();
    if !(sensor.powers.is_empty() && sensor.bumps.is_none() && sensor.knees.is_empty()) {
        body.extend(solved(b, sensor, sensed));
    }
    body.extend(sensor.cubic.map(|cubic| cubic_of(b, cubic, sensed)).unwrap_or_default());
    if let Some([low, high]) = sensor.range {
        body.push(sensed.set(sensed.get().within(low, high)));
    }
    let out = if scale.is_none() { sensed.get() } else { sensed * scale.size + scale.origin };
    body.push(output.set(out));
    b.procedure(("read_out", "Sets the output to what the sensor reads, in its units."), &[sensed], body)
}

/// The reading of what is sensed, by Newton's method on the inverse.
fn solved(b: &mut Builder, sensor: &Sensor, sensed: Variable) -> Vec<Statement> {
    let [reading, value, slope, by] = ["reading", "value", "slope", "by"].map(|name| b.local(name));
    let turn = b.index("newton");
    let mut body = vec![value.set(reading), slope.set(1.0)];
    body.extend(powers(b, &sensor.powers, [reading, value, slope]));
    body.extend(
        sensor.bumps.iter().flat_map(|bumps| bumps_of(b, bumps, [reading, value, slope])).collect::<Vec<_>>(),
    );
    body.extend(knees(b, &sensor.knees, [reading, value, slope]));
    body.extend([
        by.set((value - sensed) / slope.get().greatest(FLATTEST)),
        reading.set(reading - by.get().within(-LONGEST, LONGEST)),
        when(by.get().abs().less(DONE), vec![Statement::Leave]),
    ]);
    vec![
        note("the reading whose inverse is what is sensed"),
        reading.set(sensed),
        Statement::Repeat(turn, STEPS, body),
        sensed.set(reading),
    ]
}

fn powers(b: &mut Builder, powers: &[f64], [y, value, slope]: [Variable; 3]) -> Vec<Statement> {
    if powers.is_empty() {
        return Vec::new();
    }
    let power = b.local("power");
    let mut body = vec![power.set(y)];
    for (k, c) in powers.iter().enumerate() {
        body.extend([
            slope.set(slope + power * (c * (k + 2) as f64)),
            power.set(power * y),
            value.set(value + power * *c),
        ]);
    }
    body
}

fn bumps_of(b: &mut Builder, bumps: &Bumps, [y, value, slope]: [Variable; 3]) -> Vec<Statement> {
    let (place, bump) = (b.local("place"), b.local("bump"));
    let heights = b.constants("bump_heights", &bumps.heights, "heights of the sensor's bumps");
    let j = b.index("j");
    let body = vec![
        place.set((y - bumps.first) / bumps.spacing - j),
        bump.set(heights.at(j) * (place * place * -0.5).exp()),
        value.set(value + bump),
        slope.set(slope - bump * place / bumps.spacing),
    ];
    vec![Statement::Repeat(j, bumps.heights.len(), body)]
}

fn knees(b: &mut Builder, knees: &[Knee], [y, value, slope]: [Variable; 3]) -> Vec<Statement> {
    if knees.is_empty() {
        return Vec::new();
    }
    let [excess, bent, grown] = ["excess", "bent", "grown"].map(|name| b.local(name));
    let of_one = |knee: &Knee| {
        let beyond = excess - bent;
        let more = grown - 1.0 - bent + (grown - 1.0) * beyond;
        vec![
            excess.set((y - knee.level) * knee.sign / knee.width),
            when(
                excess.get().more(0.0),
                vec![
                    bent.set(excess.get().least(knee.steepest)),
                    grown.set(bent.get().exp()),
                    value.set(value + more * (knee.sign * knee.width)),
                    slope.set(slope + (grown - 1.0)),
                ],
            ),
        ]
    };
    knees.iter().flat_map(of_one).collect()
}

fn cubic_of(b: &mut Builder, cubic: Cubic, sensed: Variable) -> Vec<Statement> {
    let Cubic { square, cube, range: [low, high], flattest } = cubic;
    let (at, steep) = (b.local("at_cubic"), b.local("steep"));
    let value = at + at * at * (at * cube + square);
    let polynomial_slope = at * (at * (3.0 * cube) + 2.0 * square) + 1.0;
    let body = vec![
        at.set(sensed.get().within(low, high)),
        steep.set(polynomial_slope.greatest(flattest)),
        sensed.set(value + steep * (sensed - at)),
    ];
    body
}
