//! Instants at which the coefficients of a regression change.
//!
//! ```text
//! e(t) = β·s(t) + γ,   β and γ other from the instant on
//! gain(T) = R(0…T) + R(T…N) − R(0…N)
//! ```
//!
//! `R` is the sum of squares that a least-squares fit of a segment explains (G. C. Chow, "Tests of equality between sets of coefficients in two
//! linear regressions", Econometrica 28, 1960). By running sums every instant is tried, in one pass over the samples.

/// Where coefficients change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChangePoint {
    /// First sample after the change.
    pub at: usize,
    /// By how much `β` changes.
    pub change: f64,
    /// Sum of squares that the change explains.
    gain: f64,
}

/// Samples on either side of a change at least.
const LEAST: usize = 8;
/// Share of a segment's energy of `s` about its mean below which `β` and `γ` are one.
const ALIKE: f64 = 1e-9;

/// All changes of the regression of `e` on `s` with enough samples on either side.
pub fn change_points(e: &[f64], s: &[f64]) -> Vec<ChangePoint> {
    let n = e.len().min(s.len());
    let mut sums = vec![Sums::default()];
    sums.extend(e.iter().zip(s).scan(Sums::default(), |sum, (e, s)| {
        *sum = sum.plus(*e, *s);
        Some(*sum)
    }));
    let whole = sums[n].regression().explained;
    let point = |at: usize| {
        let (before, after) = (sums[at].regression(), sums[n].minus(sums[at]).regression());
        let gain = before.explained + after.explained - whole;
        ChangePoint { at, change: after.slope - before.slope, gain }
    };
    (LEAST..(n + 1).saturating_sub(LEAST)).map(point).collect()
}

/// The likeliest of some changes, best first: at most `count`, each `apart` samples from those before it.
pub fn likeliest(points: &[ChangePoint], count: usize, apart: usize) -> Vec<ChangePoint> {
    let mut found: Vec<ChangePoint> = Vec::new();
    for _ in 0..count {
        let is_new = |p: &&ChangePoint| found.iter().all(|f| f.at.abs_diff(p.at) >= apart);
        let best = points.iter().filter(is_new).max_by(|x, y| x.gain.total_cmp(&y.gain));
        found.extend(best);
    }
    found
}

/// Sums over the samples of a segment.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    n: f64,
    s: f64,
    e: f64,
    ss: f64,
    se: f64,
}

struct Regression {
    slope: f64,
    explained: f64,
}

impl Sums {
    fn plus(self, e: f64, s: f64) -> Self {
        Self { n: self.n + 1.0, s: self.s + s, e: self.e + e, ss: self.ss + s * s, se: self.se + s * e }
    }

    fn minus(self, before: Self) -> Self {
        Self {
            n: self.n - before.n,
            s: self.s - before.s,
            e: self.e - before.e,
            ss: self.ss - before.ss,
            se: self.se - before.se,
        }
    }

    /// Where `s` is constant the slope is that through the origin.
    fn regression(self) -> Regression {
        let (spread, cross) = (self.ss - self.s * self.s / self.n, self.se - self.s * self.e / self.n);
        let constant = self.e * self.e / self.n;
        match spread > ALIKE * self.ss {
            true => Regression { slope: cross / spread, explained: constant + cross * cross / spread },
            false => Regression { slope: self.se / self.ss.max(f64::MIN_POSITIVE), explained: constant },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::white;

    /// Sum of squares that the regression of a segment explains, by its definition: what is there less what is left.
    fn explained(e: &[f64], s: &[f64]) -> f64 {
        let n = e.len() as f64;
        let [mean_e, mean_s] = [e, s].map(|x| x.iter().sum::<f64>() / n);
        let cross: f64 = e.iter().zip(s).map(|(e, s)| (e - mean_e) * (s - mean_s)).sum();
        let slope = cross / s.iter().map(|s| (s - mean_s).powi(2)).sum::<f64>();
        let left: f64 = e.iter().zip(s).map(|(e, s)| (e - mean_e - slope * (s - mean_s)).powi(2)).sum();
        e.iter().map(|e| e * e).sum::<f64>() - left
    }

    #[test]
    fn a_change_is_found_where_it_is_with_its_size() {
        let mut noise = white();
        let s: Vec<f64> = (0..400).map(|t| 1.0 + (0.3 * f64::from(t)).sin()).collect();
        let e: Vec<f64> =
            (0..400).map(|t| if t < 230 { -0.2 * s[t] } else { 0.3 * s[t] + 0.1 } + 0.05 * noise()).collect();
        let found = likeliest(&change_points(&e, &s), 2, 50);
        assert_eq!(found.len(), 2);
        assert!(found[0].at.abs_diff(230) <= 2 && (found[0].change - 0.5).abs() < 0.03, "{found:?}");
        assert!(found[1].at.abs_diff(found[0].at) >= 50 && found[1].gain < found[0].gain);
        // The oracle of the gain: three regressions from scratch.
        let at = found[0].at;
        let gain = explained(&e[..at], &s[..at]) + explained(&e[at..], &s[at..]) - explained(&e, &s);
        assert!((found[0].gain - gain).abs() < 1e-8 * gain, "{} {gain}", found[0].gain);
    }

    #[test]
    fn at_rest_a_level_that_jumps_is_a_change_as_well() {
        let level = |t: i32| if t < 40 { 0.0 } else { 1.0 };
        let e: Vec<f64> = (0..100).map(level).collect();
        let found = likeliest(&change_points(&e, &[2.0; 100]), 1, 10);
        assert!(found[0].at == 40 && (found[0].change - 0.5).abs() < 1e-9, "{found:?}");
        assert!(change_points(&[1.0; 9], &[1.0; 9]).is_empty());
    }
}
