//! A plan as one JSON object. Keys stand in the order of the alphabet.

use super::words::lengths;
use super::{Outlook, Plan, PlanMethod, Prediction, Report};
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use switchback_identify::Method;
use switchback_identify::excitation::{Direction, PlannedRecord};
use switchback_identify::pulse::Estimated;
use switchback_io::output::{stamped, stamped_schema};

/// Name and version of the layout.
const SCHEMA: &str = "switchback/design/1";

/// A plan of experiments: `design --json`.
#[derive(Serialize, JsonSchema)]
struct DesignFile<'a> {
    /// What the actuator must do.
    actuator: Actuator,
    /// Label and unit.
    input: &'a str,
    /// The working interval.
    interval: [f64; 2],
    /// Levels visited.
    levels: Levels<'a>,
    /// The rig's name.
    name: &'a str,
    /// Order planned for.
    order: usize,
    /// The folder written.
    out: Option<&'a str>,
    /// Label and unit.
    output: &'a str,
    /// Samples of a period.
    period: usize,
    /// Periods.
    periods: usize,
    /// Points on each border.
    points: usize,
    /// The precision asked for, a share of u_M − u_m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    precision: Option<f64>,
    /// At the length planned; null where the plan was made without a rig.
    prediction: Option<PredictionFile>,
    /// At other lengths; null where the plan was made without a rig.
    predictions: Option<Vec<PredictionFile>>,
    /// The records to take.
    records: Vec<RecordFile>,
    /// The rig that predictions rest on.
    rig: Option<Known<'a>>,
    /// Seconds.
    #[schemars(extend("exclusiveMinimum" = 0))]
    sample_time: f64,
    /// Samples that the regression sees.
    samples: usize,
    /// Samples between visits.
    spacing: usize,
    /// Version of Switchback that wrote it.
    version: &'static str,
}

/// What the actuator must do.
#[derive(Serialize, JsonSchema)]
struct Actuator {
    /// Largest move from one sample to the next, input units.
    #[schemars(range(min = 0))]
    largest_move_per_sample: f64,
    /// Duration of all records.
    #[schemars(range(min = 0))]
    seconds: f64,
    /// Largest speed, input units per second.
    #[schemars(range(min = 0))]
    speed: f64,
}

/// Levels in the order of their visits.
#[derive(Serialize, JsonSchema)]
struct Levels<'a> {
    /// Of the ascendant experiment.
    ascendant: &'a [f64],
    /// Of the descendant experiment.
    descendant: &'a [f64],
}

/// A record to take.
#[derive(Serialize, JsonSchema)]
struct RecordFile {
    /// Its file.
    file: String,
    /// The experiment.
    #[schemars(extend("enum" = ["free", "step_high", "step_low", "descendant", "ascendant"]))]
    role: &'static str,
    /// Its samples.
    samples: usize,
    /// Its duration.
    #[schemars(range(min = 0))]
    seconds: f64,
    /// What it is for.
    #[schemars(extend("enum" = ["fit", "holdout"]))]
    r#use: &'static str,
}

/// A rig that was identified.
#[derive(Serialize, JsonSchema)]
struct Known<'a> {
    /// The method.
    method: Method,
    /// Its name.
    name: &'a str,
    /// Standard deviation of the equation error, output units.
    #[schemars(range(min = 0))]
    noise_sd: f64,
    /// What to know before trusting a prediction.
    notes: &'a [String],
}

/// Standard errors that so many periods will leave.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Prediction")]
struct PredictionFile {
    /// `a₁…aₙ`.
    a: Vec<f64>,
    /// Their standard errors.
    a_se: Vec<f64>,
    /// Points of the rising border.
    ascendant: Vec<Point>,
    /// `b₁…bₙ`.
    b: Vec<f64>,
    /// Their standard errors.
    b_se: Vec<f64>,
    /// Points of the falling border.
    descendant: Vec<Point>,
    /// The method.
    #[schemars(with = "PlanMethod")]
    method: &'static str,
    /// Periods of each experiment.
    periods: usize,
    /// Samples of each experiment.
    samples: usize,
    /// Duration of each experiment.
    #[schemars(range(min = 0))]
    seconds: f64,
    /// Largest standard error of a border point, u_M − u_m = 1.
    worst: f64,
}

