//! `--expect "gap < 2 %"`: what a diagnosis must say.

use super::{Report, ReportedDifference, Units, digits};
use std::fmt;
use switchback_diagnose::{Diagnosis, Effect, Figure, Stage, Status};

/// What is expected of a diagnosis, in the words of its JSON object.
#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// As it was given.
    text: String,
    what: What,
}

#[derive(Debug, Clone, PartialEq)]
enum What {
    /// A value of the source is this one, but for the error of the comparison.
    Value {
        what: String,
        value: f64,
    },
    /// A value of the source is that of the machine, but for a share of it.
    Within {
        what: String,
        share: f64,
    },
    /// A figure below or above a bound.
    Bound {
        figure: usize,
        sign: Sign,
        bound: f64,
        in_percent: bool,
    },
    /// The effects named are this one alone, or none.
    Cause(Option<Effect>),
    Status(Status),
    Stage(Stage),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Sign {
    Below,
    AtMost,
    Above,
    AtLeast,
}

impl Sign {
    const ALL: [(&str, Self); 4] =
        [("<=", Self::AtMost), (">=", Self::AtLeast), ("<", Self::Below), (">", Self::Above)];

    fn holds(self, found: f64, bound: f64) -> bool {
        match self {
            Self::Below => found < bound,
            Self::AtMost => found <= bound,
            Self::Above => found > bound,
            Self::AtLeast => found >= bound,
        }
    }
}

/// What a figure is called, and where it stands in a diagnosis.
type Reader = fn(&Diagnosis) -> Option<f64>;

/// The figures: keys of the JSON object with dots between them; `gap` alone is the gap before anything is added.
const FIGURES: [(&str, Reader); 8] = [
    ("gap", |d| Some(d.gap.before.estimate)),
    ("gap.before", |d| Some(d.gap.before.estimate)),
    ("gap.after", |d| Some(d.gap.after.estimate)),
    ("gap.closure", |d| d.gap.closure.as_ref().map(|closure: &Figure| closure.estimate)),
    ("gap.noise_floor", |d| Some(d.gap.noise_floor)),
    ("verdict.probability", |d| Some(d.verdict.probability)),
    ("probability_none", |d| Some(d.probability_none)),
    ("probability_unexplained", |d| Some(d.probability_unexplained)),
];

const STAGES: [Stage; 5] =
    [Stage::Input, Stage::Operator, Stage::Dynamics, Stage::Disturbance, Stage::Sensor];

/// An expectation and what was found instead, or as expected.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    /// Whether it holds.
    pub holds: bool,
    /// The figures that decide.
    pub says: String,
}

impl Expectation {
    /// Parses `gap < 2 %`, `cause none`, `cause backlash`, `verdict.status named`, `verdict.stage operator`, `delay = 0` or `friction within 5 %`.
    ///
    /// ```
    /// use switchback_io::diagnosis::Expectation;
    /// assert!(Expectation::parse("gap < 2 %").is_ok());
    /// assert!(Expectation::parse("cause none").is_ok());
    /// assert!(Expectation::parse("gab < 2 %").is_err());
    /// ```
    ///
    /// # Errors
    /// The words that are allowed.
    pub fn parse(text: &str) -> Result<Self, String> {
        if let Some(what) = parse_difference(text) {
            return Ok(Self { text: text.split_whitespace().collect::<Vec<_>>().join(" "), what: what? });
        }
        let bound = Sign::ALL.iter().find_map(|(mark, sign)| Some((text.split_once(mark)?, *sign)));
        let what = match bound {
            Some(((figure, bound), sign)) => parse_bound(figure.trim(), sign, bound.trim())?,
            None => parse_word(text.trim())?,
        };
        Ok(Self { text: text.split_whitespace().collect::<Vec<_>>().join(" "), what })
    }

