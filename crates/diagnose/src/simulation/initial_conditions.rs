//! What every record has of its own: the state of something slow when it begins, which dies away; the phase of a wave; the path of
//! a zero that is free from record to record.
//!
//! Fitted records have coefficients of their own. In held-out records they are unknown: they say nothing about the model.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::least_squares::normal::Normal;
use crate::likelihood::design::{Design, DesignScaled};
use crate::likelihood::engine::Fit;
use crate::model::augmented::{AugmentedModel, EquationColumn};
use crate::model::linear::Linear;
use crate::records::dataset::{Dataset, ScaledRecord};

/// Share of a record that is its beginning, and what is left there of something that has died away.
const INITIAL_CONDITION: f64 = 0.25;
const ANALYSED: f64 = 0.05;
/// Squared standard errors a coefficient from which a beginning shows.
const SHOWS: f64 = 25.0;

/// The augmented model and, where something dies away at the beginning of every fitted record, the same in the held-out ones; the numbers
/// of the columns added.
pub(crate) fn with_initial_conditions(
    dataset: &Dataset,
    augmented: &AugmentedModel,
) -> (AugmentedModel, Range<usize>) {
    let mut out = augmented.clone();
    let known = &augmented.equation_columns;
    let Some(scaled) = dataset.scaled_records.iter().position(ScaledRecord::is_fit) else {
        return (out, 0..0);
    };
    for (number, held_out) in dataset.scaled_records.iter().enumerate().filter(|(_, t)| !t.is_fit()) {
        // What dies away more slowly is a drift of its record, which the model ought to know.
        let dies = |radius: f64| radius.powf(INITIAL_CONDITION * held_out.v.len() as f64) < ANALYSED;
        for column in known {
            if let EquationColumn::Decay { scaled: only, radius, frequency, sine } = *column
                && only == scaled
                && dies(radius)
            {
                let start = EquationColumn::Decay { scaled: number, radius, frequency, sine };
                out.equation_columns.push(start);
            }
        }
    }
    let added = known.len()..out.equation_columns.len();
    (out, added)
}

/// The augmented model with waves, drift paths and zeros that are free from record to record in the held-out records, too; the numbers of the
/// columns added. A drift path has pieces as long as in the first record fitted.
pub(crate) fn with_drift_paths(
    dataset: &Dataset,
    augmented: &AugmentedModel,
) -> (AugmentedModel, Range<usize>) {
    let mut out = augmented.clone();
    let known = &augmented.equation_columns;
    let Some(first) = dataset.scaled_records.iter().position(ScaledRecord::is_fit) else {
        return (out, 0..0);
    };
    for (number, held_out) in dataset.scaled_records.iter().enumerate().filter(|(_, t)| !t.is_fit()) {
        let waves = known.iter().filter_map(|column| match *column {
            EquationColumn::Line { frequency, scaled: Some(scaled), sine } if scaled == first => {
                Some(EquationColumn::Line { frequency, scaled: Some(number), sine })
            }
            _ => None,
        });
        out.equation_columns.extend(waves);
        let pieces_of = |column: &EquationColumn| match *column {
            EquationColumn::Local { pieces, scaled, .. } => {
                let samples = dataset.scaled_records[scaled].v.len() / pieces.max(1);
                Some((held_out.v.len() / samples.max(1)).max(1))
            }
            _ => None,
        };
        if let Some(pieces) = known.iter().find_map(pieces_of) {
            let drift_path =
                (0..=pieces).map(|piece| EquationColumn::Local { scaled: number, piece, pieces });
            out.equation_columns.extend(drift_path);
        }
        if known.iter().any(is_offset) {
            out.equation_columns.push(EquationColumn::Offset { scaled: number, against: None });
        }
    }
    let added = known.len()..out.equation_columns.len();
    (out, added)
}

/// Whether a column is part of a drift path of its record.
fn is_drift_path(column: &EquationColumn) -> bool {
    matches!(column, EquationColumn::Local { .. })
}

/// Whether a column is the zero of a record.
fn is_offset(column: &EquationColumn) -> bool {
    matches!(column, EquationColumn::Offset { .. })
}

/// The augmented model with a level of a record that was not fitted, where fitted ones have drift paths or zeros of their own; the numbers of the
/// columns added.
pub(crate) fn with_level(augmented: &AugmentedModel, number: usize) -> (AugmentedModel, Range<usize>) {
    let mut out = augmented.clone();
    let known = augmented.equation_columns.len();
    let differs = |is_level: fn(&EquationColumn) -> bool| {
        let mut levels = augmented.equation_columns.iter().filter(|c| is_level(c)).peekable();
        levels.peek().is_some() && levels.all(|c| !c.acts_on(number))
    };
    if differs(is_drift_path) || differs(is_offset) {
        let level = [0, 1].map(|piece| EquationColumn::Local { scaled: number, piece, pieces: 1 });
        out.equation_columns.extend(level);
    }
    let added = known..out.equation_columns.len();
    (out, added)
}

