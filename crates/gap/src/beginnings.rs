//! What dies away at the beginning of a record: the state of something slow, which nobody knows.
//!
//! Fitted records have a coefficient each. In held-out records it is estimated too: it says nothing about the model.

use std::ops::Range;

use crate::assembly::{Assembly, EquationColumn};
use crate::campaign::{Campaign, Track};
use crate::design::{Design, DesignTrack};
use crate::engine::Fit;
use crate::linear::Linear;
use crate::normal::Normal;

/// Share of a record that is its beginning, and what is left there of something that has died away.
const BEGINNING: f64 = 0.25;
const GONE: f64 = 0.05;
/// Squared standard errors a coefficient from which a beginning shows.
const SHOWS: f64 = 25.0;

/// The assembly and, where something dies away at the beginning of every fitted record, the same in the held-out ones; the numbers
/// of the columns added.
pub(crate) fn with_beginnings(campaign: &Campaign, assembly: &Assembly) -> (Assembly, Range<usize>) {
    let mut out = assembly.clone();
    let known = &assembly.equation_columns;
    let Some(track) = campaign.tracks.iter().position(Track::is_fit) else { return (out, 0..0) };
    for (number, held_out) in campaign.tracks.iter().enumerate().filter(|(_, t)| !t.is_fit()) {
        // What dies away more slowly is a drift of its record, which the model ought to know.
        let dies = |radius: f64| radius.powf(BEGINNING * held_out.v.len() as f64) < GONE;
        for column in known {
            if let EquationColumn::Decay { track: own, radius, frequency, sine } = *column
                && own == track
                && dies(radius)
            {
                let start = EquationColumn::Decay { track: number, radius, frequency, sine };
                out.equation_columns.push(start);
            }
        }
    }
    let added = known.len()..out.equation_columns.len();
    (out, added)
}

/// Sets the coefficients of added columns by the equation errors before the first counted sample, the only ones a simulation may look
/// at, where these show a beginning above noise of the given variance.
pub(crate) fn set_by_first_samples(
    p: &mut Linear,
    design: &Design,
    track: &DesignTrack,
    (added, variance): (Range<usize>, f64),
) {
    let own: Vec<usize> =
        (0..track.columns.numbers.len()).filter(|&k| added.contains(&track.columns.numbers[k])).collect();
    if own.is_empty() {
        return;
    }
    let first = p.a.len().max(p.b.len() + design.taps.len());
    let errors = design.errors_from(track, p, first);
    let mut normal = Normal::new(own.len());
    let mut row = vec![0.0; own.len()];
    for (t, e) in (first..track.from).zip(errors) {
        let psi = track.columns.row(t);
        row.iter_mut().zip(&own).for_each(|(x, &k)| *x = psi[k]);
        normal.add(&row, e);
    }
    let Some(factor) = normal.factor(1e-9) else { return };
    let found = factor.solve(&normal.gradient);
    let gain: f64 = found.iter().zip(&normal.gradient).map(|(d, g)| d * g).sum();
    if gain > SHOWS * own.len() as f64 * variance {
        for (&k, d) in own.iter().zip(found) {
            p.d[track.columns.numbers[k]] = d;
        }
    }
}

/// Times what a filter may hold, and standard errors, from which a beginning is none of the filter.
const MOST_HELD: f64 = 2.0;
const CERTAIN: f64 = 6.0;

/// Whether what dies away at the beginnings of the records is what a slow filter may hold when they begin: not more than a past input
/// between the borders leaves there.
///
/// With beginnings at will, a filter that does next to nothing follows whatever drifts in each record.
pub(crate) fn begins_as_a_filter(fit: &Fit) -> bool {
    let (assembly, linear) = (&fit.assembly, &fit.linear);
    let most = linear.f[..fit.grid.len()].iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let mut columns = assembly.equation_columns.iter().zip(&linear.d);
    columns.all(|(column, d)| match *column {
        EquationColumn::Decay { radius, frequency: 0.0, sine: false, .. } => {
            let held = held([&linear.b, &assembly.taps(), &assembly.denominator], radius) * most;
            let error = (fit.variance * (1.0 - radius * radius)).sqrt();
            d.abs() <= MOST_HELD * held + CERTAIN * error
        }
        _ => true,
    })
}

