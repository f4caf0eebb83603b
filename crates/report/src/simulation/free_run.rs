//! The free run on an input with or without measured outputs.

use switchback_io::model::{ModelFile, Run};
use switchback_io::rig::InputSeries;

/// The run from the measured initial state, or from rest where none was measured or the input begins with nothing to simulate.
pub(super) fn free_run(file: &ModelFile, input: &InputSeries) -> Option<Run> {
    let Some(y) = &input.y else { return file.run(&input.v, None) };
    let label = input.output_label.as_deref().unwrap_or("output");
    let missing = y.iter().filter(|y| y.is_nan()).count();
    let is_usable = |run: &Run| run.start < input.v.len() && y[..run.start].iter().all(|y| y.is_finite());
    let from_measured = (missing < y.len()).then(|| file.run(&input.v, Some(&filled(y)))).flatten();
    let from_rest = || {
        let mut run = file.run(&input.v, None)?;
        run.notes.push(format!(
            "no initial state could be taken from `{label}`: it is missing there, or the record ends before the input has moved"
        ));
        Some(run)
    };
    let mut run = from_measured.filter(is_usable).or_else(from_rest)?.judged(y);
    if missing > 0 {
        run.notes.push(format!(
            "`{label}` is missing in {missing} of {} samples: the fit is judged on the others",
            y.len()
        ));
    }
    Some(run)
}

/// The last value that was measured in place of each that was not.
fn filled(y: &[f64]) -> Vec<f64> {
    let first = y.iter().copied().find(|y| y.is_finite()).unwrap_or(0.0);
    let held = y.iter().scan(first, |last, y| {
        *last = if y.is_finite() { *y } else { *last };
        Some(*last)
    });
    held.collect()
}
