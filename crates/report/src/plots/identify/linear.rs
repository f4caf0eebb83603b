//! The linear part: Bode diagram, step response, poles and zeros, with their 95 % intervals.

use super::linear_part::{Curve, LinearPart, Root};
use crate::plots::axis::Axis;
use crate::plots::canvas::Canvas;
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::{Mark, Reading};
use crate::plots::sheet::{Frames, Grid, Sheet};
use crate::plots::style::{AFTER, BEFORE, GREY, PALE, Pen, RADIUS, Shape, tint};
use std::f64::consts::TAU;
use switchback_identify::statistics::Z95;
use switchback_io::diagnosis::digits;
use switchback_io::identification::unit;

const HEIGHT: f64 = 270.0;
/// Roots beyond are drawn there: zeros far outside show little, and would make the unit circle a dot.
const FAR: f64 = 2.5;
const ESTIMATE: &str = "estimate";
const BAND: &str = "95 % band";

/// Four diagrams.
pub(crate) fn linear(part: &LinearPart<'_>) -> String {
    let note = format!("Poles and zeros are those of z; those beyond {FAR} are drawn there.");
    let mut sheet = Sheet::new(
        format!("{}: the linear part", part.estimate.rig),
        vec![note],
        Grid { between: 92.0, apart: 96.0, ..Grid::new(2, 2, HEIGHT) },
    );
    sheet.legend = vec![Entry::line(AFTER, ESTIMATE).hiding(ESTIMATE)];
    if part.has_errors() {
        sheet.legend.push(Entry::patch(tint(AFTER, PALE), BAND).hiding(BAND));
    }
    let roots = part.roots();
    for (look, _) in ROOTS.iter().zip(&roots).filter(|(_, found)| !found.is_empty()) {
        let sample = Sample::Mark(look.shape, look.pen, true);
        sheet.legend.push(Entry::new(sample, look.key).hiding(look.key));
    }
    let unit = unit(&part.estimate.output);
    let gain = if unit.is_empty() { "gain [dB]".to_owned() } else { format!("gain [dB of 1 {unit}]") };
    sheet.render(|canvas, frames| {
        let frequency = "frequency [Hz]";
        banded(canvas, frames, ((0, 0), "Bode diagram, gain"), (frequency, &gain), &part.gain());
        banded(canvas, frames, ((0, 1), "Bode diagram, phase"), (frequency, "phase [°]"), &part.phase());
        banded(canvas, frames, ((1, 0), "Step response"), ("time [s]", &part.estimate.output), &part.step());
        roots_of(canvas, frames, &roots);
    })
}

/// A line with its band; over frequencies the horizontal axis is logarithmic.
fn banded(
    canvas: &Canvas,
    frames: &Frames,
    (place, title): ((usize, usize), &str),
    (x, y): (&str, &str),
    Curve { x: at, values, errors }: &Curve,
) {
    let mut shown = values.clone();
    let band: Option<Vec<(f64, f64, f64)>> = errors.as_ref().map(|errors| {
        let ends = |k: usize| (at[k], values[k] - Z95 * errors[k], values[k] + Z95 * errors[k]);
        (0..at.len()).map(ends).collect()
    });
    let (low, high) = range(values);
    // An error without bounds must not flatten the curve.
    let reach = (high - low).max(1e-12);
    let ends = band.iter().flatten().flat_map(|b| [b.1, b.2]);
    shown.extend(ends.map(|y| y.clamp(low - reach, high + reach)));
    let across = match x.starts_with("frequency") {
        true => Axis::logarithmic(at.iter().copied()),
        false => Axis::linear(at.iter().copied()),
    };
    let reading = Reading { x, y, zooms: false };
    let panel = frames.readable(canvas, place, (across, Axis::linear(shown)), reading);
    panel.title(title);
    if let Some(band) = &band {
        panel.series(BAND, || panel.band(band, tint(AFTER, PALE)));
    }
    let line: Vec<(f64, f64)> = at.iter().copied().zip(values.iter().copied()).collect();
    panel.series(ESTIMATE, || panel.line(&line, Pen::data(AFTER)));
}

fn range(values: &[f64]) -> (f64, f64) {
    let finite = values.iter().filter(|x| x.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
}

/// How roots of a kind are marked.
struct Look {
    key: &'static str,
    shape: Shape,
    pen: Pen,
}

const ROOTS: [Look; 2] = [
    Look { key: "poles", shape: Shape::Cross, pen: Pen::data(BEFORE) },
    Look { key: "zeros", shape: Shape::Disc, pen: Pen::data(AFTER) },
];

fn roots_of(canvas: &Canvas, frames: &Frames, roots: &[Vec<Root>; 2]) {
    let near = |(re, im): (f64, f64)| (re.clamp(-FAR, FAR), im.clamp(-FAR, FAR));
    let places = || roots.iter().flatten().map(|root| near(root.at)).chain([(-1.0, -1.0), (1.0, 1.0)]);
    // The unit circle is as wide as it is high.
    let (width, height) = frames.size();
    let reach = places().map(|(re, im)| (re.abs() * height / width).max(im.abs())).fold(1.0, f64::max) * 1.08;
    let across = reach * width / height;
    let axes = (Axis::between(-across, across), Axis::between(-reach, reach));
    let reading = Reading { x: "real part", y: "imaginary part", zooms: false };
    let panel = frames.readable(canvas, (1, 1), axes, reading);
    panel.title("Poles and zeros");
    let circle: Vec<(f64, f64)> =
        (0..=180).map(|k| TAU * f64::from(k) / 180.0).map(|t| (t.cos(), t.sin())).collect();
    panel.line(&circle, Pen::hair(GREY));
    for (look, found) in ROOTS.iter().zip(roots) {
        panel.series(look.key, || {
            for root in found {
                let (re, im) = near(root.at);
                panel.point(re, im, Mark { shape: look.shape, ..Mark::disc(look.pen, RADIUS) });
                panel.hint((re, im), RADIUS, &in_words(root));
            }
        });
    }
}

fn in_words(root: &Root) -> String {
    let (re, im) = root.at;
    let imaginary = match im == 0.0 {
        true => String::new(),
        false => format!("; imaginary part {}", with_error(im, root.se.map(|s| s.1))),
    };
    format!("{}{imaginary}", with_error(re, root.se.map(|s| s.0)))
}

/// `0.9512 ± 0.0023`: a value with half of its 95 % interval.
pub(crate) fn with_error(value: f64, se: Option<f64>) -> String {
    let half = se.filter(|se| se.is_finite() && *se > 0.0).map(|se| format!(" ± {}", digits(Z95 * se, 2)));
    format!("{}{}", digits(value, 4), half.unwrap_or_default())
}
