//! Comparisons on the same noise, against their definition on the replicates themselves and against studies run again and again.

use crate::common::Silent;
use switchback_study::consistency::{ReplayedCell, replay, run};
use switchback_study::results::{Comparison, Paired, Pairing, Results};
use switchback_study::scenario::Scenario;

const SCENARIO: &str = r#"
study = "consistency"
question = "Which method, and which border, scatters less?"
seed = 11
replicates = 60
[system]
a = [-1.2, 0.45]
b = [0.15, 0.10]
interval = [-40.0, 40.0]
[[border]]
name = "spring"
kind = "leaf_spring"
stiffness = 0.2
friction = 1.5
[[border]]
name = "hardening"
kind = "leaf_spring"
stiffness = 0.12
hardening = 6e-5
friction = 2.0
[sweep]
noise = [0.4]
samples = [150, 333]
points = [3]
methods = ["paper-descendant", "joint", "efficient"]
"#;

fn scenario(change: (&str, &str)) -> Scenario {
    Scenario::parse("paired.toml", &SCENARIO.replacen(change.0, change.1, 1)).expect("a valid scenario")
}

fn study(scenario: &Scenario) -> Results {
    run(scenario, "switchback paired.toml".to_owned(), &Silent).expect("a study")
}

const REPLICATES: usize = 60;
const SECTIONS: usize = 16;

/// The errors of one parameter in one cell, a value a replicate.
fn errors(
    results: &Results,
    replicates: &[Vec<ReplayedCell>],
    of: &Comparison,
    over: bool,
    name: &str,
) -> Vec<f64> {
    let series = if over { &of.over } else { &of.series };
    let at = |c: &switchback_study::results::Cell| c.series == *series && c.samples == of.samples;
    let cell = results.cells.iter().position(at).expect("the cell");
    let parameter = results.cells[cell].parameters.iter().position(|p| p.name == name).expect("it");
    let truth = results.cells[cell].parameters[parameter].truth;
    let estimate = |r: &Vec<ReplayedCell>| r[cell].estimates.as_ref().expect("excited")[parameter];
    replicates.iter().map(|r| estimate(r) - truth).collect()
}

/// A figure of both sides by definition, and its jackknife over sections that hold the same replicates on both.
fn by_definition(one: &[f64], other: &[f64], figure: fn(&[f64]) -> f64) -> [f64; 3] {
    let without = |errors: &[f64], section: usize| -> Vec<f64> {
        let kept = errors.iter().enumerate().filter(|(r, _)| r % SECTIONS != section);
        kept.map(|(_, e)| *e).collect()
    };
    let jackknife = |value: &dyn Fn(usize) -> f64| {
        let values: Vec<f64> = (0..SECTIONS).map(value).collect();
        let mean = values.iter().sum::<f64>() / SECTIONS as f64;
        let spread: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        (spread * (SECTIONS - 1) as f64 / SECTIONS as f64).sqrt()
    };
    let pair = jackknife(&|s| figure(&without(one, s)) - figure(&without(other, s)));
    let alone = [one, other].map(|errors| jackknife(&|s| figure(&without(errors, s))));
    [figure(one) - figure(other), pair, alone[0].hypot(alone[1])]
}

fn log_variance(errors: &[f64]) -> f64 {
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (errors.len() - 1) as f64).ln()
}

fn log_mse(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).ln()
}

/// Figures are stored to a thousandth of their smaller error.
#[track_caller]
fn agree(stored: Paired, [value, error, alone]: [f64; 3]) {
    let close = |a: f64, b: f64, error: f64| (a - b).abs() <= 1.1e-3 * error;
    assert!(close(stored.value(), value, error.min(alone)), "{stored:?} against {value}");
    assert!(close(stored.mcse(), error, error) && close(stored.unpaired_mcse(), alone, alone), "{stored:?}");
}

