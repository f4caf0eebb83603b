//! Periodograms, autocorrelations and autoregressions of signals, each a list of records.

use std::f64::consts::{LN_2, PI};

use realfft::RealFftPlanner;

use crate::sums::{dot, energy};

/// Squared magnitudes of the transform of a zero-padded signal at frequencies `k/padded`, `k = 0…padded/2`.
///
/// # Panics
/// If the signal is longer than `padded`.
pub fn power(signal: &[f64], padded: usize) -> Vec<f64> {
    assert!(signal.len() <= padded, "a transform of {padded} points cannot hold {} samples", signal.len());
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(padded);
    let mut padded_signal = transform.make_input_vec();
    padded_signal[..signal.len()].copy_from_slice(signal);
    let mut spectrum = transform.make_output_vec();
    transform.process(&mut padded_signal, &mut spectrum).expect("the lengths are the plan's");
    spectrum.iter().map(|line| line.norm_sqr()).collect()
}

/// The strongest lines over all records, radians per sample: peaks of the summed periodograms, each over its own local level.
pub fn strongest_lines(innovations: &[Vec<f64>], count: usize) -> Vec<f64> {
    let longest = innovations.iter().map(Vec::len).max().unwrap_or(0);
    if longest < 64 {
        return Vec::new();
    }
    let padded = (2 * longest).next_power_of_two();
    let mut sum = vec![0.0; padded / 2 + 1];
    for w in innovations.iter().filter(|w| w.len() >= 64) {
        let mean = w.iter().sum::<f64>() / w.len() as f64;
        let centred: Vec<f64> = w.iter().map(|x| x - mean).collect();
        let energy: f64 = centred.iter().map(|x| x * x).sum::<f64>().max(1e-300);
        for (s, p) in sum.iter_mut().zip(power(&centred, padded)) {
            *s += p / energy * w.len() as f64;
        }
    }
    let mut order: Vec<usize> = (2..sum.len() - 1).collect();
    order.sort_by(|&i, &j| sum[j].total_cmp(&sum[i]));
    let mut lines: Vec<f64> = Vec::new();
    let apart = 4.0 * 2.0 * PI / longest as f64;
    for k in order {
        let omega = 2.0 * PI * k as f64 / padded as f64;
        if lines.iter().all(|l| (l - omega).abs() > apart) {
            lines.push(omega);
            if lines.len() == count {
                break;
            }
        }
    }
    lines
}

/// The frequency near `omega` at which a line through all records, phase and amplitude free in each, takes the most of them: what is
/// strong leaves much even a hundredth of a bin beside it.
pub fn sharpened(scaled_records: &[Vec<f64>], omega: f64) -> f64 {
    /// Share of the larger part in a golden section, and sections: to a thousandth of where it began.
    const GOLDEN: f64 = 0.618_033_988_749_895;
    const SECTIONS: usize = 15;
    let longest = scaled_records.iter().map(Vec::len).max().unwrap_or(0).max(1);
    let taken = |omega: f64| energy_of_line(scaled_records, omega);
    let bin = PI / longest as f64;
    let (mut low, mut high) = (omega - bin, omega + bin);
    for _ in 0..SECTIONS {
        let effect_term = GOLDEN * (high - low);
        if taken(high - effect_term) < taken(low + effect_term) {
            low = high - effect_term
        } else {
            high = low + effect_term
        }
    }
    0.5 * (low + high)
}

/// Share of the energy of all records that a line takes.
pub fn share_of_line(scaled_records: &[Vec<f64>], omega: f64) -> f64 {
    energy_of_line(scaled_records, omega) / scaled_records.iter().map(|w| energy(w)).sum::<f64>().max(1e-300)
}

/// Energy that a line takes, phase and amplitude free in each record.
fn energy_of_line(scaled_records: &[Vec<f64>], omega: f64) -> f64 {
    scaled_records.iter().map(|w| 2.0 * ordinate(w, omega) / w.len().max(1) as f64).sum()
}

/// Squared magnitude of the transform at one frequency (Goertzel, Am. Math. Monthly 65, 1958).
fn ordinate(signal: &[f64], omega: f64) -> f64 {
    let turn = 2.0 * omega.cos();
    let (now, before) = signal.iter().fold((0.0, 0.0), |(now, before), x| (x + turn * now - before, now));
    now * now + before * before - turn * now * before
}

