//! Where the gap lies: excess energy of the one-step residuals over cells of several axes.

use statrs::distribution::{ContinuousCDF, Normal};
use switchback_model::energy::{Blocks, Portion, false_discovery_rates, portions};

use crate::diagnosis::{Cell, CellInterval, CellUnit};
use crate::likelihood::engine::Fit;
use crate::records::dataset::Dataset;
use crate::records::motion::Motion;
use crate::residuals::score::innovations;

/// Residual and circumstances of one sample.
struct Sample {
    record: usize,
    motion: Motion,
    v: f64,
    y: f64,
    time: f64,
    excess: f64,
}

/// Residuals of a model on all records, dimensionless.
#[derive(Debug, Clone)]
pub(crate) struct Residuals {
    /// One series a record, from its first counted sample; empty where nothing is known of it.
    pub(crate) series: Vec<Vec<f64>>,
    /// Whether they are errors of a simulation: as slow as the input, wherever they come from.
    pub(crate) simulated: bool,
}

impl Residuals {
    /// Those of a model as the dataset judges it.
    pub(crate) fn of(dataset: &Dataset, fit: &Fit) -> Self {
        Self { series: innovations(dataset, fit, |_| true), simulated: dataset.criterion.simulates() }
    }
}

/// Samples of one block; the square of a normal deviate of variance one has variance two.
const BLOCKS: Blocks = Blocks { length: 25, variance: 2.0 };
/// Samples that a cell must hold.
const FEWEST: usize = 10;

/// Probability that a standard normal deviate is larger.
fn upper_tail(deviate: f64) -> f64 {
    Normal::standard().sf(deviate)
}

/// The map of residuals over a noise floor `variance`.
///
/// Two questions a cell: whether there is energy beyond the floor, `w²/σ² − 1` summed, and whether it is denser there than elsewhere
/// ([`portions`]). q-values are Benjamini–Hochberg over all cells of all axes, for each question by itself.
pub(crate) fn localise(dataset: &Dataset, residuals: &Residuals, variance: f64) -> Vec<Cell> {
    let mut map = Map { samples: samples(dataset, residuals, variance), cells: Vec::new() };
    map.kinds("record", dataset.scaled_records.iter().map(|t| t.name.clone()), |s| s.record);
    let branches = ["descending", "ascending", "holding"].map(String::from);
    map.kinds("branch", branches.into_iter(), |s| {
        if s.motion.step == 0.0 { 2 } else { usize::from(s.motion.branch > 0.0) }
    });
    let stroke = Scale { unit: CellUnit::Input, zero: 0.0, one: dataset.v_width };
    let tenths: Vec<f64> = (0..=10).map(|i| i as f64 / 10.0).collect();
    map.intervals("v", &tenths, Scale { zero: dataset.v_low, ..stroke }, |s| s.v);
    let since = [0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, f64::INFINITY];
    map.intervals("rest_samples", &since, Scale::plain(CellUnit::Samples), |s| s.motion.rest as f64);
    let travel = [0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8, f64::INFINITY];
    map.intervals("travel_since_reversal", &travel, stroke, |s| s.motion.travel);
    let sizes = [0.0, 0.1, 0.2, 0.4, 0.6, 0.8, f64::INFINITY];
    map.intervals("loop_size", &sizes, stroke, |s| s.motion.loop_size);
    // A rest has no speed.
    let speeds = [1e-12, 0.01, 0.02, 0.05, 0.1, 0.2, f64::INFINITY];
    let per_second = dataset.v_width / dataset.sample_time;
    let scale = Scale { unit: CellUnit::InputPerSecond, one: per_second, ..stroke };
    map.intervals("speed", &speeds, scale, |s| s.motion.step.abs());
    map.intervals("time", &tenths, Scale::plain(CellUnit::ShareOfDataset), |s| s.time);
    let outputs = [f64::NEG_INFINITY, -1.5, -0.75, 0.0, 0.75, 1.5, f64::INFINITY];
    let scale = Scale { unit: CellUnit::Output, zero: dataset.y_mean, one: dataset.y_scale };
    map.intervals("y", &outputs, scale, |s| s.y);
    if !residuals.simulated {
        map.cells.extend(spectrum_cells(&residuals.series, variance, dataset.sample_time));
    }
    map.judged()
}

