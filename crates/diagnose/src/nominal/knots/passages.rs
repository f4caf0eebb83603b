//! Passages of the borders by level, and what a step of a border there does to the innovations.

use crate::likelihood::design::Design;
use crate::likelihood::engine::Fit;
use crate::likelihood::gains::{Gains, Sums};
use crate::likelihood::weights::impulse_response;
use crate::model::augmented::convolve;
use crate::model::borders::side;
use crate::records::dataset::Dataset;

/// A move on a border.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passage {
    v: f64,
    /// On a free record.
    free: bool,
    /// Number among the fitted records.
    scaled: u32,
    /// The sample of the move, and that of the next one.
    from: u32,
    until: u32,
}

/// All moves on the descending and on the ascending border, by level.
#[derive(Debug)]
pub(super) struct Passages([Vec<Passage>; 2]);

impl Passages {
    pub(super) fn new(dataset: &Dataset, design: &Design) -> Self {
        let mut sides = [Vec::new(), Vec::new()];
        for (number, (scaled, effect_term)) in dataset.fit().zip(&design.scaled_records).enumerate() {
            let mut until = effect_term.moves.len() as u32;
            for (t, m) in effect_term.moves.iter().enumerate().rev().filter(|(_, m)| m.moves) {
                let (v, free, from) = (scaled.v[t], !scaled.is_pulsed(), t as u32);
                sides[side(m.branch)].push(Passage { v, free, scaled: number as u32, from, until });
                until = from;
            }
        }
        sides.iter_mut().for_each(|side| side.sort_by(|x, y| x.v.total_cmp(&y.v)));
        Self(sides)
    }

    /// Places a given number of free passages away from a level, between neighbouring ones.
    pub(super) fn places(&self, side: usize, from: f64, up: bool, counts: &[usize]) -> Vec<f64> {
        let all = &self.0[side];
        let here = all.partition_point(|p| p.v < from);
        let most = counts.iter().max().copied().unwrap_or(0) + 2;
        let levels: Vec<f64> = if up {
            // The first one below starts the row, so that a place is the middle between two.
            let below = all[..here].iter().rev().find(|p| p.free).into_iter();
            below.chain(all[here..].iter().filter(|p| p.free)).map(|p| p.v).take(most).collect()
        } else {
            let above = all[here..].iter().find(|p| p.free).into_iter();
            above.chain(all[..here].iter().rev().filter(|p| p.free)).map(|p| p.v).take(most).collect()
        };
        let middle = |count: &usize| Some(0.5 * (levels.get(*count)? + levels.get(count + 1)?));
        counts.iter().filter_map(middle).filter(|to| if up { *to > from } else { *to < from }).collect()
    }

    /// Passages above the lower and up to the upper of two levels.
    pub(super) fn between(&self, side: usize, a: f64, b: f64) -> &[Passage] {
        let at = |level: f64| self.0[side].partition_point(|p| p.v <= level);
        &self.0[side][at(a.min(b))..at(a.max(b))]
    }
}

/// A step of a border between two levels, as a column of the regression, summed up passage by passage.
pub(super) struct Steps<'a> {
    gains: &'a Gains<'a>,
    design: &'a Design,
    /// Response of the innovations to a unit of `u`, from lag 1 on.
    response: Vec<f64>,
    /// First row of each record.
    rows: Vec<usize>,
    column: Vec<f64>,
    touched: Vec<usize>,
    sums: Sums,
}

impl<'a> Steps<'a> {
    pub(super) fn new(gains: &'a Gains<'a>, design: &'a Design, fit: &Fit) -> Self {
        let whitener = design.whitener(&fit.augmented.noise, &fit.linear.a);
        let ar: Vec<f64> = std::iter::once(1.0).chain(whitener.ar).collect();
        let b = convolve(&convolve(&fit.linear.b, &design.taps), &ar);
        let mut rows = Vec::with_capacity(design.scaled_records.len());
        let mut samples = 0;
        for scaled in &design.scaled_records {
            rows.push(samples);
            samples += scaled.x.len() - scaled.from;
        }
        Self {
            gains,
            design,
            response: impulse_response(&b, &whitener.ma),
            rows,
            column: vec![0.0; samples],
            touched: Vec::new(),
            sums: gains.no_sums(),
        }
    }

    /// No passage yet.
    pub(super) fn clear(&mut self) {
        self.touched.drain(..).for_each(|row| self.column[row] = 0.0);
        self.sums = self.gains.no_sums();
    }

    /// Adds passages: while the input rests, u stays where the last move put it.
    pub(super) fn add(&mut self, passages: &[Passage]) {
        for p in passages {
            let scaled = &self.design.scaled_records[p.scaled as usize];
            for t in p.from as usize..p.until as usize {
                for (lag, h) in self.response.iter().enumerate() {
                    let at = t + lag + 1;
                    if at < scaled.from || at >= scaled.x.len() {
                        continue;
                    }
                    let row = self.rows[p.scaled as usize] + at - scaled.from;
                    let before = self.column[row];
                    self.sums.corner += (before + h) * (before + h) - before * before;
                    self.column[row] += h;
                    self.touched.push(row);
                    self.gains.add_to(&mut self.sums, row, *h);
                }
            }
        }
    }

    /// Approximate gain in deviance from the step.
    pub(super) fn gain(&self) -> f64 {
        self.gains.of_sums(&self.sums)
    }
}

#[cfg(test)]
mod tests {
    use super::super::improve::column;
    use super::*;
    use crate::likelihood::engine::{FitContext, fit};
    use crate::likelihood::jacobian::Jacobian;
    use crate::likelihood::weights::Weights;
    use crate::model::augmented::AugmentedModel;
    use crate::testing::{small_dataset, small_model};

    /// The oracle of the sums: the column itself.
    #[test]
    fn steps_gain_what_their_columns_do() {
        let (dataset, grid) = small_dataset();
        let start = small_model(&grid);
        for ma in [Vec::new(), vec![0.4]] {
            let mut augmented = AugmentedModel::default();
            augmented.noise.ar = vec![0.3];
            augmented.noise.ma = ma;
            let context = FitContext { dataset: &dataset, grid: &grid, known: None };
            let fit = fit(context, &|_| augmented.clone(), &[], &start, 3).expect("a fit");
            let design = &fit.design();
            let whitener = design.whitener(&fit.augmented.noise, &fit.linear.a);
            let w = design.innovations(&fit.linear, &whitener).concat();
            let jacobian = Jacobian::new(design, &fit.linear, &whitener, &Weights::default());
            let gains = Gains::new(&jacobian, &w, 1.0).expect("determined");
            let passages = Passages::new(&dataset, design);
            let mut steps = Steps::new(&gains, design, &fit);
            for (side, low, high) in [(0, 0.3, 0.45), (1, 0.4, 0.6)] {
                steps.clear();
                let middle = 0.5 * (low + high);
                steps.add(passages.between(side, low, middle));
                steps.add(passages.between(side, middle, high));
                let step = |v: f64| f64::from(u8::from(v > low && v <= high));
                let whole = gains.score(column(&dataset, &fit, design, &whitener, side, step));
                let (found, wanted) = (steps.gain(), gains.of(&[&whole]));
                assert!((found - wanted).abs() < 2e-2 * wanted.max(1.0), "{found} {wanted}");
            }
        }
    }
}
