//! Held-out recordings whose output differs from that of the fit records by a constant or a factor: a sensor tared anew, another amplifier.

use crate::rig::is_rest_of;
use switchback_diagnose::{Diagnosis, HoldoutSeries};
use switchback_identify::statistics::MeanInterval;
use switchback_model::Record;
use switchback_model::rig::{Rig, Usage};

/// A value with the half width of its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Half width of its interval, by a block bootstrap.
    pub half_width: f64,
}

/// The output of a held-out recording over the free run of the model of the fit records, `y = offset + gain·ŷ + e`.
#[derive(Debug, Clone, PartialEq)]
pub struct Shift {
    /// The record.
    pub record: String,
    /// The constant, output units; none where the zero is the same.
    pub offset: Option<Estimate>,
    /// The factor; none where it is one.
    pub gain: Option<Estimate>,
}

/// Share of the misfit, noise apart, that a shift explains at least: most of it.
const MOST: f64 = 0.5;

impl Shift {
    /// The output as the fit records would have it.
    fn removed(&self, y: f64) -> f64 {
        (y - self.offset.map_or(0.0, |o| o.value)) / self.gain.map_or(1.0, |g| g.value)
    }

    /// The output as this record has it.
    fn put_on(&self, y: f64) -> f64 {
        self.offset.map_or(0.0, |o| o.value) + self.gain.map_or(1.0, |g| g.value) * y
    }

    /// Of a record with its simulation and the variance of the noise; none where no constant or factor explains most of the misfit.
    fn of(record: &str, (y, run): (&[f64], &[f64]), noise: f64) -> Option<Self> {
        let excess = |errors: &[f64]| mean(errors.iter().map(|e| e * e)) - noise;
        let errors: Vec<f64> = y.iter().zip(run).map(|(y, r)| y - r).collect();
        let level = mean(y.iter().copied());
        let about_mean: Vec<f64> = y.iter().map(|y| y - level).collect();
        // A run that is nothing like the record is explained by a gain of zero.
        let least = MOST * excess(&errors).min(excess(&about_mean));
        let constant = Self { record: record.to_owned(), offset: constant(&errors), gain: None };
        let factor = Self { gain: factor(y, run), offset: None, ..constant.clone() };
        let [offset, gain] = both(y, run);
        let both = Self { offset, gain, ..constant.clone() };
        let left = |shift: &Self| {
            let errors: Vec<f64> = y.iter().zip(run).map(|(y, r)| y - shift.put_on(*r)).collect();
            excess(&errors)
        };
        let single = if left(&constant) <= left(&factor) { constant } else { factor };
        let needs_both = both.offset.is_some() && both.gain.is_some() && left(&both) <= MOST * left(&single);
        let shift = if needs_both { both } else { single };
        let is_shift = shift.offset.is_some() || shift.gain.is_some();
        (is_shift && left(&shift) <= least).then_some(shift)
    }
}

/// The shifts of whole recordings that are held out, where what remains of the gap is beyond the noise.
pub(super) fn shifts(rig: &Rig, diagnosis: &Diagnosis) -> Vec<Shift> {
    if diagnosis.gap.after.ci90[0] <= 0.0 {
        return Vec::new();
    }
    let noise = diagnosis.gap.noise_floor.powi(2);
    let is_whole = |name: &str| {
        let mut fitted = rig.records.iter().filter(|r| r.usage == Usage::Fit);
        !fitted.any(|r| is_rest_of(name, &r.name))
    };
    let whole = diagnosis.series.iter().filter(|series| is_whole(&series.record));
    whole
        .filter_map(|series| Shift::of(&series.record, (&series.measured, &series.augmented), noise))
        .collect()
}

/// The rig with its shifts removed.
pub(super) fn without(rig: &Rig, shifts: &[Shift]) -> Rig {
    let mut rig = rig.clone();
    for record in &mut rig.records {
        let Some(shift) = shifts.iter().find(|s| s.record == record.name) else { continue };
        let y = record.record.y().iter().map(|y| shift.removed(*y)).collect();
        if let Ok(shifted) = Record::new(record.record.v().to_vec(), y) {
            record.record = shifted;
        }
    }
    rig
}

