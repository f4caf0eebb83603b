use super::*;
use crate::Serial;
use crate::effect::Effect;
use crate::testing::{noise_free, small_campaign, small_model, white};

/// Least squares draws `A` towards zero; what is solved for in turn with the filter that follows from it does not stay there.
#[test]
fn behind_output_noise_the_dynamics_are_found_from_biased_ones() {
    let (campaign, grid) = small_campaign();
    let truth = Linear { a: vec![-1.5, 0.6], ..small_model(&grid) };
    let mut campaign = noise_free(campaign, &grid, &Assembly::default(), &truth);
    let mut noise = white();
    campaign.tracks[0].y.iter_mut().for_each(|y| *y += 0.2 * noise());
    let off = |p: &Linear| p.a.iter().zip(&truth.a).map(|(a, b)| (a - b).abs()).sum::<f64>();
    let ground = Ground { campaign: &campaign, grid: &grid, known: None };
    let nominal = Task { ground, build: &|_| Assembly::default(), held: 0 };
    let biased = nominal.together(&[], &truth, FINAL).expect("a fit").linear;
    assert!(off(&biased) > 0.2, "{:?}", biased.a);
    let build = |_: &[f64]| {
        let mut assembly = Assembly::default();
        assembly.noise.output_ratio = 1e3;
        assembly
    };
    let task = Task { ground, build: &build, held: 0 };
    let found = task.dynamics_refitted(&[], &biased).expect("solved");
    assert!(off(&found) < 0.3 * off(&biased), "{:?} {:?}", biased.a, found.a);
    // It has settled: another time moves nothing.
    let again = task.dynamics_refitted(&[], &found).expect("solved");
    let moved: f64 = again.a.iter().zip(&found.a).map(|(x, y)| (x - y).abs()).sum();
    assert!(moved < 1e-5, "{:?} {:?}", found.a, again.a);
}

/// A branch taken a sample too late costs more than a derivative at a start far off can tell.
#[test]
fn positions_that_act_a_little_late_are_found() {
    let (campaign, grid) = small_campaign();
    for late in [0.037, 0.3] {
        let assembly = Assembly { late, ..Assembly::default() };
        let mut campaign = noise_free(campaign.clone(), &grid, &assembly, &small_model(&grid));
        let mut noise = white();
        campaign.tracks[0].y.iter_mut().for_each(|y| *y += 1e-3 * noise());
        let ground = Ground { campaign: &campaign, grid: &grid, known: None };
        let nominal = fit(ground, &|_| Assembly::default(), &[], &small_model(&grid), FINAL).expect("a fit");
        let known = Explanation::nominal(nominal);
        let base = Known::new(&campaign, &known);
        let screened = screened(&Serial, &base, &[Question::open(Effect::InputDelay)]);
        let done = screened.iter().flat_map(|entry| &entry.laws).map(|sketch| finish(&campaign, 0, sketch));
        let best = done.min_by(|x, y| x.bic().total_cmp(&y.bic())).expect("a law");
        assert!((best.fit.nonlinear[0].value - late).abs() < 2e-3, "{late}: {:?}", best.fit.nonlinear);
    }
}
