//! Are the time stamps those of even sampling, and of which sample time?

use super::input_form::InputForm;
use crate::table::{DataProblem, Step};

/// What the stamps of a record show.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Timing {
    /// Seconds between samples.
    pub sample_time: f64,
    /// The largest difference of a step from the sample time, as a share of it; steps over dropouts not counted.
    pub jitter: f64,
    /// Samples before which others are missing.
    pub dropouts: Vec<usize>,
    /// By how many sample times stamps are off at most, where the samples are more even than they are.
    pub(super) shaken: Option<f64>,
}

/// Share of the sample time that a step may be off where the stamps themselves show it.
pub(super) const JITTER: f64 = 0.01;

/// Seconds, in sample times, put between two parts of which the second starts anew: longer than any gap that is bridged.
pub(super) const APART: f64 = 1e6;

/// Stamps on each side of a long step that show whether samples are missing there. Where each is off by up to 0.4 sample times, the medians
/// of eight differ by 0.18 sample times in standard deviation, and by 1 more where a sample is missing.
const BESIDE: usize = 8;

/// Steps apart from gaps, the gaps, and the stamps with the gaps closed.
struct Separated {
    plain: Vec<f64>,
    gaps: Vec<usize>,
    closed: Vec<f64>,
}

/// The stamps of a record that nobody has judged yet: its time column in seconds and how finely it is written.
#[derive(Clone, Copy)]
pub(super) struct Stamps<'a> {
    /// What messages call the column.
    pub column: &'a str,
    /// Seconds, one a sample that was measured.
    pub t: &'a [f64],
    /// Seconds that the last digit of each stamp is worth.
    pub resolution: &'a [f64],
    /// Each stamp as it stands in the file.
    pub written: &'a dyn Fn(usize) -> String,
    /// Who asks.
    pub input_form: &'a InputForm,
}

/// Where in a record something is wrong (none: everywhere), and what.
pub(super) type Fault = (Option<usize>, DataProblem);

