use super::*;
use crate::Serial;
use crate::effect::Effect;
use crate::testing::{noise_free, small_dataset, small_model, white};

/// Least squares draws `A` towards zero; what is solved for in turn with the filter that follows from it does not stay there.
#[test]
fn behind_output_noise_the_dynamics_are_found_from_biased_ones() {
    let (dataset, grid) = small_dataset();
    let truth = Linear { a: vec![-1.5, 0.6], ..small_model(&grid) };
    let mut dataset = noise_free(dataset, &grid, &AugmentedModel::default(), &truth);
    let mut noise = white();
    dataset.scaled_records[0].y.iter_mut().for_each(|y| *y += 0.2 * noise());
    let off = |p: &Linear| p.a.iter().zip(&truth.a).map(|(a, b)| (a - b).abs()).sum::<f64>();
    let context = FitContext { dataset: &dataset, grid: &grid, known: None };
    let nominal = Task { context, build: &|_| AugmentedModel::default(), fixed: 0 };
    let biased = nominal.together(&[], &truth, FINAL).expect("a fit").linear;
    assert!(off(&biased) > 0.2, "{:?}", biased.a);
    let build = |_: &[f64]| {
        let mut augmented = AugmentedModel::default();
        augmented.noise.output_ratio = 1e3;
        augmented
    };
    let task = Task { context, build: &build, fixed: 0 };
    let found = task.dynamics_refitted(&[], &biased).expect("solved");
    assert!(off(&found) < 0.3 * off(&biased), "{:?} {:?}", biased.a, found.a);
    // It has settled: another time moves nothing.
    let again = task.dynamics_refitted(&[], &found).expect("solved");
    let moved: f64 = again.a.iter().zip(&found.a).map(|(x, y)| (x - y).abs()).sum();
    assert!(moved < 1e-5, "{:?} {:?}", found.a, again.a);
}

/// A branch taken a sample too late costs more than a derivative at a start far off can show.
#[test]
fn positions_that_act_a_little_late_are_found() {
    let (dataset, grid) = small_dataset();
    for late in [0.037, 0.3] {
        let augmented = AugmentedModel { late, ..AugmentedModel::default() };
        let mut dataset = noise_free(dataset.clone(), &grid, &augmented, &small_model(&grid));
        let mut noise = white();
        dataset.scaled_records[0].y.iter_mut().for_each(|y| *y += 1e-3 * noise());
        let context = FitContext { dataset: &dataset, grid: &grid, known: None };
        let nominal =
            fit(context, &|_| AugmentedModel::default(), &[], &small_model(&grid), FINAL).expect("a fit");
        let known = Hypothesis::nominal(nominal);
        let base = Known::new(&dataset, &known);
        let screened = screened(&Serial, &base, &[Question::open(Effect::InputDelay)]);
        let done = screened.iter().flat_map(|entry| &entry.laws).map(|sketch| finish(&dataset, 0, sketch));
        let best = done.min_by(|x, y| x.bic().total_cmp(&y.bic())).expect("a law");
        assert!((best.fit.nonlinear[0].value - late).abs() < 2e-3, "{late}: {:?}", best.fit.nonlinear);
    }
}
