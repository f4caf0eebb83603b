//! The linear part: Bode diagram, step response, poles and zeros, with what the errors of the coefficients make of them.

use crate::pages::Z95;
use crate::pages::chart::{Chart, HALF, Ink, Layer, Mark, Reading, SQUARE, Scale, Shape};
use crate::pages::table::{Cell, Table};
use maud::{Markup, html};
use std::f64::consts::{PI, TAU};
use switchback_io::diagnosis::digits;
use switchback_io::identification::json::EstimateFile;
use switchback_io::identification::unit;
use switchback_io::model::ModelFile;
use switchback_model::linear::{
    filter, frequency_response, is_stable, roots, settling_samples, spectral_radius,
};

/// Frequencies of a Bode diagram.
const FREQUENCIES: usize = 160;
/// Samples of a step response at least and at most.
const STEP: (usize, usize) = (20, 600);

/// A figure and, where it is known, the standard error of each of its values.
type Figure = (Vec<f64>, Option<Vec<f64>>);

struct Linear<'a> {
    estimate: &'a EstimateFile,
    model: Option<&'a ModelFile>,
}

/// Four figures and a table.
pub(super) fn linear(estimate: &EstimateFile, model: Option<&ModelFile>) -> Markup {
    let linear = Linear { estimate, model };
    if !estimate.a.iter().chain(&estimate.b).all(|x| x.is_finite()) || estimate.b.is_empty() {
        return html! { p { "The coefficients are not known." } };
    }
    let has_bands = linear.of(|a, _| a.to_vec()).1.is_some();
    html! {
        div class="charts" {
            (linear.magnitude().html())
            (linear.phase().html())
            (linear.step().html())
            (linear.roots_chart().html())
        }
        (linear.root_table().html())
        p class="note" {
            "From u, which runs from u_m to u_m + 1, to the output. "
            @if has_bands { "Bands and intervals are pointwise, 95 %, from the covariance of the coefficients by linear propagation." }
            @else { "There are no bands: the covariance of the coefficients is not known." }
        }
    }
}

