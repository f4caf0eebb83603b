//! The descendant (3.1) and ascendant (4.1) experiments.

use super::levels::check_levels;
use super::{Direction, ExcitationError};
use switchback_model::hysteresis::Interval;

/// A periodic pulse experiment that masks the memory of the hysteresis: the descendant (3.1) or ascendant (4.1) one.
///
/// The input sits at the satellite (`h_M` descendant, `h_m` ascendant) and visits each level for one sample:
///
/// ```text
/// phase of V₁           τ₁ = 2s
/// phase of V_j, j ≥ 2   τ_j = (2 + j)s
/// period                T = s(m + 3)
///
/// descendant   h_m = V₁ < V₂ < … < V_m < h_M
/// ascendant    h_M = V₁ > V₂ > … > V_m > h_m
/// ```
///
/// Every visit is a move away from the satellite and back, so `u` takes only `C_d(V_j)` and `u_M` in the descendant
/// experiment, and only `C_a(V_j)` and `u_m` in the ascendant one: the hysteresis acts as a static table.
///
/// Levels are in input units; phases, spacing `s` and period in samples; indices `j` of methods count from 0.
///
/// The paper sets `s = n`. With `n = 1` that puts `V₂, V₃, …` on adjacent samples and `u` on the wrong border between
/// them, so the spacing here is at least `max(n, 2)`.
///
/// ```
/// use switchback_identify::excitation::{Direction, PulseExperiment};
/// use switchback_model::hysteresis::Interval;
/// let experiment = PulseExperiment::evenly_spaced(Interval::new(-1.0, 1.0)?, Direction::Descendant, 2, 1)?;
/// assert_eq!(experiment.levels(), [-1.0, 0.0]);
/// assert_eq!((experiment.spacing(), experiment.period()), (2, 10));
/// // Loading sample, then one period: V₁ at phase 4, V₂ at phase 8.
/// assert_eq!(experiment.record_input(10), [-1.0, 1.0, 1.0, 1.0, 1.0, -1.0, 1.0, 1.0, 1.0, 0.0, 1.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PulseExperiment {
    interval: Interval,
    direction: Direction,
    levels: Vec<f64>,
    order: usize,
    spacing: usize,
}

impl PulseExperiment {
    /// Visits `points` levels evenly spaced from the end opposite the satellite, one step short of it.
    ///
    /// ```text
    /// V_j = h_m + (j − 1)(h_M − h_m)/m   (descendant),   V_j = h_M − (j − 1)(h_M − h_m)/m   (ascendant)
    /// ```
    ///
    /// `order` is the order `n` of the linear part; the spacing is `max(n, 2)`.
    ///
    /// # Errors
    /// [`ExcitationError`] if `points` or `order` is zero, or the levels are too many to be distinguished in an `f64`.
    pub fn evenly_spaced(
        interval: Interval,
        direction: Direction,
        points: usize,
        order: usize,
    ) -> Result<Self, ExcitationError> {
        let (start, satellite) = (direction.opposite(interval), direction.satellite(interval));
        // Weighting the ends rounds decimal levels to themselves (−0.2, not −0.19999999999999996), as rig files have
        // them; at the first level it could miss the end.
        let level = |j| match j {
            0 => start,
            _ => (start * (points - j) as f64 + satellite * j as f64) / points as f64,
        };
        Self::with_levels(interval, direction, (0..points).map(level).collect(), order)
    }

    /// Visits the given levels, from the end opposite the satellite towards it; the spacing is `max(order, 2)`.
    ///
    /// # Errors
    /// [`ExcitationError`] if there is no level, `order` is zero, a level lies outside the interval or at the
    /// satellite, the first is not the end opposite the satellite, or they are not strictly ordered.
    pub fn with_levels(
        interval: Interval,
        direction: Direction,
        levels: Vec<f64>,
        order: usize,
    ) -> Result<Self, ExcitationError> {
        if order == 0 {
            return Err(ExcitationError::ZeroOrder);
        }
        check_levels(interval, direction, &levels)?;
        Ok(Self { interval, direction, levels, order, spacing: least_spacing(order) })
    }

    /// The same experiment with any spacing, for studies that break the memory masking on purpose: below 2 the input goes from one level to
    /// the next without the satellite between, and below the order the lagged pulses of neighbouring visits overlap.
    ///
    /// # Errors
    /// [`ExcitationError::ZeroSpacing`].
    pub fn with_spacing_unmasked(self, spacing: usize) -> Result<Self, ExcitationError> {
        if spacing == 0 {
            return Err(ExcitationError::ZeroSpacing);
        }
        Ok(Self { spacing, ..self })
    }

    /// The working interval.
    pub(crate) fn interval(&self) -> Interval {
        self.interval
    }

    /// Descendant or ascendant.
    pub fn direction(&self) -> Direction {
        self.direction
    }

    /// Where the input sits between visits.
    pub fn satellite(&self) -> f64 {
        self.direction.satellite(self.interval)
    }

    /// `V₁…V_m`, in the order of their visits.
    pub fn levels(&self) -> &[f64] {
        &self.levels
    }