impl Stamps<'_> {
    /// Checks that time increases in even steps, which dropouts may interrupt: steps of one and a half sample times or more.
    ///
    /// Without a declared sample time a step may be off by 1 % of it and by what rounding of the stamps explains, though never by half
    /// a sample. With one, stamps only have to show that no sample is missing or doubled:
    /// - a single step may be off by less than half a sample. A lost sample makes a step of two, a doubled one a step of
    ///   none; both are a whole sample off. Stamps rounded to a quarter of the sample time still pass. Where the mean step is
    ///   off too, it is no dropout but another sample time.
    /// - a whole piece may be off by 1 % of its length or half a sample, whichever is more: beyond that the sample time is
    ///   another one, and every frequency and time constant would be wrong by as much.
    ///
    /// Where the record starts does not matter.
    pub(super) fn judge(&self, declared: Option<f64>) -> Result<Timing, Fault> {
        self.check_order()?;
        let Some(mean) = self.mean_step() else {
            let sample_time = declared.unwrap_or(f64::NAN);
            return Ok(Timing { sample_time, jitter: 0.0, dropouts: Vec::new(), shaken: None });
        };
        let sample_time = declared.unwrap_or(mean);
        if (mean - sample_time).abs() >= 0.3 * sample_time {
            return Err((None, self.other_sample_time(mean, sample_time)));
        }
        let mut timing = Timing { sample_time, jitter: 0.0, dropouts: Vec::new(), shaken: None };
        for (k, step) in self.steps() {
            let off = (step - sample_time).abs() / sample_time;
            let rounding = self.rounding(k) / sample_time;
            let allowed = if declared.is_some() { 0.5 } else { (JITTER + rounding).min(0.499) };
            if step >= 1.5 * sample_time {
                timing.dropouts.push(k);
            } else if off > allowed {
                return Err((Some(k), self.uneven(k, sample_time)));
            } else {
                timing.jitter = timing.jitter.max(off - rounding);
            }
        }
        if declared.is_some() {
            self.check_lengths(&timing)?;
        }
        Ok(timing)
    }

    /// Time must increase, resampled or not.
    pub(super) fn check_order(&self) -> Result<(), Fault> {
        match self.steps().find(|(_, step)| *step <= 0.0) {
            Some((k, _)) => {
                let step = self.step_to(k, f64::NAN, self.input_form.not_increasing());
                Err((Some(k), DataProblem::NotIncreasing(step)))
            }
            None => Ok(()),
        }
    }

    fn step_to(&self, k: usize, sample_time: f64, remedy: String) -> Box<Step> {
        Box::new(Step {
            column: self.column.to_owned(),
            before: (self.written)(k - 1),
            now: (self.written)(k),
            step: rounded(self.t[k] - self.t[k - 1]),
            sample_time: rounded(sample_time),
            remedy,
        })
    }

    /// The sample time that the stamps show: the mean of the steps that are not over gaps, that is the time they span over their number.
    ///
    /// Each stamp may be off by its rounding (300 Hz written to a millisecond steps by 3 or 4 ms), so the median step is one of a few
    /// multiples of the last digit, and wrong by up to half of it. In the mean the errors of the stamps in between cancel; what remains is
    /// that of the two ends over the number of steps. A number of few digits within that error is taken instead, as a step or as a rate.
    pub(super) fn mean_step(&self) -> Option<f64> {
        let median = self.median_step()?;
        let mean = |steps: &[f64]| steps.iter().sum::<f64>() / steps.len() as f64;
        // Rounding may put the median below the mean; a gap that slips in the first time is out the second.
        let first = mean(&self.plain_steps(median, |k| self.rounding(k)));
        let plain = self.plain_steps(first, |_| 0.0);
        let found = mean(&plain);
        let largest = plain.iter().map(|step| (step - found).abs()).fold(0.0, f64::max);
        // Every even stretch has two ends of its own, and their errors add as those of independent numbers do.
        let ends = ((self.t.len() - plain.len()) as f64).sqrt();
        Some(nice(found, ends * largest.max(1e-9 * found) / plain.len() as f64))
    }

    fn median_step(&self) -> Option<f64> {
        (self.t.len() > 1).then(|| middle(self.steps().map(|(_, step)| step).collect()))
    }

    /// The steps that are not over gaps, where the sample time is about `step`: those below one and a half of it, and a little more where the
    /// stamps are rounded, and longer ones behind which the stamps are in time again.
    ///
    /// Behind a gap all are late by the samples that are missing. A single stamp that came late makes a long step and a short one behind it; with
    /// the long one left out the mean would be too small. Late are stamps whose median lies half a sample or more behind that of those before,
    /// a few on each side, once the gaps before them are taken away.
    fn plain_steps(&self, step: f64, rounding: impl Fn(usize) -> f64) -> Vec<f64> {
        self.separated(step, rounding).plain
    }

    fn separated(&self, step: f64, rounding: impl Fn(usize) -> f64) -> Separated {
        let on_time = |k: usize, t: f64| t - step * k as f64;
        let (mut missing, mut closed, mut plain, mut gaps) = (0.0, vec![self.t[0]], Vec::new(), Vec::new());
        for (k, length) in self.steps() {
            if length >= 1.5 * step + rounding(k) {
                let before = (k.saturating_sub(BESIDE)..k).map(|i| on_time(i, closed[i]));
                let behind = (k..(k + BESIDE).min(self.t.len())).map(|i| on_time(i, self.t[i] - missing));
                let late = middle(behind.collect()) - middle(before.collect());
                if late >= 0.5 * step {
                    missing += late;
                    closed.push(self.t[k] - missing);
                    gaps.push(k);
                    continue;
                }
            }
            closed.push(self.t[k] - missing);
            plain.push(length);
        }
        Separated { plain, gaps, closed }
    }

    /// The sample time of which nearly all steps are multiples, and how many of them are longer.
    pub(super) fn multiples(&self, declared: Option<f64>) -> Option<(f64, usize)> {
        /// Longer steps begin another part.
        const LONGEST: f64 = 0.5 * APART;
        let mut steps: Vec<f64> = self.steps().map(|(_, step)| step).collect();
        steps.sort_by(f64::total_cmp);
        let short = declared.or_else(|| steps.get(steps.len() / 20).copied()).filter(|step| *step > 0.0)?;
        let within: Vec<f64> = steps.into_iter().filter(|step| *step < LONGEST * short).collect();
        let odd = within.iter().filter(|step| (*step / short - (*step / short).round()).abs() > 0.1).count();
        let samples: f64 = within.iter().map(|step| (step / short).round()).sum();
        let gaps = within.iter().filter(|step| **step > 1.5 * short).count();
        let mean = nice(within.iter().sum::<f64>() / samples, 0.1 * short / samples);
        (50 * odd <= within.len()).then_some((declared.unwrap_or(mean), gaps))
    }

    /// By how much each stamp is off even steps, in sample times, and the gaps between.
    fn offsets(&self, sample_time: f64) -> (Vec<f64>, Vec<usize>) {
        let Separated { closed, gaps, .. } = self.separated(sample_time, |_| 0.0);
        let late: Vec<f64> = closed.iter().enumerate().map(|(k, t)| t / sample_time - k as f64).collect();
        let local =
            |k: usize| middle(late[k.saturating_sub(BESIDE)..(k + BESIDE + 1).min(late.len())].to_vec());
        ((0..late.len()).map(|k| late[k] - local(k)).collect(), gaps)
    }

    /// Stamps that shake although the samples are even: taken late by whatever received them, or rounded in odd ways.
    ///
    /// The signals show it. Where the samples lie where the stamps say, a signal leaves the straight line between its neighbours by its slope times
    /// what the stamp is off; the regression of the one on the other has the coefficient 1. Where the samples are even it has 0.
    /// Stamps of samples that stand still, or whose noise hides the difference, do no harm either way.
    pub(super) fn shaken(&self, declared: Option<f64>, signals: &[&[f64]]) -> Option<Timing> {
        /// Share of the stamps that may be off by half a sample or more.
        const LATE: f64 = 0.2;
        let sample_time = declared.or_else(|| self.mean_step())?;
        let (offsets, dropouts) = self.offsets(sample_time);
        let far = offsets.iter().filter(|off| off.abs() >= 0.5).count();
        let follow = |signal: &&[f64]| follows(signal, &offsets);
        if far as f64 > LATE * offsets.len() as f64 || signals.iter().any(follow) {
            return None;
        }
        let most = offsets.iter().map(|off| off.abs()).fold(0.0, f64::max);
        Some(Timing { sample_time, jitter: 0.0, dropouts, shaken: Some(most) })
    }

    /// The step into the `k`-th gap, a gap of a designed experiment.
    pub(super) fn gap(&self, k: usize, sample_time: f64) -> DataProblem {
        DataProblem::Gap(self.step_to(k, sample_time, self.input_form.whole()))
    }

    /// The step from which time starts anew.
    pub(super) fn anew(&self, k: usize) -> DataProblem {
        DataProblem::StartsAnew(self.step_to(k, f64::NAN, self.input_form.whole()))
    }

    fn steps(&self) -> impl Iterator<Item = (usize, f64)> {
        (1..self.t.len()).map(|k| (k, self.t[k] - self.t[k - 1]))
    }

    /// What rounding may add to the step that ends at `k`. Writers drop zeros at the end of a number, and some keep a fixed number of
    /// digits, so the finest stamp nearby shows how finely they write there.
    fn rounding(&self, k: usize) -> f64 {
        let near = &self.resolution[k.saturating_sub(8)..(k + 8).min(self.resolution.len())];
        // Twice half a last digit, and what the differences of large numbers lose.
        near.iter().copied().fold(f64::INFINITY, f64::min) + 4.0 * f64::EPSILON * self.t[k].abs()
    }

    fn check_lengths(&self, timing: &Timing) -> Result<(), Fault> {
        let sample_time = timing.sample_time;
        let mut ends = timing.dropouts.clone();
        ends.push(self.t.len());
        let mut start = 0;
        for end in ends {
            let steps = (end - 1 - start) as f64;
            let length = self.t[end - 1] - self.t[start];
            if (length - steps * sample_time).abs() > (0.01 * steps * sample_time).max(0.5 * sample_time) {
                return Err((None, self.other_sample_time(length / steps, sample_time)));
            }
            start = end;
        }
        Ok(())
    }

    fn other_sample_time(&self, mean_step: f64, sample_time: f64) -> DataProblem {
        DataProblem::OtherSampleTime {
            column: self.column.to_owned(),
            mean_step: rounded(mean_step),
            sample_time: rounded(sample_time),
            remedy: self.input_form.other_sample_time(rounded(mean_step)),
        }
    }

    fn uneven(&self, k: usize, sample_time: f64) -> DataProblem {
        DataProblem::Uneven(self.step_to(k, sample_time, self.input_form.uneven()))
    }
}

