//! Sums from which control variates are adjusted by regression, for methods of which nothing is known, and interval scores.
//!
//! ```text
//! x = βᵀc + rest,   E[c] = 0,   E[ccᵀ] = Γ known
//! mean of x:    the mean of x − βᵀc
//! mean of x²:   the mean of x² − (βᵀc)² − 2x̄ βᵀc, and βᵀΓβ; x̄ the mean of the other sections
//! ```
//!
//! For any β that does not depend on the replicates it is applied to, both have the mean of the plain figures. So the replicates of each section
//! take the β that least squares find in all other sections (cross-fitting): it adds no bias, however few replicates there are.
//! S. S. Lavenberg and P. D. Welch, "A perspective on the use of control variables to increase the efficiency of Monte Carlo simulations",
//! Management Science 27 (1981), 322–335; V. Chernozhukov et al., "Double/debiased machine learning", Econometrics Journal 21 (2018), C1–C68.
//!
//! With an antithetic partner a replicate gives two figures: half the sum of both errors, in which all that changes its sign with the noise
//! cancels, and half their difference, in which all else does. The mean of the errors is that of the first, the mean of their squares that of both
//! squares. Each is adjusted by the controls of its own kind. A failure counts as an error of zero in all sums; means are then divided by the share of
//! estimates that there are, so that failures that depend on the noise do no harm.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use switchback_identify::statistics::{Measured, jackknife_se, normal_quantile_975};

/// How many controls of each kind, and of how many parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ControlShape {
    /// Those that change their sign with the noise.
    pub(super) linear: usize,
    /// Those that do not.
    pub(super) quadratic: usize,
    pub(super) parameters: usize,
    /// Whether replicates have antithetic partners.
    pub(super) is_paired: bool,
}

/// Sums by section.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ControlSums {
    shape: ControlShape,
    sections: Vec<Vec<f64>>,
}

/// The errors of a replicate and of its partner; none where there is no estimate.
#[derive(Debug, Clone, Copy)]
pub(super) struct PairOfErrors<'a> {
    pub(super) own: Option<&'a [f64]>,
    /// The standard errors that the replicate reports.
    pub(super) se: Option<&'a [f64]>,
    pub(super) partner: Option<&'a [f64]>,
}

/// What adjusted sums say of one parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Adjusted {
    pub(super) bias: Measured,
    /// The standard deviation, where the covariance of the controls was given.
    pub(super) sd: Option<f64>,
}

/// Replicates, and the share of them that have an estimate, come first in the sums of a section.
const HEAD: usize = 2;

/// Replicates for each coefficient that least squares need before they help.
const REPLICATES_A_CONTROL: f64 = 2.0;

/// Added to the normal matrix as a share of its mean diagonal, so that it has an inverse whatever the controls are.
const RIDGE: f64 = 1e-12;

/// Controls and figures that belong together, and where their sums begin: of products of controls, controls, products with figures, figures, squares.
#[derive(Debug, Clone, Copy)]
struct Channel {
    /// The first control.
    first: usize,
    controls: usize,
    parameters: usize,
    begin: usize,
    /// Whether the mean of its figures is zero, by symmetry.
    is_odd: bool,
}

impl ControlShape {
    fn channels(self) -> Vec<Channel> {
        let Self { linear, quadratic, parameters, is_paired } = self;
        let kinds: &[(usize, usize, bool)] = if is_paired {
            &[(0, linear, true), (linear, quadratic, false)]
        } else {
            &[(0, linear + quadratic, false)]
        };
        let mut begin = HEAD;
        let channel = |&(first, controls, is_odd): &(usize, usize, bool)| {
            let channel = Channel { first, controls, parameters, begin, is_odd };
            begin = channel.end();
            channel
        };
        kinds.iter().map(channel).collect()
    }

    /// Where the scores of intervals begin: their sums, then the sums of their squares.
    fn scores(self) -> usize {
        self.channels().last().map_or(HEAD, |channel| channel.end())
    }

    /// Numbers in the sums of a section.
    fn length(self) -> usize {
        self.scores() + 2 * self.parameters
    }
}

impl Channel {
    fn sums(self) -> usize {
        self.begin + self.controls * (self.controls + 1) / 2
    }

    fn products(self) -> usize {
        self.sums() + self.controls
    }

    fn figures(self) -> usize {
        self.products() + self.controls * self.parameters
    }