/// What the drift paths or the zeros of the fitted records report the level of another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Level {
    /// The mean of all drift paths: what is to be expected where nothing of a record is known.
    mean: f64,
    /// Variance of the first value of a drift path about it.
    spread: f64,
    /// Regression of a drift path's mean on its first value, both about the mean of all: 0 where what a record begins with shows nothing
    /// of the rest, 1 where it keeps its level.
    persistence: f64,
}

impl Level {
    /// That of the fitted records; nothing without drift paths or zeros of their own. A zero is a drift path of one value; zeros reported
    /// against a model that stays lie about its own, which is 0.
    pub(crate) fn of(augmented: &AugmentedModel, coefficients: &[f64]) -> Option<Self> {
        let mut paths: Vec<(usize, Vec<f64>)> = Vec::new();
        for (column, d) in augmented.equation_columns.iter().zip(coefficients) {
            let EquationColumn::Local { scaled, .. } = *column else { continue };
            match paths.last_mut() {
                Some((last, values)) if *last == scaled => values.push(*d),
                _ => paths.push((scaled, vec![*d])),
            }
        }
        if paths.is_empty() {
            paths =
                offsets(augmented, coefficients).into_iter().map(|(scaled, d)| (scaled, vec![d])).collect();
        }
        let count: usize = paths.iter().map(|(_, values)| values.len()).sum();
        let is_known = |c: &EquationColumn| matches!(c, EquationColumn::Offset { against: None, .. });
        let mean = match augmented.equation_columns.iter().any(is_known) {
            true => 0.0,
            false => paths.iter().flat_map(|(_, values)| values).sum::<f64>() / count as f64,
        };
        let about: Vec<[f64; 2]> = paths
            .iter()
            .map(|(_, values)| [values[0] - mean, values.iter().sum::<f64>() / values.len() as f64 - mean])
            .collect();
        let sum = |of: fn(&[f64; 2]) -> f64| about.iter().map(of).sum::<f64>();
        let energy = sum(|[first, _]| first * first);
        let persistence = if energy > 0.0 { sum(|[first, all]| first * all) / energy } else { 0.0 };
        (count > 0).then(|| Self {
            mean,
            spread: energy / about.len() as f64,
            persistence: persistence.clamp(0.0, 1.0),
        })
    }

    /// The level that is to be expected where nothing of a record is known.
    pub(crate) fn expected(self) -> f64 {
        self.mean
    }

    /// The best linear prediction of a record's level from `n` equation errors about the mean level, whose variance is given: what they
    /// average is the first value and noise.
    fn given(self, errors: &[f64], variance: f64) -> f64 {
        let n = errors.len().max(1) as f64;
        let known = self.spread / (self.spread + variance / n).max(f64::MIN_POSITIVE);
        self.mean + self.persistence * known * errors.iter().sum::<f64>() / n
    }
}

/// The zero of each record that has one of its own, as it enters the equation: `A(1)` times that of the output.
pub(crate) fn offsets(augmented: &AugmentedModel, coefficients: &[f64]) -> BTreeMap<usize, f64> {
    let mut zeros = BTreeMap::new();
    for (column, d) in augmented.equation_columns.iter().zip(coefficients) {
        let EquationColumn::Offset { scaled, against } = *column else { continue };
        *zeros.entry(scaled).or_default() += d;
        if let Some(against) = against {
            *zeros.entry(against).or_default() -= d;
        }
    }
    zeros
}

/// Sets the level of a record that was not fitted: what is to be expected of it, corrected by the equation errors before the first
/// counted sample, of the given variance, where there are any.
pub(crate) fn set_level(
    p: &mut Linear,
    level: Level,
    columns: Range<usize>,
    measured: Option<(&Design, &DesignScaled, f64)>,
) {
    p.d[columns.clone()].fill(level.mean);
    if let Some((design, scaled, variance)) = measured {
        let first = p.a.len().max(p.b.len() + design.taps.len());
        let errors = design.errors_from(scaled, p, first);
        let known = &errors[..scaled.from.saturating_sub(first).min(errors.len())];
        p.d[columns].fill(level.given(known, variance));
    }
}

