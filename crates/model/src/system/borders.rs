//! Both borders as tables, piecewise linear between their knots.

use crate::hysteresis::Branch;

/// The two borders of a hysteresis, in output units over input units; beyond its ends a border keeps its end value.
///
/// ```text
/// mean(v) = ½(C_a(v) + C_d(v)),   half(v) = ½(C_a(v) − C_d(v)),   u = mean + z·half with z = ±1 on the borders
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Borders {
    /// Descending, then ascending.
    curves: [Table; 2],
}

#[derive(Debug, Clone, PartialEq)]
struct Table {
    knots: Vec<f64>,
    values: Vec<f64>,
}

impl Table {
    fn at(&self, v: f64) -> f64 {
        self.value(self.place(v))
    }

    /// The knot to the left, and the share of its cell that is passed.
    #[inline]
    fn place(&self, v: f64) -> (u32, f64) {
        self.place_near(v, 0)
    }

    /// [`Self::place`], looked for in the cell to the right of a knot first: a position seldom leaves the cell of the sample before.
    #[inline]
    fn place_near(&self, v: f64, near: u32) -> (u32, f64) {
        let (knots, near) = (&self.knots, near as usize);
        let left = if knots[near] <= v && v < knots[near + 1] {
            near
        } else {
            knots.partition_point(|&k| k <= v).clamp(1, knots.len() - 1) - 1
        };
        let share = ((v - knots[left]) / (knots[left + 1] - knots[left])).clamp(0.0, 1.0);
        (left as u32, share)
    }

    #[inline]
    fn value(&self, (left, share): (u32, f64)) -> f64 {
        let left = left as usize;
        self.values[left] + share * (self.values[left + 1] - self.values[left])
    }
}

/// Where positions lie among the knots of both borders: found once, since values at knots may change without these.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Places {
    knots: [Vec<f64>; 2],
    /// Of each position on either border.
    each: Vec<[(u32, f64); 2]>,
}

impl Borders {
    /// Joins two tables of `(knot, value)`; none unless each has two knots at least, which rise.
    pub fn new(descending: &[(f64, f64)], ascending: &[(f64, f64)]) -> Option<Self> {
        let table = |points: &[(f64, f64)]| {
            let rises = points.len() >= 2 && points.windows(2).all(|pair| pair[0].0 < pair[1].0);
            let (knots, values) = points.iter().copied().unzip();
            rises.then_some(Table { knots, values })
        };
        Some(Self { curves: [table(descending)?, table(ascending)?] })
    }

    fn table(&self, branch: Branch) -> &Table {
        &self.curves[usize::from(branch == Branch::Ascending)]
    }

