//! The control variate on the leaf-spring study: it agrees with the plain figures, and is worth what it promises.

use crate::common::Silent;
use switchback_study::consistency::run;
use switchback_study::results::{Group, Parameter, Results};
use switchback_study::scenario::Scenario;

/// The committed leaf-spring study with fewer replicates.
fn leaf_spring(replicates: usize) -> Results {
    let text = include_str!("../../../scenarios/leafspring.toml");
    let fewer = text.replace("replicates = 500", &format!("replicates = {replicates}"));
    assert_ne!(text, fewer, "the number of replicates is replaced");
    let scenario = Scenario::parse("leafspring.toml", &fewer).expect("a valid scenario");
    run(&scenario, String::new(), &Silent).expect("a study")
}

/// Every parameter of every cell with a measured bias, and how it is called.
fn parameters(results: &Results) -> impl Iterator<Item = (String, usize, &Parameter)> {
    results.cells.iter().flat_map(|cell| {
        let name = move |p: &Parameter| format!("{}, N = {}, {}", cell.series, cell.samples, p.name);
        cell.parameters.iter().map(move |p| (name(p), cell.samples, p))
    })
}

#[test]
fn plain_and_controlled_agree_in_every_cell_and_the_error_shrinks_a_hundredfold() {
    let results = leaf_spring(300);
    let mut judged = 0;
    for (name, samples, p) in parameters(&results) {
        let (Some(plain), Some(controlled)) = (p.bias, p.bias_controlled) else { continue };
        if plain.mcse() == 0.0 {
            continue;
        }
        let apart = (plain.value() - controlled.value()).abs() / plain.mcse().hypot(controlled.mcse());
        assert!(apart < 5.0, "{name}: plain and controlled bias are {apart} errors apart");
        let ratio = plain.mcse() / controlled.mcse();
        if samples == 100_000 && matches!(p.group, Group::A | Group::B) {
            judged += 1;
            assert!(ratio >= 100.0, "{name}: the control variate reduces the error {ratio} times only");
        }
    }
    // 2 borders, 3 numbers of points, 3 noise levels, 6 methods, 4 parameters.
    assert_eq!(judged, 2 * 3 * 3 * 6 * 4);
    let mut ratios = Vec::new();
    for (name, samples, p) in parameters(&results) {
        let (Some(plain), Some(controlled)) = (p.coverage, p.coverage_controlled) else { continue };
        let apart = (plain.value() - controlled.value()).abs() / plain.mcse().hypot(controlled.mcse());
        assert!(apart < 5.0, "{name}: plain and controlled coverage are {apart} errors apart");
        if samples == 100_000 && controlled.mcse() > 0.0 {
            ratios.push(plain.mcse() / controlled.mcse());
        }
    }
    ratios.sort_by(f64::total_cmp);
    assert!(
        ratios[ratios.len() / 2] >= 2.0,
        "half the errors of coverage shrink {} times or less",
        ratios[ratios.len() / 2]
    );
}