/// Autocorrelation at lags `0…most`, pooled over records.
pub fn autocorrelation(scaled_records: &[Vec<f64>], most: usize) -> Vec<f64> {
    let energy = scaled_records.iter().map(|w| energy(w)).sum::<f64>().max(1e-300);
    (0..=most)
        .map(|lag| {
            scaled_records.iter().map(|w| dot(w, w.get(lag..).unwrap_or_default())).sum::<f64>() / energy
        })
        .collect()
}

/// Independent errors per sample: one in `τ = k/ln 2` samples, `k` the lag at which the autocorrelation has fallen to a half.
///
/// Of coloured errors `1 + 2Σρ²` samples show as much about their variance as one white one (Bartlett), which is `τ` for
/// `ρ = e^(−lag/τ)`. The half is what is robust: a slow drift keeps the tail of `ρ` up.
pub fn independent_share(errors: &[Vec<f64>]) -> f64 {
    let longest = errors.iter().map(Vec::len).max().unwrap_or(1);
    let rho = autocorrelation(errors, (longest / 4).max(1));
    let half = rho.iter().position(|r| *r < 0.5).unwrap_or(rho.len());
    (LN_2 / half as f64).min(1.0)
}

/// Portmanteau statistic of a white signal of `count` samples: `count·Σ r²` over the lags 1 to `most`.
pub fn portmanteau(scaled_records: &[Vec<f64>], most: usize, count: f64) -> f64 {
    autocorrelation(scaled_records, most)[1..].iter().map(|r| r * r).sum::<f64>() * count
}

/// Mean square over all records.
pub fn mean_square(signals: &[Vec<f64>]) -> f64 {
    let count: usize = signals.iter().map(Vec::len).sum();
    signals.iter().flatten().map(|x| x * x).sum::<f64>() / count.max(1) as f64
}

/// Order of the autoregression behind [`unpredictable_variance`].
const MEMORY: usize = 12;

/// Variance of what the past of a signal does not predict: innovations of an autoregression of order 12 through all records.
pub fn unpredictable_variance(signals: &[Vec<f64>]) -> f64 {
    let count: usize = signals.iter().map(Vec::len).sum();
    let lagged = |lag: usize| -> f64 {
        signals.iter().map(|x| x.iter().zip(x.iter().skip(lag)).map(|(a, b)| a * b).sum::<f64>()).sum()
    };
    let covariance: Vec<f64> = (0..=MEMORY).map(|lag| lagged(lag) / count.max(1) as f64).collect();
    levinson(&covariance).1
}

/// The autoregression `1 + a₁ q⁻¹ + …` of covariances at lags 0, 1, …, and the variance of its innovations (Levinson's recursion).
pub fn levinson(covariance: &[f64]) -> (Vec<f64>, f64) {
    let mut variance = covariance[0];
    let mut a: Vec<f64> = Vec::new();
    for order in 0..covariance.len() - 1 {
        if variance <= 1e-12 * covariance[0] {
            break;
        }
        let partial =
            covariance[order + 1] + a.iter().enumerate().map(|(i, a)| a * covariance[order - i]).sum::<f64>();
        let reflection = -partial / variance;
        let mut next: Vec<f64> = (0..order).map(|i| a[i] + reflection * a[order - 1 - i]).collect();
        next.push(reflection);
        a = next;
        variance *= 1.0 - reflection * reflection;
    }
    (a, variance.max(0.0))
}

/// The autoregression of signals, of the order up to `most` that the Bayesian information criterion prefers; empty where they are white.
pub fn autoregression(signals: &[Vec<f64>], most: usize) -> Vec<f64> {
    let count = signals.iter().map(Vec::len).sum::<usize>().max(1) as f64;
    let rho = autocorrelation(signals, most);
    let cost = |order: usize| {
        let variance = levinson(&rho[..=order]).1.max(f64::MIN_POSITIVE);
        count * variance.ln() + order as f64 * count.ln()
    };
    let order = (0..=most).min_by(|x, y| cost(*x).total_cmp(&cost(*y))).unwrap_or_default();
    levinson(&rho[..=order]).0
}

/// Lags of the autoregression behind [`moving_average`].
const LONG: usize = 40;