/// Size of what a pole of a filter has in the equation at the beginning of a record after an input of one ever before; infinite
/// for a pole that comes twice.
///
/// ```text
/// B·N/D = … + r/(1 − p q⁻¹),   |d| ≤ |r|/(1 − p)·max|u|,   r = B(1/p)·N(1/p)/∏(1 − pⱼ/p) = −p·B(1/p)·N(1/p)/D'(1/p)
/// ```
fn held([b, numerator, denominator]: [&[f64]; 3], pole: f64) -> f64 {
    let z = 1.0 / pole;
    let residue = pole * value(b, z) * value(numerator, z) / slope(denominator, z);
    (residue / (1.0 - pole)).abs()
}

/// A polynomial by increasing powers.
fn value(coefficients: &[f64], z: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * z + c)
}

/// Its derivative.
fn slope(coefficients: &[f64], z: f64) -> f64 {
    let powers = coefficients.iter().enumerate().skip(1);
    powers.map(|(i, c)| i as f64 * c * z.powi(i as i32 - 1)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::convolve;
    use crate::testing::{noise_free, small_campaign, small_model};

    /// The oracle: the coefficient that the record was made with.
    #[test]
    fn a_beginning_is_set_where_it_shows_above_the_noise() {
        let (campaign, grid) = small_campaign();
        let radius = 0.9;
        let column = EquationColumn::Decay { track: 0, radius, frequency: 0.0, sine: false };
        let assembly = Assembly { equation_columns: vec![column], ..Assembly::default() };
        let truth = Linear { d: vec![0.7], ..small_model(&grid) };
        let campaign = noise_free(campaign, &grid, &assembly, &truth);
        let design = Design::new(&campaign, &grid, &assembly, Track::is_fit);
        let found = |variance: f64| {
            let mut p = Linear { d: vec![0.0], ..truth.clone() };
            set_by_first_samples(&mut p, &design, &design.tracks[0], (0..1, variance));
            p.d[0]
        };
        assert!((found(1e-6) - 0.7).abs() < 1e-6, "{}", found(1e-6));
        assert_eq!(found(1.0), 0.0);
    }

    /// The oracle: the filters run over an input that was one and is zero.
    #[test]
    fn a_filter_holds_what_its_past_left() {
        let (b, numerator) = ([0.7, -0.2], [1.3, -0.4, 0.1]);
        let (pole, other) = (0.96, 0.5);
        let denominator = convolve(&[1.0, -pole], &[1.0, -other]);
        let through = convolve(&b, &numerator);
        let u = |t: i32| f64::from(u8::from(t < 0));
        let mut y = std::collections::VecDeque::from([0.0, 0.0]);
        let mut last = 0.0;
        for t in -2000..60 {
            let input: f64 = through.iter().zip(0..).map(|(c, lag)| c * u(t - lag)).sum();
            last = input - denominator[1] * y[0] - denominator[2] * y[1];
            y.push_front(last);
        }
        let found = held([&b, &numerator, &denominator], pole) * pole.powi(60);
        assert!((found / last.abs() - 1.0).abs() < 1e-9, "{found} {last}");
        let twice = convolve(&[1.0, -0.9], &[1.0, -0.9]);
        assert!(held([&b, &numerator, &twice], 0.9) > 1e9);
    }

    #[test]
    fn held_out_records_begin_with_what_dies_soon() {
        let (mut campaign, _) = small_campaign();
        let mut held_out = campaign.tracks[0].clone();
        held_out.usage = switchback_estimator::rig::Usage::Holdout;
        campaign.tracks.push(held_out);
        let decay = |radius| EquationColumn::Decay { track: 0, radius, frequency: 0.0, sine: false };
        let assembly = Assembly { equation_columns: vec![decay(0.5), decay(0.999)], ..Assembly::default() };
        let (with, added) = with_beginnings(&campaign, &assembly);
        assert_eq!(added, 2..3);
        assert!(matches!(with.equation_columns[2], EquationColumn::Decay { track: 1, radius: 0.5, .. }));
    }
}