/// A point of a border, u_M − u_m = 1.
#[derive(Serialize, JsonSchema)]
struct Point {
    /// The border there.
    f: f64,
    /// Its standard error.
    se: f64,
    /// Position, input units.
    v: f64,
}

/// The JSON Schema of [`json`].
pub fn schema() -> Schema {
    stamped_schema::<DesignFile<'_>>(SCHEMA)
}

/// One JSON object, indented, with a newline at its end.
pub fn json(report: &Report) -> String {
    let plan = &report.plan;
    let (request, dataset) = (plan.request(), plan.dataset());
    let pulses = &dataset.pulses()[0];
    let levels = |direction| dataset.pulses()[index(direction)].levels();
    let outlook = report.outlook.as_ref();
    let predicted = |o: &Outlook, periods| prediction(plan, o, &o.forecast.at(periods));
    let page = DesignFile {
        actuator: actuator(plan),
        input: &request.labels[0],
        interval: [request.interval.low(), request.interval.high()],
        levels: Levels { ascendant: levels(Direction::Ascendant), descendant: levels(Direction::Descendant) },
        name: &request.name,
        order: request.order,
        out: report.folder.as_deref(),
        output: &request.labels[1],
        period: pulses.period(),
        periods: dataset.periods(),
        points: request.points,
        precision: outlook.and_then(|outlook| outlook.wanted),
        prediction: outlook.map(|o| predicted(o, dataset.periods())),
        predictions: outlook.map(|o| lengths(dataset.periods()).map(|periods| predicted(o, periods)).into()),
        records: plan.records().iter().map(|record| file(plan, record)).collect(),
        rig: outlook.map(known),
        sample_time: request.sample_time,
        samples: dataset.samples(),
        spacing: pulses.spacing(),
        version: env!("CARGO_PKG_VERSION"),
    };
    stamped(SCHEMA, &page)
}

fn index(direction: Direction) -> usize {
    match direction {
        Direction::Descendant => 0,
        Direction::Ascendant => 1,
    }
}

fn actuator(plan: &Plan) -> Actuator {
    let records = plan.records();
    let moves = records.iter().flat_map(|record| record.v.windows(2)).map(|pair| (pair[1] - pair[0]).abs());
    let largest = moves.fold(0.0, f64::max);
    Actuator {
        largest_move_per_sample: largest,
        seconds: plan.seconds(records.iter().map(|record| record.v.len()).sum()),
        speed: largest / plan.request().sample_time,
    }
}

fn file(plan: &Plan, record: &PlannedRecord) -> RecordFile {
    RecordFile {
        file: format!("{}.csv", record.name),
        role: record.role.name(),
        samples: record.v.len(),
        seconds: plan.seconds(record.v.len()),
        r#use: record.usage.name(),
    }
}

fn known(outlook: &Outlook) -> Known<'_> {
    let truth = &outlook.truth;
    Known { method: truth.method, name: &truth.rig, noise_sd: truth.noise_sd, notes: &truth.notes }
}

fn prediction(plan: &Plan, outlook: &Outlook, prediction: &Prediction) -> PredictionFile {
    let planned = outlook.forecast.planned();
    let values = |list: &[Estimated]| list.iter().map(|x| x.value).collect::<Vec<_>>();
    let [descending, ascending] = outlook.forecast.levels();
    let errors = &prediction.errors;
    let points = |levels: &[f64], k: usize, errors: &[f64]| {
        let point = |((&v, f), &se): ((&f64, f64), &f64)| Point { f, se, v };
        levels.iter().zip(values(&planned.borders[k])).zip(errors).map(point).collect()
    };
    PredictionFile {
        a: values(&planned.a),
        a_se: errors.a.clone(),
        ascendant: points(ascending, 1, &errors.ascending),
        b: values(&planned.b),
        b_se: errors.b.clone(),
        descendant: points(descending, 0, &errors.descending),
        method: outlook.forecast.method().name(),
        periods: prediction.periods,
        samples: prediction.samples,
        seconds: plan.seconds(prediction.samples),
        worst: errors.worst(),
    }
}
