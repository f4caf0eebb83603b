//! Sign, factor and delay between two outputs, by one regression of either on the shifted other.

/// `y ≈ factor·y_A(t − delay) + constant`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alignment {
    /// Factor; negative where a sign is turned.
    pub factor: f64,
    /// Delay, samples.
    pub delay: isize,
    /// Share of the variance of `y` that it explains.
    pub explained: f64,
}

/// Whole delays tried, either way.
const MOST_DELAY: isize = 30;

/// The regression of the delay that explains most; records are given as `(y, y_A)`.
pub fn align(records: &[(&[f64], &[f64])]) -> Option<Alignment> {
    let tried = (-MOST_DELAY..=MOST_DELAY).filter_map(|delay| regression(records, delay));
    // Of equals the delay nearest to none.
    tried.max_by(|x, y| x.explained.total_cmp(&y.explained).then(y.delay.abs().cmp(&x.delay.abs())))
}

/// The regression at a delay; none where either signal is constant.
pub fn regression(records: &[(&[f64], &[f64])], delay: isize) -> Option<Alignment> {
    if records.is_empty() {
        return None;
    }
    let pairs = || {
        records.iter().flat_map(move |(y, x)| {
            let skipped = MOST_DELAY as usize;
            let inside = skipped..y.len().saturating_sub(skipped).max(skipped);
            inside.map(move |t| (x[t.wrapping_add_signed(-delay)], y[t]))
        })
    };
    let count = pairs().count() as f64;
    let (sx, sy) = pairs().fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
    let (mx, my) = (sx / count, sy / count);
    let moments = pairs().fold([0.0; 3], |[xx, xy, yy], (x, y)| {
        let (x, y) = (x - mx, y - my);
        [xx + x * x, xy + x * y, yy + y * y]
    });
    let [xx, xy, yy] = moments;
    (xx > 0.0 && yy > 0.0 && count > 2.0).then(|| Alignment {
        factor: xy / xx,
        delay,
        explained: xy * xy / (xx * yy),
    })
}

/// Relative distance to a power of a thousand within which a factor is taken for one of units.
const NEAR: f64 = 0.03;

/// A gain that is a sign, a power of a thousand, or both: the sides measure in other units, and all values are in those of the machine.
pub fn unit_factor(gain: f64) -> Option<f64> {
    let factor = gain.signum() * libm::pow(1000.0, (libm::log10(gain.abs()) / 3.0).round());
    (factor.is_finite() && factor != 1.0 && (gain / factor - 1.0).abs() < NEAR).then_some(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sign_factor_and_delay_are_read_off() {
        let x: Vec<f64> =
            (0..500).map(|t| (0.11 * f64::from(t)).sin() + (0.031 * f64::from(t)).cos()).collect();
        let y: Vec<f64> = (0..500).map(|t: usize| 3.0 - 2.5 * x[t.saturating_sub(4)]).collect();
        let found = align(&[(&y, &x)]).unwrap();
        assert_eq!(found.delay, 4);
        assert!((found.factor + 2.5).abs() < 1e-9 && found.explained > 1.0 - 1e-9);
        assert_eq!(align(&[(&y, &[1.0; 500])]), None);
    }
}