    fn end(self) -> usize {
        self.figures() + 2 * self.parameters
    }

    fn add(self, sums: &mut [f64], controls: &[f64], figures: impl Iterator<Item = f64>) {
        let own = &controls[self.first..self.first + self.controls];
        let mut at = self.begin;
        for (i, x) in own.iter().enumerate() {
            for y in &own[..=i] {
                sums[at] += x * y;
                at += 1;
            }
        }
        for x in own {
            sums[at] += x;
            at += 1;
        }
        for (k, figure) in figures.enumerate() {
            for (i, x) in own.iter().enumerate() {
                sums[self.products() + k * self.controls + i] += x * figure;
            }
            sums[self.figures() + k] += figure;
            sums[self.figures() + self.parameters + k] += figure * figure;
        }
    }

    /// `Σccᵀ`
    fn gram(self, sums: &[f64]) -> DMatrix<f64> {
        let at = |i: usize, j: usize| sums[self.begin + i * (i + 1) / 2 + j];
        DMatrix::from_fn(self.controls, self.controls, |i, j| at(i.max(j), i.min(j)))
    }

    /// Least squares with an intercept in some sums, for every parameter; no coefficients where there are too few replicates.
    fn coefficients(self, sums: &[f64]) -> DMatrix<f64> {
        let none = DMatrix::zeros(self.controls, self.parameters);
        if self.controls == 0 || sums[0] < REPLICATES_A_CONTROL * self.controls as f64 {
            return none;
        }
        let controls = DVector::from_column_slice(&sums[self.sums()..self.products()]);
        let figures = DVector::from_column_slice(&sums[self.figures()..self.figures() + self.parameters]);
        let mut gram = self.gram(sums) - &controls * controls.transpose() / sums[0];
        let ridge = RIDGE * gram.trace() / self.controls as f64;
        (0..self.controls).for_each(|i| gram[(i, i)] += ridge);
        let right = DMatrix::from_column_slice(
            self.controls,
            self.parameters,
            &sums[self.products()..self.figures()],
        );
        let right = right - &controls * figures.transpose() / sums[0];
        Cholesky::<f64, Dyn>::new(gram).map_or(none, |factor| factor.solve(&right))
    }
}

impl ControlSums {
    /// Of no replicates, in so many sections.
    pub(super) fn new(shape: ControlShape, sections: usize) -> Self {
        Self { shape, sections: vec![vec![0.0; shape.length()]; sections] }
    }

    /// Adds a replicate to a section.
    pub(super) fn push(&mut self, section: usize, controls: &[f64], errors: PairOfErrors<'_>) {
        let sums = &mut self.sections[section];
        let PairOfErrors { own, se, partner } = errors;
        let at = |of: Option<&[f64]>, k: usize| of.map_or(0.0, |errors| errors[k]);
        let share = |of: Option<&[f64]>| f64::from(u8::from(of.is_some()));
        let parameters = 0..self.shape.parameters;
        sums[0] += 1.0;
        for (k, (error, se)) in own.into_iter().flatten().zip(se.into_iter().flatten()).enumerate() {
            let score = interval_score(*error, *se);
            sums[self.shape.scores() + k] += score;
            sums[self.shape.scores() + self.shape.parameters + k] += score * score;
        }
        match self.shape.channels()[..] {
            [odd, even] => {
                sums[1] += 0.5 * (share(own) + share(partner));
                odd.add(sums, controls, parameters.clone().map(|k| 0.5 * (at(own, k) - at(partner, k))));
                even.add(sums, controls, parameters.map(|k| 0.5 * (at(own, k) + at(partner, k))));
            }
            [all] => {
                sums[1] += share(own);
                all.add(sums, controls, parameters.map(|k| at(own, k)));
            }
            _ => {}
        }
    }

    /// Adds the sums of other replicates, section for section.
    pub(super) fn merge(&mut self, other: &Self) {
        let pairs = self.sections.iter_mut().flatten().zip(other.sections.iter().flatten());
        pairs.for_each(|(into, from)| *into += from);
    }

