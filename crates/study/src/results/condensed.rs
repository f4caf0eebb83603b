//! A result table in few bytes, as the repository keeps it: `results.json.gz`.
//!
//! Figures of cells have [`DIGITS`] significant digits, and no more than a tenth of their Monte-Carlo error asks for. Where a measure has a control
//! variate, the plain one is left out; so is what follows from others (mean estimate, mean squared error), and so are comparisons of single
//! parameters. Everything else is there: scenario, curves, verdicts, expectations, and all cells. The parameters of all cells stand in columns, one a
//! measure, since neighbouring numbers that are alike compress better: `parameters` of a cell is their number.

use super::measured::significant;
use super::{Measured, Parameter, Results};
use serde_json::{Map, Value, json};

/// Significant digits of figures of cells.
const DIGITS: u32 = 3;

/// Significant digits of slopes, plateaus and points of curves.
const DIGITS_OF_SUMMARIES: u32 = 5;

/// The JSON text of the condensed table.
pub fn to_json(results: &Results) -> String {
    let mut page = serde_json::to_value(condensed(results)).expect("a result table is JSON");
    for key in ["summaries", "curves"] {
        shorten(&mut page[key], DIGITS_OF_SUMMARIES);
    }
    let mut rows = Vec::new();
    for cell in page["cells"].as_array_mut().into_iter().flatten() {
        let Value::Array(parameters) = cell["parameters"].take() else { continue };
        cell["parameters"] = json!(parameters.len());
        rows.extend(parameters);
    }
    page["parameters"] = columns(&rows);
    page.to_string() + "\n"
}

/// The results of a condensed table, in the layout of `results.json`; `None` where its columns do not fit its cells.
pub(super) fn restored(mut page: Value) -> Option<Value> {
    let table = page.as_object_mut()?.remove("parameters")?;
    let (table, mut next) = (table.as_object()?, 0);
    for cell in page["cells"].as_array_mut()? {
        let end = usize::try_from(cell["parameters"].as_u64()?).ok()?.checked_add(next)?;
        let rows: Option<Vec<Value>> = (next..end).map(|place| row(table, place)).collect();
        cell["parameters"] = Value::Array(rows?);
        next = end;
    }
    Some(page)
}

fn condensed(results: &Results) -> Results {
    let mut condensed = results.clone();
    condensed.digits = Some(DIGITS);
    if let Some(pairing) = &mut condensed.paired {
        pairing.comparisons.clear();
    }
    condensed.cells.iter_mut().flat_map(|cell| &mut cell.parameters).for_each(condense);
    condensed
}

fn condense(p: &mut Parameter) {
    p.bias = p.bias.filter(|_| p.bias_controlled.is_none());
    p.sd = p.sd.filter(|_| p.sd_controlled.is_none());
    (p.mean_estimate, p.mse, p.model_sd_relative_error) = (None, None, None);
    // The figures need the plain coverage, which counts intervals.
    p.coverage_controlled = None;
    let figures = [
        &mut p.bias,
        &mut p.bias_controlled,
        &mut p.sd,
        &mut p.sd_controlled,
        &mut p.coverage,
        &mut p.interval_score,
        &mut p.coverage_bias_eliminated,
        &mut p.model_sd,
    ];
    figures.into_iter().flatten().for_each(|figure: &mut Measured| *figure = figure.shortened(DIGITS));
    let known = [&mut p.theory_bias, &mut p.theory_sd, &mut p.bound_sd];
    known.into_iter().flatten().for_each(|x| *x = significant(*x, DIGITS));
}

/// Rounds every number below that is not whole.
fn shorten(value: &mut Value, digits: u32) {
    match value {
        Value::Number(number) => {
            if let Some(x) = number.as_f64().filter(|_| number.is_f64()) {
                *value = json!(significant(x, digits));
            }
        }
        Value::Array(list) => list.iter_mut().for_each(|value| shorten(value, digits)),
        Value::Object(fields) => fields.values_mut().for_each(|value| shorten(value, digits)),
        _ => {}
    }
}

/// Objects as one list a key; a key of pairs gives the list of their first numbers and that of their second. Keys that are null in all are left out.
fn columns(rows: &[Value]) -> Value {
    let mut columns = Map::new();
    let keys = rows.iter().filter_map(Value::as_object).flat_map(Map::keys);
    for key in keys {
        if columns.contains_key(key) {
            continue;
        }
        let pairs = rows.iter().any(|row| row[key].is_array());
        let filled = rows.iter().any(|row| !row[key].is_null());
        let column =
            |get: &dyn Fn(&Value) -> Value| -> Value { rows.iter().map(|row| get(&row[key])).collect() };
        let part = |place: usize| column(&|pair| pair.get(place).cloned().unwrap_or_default());
        let column = if pairs { json!([part(0), part(1)]) } else { column(&Value::clone) };
        columns.insert(key.clone(), if filled { column } else { Value::Null });
    }
    columns.retain(|_, column| !column.is_null());
    Value::Object(columns)
}

/// A row of such columns again; `None` where one of them ends before it.
fn row(columns: &Map<String, Value>, place: usize) -> Option<Value> {
    let at = |column: &Value| match (column.get(0), column.get(1)) {
        (Some(Value::Array(first)), Some(Value::Array(second))) => {
            let pair = (first.get(place)?, second.get(place)?);
            Some(if pair.0.is_null() { Value::Null } else { json!([pair.0, pair.1]) })
        }
        _ => column.get(place).cloned(),
    };
    let fields = columns.iter().map(|(key, column)| Some((key.clone(), at(column)?)));
    fields.collect::<Option<Map<String, Value>>>().map(Value::Object)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::compare;
    use crate::results::{parse, synthetic};
    use std::path::Path;

    fn read(text: &str) -> Results {
        parse(Path::new("results.json.gz"), text).expect("results")
    }

    #[test]
    fn what_is_condensed_reads_back() {
        let results = synthetic::results();
        let back = read(&to_json(&results));
        assert_eq!(back.digits, Some(DIGITS));
        assert_eq!(back.cells, condensed(&results).cells);
        assert_eq!(back.paired.as_ref().map(|p| &p.overall), results.paired.as_ref().map(|p| &p.overall));
        assert_eq!(back.expectations, results.expectations);
    }

    #[test]
    fn a_condensed_table_agrees_with_its_own_and_not_with_another() {
        let results = synthetic::results();
        let baseline = read(&to_json(&results));
        let comparison = compare(&baseline, &results);
        assert!(comparison.agrees(), "{comparison:?}");
        assert!(comparison.differences.iter().all(|d| d.z.abs() < 0.1));
        let mut other = results.clone();
        let sd = &mut other.cells[3].parameters[1].sd;
        *sd = sd.and_then(|m| Measured::new(m.value() + 20.0 * m.mcse(), m.mcse()));
        assert!(!compare(&baseline, &other).agrees());
        let mut other = results;
        other.cells[1].parameters[0].theory_sd = Some(2.0);
        assert_eq!(compare(&baseline, &other).known.len(), 1);
    }

    #[test]
    fn columns_that_end_early_are_refused() {
        let mut page: Value = serde_json::from_str(&to_json(&synthetic::results())).expect("JSON");
        page["parameters"]["truth"].as_array_mut().expect("a column").pop();
        assert!(restored(page.clone()).is_none());
        page["cells"][0]["parameters"] = json!(u64::MAX);
        assert!(restored(page).is_none());
    }
}
