//! The files of a plan: inputs to be played, and the rig file that waits for the outputs.

use super::Plan;
use std::fmt::Write;
use switchback_identify::excitation::PlannedRecord;
use switchback_io::output::{Artefacts, number};
use switchback_io::rig::RIG_FILE;

/// One CSV a record, with the columns `t` (s) and `v` (input units), and the `rig.toml` that names them all.
pub fn artefacts(plan: &Plan) -> Artefacts {
    let records = plan.records();
    let mut artefacts = Artefacts::default();
    artefacts.add(RIG_FILE, manifest(plan, &records));
    for record in &records {
        artefacts.add(format!("{}.csv", record.name), rows(record, plan.request().sample_time));
    }
    artefacts
}

fn rows(record: &PlannedRecord, sample_time: f64) -> String {
    let mut csv = String::from("t,v\n");
    for (k, v) in record.v.iter().enumerate() {
        // Twelve digits drop what rounding left of the product, and no meaning.
        let stamp: f64 = format!("{:.11e}", k as f64 * sample_time).parse().unwrap_or_default();
        let _ = writeln!(csv, "{},{}", number(stamp), number(*v));
    }
    csv
}

fn manifest(plan: &Plan, records: &[PlannedRecord]) -> String {
    let request = plan.request();
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let (low, high) = (request.interval.low(), request.interval.high());
    let mut page = format!(
        "# Designed by `switchback design`. Play the column v of each file below, sample by sample and each file without a\n\
         # break, and add the measured output as a column y, one value a row: the header becomes `t,v,y`. If the actuator\n\
         # did not follow v, put what it really did in the column v. Then: switchback identify {RIG_FILE}\n\
         \n\
         name = {}\n\
         sample_time = {:?}  # s\n\
         order = {}  # of the linear part; leave it out to have it chosen from the data\n\
         interval = [{low:?}, {high:?}]\n\
         input = {}\n\
         output = {}\n",
        quoted(&request.name),
        request.sample_time,
        request.order,
        quoted(&request.labels[0]),
        quoted(&request.labels[1]),
    );
    for record in records {
        let _ = write!(
            page,
            "\n[[record]]\nfile = \"{}.csv\"\nrole = \"{}\"\nuse = \"{}\"\n",
            record.name,
            record.role.name(),
            record.usage.name()
        );
    }
    page
}
