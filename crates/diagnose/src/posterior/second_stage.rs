//! The likelihood of fits joins the probabilities of the first stage.

use super::bytes::{Reader, Writer};
use super::error::PosteriorError;
use super::softmax::softmax;

/// A conditional logit on what fits of the shortlist say, beside the logarithm of a first stage's probability:
///
/// ```text
/// p_k = exp(βᵀx_k) / Σ_j exp(βᵀx_j)
/// ```
///
/// Its few coefficients are learnt from rows of which the first stage had learnt neither base nor law.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondStage {
    /// `β`, one a [feature](Self::features).
    pub coefficients: Vec<f32>,
    /// Columns of each outcome's fit, in the order of [`Self::OWN`]; none where it has no fit.
    pub own: Vec<Vec<u16>>,
    /// Columns of all fits together, in the order of [`Self::COMMON`].
    pub common: Vec<u16>,
}

impl SecondStage {
    /// Statistics of an outcome's fit, `OUTCOME.STATISTIC`.
    pub const OWN: [&'static str; 7] = [
        "fit_gain",
        "fit_ahead",
        "fit_same_noise",
        "fit_held_out",
        "fit_closed",
        "fit_closed_held_out",
        "fit_over_price",
    ];
    /// Statistics of all fits, which speak for or against that nothing is missing or that it is none of these.
    pub const COMMON: [&'static str; 3] = ["fit_first", "fit_over_price", "fit_order"];
    /// Features of an outcome: `ln p`, whether it was fitted, whether its fit comes first, those of its own, and for outcomes without fits the common ones.
    pub const FEATURES: usize = 3 + Self::OWN.len() + 2 * (1 + Self::COMMON.len());

    /// `x_k`. A gain is in nats a sample, of which a tenth separates two causes in records of any length: its root keeps large ones apart.
    pub fn features(&self, row: &[f64], p: &[f64], outcome: usize, is_nothing: bool) -> Vec<f64> {
        let value = |column: &u16| row[usize::from(*column)];
        let signed_root = |x: f64| x.signum() * x.abs().sqrt();
        let own: Vec<f64> = self.own[outcome].iter().map(value).collect();
        let is_fitted = own.iter().any(|x| *x != 0.0);
        let mut x = vec![libm::log(p[outcome].max(LEAST)), f64::from(u8::from(is_fitted))];
        x.push(f64::from(u8::from(is_fitted && own.get(1).is_some_and(|ahead| *ahead == 0.0))));
        x.extend((0..Self::OWN.len()).map(|k| own.get(k).map_or(0.0, |x| signed_root(*x))));
        let common: Vec<f64> = self.common.iter().map(|column| signed_root(value(column))).collect();
        let has_no_fit = self.own[outcome].is_empty();
        for is_of_this_kind in [has_no_fit && is_nothing, has_no_fit && !is_nothing] {
            let factor = f64::from(u8::from(is_of_this_kind));
            x.push(factor);
            x.extend(common.iter().map(|x| factor * x));
        }
        x
    }

    /// Probabilities of all outcomes; `nothing` is the position of that nothing is missing.
    pub fn probabilities(&self, row: &[f64], p: &[f64], nothing: Option<usize>) -> Vec<f64> {
        let score = |outcome: usize| {
            let x = self.features(row, p, outcome, Some(outcome) == nothing);
            x.iter().zip(&self.coefficients).map(|(x, b)| x * f64::from(*b)).sum::<f64>()
        };
        softmax(&(0..p.len()).map(score).collect::<Vec<f64>>())
    }

    pub(super) fn write(&self, out: &mut Writer) {
        out.numbers(&self.coefficients);
        for list in self.own.iter().chain([&self.common]) {
            out.count(list.len());
            list.iter().for_each(|n| out.small(usize::from(*n)));
        }
    }

    pub(super) fn read(
        from: &mut Reader<'_>,
        columns: usize,
        classes: usize,
    ) -> Result<Self, PosteriorError> {
        let coefficients = from.numbers()?;
        let list = |from: &mut Reader<'_>| -> Result<Vec<u16>, PosteriorError> {
            let n = from.count_of(2)?;
            (0..n).map(|_| Ok(from.small()? as u16)).collect()
        };
        let own = (0..classes).map(|_| list(from)).collect::<Result<Vec<_>, _>>()?;
        let common = list(from)?;
        let is_there = |list: &Vec<u16>| list.iter().all(|k| usize::from(*k) < columns);
        let has_sizes = own.iter().all(|own| own.is_empty() || own.len() == Self::OWN.len())
            && common.len() == Self::COMMON.len()
            && coefficients.len() == Self::FEATURES;
        if !has_sizes || !own.iter().chain([&common]).all(is_there) {
            return Err(from.damaged("a second stage of other columns"));
        }
        Ok(Self { coefficients, own, common })
    }
}

/// Least probability in a logarithm.
const LEAST: f64 = 1e-6;
