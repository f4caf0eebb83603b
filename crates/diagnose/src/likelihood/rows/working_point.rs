//! The working point as a sparse combination of border values.

use switchback_model::step::NEGLIGIBLE;

use crate::model::augmented::{Transition, TransitionLaw};
use crate::model::borders::{Finder, Grid, side};
use crate::records::dataset::Criterion;
use crate::records::motion::Motion;

/// Follows the working point.
pub(super) struct WorkingPoint<'a> {
    finder: Finder<'a>,
    transition: Option<Transition>,
    /// Travel beyond which nothing of a transition is left.
    reach: f64,
    /// The present combination.
    pub(super) terms: Vec<(u32, f64)>,
    /// The combination where the input stopped.
    at_stop: Vec<(u32, f64)>,
    /// What fades during the present transition.
    fading: Vec<(u32, f64)>,
    /// The border that the last move was on, the share of the other one in the working point, and what that was just after the last
    /// reversal.
    border: usize,
    share: f64,
    after_turn: f64,
    /// Room for a sum of terms, and for border values.
    sum: Vec<(u32, f64)>,
    sums: Vec<f64>,
    /// Number of border values.
    borders: u32,
}

impl<'a> WorkingPoint<'a> {
    /// Of a record that begins at `v`, on a grid given with the number of columns beside its values.
    pub(super) fn new(
        (grid, columns): (&'a Grid, usize),
        transition: Option<Transition>,
        v: f64,
        criterion: Criterion,
    ) -> Self {
        let finder = Finder::new(grid);
        let hat = |side, factor| hat(&finder, side, v, factor);
        // Before the first move u is unknown; the end of the stroke that v is nearer to shows the likelier border.
        let border = usize::from(v >= 0.5);
        let share = match criterion {
            Criterion::OneStep => 0.0,
            // A simulation goes on from there for long: the middle between the borders is never far off.
            Criterion::Simulation { .. } => 0.5,
        };
        let terms =
            if share == 0.0 { hat(border, 1.0).to_vec() } else { [0, 1].map(|s| hat(s, share)).concat() };
        Self {
            finder,
            transition,
            reach: transition.map_or(0.0, |transition| transition.reach(NEGLIGIBLE)),
            terms,
            at_stop: Vec::new(),
            fading: Vec::new(),
            border,
            share,
            after_turn: share,
            sum: Vec::new(),
            borders: grid.len() as u32,
            sums: vec![0.0; grid.len() + columns],
        }
    }

    /// A reversal: notes what will fade.
    pub(super) fn turn(&mut self, m: &Motion) {
        let Some(transition) = self.transition else { return };
        match transition.law {
            TransitionLaw::Held => self.fading.clone_from(&self.terms),
            TransitionLaw::Crossing => {
                // What was the own border is the other one now, unless the first move is along it.
                let turned = self.border != side(m.branch);
                self.border = side(m.branch);
                self.after_turn = if turned { 1.0 - self.share } else { self.share };
                // Beyond the borders' values, what the record began with: it fades once.
                self.fading.clear();
                self.fading.extend(self.terms.iter().filter(|(i, _)| *i >= self.borders));
            }
            TransitionLaw::Offset => {
                self.sum.clone_from(&self.terms);
                self.sum.extend(hat(&self.finder, side(m.branch), m.turn, -1.0));
                merge(&self.sum, &mut self.sums, &mut self.fading);
            }
        }
    }

    /// A move on a border.
    pub(super) fn step(&mut self, m: &Motion, v: f64, narrowing: f64) {
        // Most moves are beyond the transition.
        let passing = self.transition.filter(|_| m.travel <= self.reach);
        let fade = passing.map_or(0.0, |transition| {
            let fade = (-(m.travel / transition.length).powf(transition.shape)).exp();
            if fade > NEGLIGIBLE { fade } else { 0.0 }
        });
        if narrowing == 0.0 && fade == 0.0 {
            self.share = 0.0;
            self.terms.clear();
            self.terms.extend(hat(&self.finder, side(m.branch), v, 1.0));
            return;
        }
        let law = self.transition.map(|transition| transition.law);
        self.share = if law == Some(TransitionLaw::Crossing) { fade * self.after_turn } else { 0.0 };
        let sum = &mut self.sum;
        sum.clear();
        let other = 0.5 * narrowing + self.share * (1.0 - narrowing);
        sum.extend(hat(&self.finder, side(m.branch), v, 1.0 - other));
        if other != 0.0 {
            sum.extend(hat(&self.finder, side(-m.branch), v, other));
        }
        if fade > 0.0 {
            if law == Some(TransitionLaw::Held) {
                sum.iter_mut().for_each(|(_, w)| *w *= 1.0 - fade);
            }
            sum.extend(self.fading.iter().map(|&(i, w)| (i, w * fade)));
        }
        if sum.len() > 2 {
            merge(sum, &mut self.sums, &mut self.terms);
        } else {
            self.terms.clone_from(sum);
        }
    }

    /// The input rests from here on.
    pub(super) fn stop(&mut self) {
        self.at_stop.clone_from(&self.terms);
    }

    /// Goes by a share of the distance from where it stopped to the middle between the borders.
    pub(super) fn relax(&mut self, v: f64, share: f64) {
        let sum = &mut self.sum;
        sum.clear();
        sum.extend(self.at_stop.iter().map(|&(i, w)| (i, w * (1.0 - share))));
        sum.extend([0, 1].iter().flat_map(|&side| hat(&self.finder, side, v, 0.5 * share)));
        merge(sum, &mut self.sums, &mut self.terms);
    }

    /// The mean over both borders where noise on the position decides the branch.
    pub(super) fn jittered(&mut self, ascending: f64, v: f64) {
        self.terms.clear();
        for (side, p) in [(0, 1.0 - ascending), (1, ascending)] {
            self.terms.extend(hat(&self.finder, side, v, p));
        }
    }
}

/// The border values that carry `v`, with their weights times a factor.
fn hat(finder: &Finder<'_>, side: usize, v: f64, factor: f64) -> [(u32, f64); 2] {
    finder.hat(side, v).map(|(i, w)| (i as u32, w * factor))
}

/// Sums repeated indices and drops negligible weights.
fn merge(terms: &[(u32, f64)], sums: &mut [f64], out: &mut Vec<(u32, f64)>) {
    for &(i, w) in terms {
        sums[i as usize] += w;
    }
    out.clear();
    for &(i, _) in terms {
        let w = std::mem::take(&mut sums[i as usize]);
        if w.abs() > NEGLIGIBLE {
            out.push((i, w));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::likelihood::design::Design;
    use crate::model::augmented::{
        AugmentedModel, BorderColumn, Relaxation, Speeds, Transition, TransitionLaw, Widening,
    };
    use crate::records::dataset::ScaledRecord;
    use crate::testing::{small_dataset, small_model};

    /// The oracle: the state `z` of friction between −1 and 1, stepped by `dz = (s − z)·|dv|/length`.
    #[test]
    fn a_crossing_is_the_state_of_friction() {
        let (dataset, grid) = small_dataset();
        let length = 0.09;
        let law = TransitionLaw::Crossing;
        let transition = Some(Transition { length, shape: 1.0, law });
        let augmented = AugmentedModel { transition, ..AugmentedModel::default() };
        let design = Design::new(&dataset, &grid, &augmented, ScaledRecord::is_fit);
        let f = small_model(&grid).f;
        for (scaled, effect_term) in dataset.fit().zip(&design.scaled_records) {
            let u = design.input(effect_term, &f);
            let on = |side: usize, v: f64| grid.hat(side, v).iter().map(|&(i, w)| w * f[i]).sum::<f64>();
            let mut z = if scaled.v[0] >= 0.5 { 1.0 } else { -1.0 };
            let mut expected = u[0];
            for t in 1..scaled.v.len() {
                let step = scaled.v[t] - scaled.v[t - 1];
                if step != 0.0 {
                    z = step.signum() + (z - step.signum()) * (-step.abs() / length).exp();
                    expected = 0.5 * (1.0 + z) * on(1, scaled.v[t]) + 0.5 * (1.0 - z) * on(0, scaled.v[t]);
                }
                assert!((u[t] - expected).abs() < 1e-4, "{t}: {} {expected}", u[t]);
            }
        }
    }

    /// The oracle: the width of the loop times what the speed makes of it.
    #[test]
    fn a_widening_loop_keeps_its_middle() {
        let (dataset, grid) = small_dataset();
        let plain = Design::new(&dataset, &grid, &AugmentedModel::default(), ScaledRecord::is_fit);
        let f = small_model(&grid).f;
        let law = |speeds| Widening { share: 0.7, power: 0.5, scale: 0.02, speeds };
        let rises = |r: f64| 0.7 * (r / 0.02).sqrt();
        let falls = |r: f64| 0.7 * (-(r / 0.02).sqrt()).exp();
        let laws: [(Widening, &dyn Fn(f64) -> f64); 2] =
            [(law(Speeds::High), &rises), (law(Speeds::Low), &falls)];
        for (widening, at) in laws {
            let augmented = AugmentedModel { widening: Some(widening), ..AugmentedModel::default() };
            let wide = Design::new(&dataset, &grid, &augmented, ScaledRecord::is_fit);
            for (number, scaled) in dataset.fit().enumerate() {
                let [plain, wide] =
                    [&plain, &wide].map(|design| design.input(&design.scaled_records[number], &f));
                let on = |side: usize, v: f64| grid.hat(side, v).iter().map(|&(i, w)| w * f[i]).sum::<f64>();
                let mut growth = 0.0;
                for t in 1..scaled.v.len() {
                    let step = scaled.v[t] - scaled.v[t - 1];
                    if step != 0.0 {
                        let half = 0.5 * (on(1, scaled.v[t]) - on(0, scaled.v[t]));
                        growth = step.signum() * half * at(step.abs());
                    }
                    assert!((wide[t] - plain[t] - growth).abs() < 1e-12, "{t}");
                }
            }
        }
    }

    /// The oracle: the distance to the middle between the borders, and how much of it is left.
    #[test]
    fn a_working_point_at_rest_goes_towards_the_middle() {
        let (dataset, grid) = small_dataset();
        let relaxation = Some(Relaxation { share: 0.8, tau: 2.5 });
        let plain = Design::new(&dataset, &grid, &AugmentedModel::default(), ScaledRecord::is_fit);
        let augmented = AugmentedModel { relaxation, ..AugmentedModel::default() };
        let relaxed = Design::new(&dataset, &grid, &augmented, ScaledRecord::is_fit);
        let f = small_model(&grid).f;
        for (number, scaled) in dataset.fit().enumerate() {
            let [plain, relaxed] =
                [&plain, &relaxed].map(|design| design.input(&design.scaled_records[number], &f));
            let on = |side: usize, v: f64| grid.hat(side, v).iter().map(|&(i, w)| w * f[i]).sum::<f64>();
            let mut rest = 0.0;
            for t in 1..scaled.v.len() {
                rest = if scaled.v[t] == scaled.v[t - 1] { rest + 1.0 } else { 0.0 };
                let middle = 0.5 * (on(0, scaled.v[t]) + on(1, scaled.v[t]));
                let left = 1.0 - 0.8 * (1.0 - (-rest / 2.5_f64).exp());
                assert!((relaxed[t] - middle - left * (plain[t] - middle)).abs() < 1e-4, "{t}");
            }
        }
    }

    /// The oracle: the bristle itself.
    #[test]
    fn a_bristle_bends_along_a_travel() {
        let (dataset, grid) = small_dataset();
        let (power, scale, length) = (2.0, 0.03, 0.05);
        let border_columns = vec![BorderColumn::Bristle { power, scale, length }];
        let augmented = AugmentedModel { border_columns, ..AugmentedModel::default() };
        let design = Design::new(&dataset, &grid, &augmented, ScaledRecord::is_fit);
        let mut f = vec![0.0; grid.len()];
        f.push(1.0);
        for (scaled, effect_term) in dataset.fit().zip(&design.scaled_records) {
            let u = design.input(effect_term, &f);
            let mut bristle = 0.0;
            for t in 1..scaled.v.len() {
                let step = scaled.v[t] - scaled.v[t - 1];
                let aim = step.signum() * (-(step / scale).powi(2)).exp();
                let share = (-step.abs() / length).exp();
                if step != 0.0 {
                    bristle = share * bristle + (1.0 - share) * aim;
                }
                assert!((u[t] - bristle).abs() < 1e-12, "{t}");
            }
        }
    }
}