/// The counted samples, with their energy beyond the floor.
fn samples(dataset: &Dataset, residuals: &Residuals, variance: f64) -> Vec<Sample> {
    let mut samples = Vec::new();
    for (record, (scaled, w)) in dataset.scaled_records.iter().zip(&residuals.series).enumerate() {
        for (k, w) in w.iter().enumerate() {
            // The innovation at t answers to the input one sample before.
            let t = scaled.from + k - 1;
            samples.push(Sample {
                record,
                motion: scaled.moves[t],
                v: scaled.v[t],
                y: scaled.y[t],
                time: (scaled.clock + t) as f64 / dataset.total as f64,
                excess: w * w / variance - 1.0,
            });
        }
    }
    samples
}

/// From the map's own axis to that of the user.
#[derive(Debug, Clone, Copy)]
struct Scale {
    unit: CellUnit,
    /// What zero and the distance from zero to one are there.
    zero: f64,
    one: f64,
}

impl Scale {
    fn plain(unit: CellUnit) -> Self {
        Self { unit, zero: 0.0, one: 1.0 }
    }

    fn of(self, x: f64) -> f64 {
        self.zero + self.one * x
    }
}

/// A cell that has not been judged among all others.
struct Found {
    axis: &'static str,
    cell: String,
    interval: Option<CellInterval>,
    portion: Portion,
}

/// A map running.
struct Map {
    samples: Vec<Sample>,
    cells: Vec<Found>,
}

impl Map {
    /// Adds the cells of an axis of kinds.
    fn kinds(
        &mut self,
        axis: &'static str,
        names: impl Iterator<Item = String>,
        cell_of: impl Fn(&Sample) -> usize,
    ) {
        let names: Vec<(String, Option<CellInterval>)> = names.map(|name| (name, None)).collect();
        self.add(axis, names, |s| Some(cell_of(s)));
    }

    /// Adds the cells of an axis of intervals, given by their edges; what lies below the first edge is in none.
    fn intervals(
        &mut self,
        axis: &'static str,
        edges: &[f64],
        scale: Scale,
        property: impl Fn(&Sample) -> f64,
    ) {
        // An edge that only keeps zero out is zero for the user.
        let reported = |x: &f64| if *x < 1e-9 && *x > 0.0 { scale.of(0.0) } else { scale.of(*x) };
        let names = labels(&edges.iter().map(reported).collect::<Vec<_>>(), scale.unit);
        self.add(axis, names, |s| bin(edges, property(s)));
    }

    fn add(
        &mut self,
        axis: &'static str,
        names: Vec<(String, Option<CellInterval>)>,
        cell_of: impl Fn(&Sample) -> Option<usize>,
    ) {
        let samples: Vec<(f64, Option<usize>)> =
            self.samples.iter().map(|s| (s.excess, cell_of(s))).collect();
        let found = names.iter().zip(portions(&samples, names.len(), BLOCKS));
        let found = found.filter(|(_, portion)| portion.count >= FEWEST);
        self.cells.extend(found.map(|((cell, interval), portion)| Found {
            axis,
            cell: cell.clone(),
            interval: *interval,
            portion,
        }));
    }

    /// The cells, each judged among all.
    fn judged(self) -> Vec<Cell> {
        let rates = |p: fn(&Portion) -> f64| {
            false_discovery_rates(&self.cells.iter().map(|found| p(&found.portion)).collect::<Vec<_>>())
        };
        let (excess, density) = (rates(|p| upper_tail(p.excess)), rates(|p| upper_tail(p.density)));
        let judged = self.cells.into_iter().zip(excess).zip(density);
        let cell = |((found, q_value), enrichment_q_value): ((Found, f64), f64)| Cell {
            axis: found.axis,
            cell: found.cell,
            interval: found.interval,
            share: found.portion.share,
            exposure: found.portion.exposure,
            enrichment: found.portion.share / found.portion.exposure,
            q_value,
            enrichment_q_value,
        };
        judged.map(cell).collect()
    }
}