    /// `m`, the number of levels; at least one.
    pub fn points(&self) -> usize {
        self.levels.len()
    }

    /// The order `n` of the linear part that the experiment was designed for.
    pub fn order(&self) -> usize {
        self.order
    }

    /// `s`, samples between visits.
    pub fn spacing(&self) -> usize {
        self.spacing
    }

    /// `T = s(m + 3)`, samples.
    pub fn period(&self) -> usize {
        self.spacing * (self.points() + 3)
    }

    /// The phase, in `0..T`, at which `levels()[j]` is visited.
    ///
    /// # Panics
    /// If `j` is not below [`points`](Self::points).
    pub fn visit_phase(&self, j: usize) -> usize {
        assert!(j < self.points(), "level {j} of an experiment with {} levels", self.points());
        if j == 0 { 2 * self.spacing } else { (3 + j) * self.spacing }
    }

    /// The input at a phase; phases beyond the period wrap around.
    pub(crate) fn v_at_phase(&self, phase: usize) -> f64 {
        let phase = phase % self.period();
        if !phase.is_multiple_of(self.spacing) {
            return self.satellite();
        }
        match phase / self.spacing {
            2 => self.levels[0],
            slot if slot >= 4 => self.levels[slot - 3],
            _ => self.satellite(),
        }
    }

    /// The input of a whole record: the loading sample at the end opposite the satellite, then `samples` samples
    /// from phase 0 on.
    pub fn record_input(&self, samples: usize) -> Vec<f64> {
        let loading = self.direction.opposite(self.interval);
        std::iter::once(loading).chain((0..samples).map(|phase| self.v_at_phase(phase))).collect()
    }
}

/// The least spacing that masks the memory (2) and keeps the lagged pulses of neighbouring visits apart (`n`).
fn least_spacing(order: usize) -> usize {
    order.max(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Direction::{Ascendant, Descendant};

    fn interval() -> Interval {
        Interval::new(-1.0, 1.0).unwrap()
    }

    #[test]
    fn one_level_makes_a_period_of_four_spacings() {
        let experiment = PulseExperiment::evenly_spaced(interval(), Descendant, 1, 3).unwrap();
        assert_eq!((experiment.spacing(), experiment.period(), experiment.visit_phase(0)), (3, 12, 6));
    }

    #[test]
    fn the_ascendant_experiment_is_the_mirror_image() {
        let experiment = |direction| PulseExperiment::evenly_spaced(interval(), direction, 5, 2).unwrap();
        let mirrored: Vec<f64> = experiment(Descendant).record_input(40).iter().map(|v| -v).collect();
        assert_eq!(experiment(Ascendant).record_input(40), mirrored);
    }

    #[test]
    fn eight_levels_of_a_second_order_rig_give_the_known_input() {
        let experiment = PulseExperiment::evenly_spaced(interval(), Descendant, 8, 2).unwrap();
        let expected = [
            -1.0, 1.0, 1.0, 1.0, 1.0, -1.0, 1.0, 1.0, 1.0, -0.75, 1.0, -0.5, 1.0, -0.25, 1.0, 0.0, 1.0, 0.25,
            1.0, 0.5, 1.0, 0.75, 1.0, 1.0, 1.0, 1.0, 1.0, -1.0, 1.0,
        ];
        assert_eq!(experiment.record_input(28), expected);
    }

    #[test]
    fn an_experiment_without_levels_or_order_is_refused() {
        let build = |points, order| PulseExperiment::evenly_spaced(interval(), Descendant, points, order);
        assert_eq!(build(0, 2).unwrap_err(), ExcitationError::NoLevels);
        assert_eq!(build(4, 0).unwrap_err(), ExcitationError::ZeroOrder);
    }

    #[test]
    fn decimal_levels_come_out_as_written() {
        let levels = |direction| {
            PulseExperiment::evenly_spaced(interval(), direction, 5, 1).unwrap().levels().to_vec()
        };
        assert_eq!(levels(Descendant), [-1.0, -0.6, -0.2, 0.2, 0.6]);
        assert_eq!(levels(Ascendant), [1.0, 0.6, 0.2, -0.2, -0.6]);
    }

    #[test]
    fn more_levels_than_an_interval_can_distinguish_are_refused() {
        let narrow = Interval::new(1.0, 1.0 + 4.0 * f64::EPSILON).unwrap();
        let error = PulseExperiment::evenly_spaced(narrow, Descendant, 64, 1).unwrap_err();
        assert!(matches!(error, ExcitationError::NotOrdered { .. } | ExcitationError::AtSatellite { .. }));
    }

    #[test]
    fn a_study_may_break_the_masking_on_purpose_but_not_the_period() {
        let experiment = PulseExperiment::evenly_spaced(interval(), Descendant, 3, 1).unwrap();
        assert_eq!(experiment.clone().with_spacing_unmasked(1).unwrap().spacing(), 1);
        assert_eq!(experiment.with_spacing_unmasked(0), Err(ExcitationError::ZeroSpacing));
    }
}
