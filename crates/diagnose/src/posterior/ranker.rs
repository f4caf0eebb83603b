//! One model that asks of every pair of a rig and an effect whether that is the cause.

use super::bytes::{Reader, Writer};
use super::error::PosteriorError;
use super::trees::Trees;

/// A binary model on an effect's own columns, their ranks among the effects, and columns of the whole rig.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranker {
    /// Classes that have columns of their own.
    pub classes: Vec<u16>,
    /// Their columns, the same statistics in the same order for each of these classes.
    pub own: Vec<Vec<u16>>,
    /// Columns of the whole rig.
    pub common: Vec<u16>,
    /// Scores a pair's row: own columns, their ranks, common columns, and the number of the effect.
    pub trees: Trees,
}

impl Ranker {
    /// The row of a pair.
    pub fn row(&self, row: &[f64], effect: usize) -> Vec<f64> {
        pair_row(&self.own, &self.common, row, effect)
    }

    /// Probabilities of all classes: those of the ranker for the classes that it knows, else those given; sums to one.
    pub fn probabilities(&self, row: &[f64], others: &[f64]) -> Vec<f64> {
        let mut p = others.to_vec();
        for (effect, class) in self.classes.iter().enumerate() {
            let score = self.trees.scores(&self.row(row, effect))[0];
            p[usize::from(*class)] = 1.0 / (1.0 + libm::exp(-score));
        }
        let sum: f64 = p.iter().sum();
        p.iter().map(|p| p / sum).collect()
    }

    pub(super) fn write(&self, out: &mut Writer) {
        let list = |out: &mut Writer, all: &[u16]| {
            out.count(all.len());
            all.iter().for_each(|n| out.small(usize::from(*n)));
        };
        list(out, &self.classes);
        self.own.iter().for_each(|own| list(out, own));
        list(out, &self.common);
        self.trees.write(out);
    }

    pub(super) fn read(
        from: &mut Reader<'_>,
        columns: usize,
        classes: usize,
    ) -> Result<Self, PosteriorError> {
        let list = |from: &mut Reader<'_>, below: usize| -> Result<Vec<u16>, PosteriorError> {
            let n = from.count_of(2)?;
            let all = (0..n).map(|_| from.small()).collect::<Result<Vec<_>, _>>()?;
            if all.iter().any(|k| *k >= below) {
                return Err(from.damaged("a ranker of columns that are not there"));
            }
            Ok(all.into_iter().map(|k| k as u16).collect())
        };
        let known = list(from, classes)?;
        let own = known.iter().map(|_| list(from, columns)).collect::<Result<Vec<_>, _>>()?;
        let common = list(from, columns)?;
        let each = own.first().map_or(0, Vec::len);
        if own.iter().any(|own| own.len() != each) {
            return Err(from.damaged("effects with unequal columns"));
        }
        let trees = Trees::read(from, 2 * each + common.len() + 1)?;
        if trees.start.len() != 1 {
            return Err(from.damaged("a ranker of more than one score"));
        }
        Ok(Self { classes: known, own, common, trees })
    }
}

/// Own columns, how many effects have a larger value in each, common columns, the number of the effect.
fn pair_row(own: &[Vec<u16>], common: &[u16], row: &[f64], effect: usize) -> Vec<f64> {
    let value = |column: &u16| row[usize::from(*column)];
    let mut pair: Vec<f64> = own[effect].iter().map(value).collect();
    for statistic in 0..own[effect].len() {
        let here = pair[statistic];
        pair.push(own.iter().filter(|other| value(&other[statistic]) > here).count() as f64);
    }
    pair.extend(common.iter().map(value));
    pair.push(effect as f64);
    pair
}
