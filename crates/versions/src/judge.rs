//! All differences of all cells, with their limits and verdicts.
//!
//! With M differences, each judged at the level α/M, a run of two versions that differ by no more than what is negligible gives an alarm with a chance of α
//! at most, however the differences go together (Bonferroni). A difference gives an alarm, or is an improvement, where it is larger than what is negligible by
//! `q` standard errors, `q` the quantile of Student's t at `1 − α/2M`; it is found nineteen times in twenty where it is larger still by the quantile
//! at 0.95. The versions are equivalent where every difference is smaller than what matters by that quantile: both one-sided tests of
//! each, at 5 %. All have to agree, so that no correction is needed (R. L. Berger, *Technometrics* 24 (1982), pp. 295–300).

use super::difference::{Discordant, Estimate, PairedErrors, bias, sd};
use super::limits::Limits;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};
use switchback_study::consistency::{CellErrors, ReplicateErrors};
use switchback_study::results::{Group, Series};

/// What two versions are to each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Replicates of each cell.
    pub replicates: u32,
    /// The limits.
    pub limits: Limits,
    /// How many differences share the chance of a false alarm.
    pub family: usize,
    /// One entry a cell.
    pub cells: Vec<CellDifferences>,
}

/// What two versions are to each other in a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct CellDifferences {
    /// The curve that the new version's cell is a point of.
    pub series: Series,
    /// `N`.
    pub samples: usize,
    /// Replicates of which both have an estimate.
    pub pairs: usize,
    /// Replicates of which one has none.
    pub failures: FailureDifference,
    /// The parameters that both estimate.
    pub parameters: Vec<ParameterDifferences>,
}

/// How often each version gives no estimate, of the record or of its antithetic partner.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureDifference {
    /// Replicates at which the baseline fails.
    pub baseline: usize,
    /// Replicates at which the new version fails.
    pub new: usize,
    /// What the new version said first.
    pub reason: Option<String>,
    /// The difference as a share of the replicates.
    pub judged: Judged,
}

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterDifferences {
    /// `a1`, `b2`, `F_desc(V3)`, `F_asc(V2)`.
    pub name: String,
    /// With whom it is judged.
    pub group: Group,
    /// New bias less the old one, in standard deviations of the baseline.
    pub bias: Judged,
    /// Logarithm of the new standard deviation over the old one.
    pub sd: Judged,
}

/// A difference, and what is to be said of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// The difference; infinite, or no number, where no standard deviation gives it a unit.
    pub value: f64,
    /// Its Monte-Carlo standard error.
    pub se: f64,
    /// Beyond it a difference is an alarm, or an improvement.
    pub limit: f64,
    /// From here on one is found nineteen times in twenty.
    pub found_from: f64,
    /// What it means.
    pub verdict: Verdict,
}

/// What a difference means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It is smaller than what matters.
    Equivalent,
    /// There are too few replicates to tell.
    Undecided,
    /// The new version is better: less bias, less scatter, fewer failures.
    Better,
    /// The new version is worse: an alarm.
    Worse,
}

impl Verdict {
    /// The name used in files and words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Equivalent => "equivalent",
            Self::Undecided => "undecided",
            Self::Better => "better",
            Self::Worse => "worse",
        }
    }
}

/// What differs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Bias.
    Bias,
    /// Standard deviation.
    Sd,
    /// Failures.
    Failures,
}

impl Measure {
    /// Every measure, in the order of tables.
    pub const ALL: [Self; 3] = [Self::Bias, Self::Sd, Self::Failures];

    /// What tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bias => "bias",
            Self::Sd => "standard deviation",
            Self::Failures => "failures",
        }
    }
}