/// The moving average `1 + c₁ q⁻¹ + …` of a degree, `c₁…` returned, of which signals are made (Durbin, Biometrika 46, 1959): the
/// autoregression of the coefficients of a long autoregression. All zeros lie within the unit circle.
pub fn moving_average(signals: &[Vec<f64>], degree: usize) -> Vec<f64> {
    let mut long = vec![1.0];
    long.extend(levinson(&autocorrelation(signals, LONG)).0);
    let mut short = levinson(&autocorrelation(&[long], degree)).0;
    short.resize(degree, 0.0);
    short
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::white;
    use proptest::prelude::*;

    /// The oracle: the sum that defines the transform.
    fn power_by_definition(signal: &[f64], padded: usize) -> Vec<f64> {
        let line = |k: usize| {
            let (mut re, mut im) = (0.0, 0.0);
            for (t, x) in signal.iter().enumerate() {
                let angle = -2.0 * PI * (k * t % padded) as f64 / padded as f64;
                re += x * angle.cos();
                im += x * angle.sin();
            }
            re * re + im * im
        };
        (0..=padded / 2).map(line).collect()
    }

    #[test]
    fn the_definition_puts_a_cosine_in_its_own_line() {
        let x: Vec<f64> = (0..32).map(|t| (2.0 * PI * 5.0 * t as f64 / 32.0).cos()).collect();
        let p = power_by_definition(&x, 32);
        assert!((p[5] - 256.0).abs() < 1e-9, "(N/2)² = 256, found {}", p[5]);
        assert!(p.iter().enumerate().all(|(k, p)| k == 5 || *p < 1e-9), "{p:?}");
    }

    proptest! {
        #[test]
        fn the_fast_transform_agrees_with_the_sum(
            signal in prop::collection::vec(-1e3..1e3_f64, 1..200),
            more in 0..100_usize,
        ) {
            let padded = (signal.len() + more).next_multiple_of(2);
            let (fast, slow) = (power(&signal, padded), power_by_definition(&signal, padded));
            prop_assert_eq!(fast.len(), slow.len());
            let largest: f64 = slow.iter().copied().fold(0.0, f64::max);
            for (fast, slow) in fast.iter().zip(&slow) {
                prop_assert!((fast - slow).abs() <= 1e-11 * largest, "{} for {}", fast, slow);
            }
        }
    }

    #[test]
    fn a_line_is_sharpened_to_where_it_is() {
        let scaled = |n: usize, phase: f64| (0..n).map(|t| (0.5741 * t as f64 + phase).sin()).collect();
        let scaled_records: [Vec<f64>; 2] = [scaled(900, 0.3), scaled(400, 2.0)];
        let found = strongest_lines(&scaled_records, 1)[0];
        assert!((sharpened(&scaled_records, found) - 0.5741).abs() < 1e-5, "{found}");
        assert!((share_of_line(&scaled_records, 0.5741) - 1.0).abs() < 0.01);
        let p = power(&scaled_records[1][..256], 256);
        let slow = ordinate(&scaled_records[1][..256], 2.0 * PI * 17.0 / 256.0);
        assert!((p[17] - slow).abs() < 1e-9 * (1.0 + slow));
    }

    #[test]
    fn the_unpredictable_variance_is_that_of_the_innovations() {
        let mut white = white();
        let mut x = vec![0.0, 0.0];
        for t in 2..20_000 {
            x.push(1.6 * x[t - 1] - 0.7 * x[t - 2] + white());
        }
        assert!((unpredictable_variance(&[x.clone()]) - 1.0).abs() < 0.05);
        assert!(mean_square(&[x]) > 5.0);
        assert!(unpredictable_variance(&[]).abs() < 1e-12);
    }

    /// The oracle: the coefficients that a signal was made with.
    #[test]
    fn a_moving_average_is_reported_by_its_coefficients() {
        let c = [0.9, 0.3, -0.4];
        let mut white = white();
        let w: Vec<f64> = (0..40_000).map(|_| white()).collect();
        let past = |t: usize| c.iter().enumerate().map(|(k, c)| c * w[t - k - 1]).sum::<f64>();
        let x: Vec<f64> = (3..w.len()).map(|t| w[t] + past(t)).collect();
        let found = moving_average(&[x], 3);
        assert!(found.iter().zip(c).all(|(found, c)| (found - c).abs() < 0.03), "{found:?}");
        assert_eq!(moving_average(&[], 2), [0.0, 0.0]);
    }
}
