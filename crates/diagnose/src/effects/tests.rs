//! Cards agree with the catalogue. A name includes its sign: data of the opposite sign are fitted by each law, and get the right name
//! or none.

use super::*;
use crate::Serial;
use crate::attribution::SIGNIFICANT;
use crate::attribution::explain::Hypothesis;
use crate::attribution::search::{Question, finish, screened};
use crate::attribution::starts::Known;
use crate::likelihood::engine::{FitContext, fit};
use crate::model::augmented::{AugmentedModel, BorderColumn, Resting, Speeds, Widening};
use crate::model::linear::Linear;
use crate::simulation::simulate::free_run;
use crate::testing::{noise_free, small_dataset, small_model, white};

#[test]
fn a_file_begins_with_what_its_effect_changes() {
    for (changes, file) in TITLES {
        assert_eq!(file.lines().next(), Some(format!("//! {changes}").as_str()));
    }
}

#[test]
fn refinement_of_the_borders_are_the_effect_that_lies_in_the_grid() {
    let in_the_grid: Vec<Effect> =
        Effect::ALL.into_iter().filter(|effect| effect.card().lies_in_the_grid).collect();
    assert_eq!(in_the_grid, [refinement().0]);
}

#[test]
fn confounded_effects_are_mutual_and_no_effect_is_its_own() {
    for effect in Effect::ALL {
        for confounded in effect.confounded_effects() {
            assert!(
                *confounded != effect && confounded.confounded_effects().contains(&effect),
                "{effect} names {confounded}"
            );
        }
    }
}

/// Standard deviation of the noise in the output.
const NOISE: f64 = 1e-3;

/// Half the distance between the borders of [`loop_of`].
pub(super) const HALF: f64 = 0.25;

/// Bent borders, the ascending one above the descending by twice `half`, and coefficients of columns beside them. Along straight borders
/// friction in proportion to speed would be a linear filter, which `B` takes.
pub(super) fn loop_of(half: f64, columns: &[f64]) -> Linear {
    let (_, grid) = small_dataset();
    let [down, up] = [0, 1].map(|side| {
        let side_of = if side == 0 { -half } else { half };
        grid.knots[side].iter().map(|v| 1.6 * (v - 0.5).abs() + side_of).collect::<Vec<f64>>()
    });
    Linear { f: [&down[..], &up, columns].concat(), ..small_model(&grid) }
}

/// The records of a machine, with a little noise.
pub(super) fn measured(augmented: &AugmentedModel, truth: &Linear) -> Dataset {
    let (dataset, grid) = small_dataset();
    let mut dataset = noise_free(dataset, &grid, augmented, truth);
    let mut noise = white();
    dataset.scaled_records[0].y.iter_mut().for_each(|y| *y += NOISE * noise());
    dataset
}

/// The best fit by the laws of an effect, and the penalised deviance that it gains over the nominal model.
pub(super) fn explained(dataset: &Dataset, effect: Effect) -> Option<(Hypothesis, f64)> {
    let (_, grid) = small_dataset();
    let context = FitContext { dataset, grid: &grid, known: None };
    let start = loop_of(HALF, &[]);
    let nominal = fit(context, &|_| AugmentedModel::default(), &[], &start, 14).expect("a fit");
    let nominal = Hypothesis::nominal(nominal);
    let known = Known::new(dataset, &nominal);
    let screened = screened(&Serial, &known, &[Question::open(effect)]);
    let done = screened.iter().flat_map(|entry| &entry.laws).map(|sketch| finish(dataset, 0, sketch));
    let named = done.map(Hypothesis::named_by_its_signs).filter(Hypothesis::may_be_a_cause);
    let best = named.min_by(|x, y| x.bic().total_cmp(&y.bic()))?;
    let gain = nominal.bic() - best.bic();
    Some((best, gain))
}

/// The name of what the laws of an effect find, where they find anything.
fn named(dataset: &Dataset, by_the_laws_of: Effect) -> Option<Effect> {
    let (best, _) = explained(dataset, by_the_laws_of).filter(|(_, gain)| *gain > SIGNIFICANT)?;
    best.effects().first().copied()
}

fn with(column: BorderColumn) -> AugmentedModel {
    AugmentedModel { border_columns: vec![column], ..AugmentedModel::default() }
}

/// Speeds of the small records, strokes a sample.
const TYPICAL: f64 = 0.05;
const BOTH: [Effect; 2] = [Effect::RateDependence, Effect::Stribeck];