impl Comparison {
    /// Of the same cells of two versions, replicate by replicate on the same noise.
    ///
    /// # Panics
    /// If they are not the same cells.
    pub fn of(baseline: &[CellErrors], new: &[CellErrors], limits: Limits) -> Self {
        assert_eq!(baseline.len(), new.len(), "both estimate from the same records");
        let cells: Vec<Matched<'_>> = baseline.iter().zip(new).map(|(x, y)| Matched::of(x, y)).collect();
        let family: usize = cells.iter().map(Matched::differences).sum();
        let judge = Judge { limits, family };
        let replicates = new.first().map_or(0, |cell| cell.replicates.len()) as u32;
        Self { replicates, limits, family, cells: cells.iter().map(|cell| cell.judged(&judge)).collect() }
    }

    /// Every difference of a measure, with its cell and parameter.
    pub fn all(&self, measure: Measure) -> impl Iterator<Item = (&CellDifferences, Option<&str>, Judged)> {
        self.cells.iter().flat_map(move |cell| {
            let of_parameter = move |p: &ParameterDifferences| match measure {
                Measure::Bias => p.bias,
                Measure::Sd | Measure::Failures => p.sd,
            };
            let parameters = cell.parameters.iter().filter(move |_| measure != Measure::Failures);
            let failures = (measure == Measure::Failures).then_some((cell, None, cell.failures.judged));
            parameters.map(move |p| (cell, Some(p.name.as_str()), of_parameter(p))).chain(failures)
        })
    }

    /// The difference of a measure that comes nearest to its limit, or lies farthest beyond it.
    pub fn largest(&self, measure: Measure) -> Option<(&CellDifferences, Option<&str>, Judged)> {
        let nearness = |judged: Judged| {
            let share = judged.value.abs() / judged.limit;
            if share.is_nan() { f64::INFINITY } else { share }
        };
        self.all(measure).max_by(|(.., x), (.., y)| nearness(*x).total_cmp(&nearness(*y)))
    }

    /// The verdict on a measure: an alarm before an improvement, both before an undecided difference.
    pub fn verdict_on(&self, measure: Measure) -> Verdict {
        self.all(measure).map(|(.., judged)| judged.verdict).max().unwrap_or(Verdict::Undecided)
    }

    /// The verdict on all measures.
    pub fn verdict(&self) -> Verdict {
        Measure::ALL.map(|measure| self.verdict_on(measure)).into_iter().max().unwrap_or(Verdict::Undecided)
    }

    /// Whether every difference is shown to be smaller than what matters.
    pub fn is_equivalent(&self) -> bool {
        self.verdict() == Verdict::Equivalent
    }

    /// How many replicates find what matters, nineteen times in twenty; `None` where nothing is known.
    pub fn replicates_that_find(&self, measure: Measure) -> Option<f64> {
        let margin = match measure {
            Measure::Bias => self.limits.bias,
            Measure::Sd => self.limits.sd,
            Measure::Failures => self.limits.failures,
        };
        let negligible = Limits::NEGLIGIBLE * margin;
        let of = |judged: Judged| ((judged.found_from - negligible) / (margin - negligible)).powi(2);
        let shares = self.all(measure).map(|(.., judged)| of(judged)).filter(|share| share.is_finite());
        shares.max_by(f64::total_cmp).map(|share| (share * f64::from(self.replicates)).ceil())
    }
}

/// One cell of both versions.
struct Matched<'e> {
    baseline: &'e CellErrors,
    new: &'e CellErrors,
    /// Places of the parameters that both estimate.
    parameters: Vec<[usize; 2]>,
}

impl<'e> Matched<'e> {
    fn of(baseline: &'e CellErrors, new: &'e CellErrors) -> Self {
        let twin = |(k, parameter): (usize, &(String, Group))| {
            Some([baseline.parameters.iter().position(|other| other == parameter)?, k])
        };
        Self { parameters: new.parameters.iter().enumerate().filter_map(twin).collect(), baseline, new }
    }

    /// Two of each parameter, and that of the failures.
    fn differences(&self) -> usize {
        2 * self.parameters.len() + 1
    }

