//! Correlation of the residuals with their own past and with the input.

use crate::plots::axis::Axis;
use crate::plots::canvas::{Canvas, Dash};
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::{Mark, Reading};
use crate::plots::sheet::{Frames, Grid, Sheet};
use crate::plots::style::{GREY, OKABE_ITO, Pen, SMALL_RADIUS, rounded};
use switchback_identify::statistics::{Whiteness, Z95, correlation};
use switchback_io::identification::json::EstimateFile;
use switchback_io::model::{RecordSeries, Series};

/// Lags drawn.
const LAGS: isize = 30;
const CORRELATION: &str = "correlation";
const BOUNDS: &str = "95 % bounds of noise";

/// Residuals of one record with its input.
struct Residuals<'a> {
    e: Vec<f64>,
    v: &'a [f64],
}

/// Both correlations with their bounds, over the records that were fitted; none where these are too short.
pub(crate) fn correlations(estimate: &EstimateFile, series: &Series) -> Option<String> {
    let runs: Vec<Residuals<'_>> =
        series.records.iter().filter(|r| r.usage == "fit").filter_map(free_run).collect();
    let one_step: Vec<Residuals<'_>> = runs.iter().map(|run| ahead(run, &estimate.a)).collect();
    let forecast = |of: &[Residuals<'_>]| {
        Whiteness::of(&of.iter().map(|r| &r.e[..]).collect::<Vec<_>>()).map(|w| w.forecast)
    };
    // As the program does where it warns of colour: noise may enter before or behind the linear part, and neither is a fault of the model.
    let is_output_error = forecast(&runs).zip(forecast(&one_step)).is_some_and(|(run, step)| run < step);
    let (name, residuals) = match is_output_error {
        true => ("y − ŷ of the free run", &runs),
        false => ("A(q⁻¹)(y − ŷ), one step ahead", &one_step),
    };
    let samples: usize = residuals.iter().map(|r| r.e.len()).sum();
    if samples <= 2 * LAGS as usize {
        return None;
    }
    let stems = [own(residuals, samples), with_input(residuals, samples)];
    let mut sheet = Sheet::new(
        "Correlations of the residuals",
        vec![format!(
            "Residuals: {name}, over {samples} samples that were fitted. Where noise is all that is left, one lag in twenty lies outside the \
             bounds. {} and {} do.",
            stems[0].outside(),
            stems[1].outside()
        )],
        Grid { between: 88.0, ..Grid::new(1, 2, 280.0) },
    );
    sheet.legend = vec![
        Entry::disc(OKABE_ITO[0], CORRELATION).hiding(CORRELATION),
        Entry::new(Sample::Dashes(Pen::data(GREY), Dash::Dots), BOUNDS).hiding(BOUNDS),
    ];
    Some(sheet.render(|canvas, frames| {
        stems.iter().enumerate().for_each(|(column, stems)| stems.draw(canvas, frames, column));
    }))
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

fn own(residuals: &[Residuals<'_>], samples: usize) -> Stems {
    let pairs: Vec<(&[f64], &[f64])> = residuals.iter().map(|r| (&r.e[..], &r.e[..])).collect();
    let lags: Vec<isize> = (0..=LAGS).collect();
    let bound = Z95 / (samples as f64).sqrt();
    Stems { title: "Autocorrelation", values: correlation(&pairs, &lags), lags, bound }
}

fn with_input(residuals: &[Residuals<'_>], samples: usize) -> Stems {
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
    Stems { title: "With the input v", values: correlation(&pairs, &lags), lags, bound }
}

/// Correlations by lag, and the bounds of noise.
struct Stems {
    title: &'static str,
    lags: Vec<isize>,
    values: Vec<f64>,
    bound: f64,
}

impl Stems {
    /// `3 of 30`: lags outside the bounds.
    fn outside(&self) -> String {
        let other = || self.lags.iter().zip(&self.values).filter(|(lag, _)| **lag != 0);
        format!("{} of {}", other().filter(|(_, r)| r.abs() > self.bound).count(), other().count())
    }

    fn draw(&self, canvas: &Canvas, frames: &Frames, column: usize) {
        let ends = [self.lags[0] as f64 - 0.5, self.lags[self.lags.len() - 1] as f64 + 0.5];
        let most = self.values.iter().map(|r| r.abs()).fold(2.0 * self.bound, f64::max);
        let least = if self.lags[0] == 0 { -2.0 * self.bound } else { -most };
        let reading = Reading { x: "lag [samples]", y: CORRELATION, zooms: false };
        let axes = (Axis::linear(ends), Axis::linear([least, most]));
        let panel = frames.readable(canvas, (0, column), axes, reading);
        panel.title(self.title);
        panel.level(0.0, None, Pen::hair(GREY));
        panel.series(BOUNDS, || {
            let bounds = [self.bound, -self.bound];
            bounds.into_iter().for_each(|y| panel.level(y, Some(Dash::Dots), Pen::data(GREY)));
        });
        let pen = Pen::data(OKABE_ITO[0]);
        panel.series(CORRELATION, || {
            for (lag, r) in self.lags.iter().map(|lag| *lag as f64).zip(self.values.iter().copied()) {
                panel.line(&[(lag, 0.0), (lag, r)], pen);
                panel.point(lag, r, Mark::disc(pen, SMALL_RADIUS));
                let text = format!("lag {}: {}", rounded(lag, 4), rounded(r, 3));
                panel.hint((lag, r), SMALL_RADIUS, &text);
            }
        });
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