#[test]
fn friction_that_rises_with_speed_is_rate_dependence_by_whichever_law() {
    let viscous = with(BorderColumn::Speed { power: 1.0, scale: TYPICAL, while_resting: Resting::Zero });
    let saturating =
        with(BorderColumn::LowSpeed { power: 1.0, scale: TYPICAL, while_resting: Resting::Held });
    let bends = with(BorderColumn::Bristle { power: 2.0, scale: TYPICAL, length: 0.01 });
    for (augmented, coefficient) in [(viscous, 0.2), (saturating, -0.2), (bends, -0.2)] {
        let dataset = measured(&augmented, &loop_of(HALF, &[coefficient]));
        let names: Vec<Effect> = BOTH.iter().filter_map(|laws| named(&dataset, *laws)).collect();
        assert!(
            !names.is_empty() && names.iter().all(|e| *e == Effect::RateDependence),
            "{augmented:?} {names:?}"
        );
    }
}

#[test]
fn friction_that_falls_with_speed_is_stribeck_by_whichever_law() {
    let gaussian =
        with(BorderColumn::LowSpeed { power: 2.0, scale: 0.5 * TYPICAL, while_resting: Resting::Held });
    let falling = with(BorderColumn::Speed { power: 0.5, scale: TYPICAL, while_resting: Resting::Held });
    for (augmented, coefficient) in [(gaussian, 0.15), (falling, -0.1)] {
        let dataset = measured(&augmented, &loop_of(HALF, &[coefficient]));
        let names: Vec<Effect> = BOTH.iter().filter_map(|laws| named(&dataset, *laws)).collect();
        assert!(!names.is_empty() && names.iter().all(|e| *e == Effect::Stribeck), "{augmented:?} {names:?}");
    }
}

#[test]
fn a_sign_is_that_of_the_loop_not_of_the_axes() {
    // The ascending border below the descending one, and the gain turned over: the same machines.
    let column = BorderColumn::Speed { power: 1.0, scale: TYPICAL, while_resting: Resting::Zero };
    for (turned, wider) in [(-HALF, -0.2), (HALF, 0.2)] {
        for gain in [-1.0, 1.0] {
            let mut truth = loop_of(turned, &[wider]);
            truth.b.iter_mut().for_each(|b| *b *= gain);
            let dataset = measured(&with(column.clone()), &truth);
            assert_eq!(named(&dataset, Effect::Stribeck), Some(Effect::RateDependence), "{turned} {gain}");
        }
    }
}

#[test]
fn a_loop_that_widens_is_named_by_the_speeds_at_which_it_does() {
    for (speeds, share, expected) in [
        (Speeds::High, 0.6, Effect::RateDependence),
        (Speeds::Low, -0.6, Effect::RateDependence),
        (Speeds::Low, 0.8, Effect::Stribeck),
        (Speeds::High, -0.3, Effect::Stribeck),
    ] {
        let widening = Widening { share, power: 1.0, scale: TYPICAL, speeds };
        let augmented = AugmentedModel { widening: Some(widening), ..AugmentedModel::default() };
        let dataset = measured(&augmented, &loop_of(HALF, &[]));
        let names: Vec<Effect> = BOTH.iter().filter_map(|laws| named(&dataset, *laws)).collect();
        assert!(!names.is_empty() && names.iter().all(|e| *e == expected), "{widening:?} {names:?}");
    }
}

/// What responds a sample before its input moves is no delay, however it is fitted.
#[test]
fn a_lead_is_no_delay() {
    let mut dataset = measured(&AugmentedModel::default(), &loop_of(HALF, &[]));
    let y = &mut dataset.scaled_records[0].y;
    y.rotate_left(1);
    let last = y.len() - 1;
    y[last] = y[last - 1];
    assert_eq!(named(&dataset, Effect::InputDelay), None);
    // The same records late are one: the test can show.
    let mut late = measured(&AugmentedModel { delay: 1.0, ..AugmentedModel::default() }, &loop_of(HALF, &[]));
    late.scaled_records[0].from += 1;
    assert_eq!(named(&late, Effect::InputDelay), Some(Effect::InputDelay));
}

/// A sensor that stretches its range is curved; a soft limit compresses, whatever its knee and width.
#[test]
fn a_sensor_that_stretches_saturates_nowhere() {
    let bent = |by: f64| {
        let mut dataset = measured(&AugmentedModel::default(), &loop_of(HALF, &[]));
        let y = &mut dataset.scaled_records[0].y;
        let mean = y.iter().sum::<f64>() / y.len() as f64;
        y.iter_mut().for_each(|y| *y += by * (*y - mean).powi(3));
        dataset
    };
    assert_eq!(named(&bent(0.2), Effect::SensorSaturation), None);
    assert_eq!(named(&bent(0.2), Effect::SensorNonlinearity), Some(Effect::SensorNonlinearity));
    assert_eq!(named(&bent(-0.05), Effect::SensorSaturation), Some(Effect::SensorSaturation));
}

