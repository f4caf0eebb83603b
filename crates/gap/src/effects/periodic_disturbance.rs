//! A sinusoid of unknown frequency.
//!
//! ```text
//! A y = B u + Σ (α cos ωt + β sin ωt),   amplitude and phase free a record, or one for the campaign;
//!                                      two frequencies; or the harmonics 1, 2, 3 and 5, or 1, 3, …, 11, of one wave; the latter free a record, too
//! ```
//!
//! Parameters: angular frequencies `omega`, radians per sample. Stage: disturbance. One line in the residual spectrum of every record. Confused
//! with: resonance where the drive excites it, drift where it is slow.

use super::{Scene, Variant, fitted_tracks, own};
use crate::assembly::{Assembly, EquationColumn};
use crate::spectrum::{share_of_line, sharpened, strongest_lines};

/// Share of what the errors make of the output from which a line rules it.
const RULES: f64 = 0.1;

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let sharpest = |signals: &[Vec<f64>], count: usize| -> Vec<f64> {
        strongest_lines(signals, count).into_iter().map(|omega| sharpened(signals, omega)).collect()
    };
    let lines = sharpest(scene.innovations, 3);
    let longest = scene.innovations.iter().map(Vec::len).max().unwrap_or(1) as f64;
    // Fewer than eight periods a record are a drift.
    let slowest = 16.0 * std::f64::consts::PI / longest;
    let tracks = fitted_tracks(scene.campaign);
    let start = |omega: f64| own("omega", "radians per sample", omega, (slowest, 3.13), 0.05 / longest);
    // Lines that rule the output have made pole pairs of `A` their own: the innovations have none of them, the output has.
    let output = scene.fit.linear.behind_poles(scene.innovations);
    let mut ruling = sharpest(&output, 2);
    ruling.retain(|omega| *omega > slowest && share_of_line(&output, *omega) > RULES);
    let lines = lines.into_iter().filter(|omega| *omega > slowest);
    let omegas: Vec<f64> = lines.chain(ruling.iter().copied()).collect();
    let Some((&strongest, others)) = omegas.split_first() else { return Vec::new() };
    let starts: Vec<_> = omegas.iter().map(|&omega| vec![start(omega)]).collect();
    let two = others.iter().map(|&other| [strongest, other]);
    let pairs = two.chain(ruling.windows(2).map(|w| [w[0], w[1]]));
    let pairs: Vec<_> = pairs.map(|two| two.map(start).to_vec()).collect();
    let a_record = move |p: &[f64], assembly: &mut Assembly| {
        for &frequency in p {
            for &track in &tracks {
                let track = Some(track);
                for sine in [false, true] {
                    assembly.equation_columns.push(EquationColumn::Line { frequency, track, sine });
                }
            }
        }
    };
    let each_record = a_record.clone();
    let mut out = vec![Variant::new(starts.clone(), a_record.clone())];
    if !pairs.is_empty() {
        out.push(Variant::new(pairs, a_record));
    }
    // What rises as it falls has odd harmonics only, those of a square wave fall slowly.
    const HARMONICS: [&[f64]; 2] = [&[1.0, 2.0, 3.0, 5.0], &[1.0, 3.0, 5.0, 7.0, 9.0, 11.0]];
    out.extend(HARMONICS.map(|harmonics| {
        Variant::new(starts.clone(), move |p, assembly| {
            for harmonic in harmonics {
                for sine in [false, true] {
                    let frequency = harmonic * p[0];
                    assembly.equation_columns.push(EquationColumn::Line { frequency, track: None, sine });
                }
            }
        })
    }));
    let wave = move |p: &[f64], assembly: &mut Assembly| {
        let frequencies: Vec<f64> = HARMONICS[1].iter().map(|harmonic| harmonic * p[0]).collect();
        each_record(&frequencies, assembly);
    };
    out.push(Variant::new(starts.clone(), wave));
    out.push(Variant::new(starts, |p, assembly| {
        for sine in [false, true] {
            assembly.equation_columns.push(EquationColumn::Line { frequency: p[0], track: None, sine });
        }
    }));
    out
}