impl Linear<'_> {
    /// A figure of `(a, b)` with its errors.
    fn of(&self, of: impl Fn(&[f64], &[f64]) -> Vec<f64>) -> Figure {
        match self.model {
            Some(model) => model.system.of_linear(of),
            None => (of(&self.estimate.a, &self.estimate.b), None),
        }
    }

    /// Radians a sample, from well below the slowest pole to half the sampling rate.
    fn omegas(&self) -> Vec<f64> {
        let slowest = spectral_radius(&self.estimate.a).clamp(1e-6, 1.0 - 1e-6);
        let low = (-slowest.ln() / 30.0).clamp(1e-6, 0.03);
        (0..FREQUENCIES).map(|k| low * (PI / low).powf(k as f64 / (FREQUENCIES - 1) as f64)).collect()
    }

    fn hertz(&self, omega: f64) -> f64 {
        omega / (TAU * self.estimate.sample_time)
    }

    fn magnitude(&self) -> Chart {
        let (omegas, delay) = (self.omegas(), self.estimate.delay);
        let figure = self.of(|a, b| {
            omegas.iter().map(|w| 20.0 * frequency_response(a, b, delay, *w).norm().log10()).collect()
        });
        let unit = unit(&self.estimate.output);
        let name = if unit.is_empty() { "gain [dB]".to_owned() } else { format!("gain [dB of 1 {unit}]") };
        self.over_frequency("Bode diagram, gain", name, &omegas, figure)
    }

    fn phase(&self) -> Chart {
        let (omegas, delay) = (self.omegas(), self.estimate.delay);
        let figure =
            self.of(|a, b| unwrapped(omegas.iter().map(|w| frequency_response(a, b, delay, *w).arg())));
        self.over_frequency("Bode diagram, phase", "phase [°]".to_owned(), &omegas, figure)
    }

    fn over_frequency(&self, title: &str, name: String, omegas: &[f64], figure: Figure) -> Chart {
        let x: Vec<f64> = omegas.iter().map(|w| self.hertz(*w)).collect();
        let scale = Scale::logarithmic("frequency [Hz]", x.iter().copied());
        banded(title, (scale, name), &x, figure)
    }

    fn step(&self) -> Chart {
        let (a, delay) = (&self.estimate.a, self.estimate.delay);
        let settled = if is_stable(a) { settling_samples(a, 1e-3) } else { STEP.1 };
        let length = (settled + settled / 5 + delay.unsigned_abs()).clamp(STEP.0, STEP.1);
        let figure = self.of(|a, b| step(a, b, delay, length));
        let x: Vec<f64> = (0..length).map(|t| t as f64 * self.estimate.sample_time).collect();
        banded(
            "Step response",
            (Scale::linear("time [s]", x.iter().copied()), self.estimate.output.clone()),
            &x,
            figure,
        )
    }

    /// Poles and zeros with the errors of their real and imaginary parts.
    fn roots(&self) -> [Vec<Root>; 2] {
        let poles = self.of(|a, _| flat(&roots(&[&[1.0], a].concat())));
        let zeros = self.of(|_, b| flat(&roots(b)));
        // A root keeps its place in the list while its parameters move a thousandth of their errors; two that meet do not, and their
        // errors mean nothing.
        [poles, zeros].map(|(values, errors)| {
            let pair = |k: usize, of: &[f64]| (of[2 * k], of[2 * k + 1]);
            (0..values.len() / 2)
                .map(|k| Root { at: pair(k, &values), se: errors.as_ref().map(|e| pair(k, e)) })
                .collect()
        })
    }

    fn roots_chart(&self) -> Chart {
        let [poles, zeros] = self.roots();
        let circle: Vec<(f64, f64)> =
            (0..=180).map(|k| TAU * f64::from(k) / 180.0).map(|t| (t.cos(), t.sin())).collect();
        // Zeros far outside tell little, and would make the circle a dot.
        let near = |x: f64| x.clamp(-2.5, 2.5);
        let mark = |name: &str, root: &Root| Mark {
            at: (near(root.at.0), near(root.at.1)),
            ends: None,
            told: format!("{name} {}", root.told()),
        };
        let all: Vec<&Root> = poles.iter().chain(&zeros).collect();
        let reach = |of: fn(&Root) -> f64| {
            all.iter().map(move |r| near(of(r))).chain([-1.0, 1.0]).collect::<Vec<_>>()
        };
        let mut layers = vec![Layer::new("unit circle", Ink::Grey, Shape::Line(circle))];
        for (name, ink, roots) in [("pole", Ink::Orange, &poles), ("zero", Ink::Blue, &zeros)] {
            let marks: Vec<Mark> = roots.iter().map(|root| mark(name, root)).collect();
            if !marks.is_empty() {
                let shape = if name == "pole" { Shape::Crosses(marks) } else { Shape::Marks(marks) };
                layers.push(Layer::new(format!("{name}s"), ink, shape));
            }
        }
        Chart {
            title: "Poles and zeros".to_owned(),
            note: "Of z; what lies beyond 2.5 is drawn there".to_owned(),
            x: Scale::linear("real part", reach(|r| r.at.0)),
            y: Scale::linear("imaginary part", reach(|r| r.at.1)),
            layers,
            reading: Reading::Nearest,
            size: SQUARE,
        }
    }

    fn root_table(&self) -> Table {
        let mut table = Table::new(
            "Poles and zeros",
            ["root", "real part", "imaginary part", "modulus", "time constant [s]", "frequency [Hz]"],
        );
        for (name, roots) in ["pole", "zero"].into_iter().zip(self.roots()) {
            for root in roots {
                let (re, im) = root.at;
                let modulus = re.hypot(im);
                let decay =
                    (modulus > 0.0 && modulus < 1.0).then(|| -self.estimate.sample_time / modulus.ln());
                let turns = self.hertz(im.atan2(re).abs());
                let se = |of: fn((f64, f64)) -> f64| root.se.map(of);
                table.row([
                    Cell::word(name),
                    Cell::number(with_error(re, se(|s| s.0)), Some(re)),
                    Cell::number(with_error(im, se(|s| s.1)), Some(im)),
                    Cell::number(digits(modulus, 4), Some(modulus)),
                    Cell::number(decay.map_or_else(|| "–".to_owned(), |d| digits(d, 3)), decay),
                    Cell::number(digits(turns, 3), Some(turns)),
                ]);
            }
        }
        table
    }
}

