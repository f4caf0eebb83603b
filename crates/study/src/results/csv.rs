//! `table.csv`: the long format, one parameter of one cell a row.

use super::{Cell, Measured, Paired, PairedParameter, Pairing, Parameter, Results, Series};
use switchback_io::output::csv_cell;

/// What places a row.
const PLACE: [&str; 10] =
    ["case", "border", "method", "points", "noise", "samples", "replicates", "failures", "parameter", "v"];

/// A column's name and where its figure stands.
type Column<T, Of = Parameter> = (&'static str, fn(&Of) -> Option<T>);

/// Measures without an error.
const EXACT: [Column<f64>; 5] = [
    ("truth", |p| Some(p.truth)),
    ("mean_estimate", |p| p.mean_estimate),
    ("theory_bias", |p| p.theory_bias),
    ("theory_sd", |p| p.theory_sd),
    ("bound_sd", |p| p.bound_sd),
];

/// Measures with their Monte-Carlo standard errors, a column each.
const MEASURED: [Column<Measured>; 9] = [
    ("bias", |p| p.bias),
    ("bias_controlled", |p| p.bias_controlled),
    ("sd", |p| p.sd),
    ("sd_controlled", |p| p.sd_controlled),
    ("mse", |p| p.mse),
    ("coverage", |p| p.coverage),
    ("coverage_controlled", |p| p.coverage_controlled),
    ("model_sd", |p| p.model_sd),
    ("model_sd_relative_error", |p| p.model_sd_relative_error),
];

/// Comparisons on the same noise, once over another method and once over another border: three columns each.
const PAIRED: [Column<Paired, PairedParameter>; 4] = [
    ("variance_ratio", |p| Some(p.variance_ratio)),
    ("variance_ratio_controlled", |p| p.variance_ratio_controlled),
    ("mse_ratio", |p| Some(p.mse_ratio)),
    ("bias_difference", |p| Some(p.bias_difference)),
];

/// What is compared, and whether that is methods.
const SUBJECTS: [(&str, bool); 2] = [("method", true), ("border", false)];

/// The table in long format: a row for each parameter of each cell; a field is empty where a measure does not exist. Comparisons
/// stand at the largest `N` alone; `…_unpaired_mcse` is the error that independent runs would leave.
pub fn to_csv(results: &Results) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Only studies with methods of others have these.
    let has_ids = results.cells.iter().any(|cell| cell.strong_id.is_some());
    let more = |fields: Vec<String>, own: [String; 5]| {
        fields.into_iter().chain(own.into_iter().filter(move |_| has_ids))
    };
    writer.write_record(more(header(), FOREIGN.map(str::to_owned))).expect("writing to memory");
    for cell in &results.cells {
        for parameter in &cell.parameters {
            let fields = row(cell, parameter, results.paired.as_ref());
            writer.write_record(more(fields, foreign(cell, parameter))).expect("writing to memory");
        }
    }
    String::from_utf8(writer.into_inner().expect("writing to memory")).expect("every field is UTF-8")
}

/// Columns of studies with methods of others.
const FOREIGN: [&str; 5] = [
    "strong_id",
    "interval_score",
    "interval_score_mcse",
    "coverage_bias_eliminated",
    "coverage_bias_eliminated_mcse",
];

fn foreign(cell: &Cell, parameter: &Parameter) -> [String; 5] {
    let number = |x: Option<f64>| x.map_or_else(String::new, |x| x.to_string());
    let figures = [parameter.interval_score, parameter.coverage_bias_eliminated];
    let [score, coverage] =
        figures.map(|m| [m.as_ref().map(Measured::value), m.as_ref().map(Measured::mcse)].map(number));
    let ([score, of_score], [coverage, of_coverage]) = (score, coverage);
    [cell.strong_id.clone().unwrap_or_default(), score, of_score, coverage, of_coverage]
}

fn header() -> Vec<String> {
    let place = PLACE.iter().map(|&name| name.to_owned());
    let exact = EXACT.iter().map(|(name, _)| (*name).to_owned());
    let measured = MEASURED.iter().flat_map(|(name, _)| [(*name).to_owned(), format!("{name}_mcse")]);
    let paired = SUBJECTS.iter().flat_map(|(subject, _)| {
        let errors = ["", "_mcse", "_unpaired_mcse"];
        let figures = PAIRED.iter().flat_map(move |(name, _)| errors.map(|e| format!("{subject}_{name}{e}")));
        std::iter::once(format!("over_{subject}")).chain(figures)
    });
    place.chain(exact).chain(measured).chain(paired).collect()
}

fn row(cell: &Cell, parameter: &Parameter, pairing: Option<&Pairing>) -> Vec<String> {
    let number = |x: Option<f64>| x.map_or_else(String::new, |x| x.to_string());
    let series = &cell.series;
    let mut fields = vec![
        csv_cell(&series.case),
        csv_cell(&series.border),
        series.method.to_string(),
        series.points.to_string(),
        series.noise.to_string(),
        cell.samples.to_string(),
        cell.replicates.to_string(),
        cell.failures.count.to_string(),
        parameter.name.clone(),
        number(parameter.v),
    ];
    fields.extend(EXACT.iter().map(|(_, get)| number(get(parameter))));
    for (_, get) in MEASURED {
        let figure = get(parameter);
        fields.extend([number(figure.map(|m| m.value())), number(figure.map(|m| m.mcse()))]);
    }
    for (_, methods) in SUBJECTS {
        let found = pairing.and_then(|pairing| pairing.find(methods, cell, parameter));
        let name = |over: &Series| if methods { over.method.to_string() } else { csv_cell(&over.border) };
        fields.push(found.map_or_else(String::new, |(over, _)| name(over)));
        for (_, get) in PAIRED {
            let figure = found.and_then(|(_, paired)| get(paired));
            let parts = [Paired::value, Paired::mcse, Paired::unpaired_mcse];
            fields.extend(parts.map(|part| number(figure.as_ref().map(part))));
        }
    }
    fields
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
        let columns = reader.headers().expect("a header").clone();
        let at = |name: &str| columns.iter().position(|c| c == name).expect("the column");
        let rows: Vec<csv::StringRecord> = reader.records().map(|r| r.expect("a whole row")).collect();
        assert_eq!(rows.len(), results.cells.iter().map(|c| c.parameters.len()).sum::<usize>());
        let bias = results.cells[0].parameters[0].bias.expect("a bias");
        assert_eq!(rows[0][at("bias")].parse::<f64>().expect("a number"), bias.value());
        assert_eq!(rows[0][at("bias_mcse")].parse::<f64>().expect("a number"), bias.mcse());
        assert_eq!(&rows[0][at("bias_controlled")], "");
        let compared = |column| rows.iter().filter(|r| !r[at(column)].is_empty()).count();
        let comparisons = &results.paired.as_ref().expect("shared noise").comparisons;
        let parameters = |methods| -> usize {
            comparisons.iter().filter(|c| c.is_of_methods() == methods).map(|c| c.parameters.len()).sum()
        };
        assert!(parameters(true) > 0 && parameters(false) > 0);
        assert_eq!(compared("over_method"), parameters(true));
        assert_eq!(compared("border_mse_ratio_unpaired_mcse"), parameters(false));
    }
}