    /// Appends all that is in it, as little-endian numbers of 64 bits.
    pub(super) fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.sections.iter().flatten().flat_map(|x| x.to_le_bytes()));
    }

    /// Takes what [`write`](Self::write) appended from the beginning of `bytes`; `None` where there is too little.
    pub(super) fn read((shape, sections): (ControlShape, usize), bytes: &mut &[u8]) -> Option<Self> {
        let mut sums = Self::new(shape, sections);
        for x in sums.sections.iter_mut().flatten() {
            let (own, rest) = bytes.split_first_chunk()?;
            (*x, *bytes) = (f64::from_le_bytes(*own), rest);
        }
        Some(sums)
    }

    /// What all sections, or all but one, say of each parameter, given the covariance of any two controls where a standard deviation is asked for;
    /// `None` where a section has no replicates, or there are no estimates.
    pub(super) fn adjusted(
        &self,
        without: Option<usize>,
        covariance: Option<&dyn Fn(usize, usize) -> f64>,
    ) -> Option<Vec<Adjusted>> {
        let chosen: Vec<&[f64]> = (0..self.sections.len())
            .filter(|section| Some(*section) != without)
            .map(|section| self.sections[section].as_slice())
            .collect();
        let total = |place: usize| chosen.iter().map(|sums| sums[place]).sum::<f64>();
        let (replicates, share) = (total(0), total(1) / total(0));
        if chosen.iter().any(|sums| sums[0] < 1.0) || replicates < 2.0 || share <= 0.0 {
            return None;
        }
        let mut parameters = vec![Accumulated::default(); self.shape.parameters];
        for channel in self.shape.channels() {
            let known = covariance.map(|of| channel.known(of));
            for (s, own) in chosen.iter().enumerate() {
                let rest = added_up(&chosen, s, self.shape.length());
                channel.adjust(own, &rest, known.as_ref(), &mut parameters);
            }
        }
        let adjusted = |sums: &Accumulated| Adjusted {
            bias: sums.bias(replicates, share),
            sd: covariance.and_then(|_| sums.sd(replicates, share)),
        };
        Some(parameters.iter().map(adjusted).collect())
    }

    /// The mean score of the 95 % intervals of each parameter, over so many estimates; no number where one of them has no standard error.
    pub(super) fn interval_scores(&self, estimates: usize) -> Vec<Measured> {
        let count = estimates as f64;
        let total = |place: usize| self.sections.iter().map(|sums| sums[place]).sum::<f64>();
        let of = |k: usize| {
            let (value, square) = (total(k) / count, total(self.shape.parameters + k) / count);
            Measured { value, mcse: ((square - value * value).max(0.0) / (count - 1.0)).sqrt() }
        };
        (0..self.shape.parameters).map(|k| of(self.shape.scores() + k)).collect()
    }

    /// The Monte-Carlo errors of the standard deviations of each parameter: a jackknife over the sections, which knows that they share coefficients.
    pub(super) fn errors_of_sd(&self, covariance: &dyn Fn(usize, usize) -> f64) -> Option<Vec<f64>> {
        let views: Option<Vec<Vec<Adjusted>>> =
            (0..self.sections.len()).map(|section| self.adjusted(Some(section), Some(covariance))).collect();
        let views = views?;
        let of = |k: usize| -> Option<f64> {
            let sds: Option<Vec<f64>> = views.iter().map(|view| view[k].sd).collect();
            jackknife_se(&sds?)
        };
        Some((0..self.shape.parameters).map(|k| of(k).unwrap_or(f64::NAN)).collect())
    }
}

/// The width of a 95 % interval, and 2/0.05 times what the truth lies outside of it: T. Gneiting and A. E. Raftery, "Strictly proper scoring rules,
/// prediction, and estimation", Journal of the American Statistical Association 102 (2007), 359–378.
fn interval_score(error: f64, se: f64) -> f64 {
    let half = normal_quantile_975() * se;
    2.0 * half + 40.0 * (error.abs() - half).max(0.0)
}

/// The sums of all sections but one.
fn added_up(sections: &[&[f64]], without: usize, length: usize) -> Vec<f64> {
    let mut all = vec![0.0; length];
    for (_, sums) in sections.iter().enumerate().filter(|(s, _)| *s != without) {
        all.iter_mut().zip(*sums).for_each(|(into, from)| *into += from);
    }
    all
}

/// What the adjusted sections of a parameter add up to.
#[derive(Debug, Clone, Default)]
struct Accumulated {
    /// Of what is left of the figures whose mean is asked for, and of its squares.
    mean: f64,
    squares: f64,
    /// Of the adjusted squares of all figures.
    second: f64,
}

impl Channel {
    /// The covariance of its controls.
    fn known(self, of: &dyn Fn(usize, usize) -> f64) -> DMatrix<f64> {
        DMatrix::from_fn(self.controls, self.controls, |i, j| of(self.first + i, self.first + j))
    }

