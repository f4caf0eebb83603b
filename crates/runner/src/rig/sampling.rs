//! Are the time stamps those of even sampling?

use super::csv_error::CsvProblem;

/// Checks that `t` increases in steps of `sample_time`; `Err` holds the index of the offending sample, or none where
/// the record as a whole is at fault.
///
/// Two tolerances, because stamps are rounded when written and jitter when taken, but neither adds up:
/// - a single step may be off by less than half a sample. A lost sample makes a step of two, a doubled one a step of
///   none; both are a whole sample off. Stamps rounded to a quarter of the sample time still pass. Where the typical step is
///   off too, it is not a gap but another sample time.
/// - the whole record may be off by 1 % of its length or half a sample, whichever is more: beyond that the sample time is
///   another one, and every frequency and time constant would be wrong by as much.
///
/// Where the record starts does not matter.
pub(super) fn check(t: &[f64], sample_time: f64) -> Result<(), (Option<usize>, CsvProblem)> {
    for k in 1..t.len() {
        if t[k] <= t[k - 1] {
            return Err((Some(k), CsvProblem::NotIncreasing { before: t[k - 1], now: t[k] }));
        }
    }
    let Some(typical) = median_step(t) else { return Ok(()) };
    let is_off = |step: f64, share: f64| (step - sample_time).abs() >= share * sample_time;
    if is_off(typical, 0.3) {
        return Err((None, CsvProblem::OtherSampleTime { mean_step: rounded(typical), sample_time }));
    }
    if let Some(k) = (1..t.len()).find(|&k| is_off(t[k] - t[k - 1], 0.5)) {
        let (before, now) = (t[k - 1], t[k]);
        return Err((Some(k), CsvProblem::Gap { before, now, step: rounded(now - before), sample_time }));
    }
    let steps = (t.len() - 1) as f64;
    let length = t[t.len() - 1] - t[0];
    if (length - steps * sample_time).abs() > (0.01 * steps * sample_time).max(0.5 * sample_time) {
        return Err((None, CsvProblem::OtherSampleTime { mean_step: rounded(length / steps), sample_time }));
    }
    Ok(())
}

fn median_step(t: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied()
}

/// Six significant digits: differences of stamps carry rounding errors that nobody wants to read.
fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn even(n: usize, step: f64, start: f64) -> Vec<f64> {
        (0..n).map(|k| start + k as f64 * step).collect()
    }

    #[test]
    fn even_stamps_pass_wherever_they_start() {
        assert_eq!(check(&even(5000, 0.004, 20.004), 0.004), Ok(()));
    }

    #[test]
    fn rounded_and_jittering_stamps_pass() {
        let thirds: Vec<f64> =
            even(300, 1.0 / 30.0, 5.0).iter().map(|t| (t * 100.0).round() / 100.0).collect();
        assert_eq!(check(&thirds, 1.0 / 30.0), Ok(()));
    }

    #[test]
    fn a_lost_sample_is_a_gap_at_its_place() {
        let mut t = even(100, 0.01, 0.0);
        t.remove(40);
        let (index, problem) = check(&t, 0.01).unwrap_err();
        assert_eq!(index, Some(40));
        assert!(matches!(problem, CsvProblem::Gap { step, .. } if step == 0.02), "{problem}");
    }

    #[test]
    fn another_sample_time_is_named() {
        for step in [0.012, 0.02, 0.005] {
            let (index, problem) = check(&even(100, step, 0.0), 0.01).unwrap_err();
            assert_eq!(index, None);
            assert!(
                matches!(problem, CsvProblem::OtherSampleTime { mean_step, .. } if mean_step == step),
                "{problem}"
            );
        }
    }

    #[test]
    fn time_never_stands_still_or_runs_back() {
        for t in [[0.0, 0.01, 0.01], [0.0, 0.01, 0.005]] {
            assert!(matches!(check(&t, 0.01), Err((Some(2), CsvProblem::NotIncreasing { .. }))));
        }
    }
}
