//! `table.csv`: the long format, one measure of one parameter of one cell a row.

use super::{Cell, Measured, Parameter, Results};

/// Columns of `table.csv`.
const HEADER: [&str; 13] = [
    "case",
    "border",
    "method",
    "points",
    "noise",
    "samples",
    "replicates",
    "failures",
    "parameter",
    "v",
    "measure",
    "value",
    "mcse",
];

/// The table in long format: a row for each measure that exists.
pub fn to_csv(results: &Results) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(HEADER).expect("writing to memory");
    for cell in &results.cells {
        for parameter in &cell.parameters {
            for (measure, figure) in measures(parameter) {
                writer.write_record(row(cell, parameter, measure, figure)).expect("writing to memory");
            }
        }
    }
    String::from_utf8(writer.into_inner().expect("writing to memory")).expect("every field is UTF-8")
}

/// A figure, with or without an error.
type Figure = (f64, Option<f64>);

fn measures(p: &Parameter) -> Vec<(&'static str, Figure)> {
    let measured = |m: Option<Measured>| m.map(|m| (m.value(), Some(m.mcse())));
    let exact = |x: Option<f64>| x.map(|x| (x, None));
    [
        ("truth", Some((p.truth, None))),
        ("mean_estimate", exact(p.mean_estimate)),
        ("bias", measured(p.bias)),
        ("bias_controlled", measured(p.bias_controlled)),
        ("sd", measured(p.sd)),
        ("sd_controlled", measured(p.sd_controlled)),
        ("mse", measured(p.mse)),
        ("coverage", measured(p.coverage)),
        ("model_sd", measured(p.model_sd)),
        ("model_sd_relative_error", measured(p.model_sd_relative_error)),
        ("theory_sd", exact(p.theory_sd)),
        ("bound_sd", exact(p.bound_sd)),
    ]
    .into_iter()
    .filter_map(|(name, figure)| Some((name, figure?)))
    .collect()
}

fn row(cell: &Cell, parameter: &Parameter, measure: &str, (value, mcse): Figure) -> [String; 13] {
    let optional = |x: Option<f64>| x.map_or_else(String::new, |x| x.to_string());
    let series = &cell.series;
    [
        series.case.clone(),
        series.border.clone(),
        series.method.to_string(),
        series.points.to_string(),
        series.noise.to_string(),
        cell.samples.to_string(),
        cell.replicates.to_string(),
        cell.failures.count.to_string(),
        parameter.name.clone(),
        optional(parameter.v),
        measure.to_owned(),
        value.to_string(),
        optional(mcse),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::synthetic;

    #[test]
    fn every_row_has_every_column_and_numbers_read_back() {
        let results = synthetic::results();
        let text = to_csv(&results);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows: Vec<csv::StringRecord> = reader.records().map(|r| r.expect("a whole row")).collect();
        let bias = results.cells[0].parameters[0].bias.expect("a bias");
        let first = rows.iter().find(|r| &r[10] == "bias").expect("a row with a bias");
        assert_eq!(first[11].parse::<f64>().expect("a number"), bias.value());
        assert_eq!(first[12].parse::<f64>().expect("a number"), bias.mcse());
    }
}
