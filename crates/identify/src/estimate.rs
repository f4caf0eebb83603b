//! What every method returns.

use super::border_distance::{BorderDistance, BorderGap, joint_limit};

/// One estimated point of a border.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BorderPoint {
    /// Position on the input axis, input units.
    pub v: f64,
    /// `F̂` at `v`, in the normalisation `u_M − u_m = 1`.
    pub f: f64,
    /// Standard error of `f`.
    pub se: f64,
}

/// An identified system in the paper's normalisation `u_M − u_m = 1`.
///
/// `gain` restores output units: `gain·f` is the stationary output that a border value `f` holds, and
/// `gain = B̂(1)/Â(1)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// `a₁…aₙ`.
    pub a: Vec<f64>,
    /// Their standard errors.
    pub a_se: Vec<f64>,
    /// `b₁…bₙ`, output units per normalised `u`.
    pub b: Vec<f64>,
    /// Their standard errors.
    pub b_se: Vec<f64>,
    /// Extra whole samples of delay between `u` and `y`: `B` acts on `u(t−1−delay)` and older; zero in the paper. −1 is a
    /// direct term `b₀u(t)` before `b₁…bₙ`; lower values look ahead, as where the sensor of `v` lags.
    pub delay: isize,
    /// Standard deviation of the equation error, output units.
    pub noise_sd: f64,
    /// `B̂(1)/Â(1)`, output units per normalised `u`.
    pub gain: f64,
    /// Stationary output with the working point at `(h_M, u_M)`.
    pub y_high: f64,
    /// Stationary output with the working point at `(h_m, u_m)`.
    pub y_low: f64,
    /// Points of the descending border, by increasing `v`; empty where the method does not see it.
    pub descending: Vec<BorderPoint>,
    /// Points of the ascending border, by increasing `v`; empty where the method does not see it.
    pub ascending: Vec<BorderPoint>,
    /// Smallest eigenvalue of the information matrix, per sample: the excitation the record really gave. Of designed experiments in squared output
    /// units or input units as the regressors have them; of any record on an output between −1 and 1.
    pub excitation: f64,
    /// Samples that entered the regression.
    pub samples: usize,
}

/// Standard errors of what follows from the coefficients and the borders together, output units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelErrors {
    /// Of [`Estimate::gain`].
    pub gain: f64,
    /// Of [`Estimate::y_high`].
    pub y_high: f64,
    /// Of [`Estimate::y_low`].
    pub y_low: f64,
}

/// A coefficient of `A` or `B` with its name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficient {
    /// `a` or `b`.
    pub letter: char,
    /// Its lag in the paper's numbering; 0 is a direct term and negative ones look ahead.
    pub lag: isize,
    /// Its value.
    pub value: f64,
    /// Its standard error.
    pub se: f64,
}

impl Estimate {
    /// `a₁…aₙ`, each with its name.
    pub fn a_coefficients(&self) -> impl Iterator<Item = Coefficient> {
        named('a', 1, &self.a, &self.a_se)
    }

    /// The coefficients of `B`, each with its name. A negative delay starts at `b₀` or before; a positive one shifts the whole of `B` and
    /// leaves the names alone.
    pub fn b_coefficients(&self) -> impl Iterator<Item = Coefficient> {
        named('b', 1 + self.delay.min(0), &self.b, &self.b_se)
    }

    /// Of `A` and of `B`, the largest coefficient that carries its polynomial though it is not distinguished from zero, with the polynomial at 1.
    ///
    /// A coefficient carries it if it is larger than `A(1)` or `B(1)`, all that remains when the coefficients are added up. It is not distinguished from
    /// zero within its joint 95 % interval (Bonferroni over the polynomial's coefficients).
    pub fn hollow_coefficients(&self) -> impl Iterator<Item = (Coefficient, f64)> {
        let sum = |values: &[f64]| values.iter().sum::<f64>();
        let parts = [
            (self.a_coefficients().collect::<Vec<_>>(), 1.0 + sum(&self.a)),
            (self.b_coefficients().collect(), sum(&self.b)),
        ];
        parts.into_iter().filter_map(|(terms, sum)| {
            let limit = joint_limit(terms.len());
            let hollow =
                terms.into_iter().filter(|c| c.value.abs() > sum.abs() && c.value.abs() <= limit * c.se);
            Some((hollow.max_by(|x, y| x.value.abs().total_cmp(&y.value.abs()))?, sum))
        })
    }

    /// How far the borders lie apart where both have a point, from the points' own errors.
    ///
    /// Errors that both borders share are counted twice, so that the borders are distinguished rather too seldom.
    pub fn distance_at_common_points(&self) -> Option<BorderDistance> {
        let gaps = self.ascending.iter().filter_map(|up| {
            let down = self.descending.iter().find(|down| down.v == up.v)?;
            Some(BorderGap {
                v: up.v,
                difference: up.f - down.f,
                se: up.se.hypot(down.se),
                interpolation: 0.0,
            })
        });
        BorderDistance::of(&gaps.collect::<Vec<_>>())
    }
}

fn named(letter: char, first: isize, values: &[f64], errors: &[f64]) -> impl Iterator<Item = Coefficient> {
    let pairs = values.iter().zip(errors);
    (first..).zip(pairs).map(move |(lag, (&value, &se))| Coefficient { letter, lag, value, se })
}