/// Cells by their edges, with as many decimals as distinguish the closest edges.
fn labels(edges: &[f64], unit: CellUnit) -> Vec<(String, Option<CellInterval>)> {
    let widths = edges.windows(2).map(|w| w[1] - w[0]);
    let narrowest = widths.filter(|x| *x > 0.0 && x.is_finite()).fold(f64::INFINITY, f64::min);
    let decimals = match narrowest.is_finite() {
        true => (3.0 - narrowest.log10().floor()).clamp(4.0, 300.0) as usize,
        false => 4,
    };
    // Far from 1 the digits before or behind the point would be hundreds.
    let reported = |x: f64| match format!("{x:.decimals$}") {
        long if long.len() > 60 => format!("{x:.16e}"),
        text => text,
    };
    // Label and figures say the same.
    let figure = |x: f64| reported(x).parse().unwrap_or(x);
    let cell = |w: &[f64]| {
        let interval = CellInterval { low: figure(w[0]), high: figure(w[1]), unit };
        (format!("{}..{}", reported(w[0]), reported(w[1])), Some(interval))
    };
    edges.windows(2).map(cell).collect()
}

fn bin(edges: &[f64], x: f64) -> Option<usize> {
    let at = edges.partition_point(|e| *e <= x);
    (at > 0).then(|| (at - 1).min(edges.len() - 2))
}

/// Excess power of the residuals by frequency.
///
/// A periodogram's ordinates are independent and exponential: of variance one where their mean is one.
fn spectrum_cells(innovations: &[Vec<f64>], variance: f64, sample_time: f64) -> Vec<Found> {
    const SEGMENT: usize = 256;
    const BANDS: usize = 8;
    let mut ordinates = Vec::new();
    for segment in innovations.iter().flat_map(|w| w.chunks_exact(SEGMENT)) {
        let power = switchback_model::spectrum::power(segment, SEGMENT);
        let used = power.iter().enumerate().skip(1).take(SEGMENT / 2 - 1);
        ordinates.extend(
            used.map(|(k, p)| (p / (SEGMENT as f64 * variance) - 1.0, Some(k * BANDS / (SEGMENT / 2)))),
        );
    }
    if ordinates.is_empty() {
        return Vec::new();
    }
    let segments = (ordinates.len() / (SEGMENT / 2 - 1)) as f64;
    let edges: Vec<f64> = (0..=BANDS).map(|k| 0.5 * k as f64 / BANDS as f64 / sample_time).collect();
    let bands = portions(&ordinates, BANDS, Blocks { length: SEGMENT / 2 - 1, variance: 1.0 });
    let found = |(band, ((cell, interval), portion)): (usize, ((String, Option<CellInterval>), Portion))| {
        let energy: f64 = ordinates.iter().filter(|o| o.1 == Some(band)).map(|o| o.0).sum();
        // White noise shows the bands' variance; segments are too few to do so.
        let excess = energy / (segments * (SEGMENT / 2 / BANDS) as f64).sqrt();
        Found {
            axis: "frequency",
            cell,
            interval,
            portion: Portion { excess, exposure: 1.0 / BANDS as f64, ..portion },
        }
    };
    labels(&edges, CellUnit::Hertz).into_iter().zip(bands).enumerate().map(found).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_close_together_are_distinguished() {
        let labels =
            |edges: &[f64]| labels(edges, CellUnit::Input).into_iter().map(|l| l.0).collect::<Vec<_>>();
        assert_eq!(labels(&[0.0, 0.1, 0.25]), ["0.0000..0.1000", "0.1000..0.2500"]);
        let close = labels(&[0.5, 0.500_001, 0.500_002, 0.500_004]);
        assert!(close.windows(2).all(|w| w[0] != w[1]));
        assert_eq!(labels(&[1.0, 1.0]), ["1.0000..1.0000"]);
    }

    #[test]
    fn a_label_and_its_figures_say_the_same() {
        let [(label, Some(interval))] = &labels(&[-0.2, 1.0 / 3.0], CellUnit::Output)[..] else {
            panic!("one cell")
        };
        assert_eq!(*label, format!("{:.4}..{:.4}", interval.low, interval.high));
        assert_eq!((interval.low, interval.high), (-0.2, 0.3333));
        let [_, (open, Some(interval))] = &labels(&[0.0, 1.0, f64::INFINITY], CellUnit::Input)[..] else {
            panic!("two cells")
        };
        assert_eq!((open.as_str(), interval.high), ("1.0000..inf", f64::INFINITY));
    }
}
