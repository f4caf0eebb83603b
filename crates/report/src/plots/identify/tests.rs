use super::{LinearPart, borders, correlations, linear, outputs};
use crate::plots::inspect::check;
use switchback_io::identification::json::EstimateFile;
use switchback_io::identification::{Identification, Method, examined_watched};
use switchback_io::model::identified_series;
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// A first-order machine between the borders v + 0.5 and v − 0.5, and its identification.
fn identified() -> (Rig, Identification) {
    let record = |name: &str, usage, phase: f64| {
        let drive = |t: f64| (0.17 * t + phase).sin() * (0.013 * t).cos();
        let v: Vec<f64> = (0..800).map(|t| drive(f64::from(t))).collect();
        let (mut y, mut u) = (vec![0.0], 0.0);
        for t in 1..v.len() {
            y.push(0.6 * y[t - 1] + 0.4 * u);
            u = if v[t] > v[t - 1] { v[t] + 0.5 } else { v[t] - 0.5 };
        }
        let record = Record::new(v, y).expect("finite");
        RigRecord { name: name.to_owned(), role: Role::Free, usage, record, predicted: None }
    };
    let rig = Rig {
        name: "bench".to_owned(),
        sample_time: 0.01,
        order: Some(1),
        interval: None,
        input_label: "stroke [mm]".to_owned(),
        output_label: "force [N]".to_owned(),
        records: vec![record("monday", Usage::Fit, 0.0), record("tuesday", Usage::Holdout, 1.0)],
    };
    let found = examined_watched(&rig, Method::Free.into(), &()).expect("identified");
    (rig, found)
}

#[test]
fn figures_of_an_identification_stay_on_their_page_and_repeat() {
    let (rig, found) = identified();
    let estimate = EstimateFile::of(&rig, &found);
    let series = identified_series(&rig, &found);
    let part = LinearPart::of(&estimate, None).expect("coefficients");
    let figures = || {
        let (borders, correlations) = (borders(&estimate), correlations(&estimate, &series));
        [borders.expect("borders"), correlations.expect("residuals"), linear(&part)]
    };
    assert_eq!(figures(), figures());
    for svg in figures() {
        assert_eq!(check(&svg), Ok(()));
        assert!(svg.contains(" data-frame=") && svg.contains(" data-hides="));
    }
}

#[test]
fn the_figure_of_a_record_stays_on_its_page_and_repeats() {
    let (rig, found) = identified();
    let run = found.runs[1].as_ref().expect("the record was simulated");
    let svg = outputs(&rig, &rig.records[1], run);
    assert_eq!(check(&svg), Ok(()));
    assert_eq!(svg, outputs(&rig, &rig.records[1], run));
    assert!(svg.contains("force [N]") && svg.contains("held out"));
}