    fn judged(&self, judge: &Judge) -> CellDifferences {
        let parameters: Vec<ParameterDifferences> =
            self.parameters.iter().map(|&places| self.parameter(places, judge)).collect();
        let both = |(x, y): (&_, &_)| self.errors(x, y, [0, 0]).is_some();
        CellDifferences {
            series: self.new.series.clone(),
            samples: self.new.samples,
            pairs: self
                .baseline
                .replicates
                .iter()
                .zip(&self.new.replicates)
                .filter(|pair| both(*pair))
                .count(),
            failures: self.failures(judge),
            parameters,
        }
    }

    fn errors(&self, x: &ReplicateErrors, y: &ReplicateErrors, places: [usize; 2]) -> Option<PairedErrors> {
        let at = |errors: Option<&[f64]>, place: usize| errors.map(|errors| errors[place]);
        let signs = x.signs().into_iter().zip(y.signs());
        PairedErrors::of(signs.map(|(x, y)| [at(x, places[0]), at(y, places[1])]))
    }

    fn parameter(&self, places: [usize; 2], judge: &Judge) -> ParameterDifferences {
        let replicates = self.baseline.replicates.iter().zip(&self.new.replicates);
        let pairs: Vec<PairedErrors> = replicates.filter_map(|(x, y)| self.errors(x, y, places)).collect();
        let (name, group) = self.new.parameters[places[1]].clone();
        // Whose mean lies nearer to the truth.
        let mean = |k: usize| pairs.iter().map(|pair| pair.mean(|pair| pair[k])).sum::<f64>().abs();
        let Limits { bias: margin_of_bias, sd: margin_of_sd, .. } = judge.limits;
        let of_bias = judge.figure(bias(&pairs), margin_of_bias, pairs.len(), mean(1) < mean(0));
        let spread = sd(&pairs);
        let of_sd = judge.figure(spread, margin_of_sd, pairs.len(), spread.value < 0.0);
        ParameterDifferences { name, group, bias: of_bias, sd: of_sd }
    }

    fn failures(&self, judge: &Judge) -> FailureDifference {
        let mut found = FailureDifference { baseline: 0, new: 0, reason: None, judged: Judged::NOTHING };
        let mut discordant = Discordant { baseline: 0, new: 0 };
        for (x, y) in self.baseline.replicates.iter().zip(&self.new.replicates) {
            let failed = [x.failure(), y.failure()];
            found.baseline += usize::from(failed[0].is_some());
            found.new += usize::from(failed[1].is_some());
            match failed {
                [Some(_), None] => discordant.baseline += 1,
                [None, Some(_)] => discordant.new += 1,
                _ => {}
            }
            if found.reason.is_none() {
                found.reason = failed[1].map(str::to_owned);
            }
        }
        found.judged = judge.failures(discordant, self.new.replicates.len());
        found
    }
}

impl Judged {
    const NOTHING: Self =
        Self { value: 0.0, se: 0.0, limit: 0.0, found_from: 0.0, verdict: Verdict::Undecided };
}

/// Who judges.
struct Judge {
    limits: Limits,
    family: usize,
}

/// Fewer pairs show nothing.
const LEAST_PAIRS: usize = 16;

impl Judge {
    /// The chance of a false alarm that one difference has.
    fn level(&self) -> f64 {
        self.limits.false_alarms / self.family as f64
    }

    /// A difference of bias or standard deviation, `margin` being what matters.
    fn figure(&self, Estimate { value, se }: Estimate, margin: f64, pairs: usize, is_better: bool) -> Judged {
        if pairs < LEAST_PAIRS {
            let infinite = f64::INFINITY;
            return Judged { value, se, limit: infinite, found_from: infinite, verdict: Verdict::Undecided };
        }
        let quantile = |tail: f64| quantile(tail, pairs - 1);
        let limit = Limits::NEGLIGIBLE * margin + quantile(0.5 * self.level()) * se;
        let found_from = limit + quantile(Limits::OVERLOOKED) * se;
        // What is no number, or infinite, is no rounding.
        let is_real = !value.is_finite() || !se.is_finite() || value.abs() > limit;
        let verdict = match is_real {
            true if is_better && se.is_finite() => Verdict::Better,
            true => Verdict::Worse,
            false if value.abs() + quantile(Limits::EQUIVALENCE) * se < margin => Verdict::Equivalent,
            false => Verdict::Undecided,
        };
        Judged { value, se, limit, found_from, verdict }
    }

