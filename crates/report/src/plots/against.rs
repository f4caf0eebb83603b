//! What stands against what in comparisons on the same noise.

use super::selection::distinct;
use super::style::OKABE_ITO;
use switchback_study::results::{Comparison, Overall, Results, Series, Subject};

/// What the sides of a comparison differ in: it decides what a colour stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Against {
    /// The method.
    Methods,
    /// The border.
    Borders,
}

impl Against {
    pub(super) const ALL: [Self; 2] = [Self::Methods, Self::Borders];

    /// In words and in file names.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Methods => "methods",
            Self::Borders => "borders",
        }
    }

    /// The name of a side.
    pub(super) fn side(self, series: &Series) -> String {
        match self {
            Self::Methods => series.method.to_string(),
            Self::Borders => series.border.clone(),
        }
    }

    /// What a colour's marks are drawn over.
    pub(super) fn others(self) -> &'static str {
        match self {
            Self::Methods => "border shapes, m and noise levels",
            Self::Borders => "methods, m and noise levels",
        }
    }

    fn holds(self, comparison: &Comparison) -> bool {
        comparison.is_of_methods() == (self == Self::Methods)
    }
}

/// The comparisons of one kind in one case.
pub(super) struct Pairs<'r> {
    pub(super) against: Against,
    pub(super) comparisons: Vec<&'r Comparison>,
    /// One a side, over all parameters and cells.
    pub(super) overall: Vec<&'r Overall>,
    /// The sides that are judged, in the order of the table.
    pub(super) sides: Vec<String>,
    /// What they are judged against.
    pub(super) over: Vec<String>,
}

impl<'r> Pairs<'r> {
    /// `None` where nothing is compared.
    pub(super) fn of(against: Against, case: &str, results: &'r Results) -> Option<Self> {
        let pairing = results.paired.as_ref()?;
        let mine = |c: &&Comparison| c.series.case == case && against.holds(c);
        let comparisons: Vec<&Comparison> = pairing.comparisons.iter().filter(mine).collect();
        let is_of_kind = |o: &&Overall| {
            o.case == case && matches!(o.subject, Subject::Method(_)) == (against == Against::Methods)
        };
        let sides = distinct(comparisons.iter().map(|c| against.side(&c.series)));
        let over = distinct(comparisons.iter().map(|c| against.side(&c.over)));
        let overall = pairing.overall.iter().filter(is_of_kind).collect();
        (!comparisons.is_empty()).then_some(Self { against, comparisons, overall, sides, over })
    }

    /// The comparisons of one side.
    pub(super) fn of_side(&self, side: &str) -> impl Iterator<Item = &'r Comparison> {
        self.comparisons.iter().copied().filter(move |c| self.against.side(&c.series) == side)
    }

    /// Which sides have no colour left.
    pub(super) fn left_out(&self) -> Option<String> {
        let rest = self.sides.get(OKABE_ITO.len()..).filter(|rest| !rest.is_empty())?;
        Some(format!("Not drawn, as there are too many: {}; they are in table.csv.", rest.join(", ")))
    }

    /// `paper-descendant or paper-ascendant`.
    pub(super) fn reference(&self) -> String {
        self.over.join(" or ")
    }
}