/// Measured and simulated outputs as the records have them, and the shifts over the runs of a model that was found without them.
pub(super) fn restored(diagnosis: &mut Diagnosis, shifts: &[Shift]) -> Vec<Shift> {
    let noise = diagnosis.gap.noise_floor.powi(2);
    let mut again = |shift: &Shift| {
        let series = diagnosis.series.iter_mut().find(|series| series.record == shift.record)?;
        let HoldoutSeries { measured, nominal, augmented, .. } = series;
        measured.iter_mut().for_each(|y| *y = shift.put_on(*y));
        let found = Shift::of(&shift.record, (measured, augmented), noise);
        for run in [nominal, augmented] {
            run.iter_mut().for_each(|y| *y = shift.put_on(*y));
        }
        found
    };
    shifts.iter().map(|shift| again(shift).unwrap_or_else(|| shift.clone())).collect()
}

fn constant(errors: &[f64]) -> Option<Estimate> {
    beyond_chance(errors, 0.0)
}

/// `Σ ŷy / Σ ŷ²`.
fn factor(y: &[f64], run: &[f64]) -> Option<Estimate> {
    let square = mean(run.iter().map(|r| r * r));
    let gain = mean(y.iter().zip(run).map(|(y, r)| y * r)) / square;
    let influence = |(y, r): (&f64, &f64)| gain + r * (y - gain * r) / square;
    beyond_chance(&y.iter().zip(run).map(influence).collect::<Vec<_>>(), 1.0)
}

/// Offset and gain by least squares.
fn both(y: &[f64], run: &[f64]) -> [Option<Estimate>; 2] {
    let (level, centre) = (mean(y.iter().copied()), mean(run.iter().copied()));
    let square = mean(run.iter().map(|r| (r - centre).powi(2)));
    let gain = mean(y.iter().zip(run).map(|(y, r)| (r - centre) * (y - level))) / square;
    let offset = level - gain * centre;
    let left = |(y, r): (&f64, &f64)| y - offset - gain * r;
    let of_gain = |(y, r): (&f64, &f64)| (r - centre) * left((y, r)) / square;
    let gains: Vec<f64> = y.iter().zip(run).map(|at| gain + of_gain(at)).collect();
    let offsets: Vec<f64> = y.iter().zip(run).map(|at| offset + left(at) - centre * of_gain(at)).collect();
    [beyond_chance(&offsets, 0.0), beyond_chance(&gains, 1.0)]
}

/// The mean of a series of influences, where its interval excludes the value that changes nothing.
fn beyond_chance(influences: &[f64], nothing: f64) -> Option<Estimate> {
    let interval = MeanInterval::of(&[influences])?;
    let excludes = !(interval.low..=interval.high).contains(&nothing);
    excludes.then_some(Estimate { value: interval.mean, half_width: 0.5 * (interval.high - interval.low) })
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run, and noise of variance 0.01 drawn by a linear congruential generator.
    fn run() -> (Vec<f64>, Vec<f64>) {
        let mut state = 7_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let run: Vec<f64> = (0..2000).map(|t| 3.0 * (0.013 * f64::from(t)).sin() + 1.0).collect();
        (run, (0..2000).map(|_| 0.1 * 12_f64.sqrt() * uniform()).collect())
    }

    fn shift(offset: f64, gain: f64) -> Option<Shift> {
        let (run, noise) = run();
        let y: Vec<f64> = run.iter().zip(noise).map(|(r, e)| offset + gain * r + e).collect();
        Shift::of("day", (&y, &run), 0.01)
    }

    #[test]
    fn a_zero_a_gain_and_both_are_found_and_nothing_where_nothing_differs() {
        assert_eq!(shift(0.0, 1.0), None);
        let zero = shift(1.7, 1.0).expect("an offset");
        assert!(
            (zero.offset.expect("an offset").value - 1.7).abs() < 0.01 && zero.gain.is_none(),
            "{zero:?}"
        );
        let gain = shift(0.0, -1.3).expect("a gain");
        assert!((gain.gain.expect("a gain").value + 1.3).abs() < 0.01 && gain.offset.is_none(), "{gain:?}");
        let both = shift(-0.8, 1.2).expect("both");
        assert!((both.gain.expect("a gain").value - 1.2).abs() < 0.01, "{both:?}");
        let offset = both.offset.expect("an offset");
        assert!((offset.value + 0.8).abs() < 3.0 * offset.half_width, "{both:?}");
        assert!((both.removed(both.put_on(0.3)) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn a_run_that_is_nothing_like_the_record_has_no_gain() {
        let (run, noise) = run();
        let y: Vec<f64> = (0..2000).map(|t| 3.0 * (0.031 * f64::from(t)).cos() + noise[t as usize]).collect();
        assert_eq!(Shift::of("day", (&y, &run), 0.01), None);
    }
}