    /// A difference of failures: the exact test, and no limit but that of its error.
    fn failures(&self, discordant: Discordant, replicates: usize) -> Judged {
        let Estimate { value, se } = discordant.estimate(replicates);
        let quantile = |tail: f64| quantile(tail, replicates.max(2) - 1);
        let margin = self.limits.failures;
        let limit = self.limit_of_failures(discordant, replicates);
        let verdict = match discordant.p_value() <= self.level() {
            true if discordant.new < discordant.baseline => Verdict::Better,
            true => Verdict::Worse,
            false if value.abs() + quantile(Limits::EQUIVALENCE) * se < margin => Verdict::Equivalent,
            false => Verdict::Undecided,
        };
        Judged { value, se, limit, found_from: limit + quantile(Limits::OVERLOOKED) * se, verdict }
    }

    /// The least difference that the exact test finds, at as many failures of the version that fails less.
    fn limit_of_failures(&self, discordant: Discordant, replicates: usize) -> f64 {
        let baseline = discordant.baseline.min(discordant.new);
        let is_found = |more: &usize| Discordant { baseline, new: baseline + more }.p_value() <= self.level();
        (1..=replicates).find(is_found).map_or(f64::INFINITY, |more| more as f64 / replicates as f64)
    }
}

/// The quantile of Student's t that is exceeded with this chance.
fn quantile(tail: f64, freedom: usize) -> f64 {
    StudentsT::new(0.0, 1.0, freedom as f64).map_or(f64::INFINITY, |t| -t.inverse_cdf(tail))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (tail, freedom, value) in
            [(0.05, 399, 1.648_68), (0.025, 15, 2.131_45), (1e-4, 30, 4.233_98), (1e-5, 1000, 4.284_3)]
        {
            assert!(
                (quantile(tail, freedom) / value - 1.0).abs() < 1e-3,
                "{tail}, {freedom}: {}",
                quantile(tail, freedom)
            );
        }
    }

    #[test]
    fn a_figure_is_judged_by_its_distance_from_what_is_negligible_and_what_matters() {
        let judge = Judge { limits: Limits::default(), family: 100 };
        let verdict =
            |value: f64, se: f64| judge.figure(Estimate { value, se }, 0.1, 400, value < 0.0).verdict;
        assert_eq!(verdict(0.0, 0.0), Verdict::Equivalent);
        // Rounding is known to many digits and is no alarm.
        assert_eq!(verdict(1e-14, 1e-16), Verdict::Equivalent);
        assert_eq!(verdict(0.04, 1e-4), Verdict::Equivalent);
        assert_eq!(verdict(0.06, 1e-4), Verdict::Worse);
        assert_eq!(verdict(-0.06, 1e-4), Verdict::Better);
        assert_eq!(verdict(0.05, 0.02), Verdict::Equivalent);
        assert_eq!(verdict(0.08, 0.02), Verdict::Undecided);
        assert_eq!(verdict(f64::INFINITY, f64::NAN), Verdict::Worse);
        assert_eq!(judge.figure(Estimate { value: 9.0, se: 0.0 }, 0.1, 3, false).verdict, Verdict::Undecided);
    }

    #[test]
    fn failures_are_judged_by_their_exact_chance() {
        let judge = Judge { limits: Limits::default(), family: 100 };
        let judged = |baseline, new| judge.failures(Discordant { baseline, new }, 1000);
        assert_eq!(judged(0, 0).verdict, Verdict::Equivalent);
        // 2⁻¹³ is more than 10⁻⁴, 2⁻¹⁴ less.
        assert_eq!((judged(0, 14).verdict, judged(0, 15).verdict), (Verdict::Undecided, Verdict::Worse));
        assert_eq!(judged(0, 3).limit, 0.015);
        assert_eq!(judged(400, 0).verdict, Verdict::Better);
        assert_eq!(judged(400, 400).verdict, Verdict::Undecided);
    }
}
