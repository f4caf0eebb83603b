//! A plan as one JSON object.

use super::words::lengths;
use super::{Outlook, Plan, Prediction, Report};
use serde_json::{Value, json};
use switchback_identify::excitation::Direction;
use switchback_io::output::stamped;

/// Name and version of the layout.
const SCHEMA: &str = "switchback/design/1";

/// One JSON object, indented, with a newline at its end.
///
/// `prediction` holds the length planned, `predictions` a ladder of lengths around it; both are null where the plan was made without a rig.
pub fn json(report: &Report) -> String {
    let plan = &report.plan;
    let request = plan.request();
    let records = plan.records();
    let pulses = &plan.dataset().pulses()[0];
    let total: usize = records.iter().map(|record| record.v.len()).sum();
    let largest = records
        .iter()
        .flat_map(|record| record.v.windows(2))
        .map(|pair| (pair[1] - pair[0]).abs())
        .fold(0.0, f64::max);
    let outlook = report.outlook.as_ref();
    let page = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "name": request.name,
        "order": request.order,
        "points": request.points,
        "interval": [request.interval.low(), request.interval.high()],
        "sample_time": request.sample_time,
        "input": request.labels[0],
        "output": request.labels[1],
        "spacing": pulses.spacing(),
        "period": pulses.period(),
        "periods": plan.dataset().periods(),
        "samples": plan.dataset().samples(),
        "levels": {
            "descendant": plan.dataset().pulses()[direction(Direction::Descendant)].levels(),
            "ascendant": plan.dataset().pulses()[direction(Direction::Ascendant)].levels(),
        },
        "records": records.iter().map(|record| json!({
            "file": format!("{}.csv", record.name),
            "role": record.role.name(),
            "use": record.usage.name(),
            "samples": record.v.len(),
            "seconds": plan.seconds(record.v.len()),
        })).collect::<Vec<_>>(),
        "actuator": {
            "largest_move_per_sample": largest,
            "speed": largest / request.sample_time,
            "seconds": plan.seconds(total),
        },
        "rig": outlook.map(truth),
        "precision": outlook.and_then(|outlook| outlook.wanted),
        "prediction": outlook.map(|o| prediction(plan, o, &o.forecast.at(plan.dataset().periods()))),
        "predictions": outlook.map(|o| {
            lengths(plan.dataset().periods())
                .map(|periods| prediction(plan, o, &o.forecast.at(periods)))
        }),
        "out": report.folder,
    });
    stamped(SCHEMA, &page)
}

fn direction(direction: Direction) -> usize {
    match direction {
        Direction::Descendant => 0,
        Direction::Ascendant => 1,
    }
}

fn truth(outlook: &Outlook) -> Value {
    let truth = &outlook.truth;
    json!({
        "name": truth.rig,
        "method": truth.method.name(),
        "noise_sd": truth.noise_sd,
        "notes": truth.notes,
    })
}

fn prediction(plan: &Plan, outlook: &Outlook, prediction: &Prediction) -> Value {
    let planned = outlook.forecast.planned();
    let values =
        |list: &[switchback_identify::pulse::Estimated]| list.iter().map(|x| x.value).collect::<Vec<_>>();
    let [descending, ascending] = outlook.forecast.levels();
    let errors = &prediction.errors;
    let points = |levels: &[f64], k: usize, errors: &[f64]| {
        let point = |((v, f), se): ((&f64, f64), &f64)| json!({ "v": v, "f": f, "se": se });
        levels.iter().zip(values(&planned.borders[k])).zip(errors).map(point).collect::<Vec<_>>()
    };
    json!({
        "method": outlook.forecast.method().name(),
        "periods": prediction.periods,
        "samples": prediction.samples,
        "seconds": plan.seconds(prediction.samples),
        "a": values(&planned.a),
        "a_se": errors.a,
        "b": values(&planned.b),
        "b_se": errors.b,
        "descendant": points(descending, 0, &errors.descending),
        "ascendant": points(ascending, 1, &errors.ascending),
        "worst": errors.worst(),
    })
}