    /// Whether it holds.
    pub fn check(&self, report: &Report) -> Checked {
        let diagnosis = &report.diagnosis;
        let verdict = &diagnosis.verdict;
        let (holds, found) = match &self.what {
            What::Value { what, value } => value_is(report, what, *value),
            What::Within { what, share } => is_within(report, what, *share),
            &What::Bound { figure, sign, bound, in_percent } => match FIGURES[figure].1(diagnosis) {
                Some(found) if in_percent => {
                    (sign.holds(100.0 * found, bound), format!("{} %", super::digits(100.0 * found, 3)))
                }
                Some(found) => (sign.holds(found, bound), super::digits(found, 3)),
                None => (false, "nothing, for there is no gap to close".to_owned()),
            },
            What::Cause(None) => (verdict.status == Status::None, cause(report)),
            What::Cause(Some(effect)) => (verdict.effects == [*effect], cause(report)),
            What::Status(status) => (verdict.status == *status, verdict.status.name().to_owned()),
            What::Stage(stage) => {
                (verdict.stage == Some(*stage), verdict.stage.map_or("none", Stage::name).to_owned())
            }
        };
        let so = if holds { "as expected" } else { "not as expected" };
        Checked { holds, says: format!("{so}: {}; found {found}", self.text) }
    }
}

impl fmt::Display for Expectation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Standard errors within which two values are the same: the two-sided level is 5 %.
const SAME: f64 = 1.96;

/// The row of a quantity; in words where there is none.
fn row(report: &Report, what: &str) -> Result<ReportedDifference, String> {
    let Some(differences) = &report.diagnosis.differences else {
        return Err("nothing: the machine was compared with no model, simulator or records".to_owned());
    };
    let found = differences.rows.iter().find(|row| row.what == what);
    found.map(|row| ReportedDifference::of(row, &Units::of(&report.rig))).ok_or_else(|| {
        let names: Vec<&str> = differences.rows.iter().map(|row| row.what.as_str()).collect();
        format!("no `{what}` among {}", names.join(", "))
    })
}

fn found(row: &ReportedDifference) -> String {
    let text = format!(
        "{} against {} ± {} {}",
        digits(row.in_a, 4),
        digits(row.in_b, 4),
        digits(row.se, 2),
        row.unit
    );
    text.trim_end().to_owned()
}

fn value_is(report: &Report, what: &str, value: f64) -> (bool, String) {
    match row(report, what) {
        Ok(row) => ((row.in_a - value).abs() <= SAME * row.se, found(&row)),
        Err(words) => (false, words),
    }
}

fn is_within(report: &Report, what: &str, share: f64) -> (bool, String) {
    match row(report, what) {
        Ok(row) => ((row.in_a - row.in_b).abs() <= share * row.in_b.abs(), found(&row)),
        Err(words) => (false, words),
    }
}

/// `delay = 0` or `friction within 5 %`; none where a text is of neither form.
fn parse_difference(text: &str) -> Option<Result<What, String>> {
    let number = |text: &str| {
        let number = text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        number.ok_or_else(|| {
            format!("`{}` is no number; give e.g. `delay = 0` or `friction within 5 %`", text.trim())
        })
    };
    if let Some((what, share)) = text.split_once(" within ") {
        let what = what.trim().to_owned();
        let share = share.trim();
        return Some(match share.strip_suffix('%') {
            Some(percent) => number(percent).map(|share| What::Within { what, share: share / 100.0 }),
            None => number(share).map(|share| What::Within { what, share }),
        });
    }
    let (what, value) = text.split_once('=').filter(|_| !text.contains(['<', '>']))?;
    Some(number(value).map(|value| What::Value { what: what.trim().to_owned(), value }))
}

/// The cause in a word.
fn cause(report: &Report) -> String {
    let verdict = &report.diagnosis.verdict;
    let names = |effects: &[Effect]| effects.iter().map(|e| e.name()).collect::<Vec<_>>();
    match verdict.status {
        Status::Named => names(&verdict.effects).join(" and "),
        Status::Class => format!("one of {}", names(&verdict.class).join(", ")),
        status => status.name().to_owned(),
    }
}

