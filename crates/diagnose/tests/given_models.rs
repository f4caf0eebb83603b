//! Models that were given: the map shows where these miss, not where one identified from the records would.

use crate::bench::{made, played, record, response, rig, white, whole};
use switchback_diagnose::{Diagnosis, Effect, Model, NominalModel, Settings, Status, diagnose};
use switchback_model::rig::{Rig, RigRecord, Usage};

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

/// The values that differ, and by how much.
fn rows(diagnosis: &Diagnosis) -> Vec<(String, f64)> {
    let rows = &diagnosis.differences.as_ref().expect("a comparison").rows;
    rows.iter().filter(|row| row.differs).map(|row| (row.what.clone(), row.in_b - row.in_a)).collect()
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
    // Nothing is missing: one border that lies higher by 0.1 is half of that in the friction, and half in the zero.
    assert_eq!(wrong.verdict.status, Status::Parameters, "{:?}", wrong.verdict);
    assert!(wrong.verdict.effects.is_empty() && wrong.gap.closure.expect("a gap").estimate > 0.95);
    let mut off = rows(&wrong);
    off.sort_by(|x, y| x.0.cmp(&y.0));
    let [(friction, by_friction), (offset, by_offset)] = &off[..] else { panic!("{off:?}") };
    assert_eq!((friction.as_str(), offset.as_str()), ("friction", "offset"));
    assert!((by_friction + 0.05).abs() < 0.005 && (by_offset + 0.05).abs() < 0.005, "{off:?}");
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

/// The bench after its input has got a play.
fn worn() -> Vec<RigRecord> {
    let worn = |name, usage, samples, phase| {
        let sound = made(name, usage, samples, phase);
        let v = sound.record.v().to_vec();
        let mut white = white(7);
        let y = response(&played(&v, 0.3), &[-0.6], &mut || 0.01 * white());
        record(name, usage, v, y)
    };
    vec![worn("sweep", Usage::Fit, 3000, 0.0), worn("drive", Usage::Holdout, 1500, 1.0)]
}

#[test]
fn what_has_changed_is_reported_on_top_of_the_given_model() {
    let pole = |found: &Diagnosis| found.differences.as_ref().expect("a comparison").aligned.linear.a()[0];
    let by_table = found(&rig(None, worn()), Model::Given(raised(0.0)));
    assert_eq!(by_table.verdict.effects, [Effect::Backlash], "{:?}", by_table.verdict);
    assert!((pole(&by_table) + 0.6).abs() < 1e-9, "{:?}", pole(&by_table));
    // The same model as another simulator's predictions: what stands in for it behaves as it does.
    let predicted = |mut r: RigRecord| {
        r.predicted = Some(response(r.record.v(), &[-0.6], &mut || 0.0));
        r
    };
    let records: Vec<RigRecord> = worn().into_iter().map(predicted).collect();
    let by_runs = found(&rig(None, records), Model::Predicted);
    assert_eq!(by_runs.verdict.effects, [Effect::Backlash], "{:?}", by_runs.verdict);
    assert!((pole(&by_runs) + 0.6).abs() < 0.01, "{:?}", pole(&by_runs));
    for found in [by_table, by_runs] {
        let [(play, by)] = &rows(&found)[..] else { panic!("{:?}", rows(&found)) };
        assert!(play == "play" && (by - 0.3).abs() < 0.01, "{by}");
        let closure = found.gap.closure.expect("a gap").estimate;
        assert!(closure > 0.95, "{closure}");
    }
}

#[test]
fn a_gain_that_is_another_one_is_no_effect() {
    let stronger = |r: RigRecord| {
        let y = r.record.y().iter().map(|y| 1.2 * y).collect();
        record(&r.name, r.usage, r.record.v().to_vec(), y)
    };
    let found = found(&rig(None, whole().into_iter().map(stronger).collect()), Model::Given(raised(0.0)));
    assert_eq!(found.verdict.status, Status::Parameters, "{:?}", found.verdict);
    let [(gain, by)] = &rows(&found)[..] else { panic!("{:?}", rows(&found)) };
    assert!(gain == "gain" && (by - 0.2).abs() < 0.01, "{by}");
}