    /// `(knot, value)` of one border.
    pub fn points(&self, branch: Branch) -> impl Iterator<Item = (f64, f64)> + '_ {
        let table = self.table(branch);
        table.knots.iter().copied().zip(table.values.iter().copied())
    }

    /// `(mean, half)` at a position.
    pub fn at(&self, v: f64) -> (f64, f64) {
        self.at_place([self.curves[0].place(v), self.curves[1].place(v)])
    }

    /// Where positions lie among the knots.
    pub(super) fn places(&self, positions: &[f64]) -> Places {
        Places {
            knots: self.curves.each_ref().map(|c| c.knots.clone()),
            each: self.each_place(positions).collect(),
        }
    }

    pub(super) fn has_the_knots_of(&self, places: &Places) -> bool {
        self.curves.iter().zip(&places.knots).all(|(curve, knots)| curve.knots == *knots)
    }

    fn each_place(&self, positions: &[f64]) -> impl Iterator<Item = [(u32, f64); 2]> {
        positions.iter().scan([0; 2], |near, &v| {
            let places = [0, 1].map(|side| self.curves[side].place_near(v, near[side]));
            *near = places.map(|(left, _)| left);
            Some(places)
        })
    }

    #[inline]
    fn at_place(&self, [descending, ascending]: [(u32, f64); 2]) -> (f64, f64) {
        let [descending, ascending] = [self.curves[0].value(descending), self.curves[1].value(ascending)];
        (0.5 * (ascending + descending), 0.5 * (ascending - descending))
    }

    /// `(mean, half)` at positions, the places of which are those of these knots or are found anew.
    pub(super) fn along(&self, positions: &[f64], places: &Places) -> Vec<(f64, f64)> {
        if !self.has_the_knots_of(places) {
            return self.each_place(positions).map(|places| self.at_place(places)).collect();
        }
        places.each.iter().map(|&places| self.at_place(places)).collect()
    }

    /// Number of knots of both.
    pub fn count(&self) -> usize {
        self.curves.iter().map(|c| c.knots.len()).sum()
    }

    /// Mean distance of two knots of a border.
    pub fn apart(&self) -> f64 {
        let (low, high) = self.range();
        (high - low) / (self.count() as f64 / 2.0 - 1.0).max(1.0)
    }

    /// The value at a knot, numbered through from the descending border's first.
    pub fn value_mut(&mut self, knot: usize) -> &mut f64 {
        let first = self.curves[0].values.len();
        match knot.checked_sub(first) {
            None => &mut self.curves[0].values[knot],
            Some(knot) => &mut self.curves[1].values[knot],
        }
    }

    /// For each knot, numbered through, the sum of squares of its share in the working points at these places; `z` is −1 on the descending border, 1 on the
    /// ascending one.
    pub(super) fn weights(&self, places: &Places, z: &[f64]) -> Vec<f64> {
        let mut weights = vec![0.0; self.count()];
        let first = self.curves[0].knots.len();
        for (places, z) in places.each.iter().zip(z) {
            for ((left, share), of_border, first) in
                [(places[0], 0.5 * (1.0 - z), 0), (places[1], 0.5 * (1.0 + z), first)]
            {
                let left = first + left as usize;
                weights[left] += (of_border * (1.0 - share)).powi(2);
                weights[left + 1] += (of_border * share).powi(2);
            }
        }
        weights
    }

    /// The same without inner knots of less than this weight, and with wider cells at ends of less. None where nothing changes.
    #[must_use]
    pub fn without_light_knots(&self, weights: &[f64], least: f64) -> Option<Self> {
        let first = self.curves[0].knots.len();
        let heavy = |table: &Table, weights: &[f64]| {
            let last = weights.len() - 1;
            let is_kept = |k: usize| match k {
                _ if k == 0 || k == last => true,
                1 if weights[0] < least => false,
                _ if k == last - 1 && weights[last] < least => false,
                _ => weights[k] >= least,
            };
            let kept: Vec<usize> = (0..=last).filter(|k| is_kept(*k)).collect();
            let of = |values: &[f64]| kept.iter().map(|k| values[*k]).collect();
            Table { knots: of(&table.knots), values: of(&table.values) }
        };
        let curves = [heavy(&self.curves[0], &weights[..first]), heavy(&self.curves[1], &weights[first..])];
        (curves != self.curves).then_some(Self { curves })
    }

    /// The same curves with knots no farther apart than this.
    #[must_use]
    pub fn refined(&self, widest: f64) -> Self {
        let refine = |table: &Table| {
            let mut knots = vec![table.knots[0]];
            for pair in table.knots.windows(2) {
                let pieces = ((pair[1] - pair[0]) / widest * (1.0 - 1e-9)).ceil().max(1.0) as usize;
                knots.extend((1..=pieces).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / pieces as f64));
            }
            Table { values: knots.iter().map(|&v| table.at(v)).collect(), knots }
        };
        Self { curves: [refine(&self.curves[0]), refine(&self.curves[1])] }
    }

    /// The same curves on knots dense enough for a parabola: its chords over a 64th of the stroke lie off it by 3·10⁻⁴ of the square's standard deviation
    /// over the stroke, in the mean.
    #[must_use]
    pub fn dense(&self) -> Self {
        let (low, high) = self.range();
        self.refined((high - low) / 64.0)
    }

    /// The same curves, where they end short of a range continued to its ends: by their mean slopes over the eighth of themselves next to each end.
    #[must_use]
    pub fn continued(&self, (low, high): (f64, f64)) -> Self {
        let continued = |table: &Table| {
            let (first, last) = (table.knots[0], table.knots[table.knots.len() - 1]);
            let along = (last - first) / 8.0;
            let to = |v: f64, end: f64, inside: f64| {
                let slope = (table.at(inside) - table.at(end)) / (inside - end);
                (v, table.at(end) + slope * (v - end))
            };
            let before = (low < first).then(|| to(low, first, first + along));
            let behind = (high > last).then(|| to(high, last, last - along));
            let own = table.knots.iter().copied().zip(table.values.iter().copied());
            let (knots, values) = before.into_iter().chain(own).chain(behind).unzip();
            Table { knots, values }
        };
        Self { curves: [continued(&self.curves[0]), continued(&self.curves[1])] }
    }

    /// The same on the knots of both, with mean and half width changed as functions of the position.
    #[must_use]
    pub fn map(&self, change: impl Fn(f64, f64, f64) -> (f64, f64)) -> Self {
        let mut knots: Vec<f64> = self.curves.iter().flat_map(|c| c.knots.iter().copied()).collect();
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        let changed = |v: f64| {
            let (mean, half) = self.at(v);
            change(v, mean, half)
        };
        let table = |side: f64| Table {
            values: knots.iter().map(|&v| changed(v)).map(|(mean, half)| mean + side * half).collect(),
            knots: knots.clone(),
        };
        Self { curves: [table(-1.0), table(1.0)] }
    }

    /// Ends of the positions that both tables cover.
    pub fn range(&self) -> (f64, f64) {
        let first = |c: &Table| c.knots[0];
        let last = |c: &Table| c.knots[c.knots.len() - 1];
        let [d, a] = &self.curves;
        (first(d).max(first(a)), last(d).min(last(a)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_that_no_position_is_near_are_light() {
        let knots = [-1.0, 0.0, 1.0, 2.0, 3.0];
        let table = knots.map(|v| (v, v * v));
        let borders = Borders::new(&table, &table).expect("tables");
        // Descending on positions from -1 to 1, ascending only on the first knot and halfway to the second.
        let (positions, z) = ([1.0, 0.5, 0.0, -1.0, -1.0, -0.5], [-1.0, -1.0, -1.0, -1.0, 1.0, 1.0]);
        let weights = borders.weights(&borders.places(&positions), &z);
        assert_eq!(weights, [1.0, 1.25, 1.25, 0.0, 0.0, 1.25, 0.25, 0.0, 0.0, 0.0]);
        let fewer = borders.without_light_knots(&weights, 1.0).expect("light knots");
        let knots = |branch| fewer.points(branch).map(|(v, _)| v).collect::<Vec<_>>();
        assert_eq!(knots(Branch::Descending), [-1.0, 0.0, 1.0, 3.0]);
        assert_eq!(knots(Branch::Ascending), [-1.0, 3.0]);
    }

    #[test]
    fn curves_are_continued_by_their_slopes() {
        let borders = Borders::new(&[(-4.0, -8.0), (4.0, 8.0)], &[(-4.0, 3.0), (-3.0, 4.0), (4.0, 4.0)])
            .expect("tables");
        let wider = borders.continued((-6.0, 3.0));
        let points = |branch| wider.points(branch).collect::<Vec<_>>();
        assert_eq!(points(Branch::Descending), [(-6.0, -12.0), (-4.0, -8.0), (4.0, 8.0)]);
        assert_eq!(points(Branch::Ascending), [(-6.0, 1.0), (-4.0, 3.0), (-3.0, 4.0), (4.0, 4.0)]);
        assert_eq!(borders.continued((-1.0, 1.0)), borders);
    }

    #[test]
    fn a_place_is_the_same_wherever_it_is_looked_for_first() {
        let borders = Borders::new(&[(-1.0, 0.0), (0.5, 2.0), (2.0, -1.0)], &[(-2.0, 1.0), (3.0, 4.0)])
            .expect("tables");
        // On knots, between them, beyond both ends, back and forth.
        let positions: Vec<f64> = (0..400).map(|t| 4.0 * (0.7 * f64::from(t)).sin()).collect();
        let positions = [&[-1.0, 0.5, 2.0, -9.0, 9.0, f64::NAN, 0.5, 2.0, -1.0], &positions[..]].concat();
        let alone = |v: f64| borders.curves.each_ref().map(|curve| curve.place(v));
        for (places, &v) in borders.each_place(&positions).zip(&positions) {
            let bits = |places: [(u32, f64); 2]| places.map(|(left, share)| (left, share.to_bits()));
            assert_eq!(bits(places), bits(alone(v)), "{v}");
        }
        assert_eq!(alone(0.0)[0], (0, 1.0 / 1.5));
    }
}
