//! The columns `t,v,y,y_low,y_high`.

use std::fmt::Write;
use switchback_io::model::Run;
use switchback_io::rig::InputSeries;

pub(super) fn table(input: &InputSeries, run: &Run) -> String {
    let unit = input.time_unit.iter().filter(|_| input.times.is_some());
    let unit: String = unit.map(|unit| format!(" [{unit}]")).collect();
    let mut text = format!("t{unit},v,y,y_low,y_high\n");
    for (k, v) in input.v.iter().enumerate() {
        let t = match &input.times {
            Some(times) => times[k].clone(),
            None => stamp(input.start + k as f64 * input.sample_time).to_string(),
        };
        let _ = writeln!(text, "{t},{v},{},{},{}", run.y[k], run.low[k], run.high[k]);
    }
    text
}

/// Twelve digits of a time: they drop what rounding left of a product, and no meaning.
fn stamp(t: f64) -> f64 {
    format!("{t:.11e}").parse().unwrap_or(t)
}