/// An after-effect is creep whether it goes on or goes back, and which it is is reported: `kappa`, or the share of the distance to the middle.
#[test]
fn an_after_effect_that_goes_back_is_creep_and_says_so() {
    for kappa in [0.4, -0.3] {
        let mut augmented = AugmentedModel::default();
        let pole = 0.95;
        augmented.filter(&[1.0 + kappa * (1.0 - pole), -pole], &[1.0, -pole]);
        let dataset = measured(&augmented, &loop_of(HALF, &[]));
        let (best, gain) = explained(&dataset, Effect::Creep).expect("a fit");
        assert!(gain > SIGNIFICANT, "{kappa}: {gain}");
        let reported = best.fit.nonlinear.iter().find(|o| o.name == "kappa").expect("a filter");
        assert!(reported.value * kappa > 0.0, "{kappa}: {:?}", best.fit.nonlinear);
    }
}

/// Where a law holds for one sign only, its bounds say so.
#[test]
fn what_has_one_sign_is_never_searched_on_the_other_side() {
    let dataset = measured(&AugmentedModel::default(), &loop_of(HALF, &[]));
    let (_, grid) = small_dataset();
    let context = FitContext { dataset: &dataset, grid: &grid, known: None };
    let fit = fit(context, &|_| AugmentedModel::default(), &[], &loop_of(HALF, &[]), 10).expect("a fit");
    let scene = Scene { dataset: &dataset, fit: &fit, innovations: &[vec![0.0; 64]] };
    let positive: [(Effect, &[&str]); 6] = [
        (Effect::InputDelay, &["delay"]),
        (Effect::Backlash, &["play"]),
        (Effect::GradualTransition, &["length", "shape"]),
        (Effect::ExtraPole, &["pole"]),
        (Effect::Resonance, &["omega", "zeta"]),
        (Effect::SensorSaturation, &["width"]),
    ];
    for (effect, names) in positive {
        let laws = (effect.card().laws)(&scene);
        let all = laws.iter().flat_map(|law| law.starts.iter().flatten());
        let found: Vec<&NonlinearParameter> = all.filter(|o| names.contains(&o.name)).collect();
        assert!(
            !found.is_empty() && found.iter().all(|o| o.low >= 0.0 && o.value > 0.0),
            "{effect}: {found:?}"
        );
    }
}

/// Records of one machine, each with a little noise and a zero of its own.
fn with_zeros(zeros: &[f64]) -> Dataset {
    let (dataset, grid) = small_dataset();
    let mut dataset = noise_free(dataset, &grid, &AugmentedModel::default(), &loop_of(HALF, &[]));
    let clean = dataset.scaled_records.remove(0);
    let mut noise = white();
    dataset.scaled_records.extend(zeros.iter().map(|zero| {
        let mut scaled = clean.clone();
        scaled.y.iter_mut().for_each(|y| *y += zero + NOISE * noise());
        scaled
    }));
    dataset
}

#[test]
fn zeros_of_the_records_are_found_and_reported() {
    let dataset = with_zeros(&[0.3, -0.1, 0.1]);
    let (best, gain) = explained(&dataset, Effect::RecordOffset).expect("a fit");
    assert!(gain > SIGNIFICANT, "{gain}");
    let reading = Reading { dataset: &dataset, fit: &best.fit, searched: &[] };
    let reported = (Effect::RecordOffset.card().reported_first)(&reading);
    let reported: Vec<(&str, f64)> = reported.iter().map(|p| (p.name, p.value / dataset.y_scale)).collect();
    let [("largest_difference", largest), ("sd_between_records", sd)] = reported[..] else {
        panic!("{reported:?}")
    };
    assert!((largest - 0.4).abs() < 0.01 && (sd - 0.2).abs() < 0.01, "{reported:?}");
}

#[test]
fn a_zero_of_the_only_record_is_a_level_of_the_borders() {
    assert!(explained(&with_zeros(&[0.3]), Effect::RecordOffset).is_none());
}

#[test]
fn a_record_that_was_not_fitted_has_the_zero_that_it_begins_with() {
    let mut dataset = with_zeros(&[0.3, -0.1, 0.2]);
    dataset.scaled_records[2].usage = switchback_model::rig::Usage::Holdout;
    let (best, _) = explained(&dataset, Effect::RecordOffset).expect("a fit");
    let scaled = &dataset.scaled_records[2];
    let run = free_run(&dataset, &best.fit, 2, scaled);
    let missed = scaled.y.iter().zip(&run).skip(scaled.from).map(|(y, run)| (y - run).abs());
    let most = missed.fold(0.0, f64::max);
    assert!(most < 0.02, "{most}");
}
