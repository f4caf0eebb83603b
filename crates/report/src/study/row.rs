//! Summaries condensed to one row of the table.

use switchback_study::MethodName;
use switchback_study::results::{Fitted, Group, Results, Summary, Verdict};

/// Curves of one case and method (and group, where there is room) in one row.
#[derive(Debug)]
pub(crate) struct Row<'r> {
    /// Name of the case.
    pub case: &'r str,
    /// The method.
    pub method: &'r MethodName,
    /// `None` where all groups share a row.
    pub group: Option<Group>,
    /// One entry a curve over N and group of parameters.
    pub summaries: Vec<&'r Summary>,
}

/// More rows than this do not fit a screen; groups are then put together.
const SCREEN: usize = 32;

/// The rows of a table: one a case, method and group, or one a case and method where those would be too many.
pub(crate) fn rows(results: &Results) -> Vec<Row<'_>> {
    let by_group = gather(results, true);
    if by_group.len() <= SCREEN { by_group } else { gather(results, false) }
}

fn gather(results: &Results, by_group: bool) -> Vec<Row<'_>> {
    let mut rows: Vec<Row<'_>> = Vec::new();
    for summary in &results.summaries {
        let (case, method) = (summary.series.case.as_str(), &summary.series.method);
        let group = by_group.then_some(summary.group);
        match rows.iter_mut().find(|r| r.case == case && r.method == method && r.group == group) {
            Some(row) => row.summaries.push(summary),
            None => rows.push(Row { case, method, group, summaries: vec![summary] }),
        }
    }
    rows
}

impl Row<'_> {
    /// Median estimate over the curves, between the medians of the interval ends.
    pub(crate) fn slope(&self, of: impl Fn(&Summary) -> Option<Fitted>) -> Option<Fitted> {
        let fitted: Vec<Fitted> = self.summaries.iter().filter_map(|s| of(s)).collect();
        let over = |f: fn(&Fitted) -> f64| median(fitted.iter().map(f).collect());
        Fitted::new(over(|f| f.estimate)?, (over(|f| f.ci.0)?, over(|f| f.ci.1)?))
    }

    /// Median over the curves that have the measure.
    pub(crate) fn median(&self, of: impl Fn(&Summary) -> Option<f64>) -> Option<f64> {
        median(self.summaries.iter().filter_map(|s| of(s)).collect())
    }

    /// Largest bias that stays, over the curves that are inconsistent.
    pub(crate) fn plateau(&self) -> Option<f64> {
        let inconsistent = self.summaries.iter().filter(|s| s.verdict == Verdict::Inconsistent);
        inconsistent.filter_map(|s| Some(s.plateau?.estimate.abs())).max_by(f64::total_cmp)
    }

    /// `consistent` where all curves agree, else how many say what: `inconsistent 17, undecided 1`.
    pub(crate) fn verdict(&self) -> String {
        let kinds = [Verdict::Inconsistent, Verdict::Undecided, Verdict::Consistent];
        let count = |v: Verdict| self.summaries.iter().filter(|s| s.verdict == v).count();
        match kinds.into_iter().find(|v| count(*v) == self.summaries.len()) {
            Some(all) => all.to_string(),
            None => kinds
                .into_iter()
                .filter(|v| count(*v) > 0)
                .map(|v| format!("{v} {}", count(v)))
                .collect::<Vec<_>>()
                .join(", "),
        }
    }
}

/// The middle of the values, the mean of the two middle ones where their number is even.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    Some(if values.len() % 2 == 1 { upper } else { (values[middle - 1] + upper) / 2.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_study::results::synthetic;

    #[test]
    fn a_median_needs_a_value() {
        assert_eq!(median(vec![]), None);
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
    }

    #[test]
    fn every_summary_lands_in_exactly_one_row() {
        let results = synthetic::results();
        for by_group in [true, false] {
            let rows = gather(&results, by_group);
            assert_eq!(rows.iter().map(|r| r.summaries.len()).sum::<usize>(), results.summaries.len());
        }
    }
}