fn parse_bound(figure: &str, sign: Sign, bound: &str) -> Result<What, String> {
    let place = FIGURES.iter().position(|(name, _)| *name == figure).ok_or_else(|| {
        let names: Vec<&str> = FIGURES.iter().map(|(name, _)| *name).collect();
        format!("`{figure}` is no figure; the figures are {}", names.join(", "))
    })?;
    let (number, in_percent) = match bound.strip_suffix('%') {
        Some(number) => (number.trim(), true),
        None => (bound, false),
    };
    let bound = number.parse::<f64>().ok().filter(|bound| bound.is_finite());
    let bound = bound.ok_or_else(|| format!("`{number}` is no number; give e.g. `{figure} < 2 %`"))?;
    Ok(What::Bound { figure: place, sign, bound, in_percent })
}

fn parse_word(text: &str) -> Result<What, String> {
    let (key, word) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let word = word.trim();
    let allowed =
        |names: Vec<&str>| format!("`{word}` cannot be expected of {key}; allowed are {}", names.join(", "));
    match key {
        "cause" if word == "none" => Ok(What::Cause(None)),
        "cause" => Effect::from_name(word).map(|effect| What::Cause(Some(effect))).ok_or_else(|| {
            allowed(std::iter::once("none").chain(Effect::ALL.iter().map(|effect| effect.name())).collect())
        }),
        "verdict.status" => {
            let status = Status::ALL.into_iter().find(|status| status.name() == word).map(What::Status);
            status.ok_or_else(|| allowed(Status::ALL.iter().map(|status| status.name()).collect()))
        }
        "verdict.stage" => {
            let stage = STAGES.into_iter().find(|stage| stage.name() == word).map(What::Stage);
            stage.ok_or_else(|| allowed(STAGES.iter().map(|stage| stage.name()).collect()))
        }
        _ => {
            let figures: Vec<&str> = FIGURES.iter().map(|(name, _)| *name).collect();
            Err(format!(
                "`{text}` is no expectation: give a figure with a bound, e.g. `gap < 2 %` ({}), or a word, e.g. `cause none` (cause, verdict.status, verdict.stage)",
                figures.join(", ")
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_the_json_object() {
        let expect = |text: &str| Expectation::parse(text).expect(text).what;
        assert_eq!(
            expect("gap<2%"),
            What::Bound { figure: 0, sign: Sign::Below, bound: 2.0, in_percent: true }
        );
        assert_eq!(
            expect("gap.closure >= 0.9"),
            What::Bound { figure: 3, sign: Sign::AtLeast, bound: 0.9, in_percent: false }
        );
        assert_eq!(expect("delay = 0"), What::Value { what: "delay".to_owned(), value: 0.0 });
        assert_eq!(expect("friction within 5 %"), What::Within { what: "friction".to_owned(), share: 0.05 });
        assert_eq!(expect("cause none"), What::Cause(None));
        assert_eq!(expect("cause  backlash"), What::Cause(Some(Effect::Backlash)));
        assert_eq!(expect("verdict.status unexplained"), What::Status(Status::Unexplained));
        assert_eq!(expect("verdict.stage operator"), What::Stage(Stage::Operator));
    }

    #[test]
    fn a_typo_is_reported_with_the_words_that_are_allowed() {
        for (text, word) in [
            ("gab < 2 %", "gap.before"),
            ("gap < two", "is no number"),
            ("delay = zero", "is no number"),
            ("friction within five", "is no number"),
            ("gap < nan", "is no number"),
            ("gap", "cause none"),
            ("cause backlsh", "backlash"),
            ("cause", "none, "),
            ("verdict.status nonne", "unexplained"),
            ("verdict.stage foo", "operator"),
            ("", "gap < 2 %"),
        ] {
            let reported = Expectation::parse(text).expect_err(text);
            assert!(reported.contains(word), "{text}: {reported}");
        }
    }
}
