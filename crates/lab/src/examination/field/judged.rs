//! What an examination asks of a case.

use super::case::Case;
use super::report::answers;
use crate::examination::Judged;

impl Judged for Case {
    fn id(&self) -> usize {
        self.id
    }

    fn answers(cases: &[Self]) -> String {
        answers(cases)
    }
}
