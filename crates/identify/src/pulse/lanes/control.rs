//! The control variate of eight replicates: the leading terms of their errors.

use super::profile_control::ProfileControl;
use super::sample::LaneSample;
use super::sized::{SizedWork, run};
use super::terms::LaneTerms;
use super::whole::WholeControl;
use crate::pulse::GroupedStatistics;
use crate::pulse::solution::Solution;
use switchback_noise::lanes::{Lane, Work, keep_apart, widest};

/// [`Limit::terms`](super::super::Limit::terms) with all that is the same in every replicate worked out.
#[derive(Debug, Clone)]
pub struct LaneControl(Kind);

#[derive(Debug, Clone)]
enum Kind {
    Profile(ProfileControl),
    Whole(WholeControl),
    Folds(FoldControl),
}

/// A constant linear map of the means over periods: `θ_k = Σ_p R_k,p (ȳ_p − z_p)`, experiments side by side.
#[derive(Debug, Clone)]
pub(crate) struct FoldControl {
    /// `R`, one row a parameter.
    pub(crate) responses: Vec<f64>,
    /// `Σ_p R_k,p z_p`.
    pub(crate) rest: Vec<f64>,
}

impl LaneControl {
    pub(crate) fn profile(solution: &Solution) -> Self {
        Self(Kind::Profile(ProfileControl::of(solution)))
    }

    pub(crate) fn whole(solution: &Solution, expected: &GroupedStatistics) -> Self {
        Self(Kind::Whole(WholeControl::of(solution, expected)))
    }

    /// Of a method that works on the folds.
    pub(crate) fn folds(control: FoldControl) -> Self {
        Self(Kind::Folds(control))
    }

    /// The leading terms of every parameter's error for each sample, in as many of `terms`.
    ///
    /// Nothing for the orders that [`LaneMethod::fit`](super::LaneMethod::fit) leaves to the solver that goes one by one.
    ///
    /// # Panics
    /// If there are fewer of `terms` than samples.
    pub fn terms(&self, samples: &[LaneSample<'_>], terms: &mut [LaneTerms]) {
        let (order, size) = match &self.0 {
            Kind::Profile(control) => control.size(),
            Kind::Whole(control) => control.size(),
            Kind::Folds(control) => {
                for (sample, terms) in samples.iter().zip(&mut terms[..samples.len()]) {
                    widest(FoldTerms { control, sample, terms });
                }
                return;
            }
        };
        let terms = &mut terms[..samples.len()];
        run(order, size, Terms { control: self, samples, terms });
    }
}

/// [`LaneControl::terms`] of a [`FoldControl`] on its way.
struct FoldTerms<'a> {
    control: &'a FoldControl,
    sample: &'a LaneSample<'a>,
    terms: &'a mut LaneTerms,
}

impl Work for FoldTerms<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { control, sample, terms: LaneTerms { first, second, .. } } = self;
        let parameters = control.rest.len();
        first.resize(parameters, Lane::ZERO);
        second.clear();
        second.resize(parameters, Lane::ZERO);
        let rows = control.responses.chunks_exact(control.responses.len() / parameters);
        for ((first, row), rest) in first.iter_mut().zip(rows).zip(&control.rest) {
            let mut sum = Lane::splat(-rest);
            let outputs = sample.parts.iter().flat_map(|part| &part.folds);
            for (output, response) in outputs.zip(row) {
                keep_apart();
                sum += *output * *response;
            }
            *first = sum;
        }
    }
}

/// [`LaneControl::terms`] on its way.
struct Terms<'a> {
    control: &'a LaneControl,
    samples: &'a [LaneSample<'a>],
    terms: &'a mut [LaneTerms],
}

impl SizedWork for Terms<'_> {
    #[inline(always)]
    fn run<const N: usize, const D: usize>(self) {
        let Self { control, samples, terms } = self;
        for (sample, terms) in samples.iter().zip(terms) {
            keep_apart();
            match &control.0 {
                Kind::Profile(control) => control.carry::<N, D>(sample, terms),
                Kind::Whole(control) => control.carry::<N, D>(sample, terms),
                Kind::Folds(_) => unreachable!("it asks for no order"),
            }
        }
    }
}