/// Sets the coefficients of added columns by the equation errors before the first counted sample, the only ones a simulation may look
/// at, where these show a beginning above noise of the given variance.
pub(crate) fn set_by_first_samples(
    p: &mut Linear,
    design: &Design,
    scaled: &DesignScaled,
    (added, variance): (Range<usize>, f64),
) {
    let here: Vec<usize> =
        (0..scaled.columns.numbers.len()).filter(|&k| added.contains(&scaled.columns.numbers[k])).collect();
    if here.is_empty() {
        return;
    }
    let first = p.a.len().max(p.b.len() + design.taps.len());
    let errors = design.errors_from(scaled, p, first);
    let mut normal = Normal::new(here.len());
    let mut row = vec![0.0; here.len()];
    for (t, e) in (first..scaled.from).zip(errors) {
        let psi = scaled.columns.row(t);
        row.iter_mut().zip(&here).for_each(|(x, &k)| *x = psi[k]);
        normal.add(&row, e);
    }
    let Some(factor) = normal.factor(1e-9) else { return };
    let found = factor.solve(&normal.gradient);
    let gain: f64 = found.iter().zip(&normal.gradient).map(|(d, g)| d * g).sum();
    if gain > SHOWS * here.len() as f64 * variance {
        for (&k, d) in here.iter().zip(found) {
            p.d[scaled.columns.numbers[k]] = d;
        }
    }
}

/// Times the greatest input that a filter may hold, and standard errors beyond it, from which a beginning is none of the filter. A
/// simulation begins at rest at one border, the record anywhere between them: twice. As much again for what is in series.
const MOST_FIXED: f64 = 4.0;
const CERTAIN: f64 = 10.0;

/// Whether the transients with a given pole at the initial conditions of the records may be the initial states of a filter: no larger than a past input between
/// the borders can have left.
///
/// ```text
/// ũ = … + κ·(1−p)/(1−p q⁻¹) u,   A y = B ũ + d·pᵗ   ⟹   |d| ≤ |B(1/p)·κ|·2·max|u|
/// ```
///
/// `share` is `κ`. Compared at the first counted sample: nothing is known of what has died away before.
pub(crate) fn begins_as_a_filter(fit: &Fit, pole: f64, share: f64) -> bool {
    let greatest = fit.linear.f[..fit.grid.len()].iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let fixed = MOST_FIXED * greatest * (share * value(&fit.linear.b, 1.0 / pole)).abs();
    let of_this = |column: &EquationColumn| match *column {
        EquationColumn::Decay { radius, frequency: 0.0, sine: false, .. } => radius == pole,
        _ => false,
    };
    fit.design().scaled_records.iter().all(|scaled| {
        let counted = (scaled.x.len() - scaled.from) as f64;
        let energy = (1.0 - pole.powf(2.0 * counted)) / (1.0 - pole * pole);
        let remains = pole.powi(scaled.from as i32);
        let most = fixed * remains + CERTAIN * (fit.variance / energy).sqrt();
        let columns = scaled.columns.numbers.iter();
        columns
            .filter(|&&j| of_this(&fit.augmented.equation_columns[j]))
            .all(|&j| fit.linear.d[j].abs() * remains <= most)
    })
}

