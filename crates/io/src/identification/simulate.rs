//! Free-run simulation of an estimate whose borders are points.

use super::FreeRun;
use switchback_identify::{BorderPoint, Estimate};
use switchback_model::Record;
use switchback_model::hysteresis::{Branch, Interval};
use switchback_model::linear::is_stable;

/// An estimate that can run on its own: stable, with points on its borders.
///
/// Between points a border is straight. A pulse experiment visits its border up to one level short of the satellite; the
/// last piece to there continues the one before it. An experiment that is missing leaves one known point of its border, the
/// end of the interval that the other's satellite is.
#[derive(Debug, Clone)]
pub struct EstimatedSystem<'a> {
    estimate: &'a Estimate,
    interval: Interval,
    /// `(v, F)` by increasing `v`.
    descending: Vec<(f64, f64)>,
    ascending: Vec<(f64, f64)>,
}

impl<'a> EstimatedSystem<'a> {
    /// Completes the borders over the working interval; `Err` says why the estimate cannot run.
    pub fn new(estimate: &'a Estimate, interval: Interval) -> Result<Self, &'static str> {
        if !is_stable(&estimate.a) {
            return Err("the estimated A is unstable");
        }
        Ok(Self::of_any(estimate, interval))
    }

    /// The same for an estimate that may be unstable.
    pub(crate) fn of_any(estimate: &'a Estimate, interval: Interval) -> Self {
        let points =
            |border: &[BorderPoint]| -> Vec<(f64, f64)> { border.iter().map(|p| (p.v, p.f)).collect() };
        let mut descending = points(&estimate.descending);
        match descending[..] {
            [] => descending.push((interval.low(), estimate.y_low / estimate.gain)),
            [.., last] if last.0 < interval.high() => {
                descending.push((interval.high(), continued(descending.iter().rev(), interval.high())));
            }
            _ => {}
        }
        let mut ascending = points(&estimate.ascending);
        match ascending[..] {
            [] => ascending.push((interval.high(), estimate.y_high / estimate.gain)),
            [first, ..] if first.0 > interval.low() => {
                ascending.insert(0, (interval.low(), continued(ascending.iter(), interval.low())));
            }
            _ => {}
        }
        Self { estimate, interval, descending, ascending }
    }

    /// The completed borders, descending and ascending: `(v, F)` by increasing `v`.
    pub fn borders(&self) -> [&[(f64, f64)]; 2] {
        [&self.descending, &self.ascending]
    }

    /// Runs on a record's input; none where it moves along a border that was not estimated, or not at all.
    ///
    /// The outputs measured until the first sample whose inputs are all known (the first move and the memory of the
    /// system) are the initial state; all later ones are simulated from `v` alone.
    pub(crate) fn run(&self, record: &Record) -> Option<FreeRun> {
        let v = record.v();
        let first_known = first_move(v)?;
        let start = (first_known + self.memory()).min(v.len());
        let u = self.along(v, first_known, 0.0)?;
        let y = self.from(&u, record.y()[..start].to_vec());
        Some(FreeRun::new(record.y(), y, start))
    }

    /// Runs on an input from rest: the input has been at its first value for ever, on the border of the first move where that is known
    /// there. None where it moves along a border that was not estimated.
    pub(crate) fn run_from_rest(&self, v: &[f64]) -> Option<Vec<f64>> {
        let first_known = first_move(v).unwrap_or(v.len());
        let falls = v.get(first_known).is_some_and(|now| *now < v[0]);
        let [own, other] = if falls {
            [Branch::Descending, Branch::Ascending]
        } else {
            [Branch::Ascending, Branch::Descending]
        };
        let rest = self.border(own, v[0]).or_else(|| self.border(other, v[0]))?;
        // The memory of the system before the record.
        let before = self.memory().max(1);
        let u = [vec![rest; before], self.along(v, first_known, rest)?].concat();
        let mut y = self.from(&u, vec![self.estimate.gain * rest; before]);
        Some(y.split_off(before))
    }

    /// Samples that an output looks back.
    fn memory(&self) -> usize {
        self.estimate.a.len() + self.estimate.delay.max(0) as usize
    }

    /// `u` along an input whose branch is known from a sample on; before it the value given.
    fn along(&self, v: &[f64], first_known: usize, before: f64) -> Option<Vec<f64>> {
        let mut u = vec![before; v.len()];
        for t in first_known..v.len() {
            u[t] = match v[t].total_cmp(&v[t - 1]) {
                std::cmp::Ordering::Greater => self.border(Branch::Ascending, v[t])?,
                std::cmp::Ordering::Less => self.border(Branch::Descending, v[t])?,
                std::cmp::Ordering::Equal => u[t - 1],
            };
        }
        Some(u)
    }

    /// The outputs for `u`, given the first ones.
    fn from(&self, u: &[f64], mut y: Vec<f64>) -> Vec<f64> {
        let Estimate { a, b, delay, .. } = self.estimate;
        for t in y.len()..u.len() {
            // A look ahead that leaves the record finds the input at rest where it ended.
            let driven = |j: usize| b[j] * u[(t - j).saturating_add_signed(-1 - delay).min(u.len() - 1)];
            let free = |i: usize| a[i] * y[t - 1 - i];
            y.push((0..b.len()).map(driven).sum::<f64>() - (0..a.len()).map(free).sum::<f64>());
        }
        y
    }

    /// The border's value, none where nothing is known of it. Outside the interval it keeps its last value.
    fn border(&self, branch: Branch, v: f64) -> Option<f64> {
        let points = match branch {
            Branch::Descending => &self.descending,
            Branch::Ascending => &self.ascending,
        };
        if let [(at, f)] = points[..] {
            return ((v - at).abs() <= 1e-6 * self.interval.width()).then_some(f);
        }
        let right = points.partition_point(|point| point.0 <= v);
        Some(match (right.checked_sub(1).map(|left| points[left]), points.get(right)) {
            (Some(left), Some(right)) => left.1 + (right.1 - left.1) * (v - left.0) / (right.0 - left.0),
            (Some(only), None) => only.1,
            (None, _) => points[0].1,
        })
    }
}

/// The first sample at which an input moves.
fn first_move(v: &[f64]) -> Option<usize> {
    (1..v.len()).find(|&t| v[t] != v[t - 1])
}

/// The straight line through the two outermost points at `v`; constant where there is but one.
fn continued<'p>(mut from_the_end: impl Iterator<Item = &'p (f64, f64)>, v: f64) -> f64 {
    match (from_the_end.next(), from_the_end.next()) {
        (Some(last), Some(before)) => last.1 + (last.1 - before.1) * (v - last.0) / (last.0 - before.0),
        (Some(last), None) => last.1,
        (None, _) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_model::hysteresis::{LeafSpring, SwitchedHysteresis};
    use switchback_model::linear::filter;

    const A: [f64; 2] = [-1.2, 0.5];
    const B: [f64; 2] = [0.4, 0.2];

    fn spring() -> SwitchedHysteresis {
        let interval = Interval::new(-1.0, 1.0).unwrap();
        // u_M − u_m = 2·(0.3 + 0.2) = 1: already in the paper's normalisation.
        SwitchedHysteresis::new(interval, Box::new(LeafSpring::constant(0.3, 0.2).unwrap())).unwrap()
    }

    fn estimate(descending: &[f64], ascending: &[f64]) -> Estimate {
        let spring = spring();
        let points = |branch, vs: &[f64]| {
            vs.iter().map(|&v| BorderPoint { v, f: spring.border(branch, v), se: 0.01 }).collect()
        };
        let gain = 0.6 / 0.3;
        Estimate {
            a: A.to_vec(),
            a_se: vec![0.0; 2],
            b: B.to_vec(),
            b_se: vec![0.0; 2],
            delay: 0,
            noise_sd: 0.0,
            gain,
            y_high: gain * spring.u_high(),
            y_low: gain * spring.u_low(),
            descending: points(Branch::Descending, descending),
            ascending: points(Branch::Ascending, ascending),
            excitation: 1.0,
            samples: 0,
        }
    }

    fn measured(v: Vec<f64>) -> Record {
        let u = spring().output(&v, 0.1);
        let y = filter(&A, &B, &u, &[], 0.3, 0.1);
        Record::new(v, y).unwrap()
    }

    #[test]
    fn the_true_system_reproduces_a_free_record() {
        let estimate = estimate(&[-1.0, -0.5, 0.0, 0.5], &[-0.5, 0.0, 0.5, 1.0]);
        let system = EstimatedSystem::new(&estimate, spring().interval()).unwrap();
        let v = (0..400).map(|k| (0.1 * f64::from(k)).sin() * (0.013 * f64::from(k)).cos()).collect();
        let run = system.run(&measured(v)).unwrap();
        assert!(run.fit_percent > 99.999_999, "{}", run.fit_percent);
    }

    #[test]
    fn one_experiment_runs_on_its_own_kind_and_on_no_other() {
        let estimate = estimate(&[-1.0, -0.5, 0.0, 0.5], &[]);
        let system = EstimatedSystem::new(&estimate, spring().interval()).unwrap();
        let visits = [-1.0, 1.0, 0.0, 1.0, 1.0, -0.5, 1.0, 1.0, 0.5, 1.0].repeat(10);
        assert!(system.run(&measured(visits)).unwrap().fit_percent > 99.999_999);
        assert_eq!(system.run(&measured((0..50).map(|k| (0.3 * f64::from(k)).sin()).collect())), None);
    }

    #[test]
    fn an_input_that_never_moves_shows_nothing() {
        let estimate = estimate(&[-1.0, 0.0], &[0.0, 1.0]);
        let system = EstimatedSystem::new(&estimate, spring().interval()).unwrap();
        assert_eq!(system.run(&Record::new(vec![0.5; 20], vec![1.0; 20]).unwrap()), None);
    }
}
