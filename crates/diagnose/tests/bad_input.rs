//! Records that cannot be judged, or only in part.

use std::f64::consts::PI;

use crate::bench::{input, made, output, record, rig, whole};
use switchback_diagnose::{
    DiagnoseError, Diagnosis, Effect, Model, NominalModel, Settings, Status, diagnose,
};
use switchback_model::rig::{Rig, RigRecord, Usage};

fn found(rig: &Rig, model: Model) -> Diagnosis {
    diagnose(rig, model, &Settings::default()).expect("a diagnosis")
}

fn refused(rig: &Rig, model: Model) -> DiagnoseError {
    match diagnose(rig, model, &Settings::default()) {
        Ok(found) => panic!("diagnosed as {:?}", found.verdict),
        Err(refusal) => refusal,
    }
}

#[test]
fn a_good_rig_has_no_gap_whether_or_not_it_declares_its_order() {
    for order in [Some(1), None] {
        let diagnosis = found(&rig(order, whole()), Model::Identify);
        assert_eq!(diagnosis.verdict.status, Status::None, "{order:?}: {:?}", diagnosis.verdict);
        assert!((0.008..0.016).contains(&diagnosis.gap.noise_floor), "{:?}", diagnosis.gap);
        let reported = diagnosis.limitations.iter().any(|l| l.contains("declares no order"));
        assert_eq!(reported, order.is_none());
    }
}

#[test]
fn without_a_hold_out_the_figures_are_said_to_flatter() {
    let diagnosis = found(&rig(Some(1), vec![made("sweep", Usage::Fit, 3000, 0.0)]), Model::Identify);
    assert!(diagnosis.limitations.iter().any(|l| l.contains("hold a record out")));
}

#[test]
fn without_a_fit_record_nothing_can_be_identified() {
    let records = vec![made("drive", Usage::Holdout, 1500, 1.0)];
    assert_eq!(refused(&rig(Some(1), records), Model::Identify), DiagnoseError::NoFitRecord);
}

#[test]
fn records_too_short_for_their_order_are_refused_with_the_number_needed() {
    for order in [Some(3), None] {
        let records = vec![made("sweep", Usage::Fit, 20, 0.0), made("drive", Usage::Holdout, 1500, 1.0)];
        match refused(&rig(order, records), Model::Identify) {
            DiagnoseError::TooShort { samples, needed, .. } => assert!(samples < needed),
            other => panic!("{other}"),
        }
    }
}

#[test]
fn a_constant_input_or_output_is_refused() {
    let v = input(500, 0.0);
    let still = vec![record("still", Usage::Fit, vec![0.3; 500], v.clone())];
    assert_eq!(refused(&rig(Some(1), still), Model::Identify), DiagnoseError::ConstantInput);
    let dead = vec![record("dead", Usage::Fit, v, vec![0.3; 500])];
    assert_eq!(refused(&rig(None, dead), Model::Identify), DiagnoseError::ConstantOutput);
}

#[test]
fn a_held_out_record_whose_output_never_moves_is_reported() {
    let v = input(1500, 1.0);
    let mut records = whole();
    records.push(record("dead", Usage::Holdout, v.clone(), vec![0.3; v.len()]));
    let diagnosis = found(&rig(Some(1), records), Model::Identify);
    let reported: Vec<&String> = diagnosis.limitations.iter().filter(|l| l.contains("never moves")).collect();
    assert!(matches!(reported[..], [reported] if reported.contains("`dead`")), "{reported:?}");
}

#[test]
fn one_period_is_judged_with_a_word_about_it() {
    let v: Vec<f64> = (0..400).map(|t| (2.0 * PI * t as f64 / 400.0).sin()).collect();
    let y = output(&v);
    let records =
        vec![record("period", Usage::Fit, v.clone(), y.clone()), record("again", Usage::Holdout, v, y)];
    for order in [Some(1), None] {
        let diagnosis = found(&rig(order, records.clone()), Model::Identify);
        assert!(diagnosis.limitations.iter().any(|l| l.contains("repeats")), "{:?}", diagnosis.limitations);
        assert!(diagnosis.gap.before.estimate.is_finite());
    }
}

#[test]
fn clipped_readings_are_among_the_causes() {
    let clipped = |r: RigRecord| {
        let y = r.record.y().iter().map(|y| y.min(0.6)).collect();
        record(&r.name, r.usage, r.record.v().to_vec(), y)
    };
    let diagnosis = found(&rig(Some(1), whole().into_iter().map(clipped).collect()), Model::Identify);
    let named = [diagnosis.verdict.effects.clone(), diagnosis.verdict.class.clone()].concat();
    assert!(named.contains(&Effect::SensorSaturation), "{:?}", diagnosis.verdict);
}

#[test]
fn predictions_with_gaps_are_refused_where_they_lie() {
    let predicted = |y_sim: Vec<f64>| {
        let mut records = whole();
        records[1].predicted = Some(y_sim);
        rig(Some(1), records)
    };
    let short = DiagnoseError::Prediction { record: "drive".into(), found: 7, expected: 1500 };
    assert_eq!(refused(&predicted(vec![0.0; 7]), Model::Predicted), short);
    let mut holed = vec![0.0; 1500];
    holed[40] = f64::NAN;
    match refused(&predicted(holed), Model::Predicted) {
        DiagnoseError::PredictionNotFinite { record, index, .. } => {
            assert_eq!((record.as_str(), index), ("drive", 40))
        }
        other => panic!("{other}"),
    }
}

#[test]
fn a_model_of_another_order_or_without_stability_is_refused() {
    let border = vec![(-1.0, -1.0), (1.0, 1.0)];
    let model = |a: Vec<f64>| {
        let b = a.iter().map(|_| 0.4).collect();
        Model::Given(NominalModel { a, b, descending: border.clone(), ascending: border.clone() })
    };
    let wrong = refused(&rig(Some(1), whole()), model(vec![-0.9, 0.2]));
    assert_eq!(wrong, DiagnoseError::Order { model: 2, rig: 1 });
    let unstable = refused(&rig(Some(1), whole()), model(vec![-1.2]));
    assert!(matches!(unstable, DiagnoseError::Model { .. }) && unstable.to_string().contains("unstable"));
}
