//! What is done by the border on which a run begins.

use super::builder::choose;
use super::input::Ends;
use crate::step::program::Statement;

/// What is done where a run is to begin on the descending border, where that is left to the model, and on the ascending one.
pub(super) fn by_border(
    ends: &Ends,
    [descending, by_itself, ascending]: [Vec<Statement>; 3],
) -> Vec<Statement> {
    let border = || ends.branch.get();
    vec![choose(border().less(0.0), descending, vec![choose(border().more(0.0), ascending, by_itself)])]
}