/// A polynomial by increasing powers.
fn value(coefficients: &[f64], z: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * z + c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::engine::{FitContext, fit};
    use crate::testing::{noise_free, small_dataset, small_model};

    /// The oracle: the coefficient that the record was made with.
    #[test]
    fn a_initial_condition_is_set_where_it_shows_above_the_noise() {
        let (dataset, grid) = small_dataset();
        let radius = 0.9;
        let column = EquationColumn::Decay { scaled: 0, radius, frequency: 0.0, sine: false };
        let augmented = AugmentedModel { equation_columns: vec![column], ..AugmentedModel::default() };
        let truth = Linear { d: vec![0.7], ..small_model(&grid) };
        let dataset = noise_free(dataset, &grid, &augmented, &truth);
        let design = Design::new(&dataset, &grid, &augmented, ScaledRecord::is_fit);
        let found = |variance: f64| {
            let mut p = Linear { d: vec![0.0], ..truth.clone() };
            set_by_first_samples(&mut p, &design, &design.scaled_records[0], (0..1, variance));
            p.d[0]
        };
        assert!((found(1e-6) - 0.7).abs() < 1e-6, "{}", found(1e-6));
        assert_eq!(found(1.0), 0.0);
    }

    #[test]
    fn a_filter_begins_with_what_a_past_input_left() {
        let pole = 0.94;
        let column = EquationColumn::Decay { scaled: 0, radius: pole, frequency: 0.0, sine: false };
        let mut augmented = AugmentedModel { equation_columns: vec![column], ..AugmentedModel::default() };
        augmented.filter(&[1.0 - pole], &[1.0, -pole]);
        let sound = |d: f64, share: f64| {
            let (dataset, grid) = small_dataset();
            let truth = Linear { d: vec![d], ..small_model(&grid) };
            let dataset = noise_free(dataset, &grid, &augmented, &truth);
            let context = FitContext { dataset: &dataset, grid: &grid, known: None };
            let fit = fit(context, &|_| augmented.clone(), &[], &truth, 1).expect("a fit");
            begins_as_a_filter(&fit, pole, share)
        };
        // Inputs up to one, a gain of one.
        assert!(sound(2.0, 1.0) && sound(-2.0, -1.0));
        assert!(!sound(20.0, 1.0) && !sound(-2.0, 0.1));
    }

    #[test]
    fn held_out_records_begin_with_what_dies_soon() {
        let (mut dataset, _) = small_dataset();
        let mut held_out = dataset.scaled_records[0].clone();
        held_out.usage = switchback_model::rig::Usage::Holdout;
        dataset.scaled_records.push(held_out);
        let decay = |radius| EquationColumn::Decay { scaled: 0, radius, frequency: 0.0, sine: false };
        let augmented =
            AugmentedModel { equation_columns: vec![decay(0.5), decay(0.999)], ..AugmentedModel::default() };
        let (with, added) = with_initial_conditions(&dataset, &augmented);
        assert_eq!(added, 2..3);
        assert!(matches!(with.equation_columns[2], EquationColumn::Decay { scaled: 1, radius: 0.5, .. }));
    }

    #[test]
    fn held_out_records_have_waves_and_courses_of_their_own() {
        let (mut dataset, _) = small_dataset();
        let mut held_out = dataset.scaled_records[0].clone();
        held_out.usage = switchback_model::rig::Usage::Holdout;
        let half = held_out.v.len() / 2;
        held_out.v = held_out.v[..half].to_vec().into();
        dataset.scaled_records.push(held_out);
        let line = |scaled, sine| EquationColumn::Line { frequency: 0.3, scaled, sine };
        let local = |scaled, piece, pieces| EquationColumn::Local { scaled, piece, pieces };
        let waves = [line(Some(0), false), line(Some(0), true), line(None, true)];
        let drift_path = (0..=4).map(|piece| local(0, piece, 4));
        let augmented = AugmentedModel {
            equation_columns: waves.into_iter().chain(drift_path).collect(),
            ..AugmentedModel::default()
        };
        let (with, added) = with_drift_paths(&dataset, &augmented);
        // Half as long: half as many pieces. A wave of the dataset goes on.
        let expected =
            [line(Some(1), false), line(Some(1), true), local(1, 0, 2), local(1, 1, 2), local(1, 2, 2)];
        assert_eq!(with.equation_columns[added], expected);
        let (with, level) = with_level(&augmented, 1);
        assert_eq!(with.equation_columns[level], [local(1, 0, 1), local(1, 1, 1)]);
        assert!(
            with_level(&augmented, 0).1.is_empty() && with_level(&AugmentedModel::default(), 1).1.is_empty()
        );
        assert_eq!(Level::of(&AugmentedModel::default(), &[]), None);
    }

    /// The oracle: Gaussian conditioning worked out by hand.
    #[test]
    fn the_level_of_a_record_is_predicted_from_what_it_begins_with() {
        let local = |scaled, piece| EquationColumn::Local { scaled, piece, pieces: 1 };
        let columns = [local(0, 0), local(0, 1), local(1, 0), local(1, 1)];
        let augmented = AugmentedModel { equation_columns: columns.into(), ..AugmentedModel::default() };
        // Two records that keep half of what they begin with on the mean.
        let level = Level::of(&augmented, &[3.0, 1.0, -1.0, 1.0]).expect("drift paths");
        assert_eq!(level, Level { mean: 1.0, spread: 4.0, persistence: 0.5 });
        // Four errors of variance 16 average to the first value with variance 4: half of it is noise.
        let given = level.given(&[2.0, 6.0, 4.0, 4.0], 16.0);
        assert!((given - (1.0 + 0.5 * 0.5 * 4.0)).abs() < 1e-12, "{given}");
        assert_eq!(level.given(&[], 16.0), 1.0);
        // Zeros that sum to nothing: 3, −1 and −2. All of a record has the zero that it begins with.
        let columns = [1, 2].map(|scaled| EquationColumn::Offset { scaled, against: Some(0) });
        let zeros = AugmentedModel { equation_columns: columns.into(), ..AugmentedModel::default() };
        let level = Level::of(&zeros, &[-1.0, -2.0]).expect("zeros");
        assert_eq!(level, Level { mean: 0.0, spread: 14.0 / 3.0, persistence: 1.0 });
        for number in 0..3 {
            assert!(with_level(&zeros, number).1.is_empty());
        }
        assert_eq!(with_level(&zeros, 3).1.len(), 2);
        // One record shows nothing of how records differ.
        let one =
            AugmentedModel { equation_columns: vec![local(0, 0), local(0, 1)], ..AugmentedModel::default() };
        let alone = Level::of(&one, &[3.0, 1.0]).expect("a drift path");
        assert_eq!((alone.mean, alone.persistence), (2.0, 0.0));
    }
}
