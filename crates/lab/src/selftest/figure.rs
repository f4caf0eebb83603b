//! A number or a word that a check found, beside what it must be.

/// What a check found, what it must be, and how near it came to its limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What it is, with its unit.
    pub what: String,
    /// What was found.
    pub found: String,
    /// What must be found: a value with the range that chance leaves it, a limit, or a word.
    pub expected: String,
    /// Share of the distance from the expected value to its limit that is used up; above 1 the figure is wrong.
    pub strain: f64,
}

impl Figure {
    /// A number that chance moves about its expectation, within the range given.
    pub(crate) fn within(
        what: impl Into<String>,
        found: f64,
        expected: f64,
        (low, high): (f64, f64),
    ) -> Self {
        let strain = if found >= low && found <= high {
            let room = if found < expected { expected - low } else { high - expected };
            if found == expected { 0.0 } else { (found - expected).abs() / room }
        } else {
            f64::INFINITY
        };
        Self {
            what: what.into(),
            found: short(found),
            expected: format!("{} [{}, {}]", short(expected), short(low), short(high)),
            strain,
        }
    }

    /// A distance that must not exceed a limit.
    pub fn at_most(what: impl Into<String>, found: f64, limit: f64) -> Self {
        let strain = if found <= limit { found / limit } else { f64::INFINITY };
        Self { what: what.into(), found: short(found), expected: format!("at most {}", short(limit)), strain }
    }

    /// A word that must come out.
    pub(crate) fn word(
        what: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        let (found, expected) = (found.into(), expected.into());
        let strain = if found == expected { 0.0 } else { f64::INFINITY };
        Self { what: what.into(), found, expected, strain }
    }

    /// Whether it is what it must be.
    pub(crate) fn holds(&self) -> bool {
        self.strain <= 1.0
    }
}

/// Five significant digits, without the noise of a float's tail.
fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&x.abs()) {
        return format!("{x:.3e}");
    }
    let decimals = (4.0 - x.abs().log10().floor()).max(0.0) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_outside_or_no_number_does_not_hold() {
        let at = |found| Figure::within("x", found, 1.0, (0.5, 3.0)).holds();
        assert!(at(0.5) && at(1.0) && at(3.0));
        assert!(!at(0.4999) && !at(3.001) && !at(f64::NAN));
        assert!(Figure::at_most("x", 1.0, 1.0).holds() && !Figure::at_most("x", 1.1, 1.0).holds());
        assert!(!Figure::at_most("x", f64::NAN, 1.0).holds());
        assert!(!Figure::word("cause", "creep", "backlash").holds());
    }

    #[test]
    fn strain_is_the_share_of_the_room_on_its_side() {
        assert_eq!(Figure::within("x", 0.75, 1.0, (0.5, 3.0)).strain, 0.5);
        assert_eq!(Figure::within("x", 2.0, 1.0, (0.5, 3.0)).strain, 0.5);
        // No room on a side, and found there: a share of nothing.
        assert_eq!(Figure::within("x", 0.0, 0.0, (0.0, 1.0)).strain, 0.0);
    }

    #[test]
    fn numbers_are_short() {
        let all = [0.0, 0.95, 1.0 / 3.0, 1234567.0, -2.5e-9, 20.0, 100000.0].map(short);
        assert_eq!(all, ["0", "0.95", "0.33333", "1.235e6", "-2.500e-9", "20", "100000"]);
    }
}