#[test]
fn a_comparison_is_its_definition_on_the_replicates() {
    let scenario = scenario(("", ""));
    let results = study(&scenario);
    let replicates: Vec<_> =
        (0..REPLICATES as u32).map(|r| replay(&scenario, r).expect("replayed")).collect();
    let pairing = results.paired.as_ref().expect("shared noise");
    let mut compared = 0;
    for comparison in &pairing.comparisons {
        for parameter in &comparison.parameters {
            let side = |over| errors(&results, &replicates, comparison, over, &parameter.name);
            let (one, other) = (side(false), side(true));
            let ratio = |[log, error, alone]: [f64; 3]| [log.exp(), log.exp() * error, log.exp() * alone];
            agree(parameter.variance_ratio, ratio(by_definition(&one, &other, log_variance)));
            agree(parameter.mse_ratio, ratio(by_definition(&one, &other, log_mse)));
            compared += 1;
        }
    }
    // joint and efficient: a, b and descending border over the paper's; ascending border of efficient over joint's; on two borders.
    let methods = 2 * (2 * (2 + 2 + 3) + 3);
    let borders = 7 + 2 * 10;
    assert_eq!(compared, methods + borders);
}

#[test]
fn every_group_stands_at_every_n_and_the_whole_at_the_largest() {
    let results = study(&scenario(("", "")));
    let Pairing { overall, comparisons } = results.paired.as_ref().expect("shared noise");
    let groups: Vec<usize> = comparisons.iter().map(|c| c.groups.len()).collect();
    // By method: over paper-descendant three groups, over joint one; by border: three groups or four.
    assert_eq!(groups, [6, 6, 2, 6, 6, 2, 6, 8, 8]);
    let reported: Vec<String> =
        overall.iter().map(|o| format!("{} over {}", o.subject, o.over.join(" and "))).collect();
    assert_eq!(
        reported,
        ["joint over paper-descendant", "efficient over paper-descendant and joint", "hardening over spring"]
    );
    assert!(
        overall
            .iter()
            .all(|o| o.samples == 333 && o.variance_ratio.mcse() < o.variance_ratio.unpaired_mcse())
    );
}

#[test]
fn cells_with_their_own_noise_are_not_compared() {
    let results = study(&scenario(("seed = 11", "seed = 11\ncoupling = \"independent\"")));
    assert_eq!(results.paired, None);
}

/// The same study with many seeds: how far its ratios really scatter, over what they say of themselves.
#[test]
fn both_errors_are_what_repeated_studies_show() {
    let seeds = 1..=60;
    let mut logarithms = [Vec::new(), Vec::new()];
    let mut claimed = [0.0, 0.0];
    for seed in seeds.clone() {
        let shared = study(&scenario(("seed = 11", &format!("seed = {seed}"))));
        let border =
            shared.paired.as_ref().expect("shared noise").overall.last().expect("borders").variance_ratio;
        logarithms[0].push(border.value().ln());
        claimed[0] += (border.mcse() / border.value()).powi(2);
        claimed[1] += (border.unpaired_mcse() / border.value()).powi(2);
        // The second border from a study of its own: other noise for the other side.
        let other = study(&scenario(("seed = 11", &format!("seed = {}", seed + 1000))));
        let mean_log_variance = |results: &Results, border: &str| {
            let largest = results.cells.iter().filter(|c| c.samples == 333 && c.series.border == border);
            let logs: Vec<f64> = largest
                .flat_map(|c| &c.parameters)
                .map(|p| 2.0 * p.sd.expect("estimated").value().ln())
                .collect();
            logs.iter().sum::<f64>() / logs.len() as f64
        };
        logarithms[1].push(mean_log_variance(&other, "hardening") - mean_log_variance(&shared, "spring"));
    }
    for (kind, (logarithms, claimed)) in logarithms.iter().zip(claimed).enumerate() {
        let studies = logarithms.len() as f64;
        let mean = logarithms.iter().sum::<f64>() / studies;
        let variance = logarithms.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (studies - 1.0);
        let ratio = variance / (claimed / studies);
        // A chi-square of 59 degrees of freedom over them lies in (0.6, 1.5) with probability 0.99.
        assert!((0.55..1.6).contains(&ratio), "kind {kind}: true over claimed variance {ratio}");
        println!("kind {kind}: sd {:.4}, true over claimed variance {ratio:.2}", variance.sqrt());
    }
}
