//! Whether two borders differ beyond their errors.

use statrs::distribution::{ContinuousCDF, Normal};

/// The ascending border less the descending one at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BorderGap {
    /// Position on the input axis, input units.
    pub v: f64,
    /// `F̂_a − F̂_d`, in the normalisation `u_M − u_m = 1`.
    pub difference: f64,
    /// Its standard error.
    pub se: f64,
    /// What straight lines between points may be off by, so that equal curves on different points seem to differ.
    pub interpolation: f64,
}

impl BorderGap {
    fn z(&self) -> f64 {
        let beyond = self.difference.abs() - self.interpolation;
        if beyond <= 0.0 { 0.0 } else { beyond / self.se }
    }
}

/// How far two borders lie apart, seen against their errors.
///
/// ```text
/// z_j = (|F̂_a(v_j) − F̂_d(v_j)| − i_j) / se_j,   distinguished at v_j if z_j > Φ⁻¹(1 − 0.025/K),   j = 1…K
/// ```
///
/// `i_j` is what straight lines between the points of a curved border may be off by. With `K` places looked at, the limit for each is that of Bonferroni, so that a machine with one curve is seen to have two at some place in at
/// most 5 % of all records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BorderDistance {
    /// Where the borders are most clearly apart.
    pub clearest: BorderGap,
    /// `z` there.
    pub z: f64,
    /// The limit that each `z` is held against.
    pub limit: f64,
    /// Places looked at.
    pub places: usize,
    /// Share of the stroke between the outermost places over which the borders are distinguished, from 0 to 1: pieces whose ends both are.
    pub distinguished: f64,
}

/// Two-sided level of the joint test.
const LEVEL: f64 = 0.05;

impl BorderDistance {
    /// From the differences at several places, by increasing `v`; `None` without a place, or where an error is unknown.
    pub(crate) fn of(gaps: &[BorderGap]) -> Option<Self> {
        if gaps.iter().any(|gap| !(gap.difference.is_finite() && gap.se >= 0.0)) {
            return None;
        }
        let clearest = *gaps.iter().max_by(|x, y| x.z().total_cmp(&y.z()))?;
        let limit = joint_limit(gaps.len());
        let stroke = gaps[gaps.len() - 1].v - gaps[0].v;
        let apart = gaps.windows(2).filter(|pair| pair.iter().all(|gap| gap.z() > limit));
        // An empty sum is −0.
        let apart: f64 = 0.0 + apart.map(|pair| pair[1].v - pair[0].v).sum::<f64>();
        let distinguished = match stroke > 0.0 {
            true => apart / stroke,
            false => f64::from(u8::from(clearest.z() > limit)),
        };
        Some(Self { clearest, z: clearest.z(), limit, places: gaps.len(), distinguished })
    }

    /// Whether the borders differ nowhere.
    pub fn has_vanished(&self) -> bool {
        self.z <= self.limit
    }
}

/// What each of `count` standard normal deviates stays under, all of them together with probability 95 % or more.
pub(super) fn joint_limit(count: usize) -> f64 {
    Normal::standard().inverse_cdf(1.0 - 0.5 * LEVEL / count.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gap(v: f64, difference: f64) -> BorderGap {
        BorderGap { v, difference, se: 0.1, interpolation: 0.0 }
    }

    #[test]
    fn one_place_is_held_against_the_usual_limit_and_more_places_against_a_higher_one() {
        assert!((joint_limit(1) - 1.959_964).abs() < 1e-6);
        assert!((joint_limit(10) - 2.807_034).abs() < 1e-6);
    }

    #[test]
    fn the_share_distinguished_is_that_of_the_stroke() {
        let found =
            BorderDistance::of(&[gap(0.0, 0.0), gap(1.0, 0.5), gap(3.0, 0.6), gap(4.0, 0.1)]).unwrap();
        assert!((found.distinguished - 0.5).abs() < 1e-12 && !found.has_vanished());
        assert_eq!(found.clearest.v, 3.0);
        let found = BorderDistance::of(&[gap(0.0, 0.1), gap(1.0, -0.2)]).unwrap();
        assert!(found.distinguished == 0.0 && found.has_vanished());
    }

    #[test]
    fn what_interpolation_explains_shows_nothing_apart() {
        let curved = BorderGap { interpolation: 0.4, ..gap(0.0, -0.5) };
        let found = BorderDistance::of(&[curved]).unwrap();
        assert!((found.z - 1.0).abs() < 1e-12 && found.has_vanished());
    }

    #[test]
    fn an_unknown_error_gives_no_answer() {
        assert_eq!(BorderDistance::of(&[BorderGap { se: f64::NAN, ..gap(0.0, 1.0) }]), None);
        assert_eq!(BorderDistance::of(&[]), None);
    }
}