    /// Adds what the coefficients of the rest leave of a section.
    fn adjust(self, own: &[f64], rest: &[f64], known: Option<&DMatrix<f64>>, parameters: &mut [Accumulated]) {
        let (gram, coefficients) = (self.gram(own), self.coefficients(rest));
        for (k, into) in parameters.iter_mut().enumerate() {
            let beta = coefficients.column(k);
            let with = |sums: &[f64]| beta.iter().zip(sums).map(|(b, x)| b * x).sum::<f64>();
            let products = self.products() + k * self.controls;
            let (figure, square) = (own[self.figures() + k], own[self.figures() + self.parameters + k]);
            let explained = beta.dot(&(&gram * beta));
            let shift = with(&own[self.sums()..self.products()]);
            if !self.is_odd {
                into.mean += figure - shift;
                let crossed = with(&own[products..products + self.controls]);
                into.squares += square - 2.0 * crossed + explained;
            }
            let expected = known.map_or(0.0, |known| own[0] * beta.dot(&(known * beta)));
            // What the controls add to a square beside a mean that is not zero has mean zero, too.
            let mean = if self.is_odd { 0.0 } else { rest[self.figures() + k] / rest[0] };
            into.second += square - explained + expected - 2.0 * mean * shift;
        }
    }
}

impl Accumulated {
    fn bias(&self, replicates: f64, share: f64) -> Measured {
        let mean = self.mean / replicates;
        let spread = ((self.squares / replicates - mean * mean) / (replicates - 1.0)).max(0.0);
        let bias = mean / share;
        // The share of estimates is itself an estimate.
        let of_share = bias * bias * share * (1.0 - share) / replicates;
        Measured { value: bias, mcse: (spread + of_share.max(0.0)).sqrt() / share }
    }

