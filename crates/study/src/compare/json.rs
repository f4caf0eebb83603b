//! The comparison as one JSON object.

use super::{Comparison, Difference};
use crate::results::{Measured, Results};
use serde_json::{Value, json};
use switchback_io::output::stamped;

/// Name and version of the layout.
const SCHEMA: &str = "switchback/compare/1";

/// One JSON object, indented, with a newline at its end. A `z` that is infinite, both figures being exact and different, is null.
pub fn json(comparison: &Comparison, baseline: &Results, new: &Results) -> String {
    let largest = comparison.differences.iter().map(|d| d.z.abs()).fold(0.0, f64::max);
    let page = json!({
        "baseline": origin(baseline),
        "new": origin(new),
        "agrees": comparison.agrees(),
        "identical": comparison.identical(),
        "measures": comparison.differences.len(),
        "largest_z": largest,
        "threshold": comparison.threshold,
        "beyond_chance": comparison.beyond_chance().into_iter().map(difference).collect::<Vec<_>>(),
        "only_baseline": comparison.only_baseline,
        "only_new": comparison.only_new,
        "known": comparison.known,
    });
    stamped(SCHEMA, &page)
}

fn origin(results: &Results) -> Value {
    json!({ "name": results.name, "seed": results.seed, "version": results.version })
}

fn difference(d: &Difference) -> Value {
    let figure = |m: Measured| json!([m.value(), m.mcse()]);
    json!({
        "series": d.place.series.to_string(),
        "samples": d.place.samples,
        "parameter": d.place.parameter,
        "measure": d.place.measure,
        "baseline": figure(d.baseline),
        "new": figure(d.new),
        "z": d.z,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::compare;
    use crate::results::synthetic;

    #[test]
    fn the_object_says_whether_the_two_agree_and_what_differs() {
        let baseline = synthetic::results();
        let page = |new: &Results| -> Value {
            serde_json::from_str(&json(&compare(&baseline, new), &baseline, new)).expect("JSON")
        };
        let same = page(&baseline);
        assert_eq!((&same["agrees"], &same["identical"]), (&Value::Bool(true), &Value::Bool(true)));

        let mut new = baseline.clone();
        let bias = &mut new.cells[0].parameters[0].bias;
        *bias = bias.and_then(|m| Measured::new(m.value() + 30.0 * m.mcse(), m.mcse()));
        let other = page(&new);
        assert_eq!(other["agrees"], false);
        assert_eq!(other["beyond_chance"][0]["measure"], "bias");
        assert_eq!(other["beyond_chance"][0]["parameter"], "a1");
    }
}
