//! Whether the program computes on this machine what it should: checks with known answers, in less than a minute.
//!
//! A check is one file. It gives [`Figure`]s: what was found, what must be found. Where chance moves a figure its limits come from the law that it
//! follows (`chance`), so that a check fails where nothing is wrong with probability [`FALSE_ALARM`] at most, on any seed.
//!
//! | file | what it asks |
//! |---|---|
//! | `noise` | Is the noise of every study white and normal? |
//! | `engines` | Do both engines give the same estimates? |
//! | `known_answers` | Do the estimators find what is known? |
//! | `coverage` | Do 95 % intervals hold the truth in 95 % of the replicates? |
//! | `monte_carlo_errors` | Are the Monte-Carlo errors of a study what repeating the study shows? |
//! | `injected` | Does a diagnosis find what was put in, and nothing where nothing was? |
//!
//! To add one, add its file and its line in [`CHECKS`].

mod chance;
mod coverage;
mod engines;
mod figure;
mod injected;
mod json;
mod known_answers;
mod monte_carlo_errors;
mod noise;
mod small_study;
mod words;

pub(crate) use chance::FALSE_ALARM;
pub use figure::Figure;
pub use json::json;
pub use json::schema;
pub use words::table;

/// A check: what it is called, what is wrong if it fails, and how it finds its figures from a seed.
pub struct Check {
    /// Its name on the page.
    pub name: &'static str,
    /// What a user must know if it fails.
    pub wrong: &'static str,
    figures: fn(u64) -> miette::Result<Vec<Figure>>,
}

/// Every check, the nearest to a cause first: what fails further down may be due to what failed above.
pub const CHECKS: [Check; 6] = [
    Check {
        name: "noise",
        wrong: "the noise of studies is not white and normal, so that no study on this machine means anything",
        figures: |seed| Ok(noise::figures(seed)),
    },
    Check {
        name: "engines",
        wrong: "the fast engine does not compute what simulating sample by sample gives; run studies with --engine direct",
        figures: engines::figures,
    },
    Check {
        name: "known answers",
        wrong: "an estimator misses a system that noiseless records determine; do not trust what it identifies",
        figures: known_answers::figures,
    },
    Check {
        name: "coverage",
        wrong: "95 % intervals do not hold the truth in 95 % of the cases; do not trust standard errors and intervals",
        figures: coverage::figures,
    },
    Check {
        name: "Monte-Carlo errors",
        wrong: "the errors reported beside a study's measures are not what repeating the study shows; run more replicates than they ask for",
        figures: monte_carlo_errors::figures,
    },
    Check {
        name: "planted effect",
        wrong: "a diagnosis does not find what was put into a made rig, or finds what was not; do not trust the causes it names",
        figures: injected::figures,
    },
];

/// What came of a check.
#[derive(Debug)]
pub struct Finding {
    /// Its name.
    pub check: &'static str,
    /// What is wrong where it failed.
    pub wrong: &'static str,
    /// Its figures, or why it has none.
    pub figures: Result<Vec<Figure>, String>,
}

impl Check {
    /// Runs it; a program that refuses or cannot do what the check asks for fails it.
    pub fn run(&self, seed: u64) -> Finding {
        let figures = (self.figures)(seed).map_err(|report| report.to_string());
        Finding { check: self.name, wrong: self.wrong, figures }
    }
}

impl Finding {
    /// Whether all that was found is what it must be.
    pub fn holds(&self) -> bool {
        self.figures.as_ref().is_ok_and(|figures| !figures.is_empty() && figures.iter().all(Figure::holds))
    }

    /// The figure nearest to its limit, or furthest beyond.
    pub(crate) fn nearest(&self) -> Option<&Figure> {
        let figures = self.figures.as_ref().ok()?;
        figures.iter().max_by(|x, y| x.strain.total_cmp(&y.strain))
    }

    /// The figures that are wrong.
    pub(crate) fn failed(&self) -> impl Iterator<Item = &Figure> {
        self.figures.iter().flatten().filter(|figure| !figure.holds())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    pub(super) fn all_hold(figures: &[Figure]) {
        assert!(!figures.is_empty());
        let wrong: Vec<&Figure> = figures.iter().filter(|figure| !figure.holds()).collect();
        assert!(wrong.is_empty(), "{wrong:#?}");
    }

    /// The figure of that name is among those that are wrong.
    #[track_caller]
    pub(super) fn some_fail(figures: &[Figure], what: &str) {
        let figure = figures.iter().find(|figure| figure.what == what);
        let names = || figures.iter().map(|figure| figure.what.as_str()).collect::<Vec<_>>();
        let figure = figure.unwrap_or_else(|| panic!("`{what}` is none of {:?}", names()));
        assert!(!figure.holds(), "{figure:?}");
    }

    #[test]
    fn a_check_without_figures_or_with_a_refusal_fails() {
        let none = Check { name: "none", wrong: "", figures: |_| Ok(Vec::new()) };
        let refused = Check { name: "refused", wrong: "", figures: |_| Err(miette::miette!("no")) };
        assert!(!none.run(1).holds() && !refused.run(1).holds());
        assert_eq!(refused.run(1).figures, Err("no".to_owned()));
    }

    #[test]
    fn what_is_nearest_to_its_limit_is_reported() {
        let figures = |_| Ok(vec![Figure::at_most("a", 0.1, 1.0), Figure::at_most("b", 2.0, 1.0)]);
        let finding = Check { name: "two", wrong: "", figures }.run(1);
        assert_eq!(finding.nearest().map(|figure| figure.what.as_str()), Some("b"));
        assert!(!finding.holds() && finding.failed().count() == 1);
    }
}