    fn sd(&self, replicates: f64, share: f64) -> Option<f64> {
        let bias = self.mean / replicates / share;
        let variance = self.second / replicates / share - bias * bias;
        (variance > 0.0).then(|| variance.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;
    use proptest::prelude::*;
    use switchback_noise::{StreamId, white_samples};

    const SECTIONS: usize = 16;

    fn shape(is_paired: bool) -> ControlShape {
        ControlShape { linear: 2, quadratic: 1, parameters: 1, is_paired }
    }

    /// Replicates of an estimator whose error is quadratic in two unit normals `w`, and what is left of it; its mean is `curvature`.
    struct Replicates {
        controls: Vec<[f64; 3]>,
        errors: Vec<[Option<f64>; 2]>,
    }

    impl Replicates {
        /// An estimate fails where its noise exceeds `fails_from`.
        fn new(count: usize, replicate: u32, curvature: f64, fails_from: f64) -> Self {
            let w = white_samples(StreamId { seed: 9, experiment: 0, replicate }, 3 * count);
            let of = |w: &[f64]| {
                let error = |sign: f64| {
                    let [x, y] = [sign * w[0], sign * w[1]];
                    let error = 0.7 * x - 0.2 * y + curvature * x * x + 0.3 * x * y + 0.01 * sign * w[2];
                    (x < fails_from).then_some(error)
                };
                ([w[0], w[1], w[0] * w[1]], [error(1.0), error(-1.0)])
            };
            let (controls, errors) = w.chunks(3).map(of).unzip();
            Self { controls, errors }
        }

        fn sums(&self, is_paired: bool) -> ControlSums {
            let mut sums = ControlSums::new(shape(is_paired), SECTIONS);
            for (r, (controls, errors)) in self.controls.iter().zip(&self.errors).enumerate() {
                let [own, partner] = errors.map(|error| error.map(|error| [error]));
                let own = own.as_ref().map(|error| error.as_slice());
                let partner = partner.as_ref().map(|error| error.as_slice());
                sums.push(r % SECTIONS, controls, PairOfErrors { own, se: Some(&[0.5]), partner });
            }
            sums
        }

        /// The adjusted mean of whatever has no mean zero by symmetry, with its error, replicate by replicate and without sums.
        fn slowly(&self, is_paired: bool) -> (f64, f64) {
            let figures: Vec<f64> = self
                .errors
                .iter()
                .map(|[own, partner]| {
                    let [own, partner] = [own.unwrap_or(0.0), partner.unwrap_or(0.0)];
                    if is_paired { 0.5 * (own + partner) } else { own }
                })
                .collect();
            let controls = |r: usize| -> Vec<f64> {
                if is_paired { vec![self.controls[r][2]] } else { self.controls[r].to_vec() }
            };
            let mut left = vec![0.0; figures.len()];
            for section in 0..SECTIONS {
                let others: Vec<usize> = (0..figures.len()).filter(|r| r % SECTIONS != section).collect();
                let count = controls(0).len();
                let rows = DMatrix::from_fn(others.len(), count + 1, |i, j| {
                    if j < count { controls(others[i])[j] } else { 1.0 }
                });
                let right = DVector::from_fn(others.len(), |i, _| figures[others[i]]);
                let beta = rows.svd(true, true).solve(&right, 1e-14).expect("both factors were asked for");
                for r in (section..figures.len()).step_by(SECTIONS) {
                    left[r] =
                        figures[r] - controls(r).iter().zip(beta.iter()).map(|(c, b)| c * b).sum::<f64>();
                }
            }
            let count = left.len() as f64;
            let mean = left.iter().sum::<f64>() / count;
            let variance = left.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
            (mean, (variance / count).sqrt())
        }
    }

    fn identity(i: usize, j: usize) -> f64 {
        if i == j { 1.0 } else { 0.0 }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn sums_give_what_regressions_section_by_section_do(replicate in 0..1000_u32, count in 40..400_usize, is_paired: bool) {
            let replicates = Replicates::new(count, replicate, 0.1, f64::INFINITY);
            let found = replicates.sums(is_paired).adjusted(None, None).expect("enough")[0].bias;
            let (mean, error) = replicates.slowly(is_paired);
            prop_assert!((found.value - mean).abs() < 1e-9, "{found:?} {mean}");
            prop_assert!((found.mcse - error).abs() < 1e-9 * error, "{found:?} {error}");
        }

        #[test]
        fn pieces_add_up_and_bytes_read_back(replicate in 0..1000_u32, cut in 0..10_usize) {
            let replicates = Replicates::new(160, replicate, 0.1, 1.0);
            let whole = replicates.sums(true);
            let part = |from: usize, to: usize| {
                let (controls, errors) = (replicates.controls[from..to].to_vec(), replicates.errors[from..to].to_vec());
                Replicates { controls, errors }.sums(true)
            };
            let cut = SECTIONS * cut;
            let mut sums = part(0, cut);
            sums.merge(&part(cut, 160));
            // Of products summed in another order: N ε times the largest sum of squares, by Cauchy and Schwarz.
            let largest = whole.sections.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
            for (one, other) in sums.sections.iter().flatten().zip(whole.sections.iter().flatten()) {
                prop_assert!((one - other).abs() <= 160.0 * f64::EPSILON * largest);
            }
            let mut bytes = Vec::new();
            whole.write(&mut bytes);
            bytes.push(7);
            let mut rest = bytes.as_slice();
            prop_assert_eq!(ControlSums::read((shape(true), SECTIONS), &mut rest), Some(whole));
            prop_assert_eq!(rest, &[7]);
            prop_assert_eq!(ControlSums::read((shape(true), SECTIONS), &mut &bytes[..9]), None);
        }
    }

    /// Mean and standard error of a mean.
    fn mean(values: &[f64]) -> (f64, f64) {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
        (mean, (variance / count).sqrt())
    }

    #[test]
    fn in_expectation_adjusted_figures_are_the_plain_ones_and_their_errors_are_right() {
        // Bias 0.1, second moment 0.49 + 0.04 + 3·0.01 + 0.09 + 0.0001.
        let (truth, second) = (0.1, 0.49 + 0.04 + 0.03 + 0.09 + 0.0001);
        for is_paired in [false, true] {
            let studies: Vec<Adjusted> = (0..1500)
                .map(|study| {
                    let replicates = Replicates::new(64, study, 0.1, f64::INFINITY);
                    replicates.sums(is_paired).adjusted(None, Some(&identity)).expect("enough")[0]
                })
                .collect();
            let (bias, se) = mean(&studies.iter().map(|s| s.bias.value).collect::<Vec<_>>());
            assert!((bias - truth).abs() < 4.0 * se, "{is_paired}: {bias} ± {se}");
            let spread = se * (studies.len() as f64).sqrt();
            let (reported, _) = mean(&studies.iter().map(|s| s.bias.mcse.powi(2)).collect::<Vec<_>>());
            assert!(
                (reported.sqrt() / spread - 1.0).abs() < 0.08,
                "{is_paired}: {} {spread}",
                reported.sqrt()
            );
            // The plain error is 0.1: regression leaves 0.018 of it.
            assert!(spread < 0.03, "{is_paired}: {spread}");
            // Less what the error of the bias adds to its square.
            let square = |s: &Adjusted| s.sd.expect("a deviation").powi(2) + s.bias.value.powi(2);
            let (found, se) = mean(&studies.iter().map(square).collect::<Vec<_>>());
            assert!((found - second).abs() < 4.0 * se, "{is_paired}: {found} ± {se}");
            let z = |study: u32| {
                let sums = Replicates::new(256, study, 0.1, f64::INFINITY).sums(is_paired);
                let sd = sums.adjusted(None, Some(&identity)).expect("enough")[0].sd.expect("a deviation");
                let error = sums.errors_of_sd(&identity).expect("enough")[0];
                ((sd - (second - truth * truth).sqrt()) / error).powi(2)
            };
            let (of_errors, _) = mean(&(2000..2600).map(z).collect::<Vec<_>>());
            assert!((0.75..1.5).contains(&of_errors), "{is_paired}: {of_errors}");
        }
    }

    #[test]
    fn failures_are_as_if_they_had_not_been_drawn() {
        // Of x < 1 alone, the mean of 0.7 x + 0.1 x².
        let (density, share) = ((-0.5_f64).exp() / std::f64::consts::TAU.sqrt(), 0.841_344_746_068_543);
        let truth = (-0.7 * density + 0.1 * (share - density)) / share;
        for is_paired in [false, true] {
            let studies: Vec<Adjusted> = (0..800)
                .map(|study| {
                    let replicates = Replicates::new(128, study, 0.1, 1.0);
                    replicates.sums(is_paired).adjusted(None, None).expect("enough")[0]
                })
                .collect();
            let (bias, se) = mean(&studies.iter().map(|s| s.bias.value).collect::<Vec<_>>());
            // A ratio of means has a bias of its own, of order 1/R.
            assert!((bias - truth).abs() < 4.0 * se + 0.002, "{is_paired}: {bias} ± {se}, {truth}");
        }
    }

    #[test]
    fn intervals_are_scored_by_their_width_and_by_what_they_miss() {
        let replicates = Replicates::new(90, 4, 0.1, f64::INFINITY);
        let errors: Vec<f64> = replicates.errors.iter().filter_map(|[own, _]| *own).collect();
        let half = 1.959_963_984_540_054 * 0.5;
        let score =
            |error: &f64| 2.0 * half + if error.abs() > half { (error.abs() - half) / 0.025 } else { 0.0 };
        let (value, mcse) = mean(&errors.iter().map(score).collect::<Vec<_>>());
        let found = replicates.sums(true).interval_scores(90)[0];
        assert!((found.value - value).abs() < 1e-12 && (found.mcse - mcse).abs() < 1e-12, "{found:?}");
        assert!(value > 2.0 * half, "some are missed");
    }

    #[test]
    fn few_replicates_are_left_as_they_are() {
        let replicates = Replicates::new(17, 3, 0.1, f64::INFINITY);
        let sums = replicates.sums(false);
        assert!(sums.adjusted(None, None).is_some());
        assert!(Replicates::new(15, 3, 0.1, f64::INFINITY).sums(false).adjusted(None, None).is_none());
        assert!(Replicates::new(64, 3, 0.1, f64::NEG_INFINITY).sums(false).adjusted(None, None).is_none());
        let all = ControlShape { linear: 40, ..shape(false) };
        let mut sums = ControlSums::new(all, SECTIONS);
        for (r, errors) in replicates.errors.iter().enumerate() {
            let own = errors[0].map(|error| [error]);
            let controls = [0.1 * r as f64; 41];
            let own = own.as_ref().map(|e| e.as_slice());
            sums.push(r, &controls, PairOfErrors { own, se: None, partner: None });
            if r == 15 {
                break;
            }
        }
        let plain = replicates.errors[..16].iter().filter_map(|[own, _]| *own).sum::<f64>() / 16.0;
        let found = sums.adjusted(None, None).expect("sixteen sections")[0].bias.value;
        assert!((found - plain).abs() < 1e-12, "too few for forty coefficients: {found} {plain}");
    }
}