/// Whether a signal lies where the stamps say, rather than evenly.
fn follows(signal: &[f64], offsets: &[f64]) -> bool {
    let beside = |of: &[f64], k: usize| of[k] - 0.5 * (of[k - 1] + of[k + 1]);
    let inner = 1..signal.len().saturating_sub(1);
    let pairs: Vec<(f64, f64)> = inner
        .map(|k| (beside(signal, k), 0.5 * (signal[k + 1] - signal[k - 1]) * beside(offsets, k)))
        .collect();
    // Corners and spikes say nothing of the clock.
    let mut sizes: Vec<f64> = pairs.iter().map(|(off, _)| off.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let Some(usual) = sizes.get(9 * sizes.len() / 10) else { return false };
    let plain = || pairs.iter().filter(|(off, _)| off.abs() <= *usual);
    let (cross, square): (f64, f64) = plain().fold((0.0, 0.0), |(cross, square), (off, expected)| {
        (cross + off * expected, square + expected * expected)
    });
    let noise = plain().map(|(off, _)| off * off).sum::<f64>() / plain().count().max(1) as f64;
    let slope = cross / square;
    square > 0.0 && slope > 0.4 && slope > 3.0 * (noise / square).sqrt()
}

/// The upper median of some numbers, one at least.
fn middle(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

/// Seconds that the last digit of a stamp is worth, as it was written in units of `unit` seconds.
pub(super) fn resolution(stamp: f64, unit: f64) -> f64 {
    let written = format!("{stamp:e}");
    let (digits, exponent) = written.split_once('e').unwrap_or((&written, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let exponent: i32 = exponent.parse().unwrap_or(0);
    unit * 10f64.powi(exponent - decimals as i32)
}

/// The step of the fewest digits within `tolerance`, or that whose rate has fewer still: 0.004 s, but 300 Hz.
pub(super) fn nice(step: f64, tolerance: f64) -> f64 {
    let (digits, short) = shortest(step, tolerance);
    let (digits_of_rate, rate) = shortest(1.0 / step, tolerance / (step * step));
    if digits_of_rate < digits { 1.0 / rate } else { short }
}

/// The number with the fewest decimals of its power of ten within `tolerance`, and how many these are.
fn shortest(x: f64, tolerance: f64) -> (usize, f64) {
    (0..17)
        .filter_map(|digits| Some((digits, format!("{x:.digits$e}").parse().ok()?)))
        .find(|(_, short): &(usize, f64)| (short - x).abs() <= tolerance)
        .unwrap_or((17, x))
}

/// Eight significant digits: differences of stamps carry rounding errors that nobody wants to read.
pub fn rounded(x: f64) -> f64 {
    format!("{x:.7e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn even(n: usize, step: f64, start: f64) -> Vec<f64> {
        (0..n).map(|k| start + k as f64 * step).collect()
    }

    fn judged(t: &[f64], declared: Option<f64>) -> Result<Timing, Fault> {
        let resolution: Vec<f64> = t.iter().map(|t| resolution(*t, 1.0)).collect();
        let written = |k: usize| t[k].to_string();
        Stamps {
            column: "t",
            t,
            resolution: &resolution,
            written: &written,
            input_form: &InputForm::Manifest,
        }
        .judge(declared)
    }

    #[test]
    fn the_last_digit_of_a_stamp_is_known() {
        for (stamp, worth) in [(0.25, 0.01), (12.0, 1.0), (1e-5, 1e-5), (1234.5, 0.1)] {
            let found = resolution(stamp, 1.0);
            assert!((found / worth - 1.0).abs() < 1e-12, "{stamp}: {found}");
        }
    }

    #[test]
    fn even_stamps_pass_wherever_they_start() {
        for declared in [None, Some(0.004)] {
            let timing = judged(&even(5000, 0.004, 20.004), declared).unwrap();
            assert_eq!((timing.sample_time, timing.dropouts), (0.004, vec![]));
            assert!(timing.jitter < 1e-6, "{}", timing.jitter);
        }
    }

    #[test]
    fn rounded_stamps_pass_and_their_mean_step_is_found() {
        let hundredths = |t: &f64| (t * 100.0).round() / 100.0;
        let thirds: Vec<f64> = even(3001, 1.0 / 30.0, 5.0).iter().map(hundredths).collect();
        assert!(judged(&thirds, Some(1.0 / 30.0)).is_ok());
        assert_eq!(judged(&thirds, None).unwrap().sample_time, 1.0 / 30.0);
    }

    #[test]
    fn rates_are_found_from_stamps_of_a_millisecond() {
        let milliseconds = |t: &f64| (t * 1000.0).round() / 1000.0;
        for rate in [24.0, 30.0, 60.0, 128.0, 256.0, 300.0, 700.0] {
            let mut t: Vec<f64> = even(2000, 1.0 / rate, 0.0).iter().map(milliseconds).collect();
            assert_eq!(judged(&t, None).unwrap().sample_time, 1.0 / rate);
            t.drain(700..1000);
            let timing = judged(&t, None).unwrap();
            assert_eq!(timing.dropouts, [700]);
            assert_eq!(timing.sample_time, 1.0 / rate);
        }
    }

    #[test]
    fn jitter_below_one_percent_is_measured_and_beyond_it_is_refused() {
        let shaken = |share: f64| -> Vec<f64> {
            let shake = |k: usize| share * 0.01 * (k as f64 * 1.7).sin();
            (0..500).map(|k| 0.01 * k as f64 + 0.5 * shake(k)).collect()
        };
        let timing = judged(&shaken(0.009), None).unwrap();
        assert!(timing.jitter > 0.004 && timing.jitter < 0.01, "{}", timing.jitter);
        let (index, problem) = judged(&shaken(0.05), None).unwrap_err();
        assert!(matches!(problem, DataProblem::Uneven(_)) && index.is_some(), "{problem}");
        assert!(judged(&shaken(0.05), Some(0.01)).is_ok(), "a declared sample time forgives it");
    }

    /// Of stamps that are each off by up to 0.4 samples, one step in fourteen is longer than one and a half. Where none of them is taken for a
    /// gap, and no gap for one of them, the mean is known to the errors of the two ends of each even stretch.
    #[test]
    fn late_stamps_are_no_lost_samples() {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            2.0 * (state >> 11) as f64 / (1_u64 << 53) as f64 - 1.0
        };
        for (shake, gaps, allowed) in [(0.4, 0, JITTER), (0.1, 12, 2.0 * 0.1 * 13.0 / 560.0)] {
            for _ in 0..50 {
                let mut t: Vec<f64> = (0..600).map(|k| 0.01 * (f64::from(k) + shake * uniform())).collect();
                (0..gaps).for_each(|gap| drop(t.drain(45 * gap + 20..45 * gap + 21 + gap % 3)));
                let resolution = vec![1e-9; t.len()];
                let written = |k: usize| t[k].to_string();
                let (t, resolution) = (&t[..], &resolution[..]);
                let stamps = Stamps {
                    column: "t",
                    t,
                    resolution,
                    written: &written,
                    input_form: &InputForm::Manifest,
                };
                let found = stamps.mean_step().unwrap();
                assert!((found / 0.01 - 1.0).abs() < allowed, "{gaps} gaps: {found}");
            }
        }
    }

    #[test]
    fn lost_samples_are_dropouts_at_their_places() {
        for declared in [None, Some(0.01)] {
            let mut t = even(100, 0.01, 0.0);
            t.drain(60..75);
            t.remove(40);
            assert_eq!(judged(&t, declared).unwrap().dropouts, [40, 59]);
        }
    }

    #[test]
    fn another_sample_time_is_named() {
        for step in [0.012, 0.02, 0.005] {
            let (index, problem) = judged(&even(100, step, 0.0), Some(0.01)).unwrap_err();
            assert_eq!(index, None);
            assert!(
                matches!(problem, DataProblem::OtherSampleTime { mean_step, .. } if mean_step == step),
                "{problem}"
            );
        }
    }

    #[test]
    fn time_never_stands_still_or_runs_back() {
        for t in [[0.0, 0.01, 0.01], [0.0, 0.01, 0.005]] {
            assert!(matches!(judged(&t, None), Err((Some(2), DataProblem::NotIncreasing(_)))));
        }
    }
}
