//! What is left in the residuals: correlation with their own past and with the input.

use crate::pages::Z95;
use crate::pages::chart::{Chart, HALF, Ink, Layer, Reading, Scale, Shape};
use maud::{Markup, html};
use switchback_identify::statistics::{Whiteness, correlation};
use switchback_io::identification::json::EstimateFile;
use switchback_io::model::{RecordSeries, Series};

/// Lags drawn.
const LAGS: isize = 30;

/// Residuals of one record with its input.
struct Residuals<'a> {
    e: Vec<f64>,
    v: &'a [f64],
}

/// Both correlations with their bounds, over the records that were fitted.
pub(super) fn correlations(estimate: &EstimateFile, series: &Series) -> Markup {
    let runs: Vec<Residuals<'_>> =
        series.records.iter().filter(|r| r.usage == "fit").filter_map(free_run).collect();
    let one_step: Vec<Residuals<'_>> = runs.iter().map(|run| ahead(run, &estimate.a)).collect();
    let foretold = |of: &[Residuals<'_>]| {
        Whiteness::of(&of.iter().map(|r| &r.e[..]).collect::<Vec<_>>()).map(|w| w.foretold)
    };
    // As the program does where it warns of colour: noise may enter before or behind the linear part, and neither is a fault of the model.
    let is_output_error = foretold(&runs).zip(foretold(&one_step)).is_some_and(|(run, step)| run < step);
    let (name, residuals) = match is_output_error {
        true => ("y − ŷ of the free run", &runs),
        false => ("A(q⁻¹)(y − ŷ), one step ahead", &one_step),
    };
    let samples: usize = residuals.iter().map(|r| r.e.len()).sum();
    if samples <= 2 * LAGS as usize {
        return html! { p { "The fitted records are too short, or have no run." } };
    }
    html! {
        p { "Residuals: " (name) ", over " (samples) " samples that were fitted. Where noise is all that is left, one lag in twenty lies outside the bounds." }
        div class="charts" { (own(residuals, samples).html()) (with_input(residuals, samples).html()) }
        p class="note" {
            @if let Some(innovations) = &estimate.innovations {
                "The past of the residuals foretells " (format!("{:.1} %", 100.0 * innovations.foretold)) " of their variance (Ljung–Box "
                (format!("{:.0}", innovations.ljung_box)) " over " (innovations.lags) " lags). "
            }
            "Correlation with the input at negative lags means feedback from output to input, or a model that looks too far ahead. "
            code { "switchback gap" } " looks for the cause of what is left."
        }
    }
}

/// The errors of a record's run, from the first simulated sample on: before it a run is the measured output.
fn free_run(record: &RecordSeries) -> Option<Residuals<'_>> {
    let run = record.runs.iter().flatten().next()?;
    let e: Vec<f64> = record.y.iter().zip(&run.y).map(|(y, s)| y - s).collect();
    let start = e.iter().position(|e| *e != 0.0)?;
    Some(Residuals { e: e[start..].to_vec(), v: &record.v[start..] })
}

/// Residuals of the prediction one step ahead.
fn ahead<'a>(run: &Residuals<'a>, a: &[f64]) -> Residuals<'a> {
    let from = a.len().min(run.e.len());
    let past = |t: usize| a.iter().enumerate().map(|(i, a)| a * run.e[t - 1 - i]).sum::<f64>();
    Residuals { e: (from..run.e.len()).map(|t| run.e[t] + past(t)).collect(), v: &run.v[from..] }
}

fn own(residuals: &[Residuals<'_>], samples: usize) -> Chart {
    let pairs: Vec<(&[f64], &[f64])> = residuals.iter().map(|r| (&r.e[..], &r.e[..])).collect();
    let lags: Vec<isize> = (0..=LAGS).collect();
    let bound = Z95 / (samples as f64).sqrt();
    stems("Autocorrelation of the residuals", &lags, &correlation(&pairs, &lags), bound)
}

fn with_input(residuals: &[Residuals<'_>], samples: usize) -> Chart {
    let lags: Vec<isize> = (-LAGS..=LAGS).collect();
    let pairs: Vec<(&[f64], &[f64])> = residuals.iter().map(|r| (r.v, &r.e[..])).collect();
    // Ljung (1999), §16.6: the variance is Σ r_e(k) r_v(k) / N, which is 1/N where one of both is white.
    let of = |pick: fn(&Residuals<'_>) -> Vec<f64>| -> Vec<f64> {
        let all: Vec<Vec<f64>> = residuals.iter().map(pick).collect();
        correlation(&all.iter().map(|x| (&x[..], &x[..])).collect::<Vec<_>>(), &lags)
    };
    let (own, input) = (of(|r| r.e.clone()), of(|r| r.v.to_vec()));
    let sum: f64 = own.iter().zip(&input).map(|(e, v)| e * v).sum();
    let bound = Z95 * (sum.max(1.0) / samples as f64).sqrt();
    stems("Correlation of the residuals with the input v", &lags, &correlation(&pairs, &lags), bound)
}

fn stems(title: &str, lags: &[isize], values: &[f64], bound: f64) -> Chart {
    let x = |lag: &isize| *lag as f64;
    let points: Vec<(f64, f64)> = lags.iter().map(x).zip(values.iter().copied()).collect();
    let outside = points.iter().filter(|(lag, r)| *lag != 0.0 && r.abs() > bound).count();
    let (first, last) = (x(&lags[0]) - 0.5, x(&lags[lags.len() - 1]) + 0.5);
    let far = (f64::NAN, f64::NAN);
    let bounds = vec![(first, bound), (last, bound), far, (first, -bound), (last, -bound)];
    let most = values.iter().map(|r| r.abs()).fold(2.0 * bound, f64::max);
    let counted = lags.iter().filter(|lag| **lag != 0).count();
    Chart {
        title: title.to_owned(),
        note: format!("{outside} of {counted} lags are outside the 95 % bounds"),
        x: Scale::linear("lag [samples]", [first, last]),
        y: Scale::linear(
            "correlation",
            if lags[0] == 0 { vec![-2.0 * bound, most] } else { vec![-most, most] },
        ),
        layers: vec![
            Layer::new("95 % bounds of noise", Ink::Green, Shape::Dashes(bounds)),
            Layer::new("correlation", Ink::Blue, Shape::Stems(points)),
        ],
        reading: Reading::Along,
        size: HALF,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_step_residuals_of_a_first_order_model_are_its_equation_error() {
        // e(t) = 0.5 e(t−1) + w(t).
        let w = [1.0, -2.0, 0.5, 0.25];
        let mut e = vec![0.0; 4];
        (0..4).for_each(|t| e[t] = w[t] + if t > 0 { 0.5 * e[t - 1] } else { 0.0 });
        let run = Residuals { e, v: &[1.0, 2.0, 3.0, 4.0] };
        let step = ahead(&run, &[-0.5]);
        assert_eq!(step.e, w[1..]);
        assert_eq!(step.v, [2.0, 3.0, 4.0]);
    }
}
