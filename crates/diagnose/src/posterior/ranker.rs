//! One model that scores every pair of a rig and an outcome.

use super::bytes::{Reader, Writer};
use super::error::PosteriorError;
use super::softmax::softmax;
use super::trees::Trees;

/// A conditional logit whose score is a sum of trees: `p_k = exp(s(x_k))/Σ_j exp(s(x_j))`, with `x_k` an outcome's own columns, their ranks among the
/// outcomes, and columns of the whole rig. What is learnt of one effect serves all others.
///
/// D. McFadden, "Conditional logit analysis of qualitative choice behavior", 1974.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranker {
    /// Columns of each outcome's own: the same statistics in the same order, or none.
    pub own: Vec<Vec<u16>>,
    /// Columns of the whole rig.
    pub common: Vec<u16>,
    /// Scores a pair's row.
    pub trees: Trees,
}

impl Ranker {
    /// Statistics that outcomes with own columns have.
    fn statistics(&self) -> usize {
        self.own.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// Numbers in the row of a pair.
    pub fn width(&self) -> usize {
        2 * self.statistics() + self.common.len() + 1
    }

    /// The row of a pair: own columns, how many outcomes have a larger value in each, common columns, the number of the outcome. An outcome without
    /// own columns has zeros for both.
    pub fn row(&self, row: &[f64], outcome: usize) -> Vec<f64> {
        let value = |column: &u16| row[usize::from(*column)];
        let own = &self.own[outcome];
        let mut pair: Vec<f64> = own.iter().map(value).collect();
        for (statistic, here) in pair.clone().into_iter().enumerate() {
            let others = self.own.iter().filter_map(|other| other.get(statistic));
            pair.push(others.filter(|other| value(other) > here).count() as f64);
        }
        pair.resize(2 * self.statistics(), 0.0);
        pair.extend(self.common.iter().map(value));
        pair.push(outcome as f64);
        pair
    }

    /// Probabilities of all outcomes.
    pub fn probabilities(&self, row: &[f64]) -> Vec<f64> {
        let score = |outcome: usize| self.trees.scores(&self.row(row, outcome))[0];
        softmax(&(0..self.own.len()).map(score).collect::<Vec<f64>>())
    }

    pub(super) fn write(&self, out: &mut Writer) {
        let list = |out: &mut Writer, all: &[u16]| {
            out.count(all.len());
            all.iter().for_each(|n| out.small(usize::from(*n)));
        };
        self.own.iter().for_each(|own| list(out, own));
        list(out, &self.common);
        self.trees.write(out);
    }

    pub(super) fn read(
        from: &mut Reader<'_>,
        columns: usize,
        classes: usize,
    ) -> Result<Self, PosteriorError> {
        let list = |from: &mut Reader<'_>| -> Result<Vec<u16>, PosteriorError> {
            let n = from.count_of(2)?;
            let all = (0..n).map(|_| from.small()).collect::<Result<Vec<_>, _>>()?;
            if all.iter().any(|k| *k >= columns) {
                return Err(from.damaged("a ranker of columns that are not there"));
            }
            Ok(all.into_iter().map(|k| k as u16).collect())
        };
        let own = (0..classes).map(|_| list(from)).collect::<Result<Vec<_>, _>>()?;
        let common = list(from)?;
        let trees = Trees { edges: Vec::new(), start: Vec::new(), rounds: Vec::new() };
        let empty = Self { own, common, trees };
        let each = empty.statistics();
        if empty.own.iter().any(|own| !own.is_empty() && own.len() != each) {
            return Err(from.damaged("outcomes with unequal columns"));
        }
        let trees = Trees::read(from, empty.width())?;
        if trees.start.len() != 1 {
            return Err(from.damaged("a ranker of more than one score"));
        }
        Ok(Self { trees, ..empty })
    }
}
