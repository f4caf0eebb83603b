//! Models that were given: the map shows where these miss, not where one identified from the records would.

mod bench;

use bench::{rig, whole};
use switchback_estimator::rig::{Rig, RigRecord};
use switchback_gap::{Diagnosis, Model, NominalModel, Settings, Status, diagnose};

/// The bench's own model, its ascending border raised.
fn raised(by: f64) -> NominalModel {
    NominalModel {
        a: vec![-0.6],
        b: vec![0.4],
        descending: vec![(-1.0, -1.5), (1.0, 0.5)],
        ascending: vec![(-1.0, -0.5 + by), (1.0, 1.5 + by)],
    }
}

/// The share of a cell in its axis, and whether it is significant.
fn cell(diagnosis: &Diagnosis, axis: &str, name: &str) -> (f64, bool) {
    let found = diagnosis.where_.iter().find(|c| c.axis == axis && c.cell == name);
    found.map_or((0.0, false), |c| (c.share, c.q_value < 0.05))
}

fn found(rig: &Rig, model: Model) -> Diagnosis {
    diagnose(rig, model, &Settings::default()).expect("a diagnosis")
}

#[test]
fn the_map_of_a_given_model_shows_where_it_is_wrong() {
    let rig = rig(Some(1), whole());
    let wrong = found(&rig, Model::Given(raised(0.1)));
    let (share, significant) = cell(&wrong, "branch", "ascending");
    assert!(significant && share > 0.8, "{:?}", wrong.where_);
    // Nothing is missing but the right borders.
    assert_eq!(wrong.verdict.status, Status::Refit, "{:?}", wrong.verdict);
    let refit = wrong.verdict.refit.expect("a model identified anew");
    assert_eq!((refit.order, refit.delay), (1, 0));
    assert!(refit.closure.estimate > 0.95 && wrong.verdict.effects.is_empty(), "{refit:?}");
    // A model that is right leaves nothing to map, and so does the one identified.
    for model in [Model::Given(raised(0.0)), Model::Identify] {
        let right = found(&rig, model);
        assert!(right.where_.iter().all(|c| c.q_value > 0.001), "{:?}", right.where_);
    }
}

#[test]
fn the_map_of_another_simulator_shows_its_errors() {
    // An error answers to the input one sample before. A simulator that is right but for an offset while the input lies in the upper half.
    let simulated = |mut r: RigRecord| {
        let errors = r.record.v().iter().map(|v| if *v > 0.0 { 0.2 } else { 0.0 });
        r.predicted = Some(r.record.y().iter().zip(errors).map(|(y, e)| y + e).collect());
        r
    };
    let found = found(&rig(Some(1), whole().into_iter().map(simulated).collect()), Model::Predicted);
    let upper: Vec<f64> = (found.where_.iter().filter(|c| c.axis == "v"))
        .filter(|c| {
            c.cell.split("..").next().and_then(|low| low.parse().ok()).is_some_and(|low: f64| low >= -0.01)
        })
        .map(|c| c.share)
        .collect();
    assert!(upper.len() == 5 && upper.iter().sum::<f64>() > 0.9, "{:?}", found.where_);
}