struct Root {
    at: (f64, f64),
    se: Option<(f64, f64)>,
}

impl Root {
    fn told(&self) -> String {
        let (re, im) = self.at;
        let imaginary = if im == 0.0 {
            String::new()
        } else {
            format!("\nimaginary part {}", with_error(im, self.se.map(|s| s.1)))
        };
        format!("{}{imaginary}", with_error(re, self.se.map(|s| s.0)))
    }
}

fn with_error(value: f64, se: Option<f64>) -> String {
    let half = se.filter(|se| se.is_finite() && *se > 0.0).map(|se| format!(" ± {}", digits(Z95 * se, 2)));
    format!("{}{}", digits(value, 4), half.unwrap_or_default())
}

fn flat(roots: &[nalgebra::Complex<f64>]) -> Vec<f64> {
    roots.iter().flat_map(|root| [root.re, root.im]).collect()
}

/// Response to a step of `u` from `u_m` to `u_m + 1` at time zero.
fn step(a: &[f64], b: &[f64], delay: isize, length: usize) -> Vec<f64> {
    let y = filter(a, b, &vec![1.0; length + delay.min(0).unsigned_abs()], &[], 0.0, 0.0);
    let at = |t: isize| usize::try_from(t).ok().and_then(|t| y.get(t).copied()).unwrap_or(0.0);
    (0..length as isize).map(|t| at(t - delay)).collect()
}

/// Angles in degrees without jumps of a turn.
fn unwrapped(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut before: Option<f64> = None;
    let mut turned = |angle: f64| {
        let angle = before.map_or(angle, |before| angle + TAU * ((before - angle) / TAU).round());
        before = Some(angle);
        angle.to_degrees()
    };
    angles.map(&mut turned).collect()
}

/// A line with its band.
fn banded(title: &str, (x_scale, y_name): (Scale, String), x: &[f64], (values, errors): Figure) -> Chart {
    let mut layers = Vec::new();
    let mut shown = values.clone();
    if let Some(errors) = &errors {
        let ends = |k: usize| (values[k] - Z95 * errors[k], values[k] + Z95 * errors[k]);
        let band: Vec<(f64, f64, f64)> = (0..x.len()).map(|k| (x[k], ends(k).0, ends(k).1)).collect();
        let (low, high) = range(&values);
        // An error without bounds must not flatten the curve.
        let reach = (high - low).max(1e-12);
        shown.extend(band.iter().flat_map(|b| [b.1, b.2]).map(|y| y.clamp(low - reach, high + reach)));
        layers.push(Layer::new("95 % band", Ink::Blue, Shape::Band(band)));
    }
    let line = x.iter().copied().zip(values.iter().copied()).collect();
    layers.push(Layer::new("estimate", Ink::Blue, Shape::Line(line)));
    Chart {
        title: title.to_owned(),
        note: String::new(),
        x: x_scale,
        y: Scale::linear(y_name, shown),
        layers,
        reading: Reading::Along,
        size: HALF,
    }
}

fn range(values: &[f64]) -> (f64, f64) {
    let finite = values.iter().filter(|x| x.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_comes_as_late_as_the_delay_says() {
        // 1 − 0.5ᵗ, one sample late.
        assert_eq!(step(&[-0.5], &[0.5], 0, 4), [0.0, 0.5, 0.75, 0.875]);
        assert_eq!(step(&[-0.5], &[0.5], 2, 4), [0.0, 0.0, 0.0, 0.5]);
        assert_eq!(step(&[-0.5], &[0.5, 0.0], -1, 3), [0.5, 0.75, 0.875]);
    }

    #[test]
    fn a_phase_has_no_jumps() {
        let lag = unwrapped((0..100).map(|k| (-0.2 * f64::from(k)).sin().atan2((-0.2 * f64::from(k)).cos())));
        assert!((lag[99] - (-0.2f64 * 99.0).to_degrees()).abs() < 1e-9);
    }
}
