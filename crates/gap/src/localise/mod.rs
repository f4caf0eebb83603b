//! Where the gap lies: excess energy of the one-step residuals over cells of several axes.

use statrs::distribution::{ContinuousCDF, Normal};

use crate::diagnosis::Cell;
use crate::likelihood::engine::Fit;
use crate::records::campaign::Campaign;
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
    /// One series a track, from its first counted sample; empty where nothing is known of it.
    pub(crate) series: Vec<Vec<f64>>,
    /// Whether they are errors of a simulation: as slow as the input, wherever they come from.
    pub(crate) simulated: bool,
}

impl Residuals {
    /// Those of a model as the campaign judges it.
    pub(crate) fn of(campaign: &Campaign, fit: &Fit) -> Self {
        Self { series: innovations(campaign, fit, |_| true), simulated: campaign.criterion.simulates() }
    }
}

/// The map of residuals over a noise floor `variance`.
///
/// A cell's statistic is its sum of `w²/σ² − 1` over the standard deviation of that sum, taken from sums over short blocks of
/// time so that neighbours may be dependent, and no smaller than white normal noise gives. q-values are Benjamini–Hochberg
/// over all cells of all axes.
pub(crate) fn localise(campaign: &Campaign, residuals: &Residuals, variance: f64) -> Vec<Cell> {
    let mut samples = Vec::new();
    for (record, (track, w)) in campaign.tracks.iter().zip(&residuals.series).enumerate() {
        let moves = &track.moves;
        for (k, w) in w.iter().enumerate() {
            // The innovation at t answers to the input one sample before.
            let t = track.from + k - 1;
            samples.push(Sample {
                record,
                motion: moves[t],
                v: track.v[t],
                y: track.y[t],
                time: (track.clock + t) as f64 / campaign.total as f64,
                excess: w * w / variance - 1.0,
            });
        }
    }
    let mut cells = Vec::new();
    let names: Vec<String> = campaign.tracks.iter().map(|t| t.name.clone()).collect();
    map(&mut cells, &samples, "record", &names, |s| Some(s.record));
    let branches = ["descending", "ascending", "holding"].map(String::from);
    map(&mut cells, &samples, "branch", &branches, |s| {
        Some(if s.motion.step == 0.0 { 2 } else { usize::from(s.motion.branch > 0.0) })
    });
    let low = campaign.v_low;
    let ends: Vec<f64> = (0..=10).map(|i| i as f64 / 10.0).collect();
    let levels = labels(&ends.iter().map(|e| low + e * campaign.v_width).collect::<Vec<_>>());
    map(&mut cells, &samples, "v", &levels, |s| bin(&ends, s.v));
    let since = [0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, f64::INFINITY];
    map(&mut cells, &samples, "rest_samples", &labels(&since), |s| bin(&since, s.motion.rest as f64));
    let travel = [0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8, f64::INFINITY];
    let scaled: Vec<f64> = travel.iter().map(|x| x * campaign.v_width).collect();
    map(&mut cells, &samples, "travel_since_reversal", &labels(&scaled), |s| bin(&travel, s.motion.travel));
    let sizes = [0.0, 0.1, 0.2, 0.4, 0.6, 0.8, f64::INFINITY];
    let scaled: Vec<f64> = sizes.iter().map(|x| x * campaign.v_width).collect();
    map(&mut cells, &samples, "loop_size", &labels(&scaled), |s| bin(&sizes, s.motion.loop_size));
    let speeds = [1e-12, 0.01, 0.02, 0.05, 0.1, 0.2, f64::INFINITY];
    let scaled: Vec<f64> =
        speeds.iter().map(|x| if *x < 1e-9 { 0.0 } else { x * campaign.v_width }).collect();
    map(&mut cells, &samples, "speed", &labels(&scaled), |s| bin(&speeds, s.motion.step.abs()));
    map(&mut cells, &samples, "time", &labels(&ends), |s| bin(&ends, s.time));
    let outputs = [f64::NEG_INFINITY, -1.5, -0.75, 0.0, 0.75, 1.5, f64::INFINITY];
    let scaled: Vec<f64> = outputs.iter().map(|x| campaign.y_mean + x * campaign.y_scale).collect();
    map(&mut cells, &samples, "y", &labels(&scaled), |s| bin(&outputs, s.y));
    if !residuals.simulated {
        spectrum_cells(&mut cells, &residuals.series, variance);
    }
    control_false_discoveries(&mut cells);
    cells
}

/// Cells by their edges, with as many decimals as tell the closest edges apart.
fn labels(edges: &[f64]) -> Vec<String> {
    let widths = edges.windows(2).map(|w| w[1] - w[0]);
    let narrowest = widths.filter(|x| *x > 0.0 && x.is_finite()).fold(f64::INFINITY, f64::min);
    let decimals = match narrowest.is_finite() {
        true => (3.0 - narrowest.log10().floor()).clamp(4.0, 300.0) as usize,
        false => 4,
    };
    edges.windows(2).map(|w| format!("{:.decimals$}..{:.decimals$}", w[0], w[1])).collect()
}

fn bin(edges: &[f64], x: f64) -> Option<usize> {
    let at = edges.partition_point(|e| *e <= x);
    (at > 0).then(|| (at - 1).min(edges.len() - 2))
}

/// Samples of one block.
const BLOCK: usize = 25;

/// Adds the cells of one axis.
fn map(
    cells: &mut Vec<Cell>,
    samples: &[Sample],
    axis: &'static str,
    names: &[String],
    cell_of: impl Fn(&Sample) -> Option<usize>,
) {
    let mut sums = vec![0.0; names.len()];
    let mut counts = vec![0usize; names.len()];
    let mut spreads = vec![0.0; names.len()];
    for block in samples.chunks(BLOCK) {
        let mut here = vec![(0.0, 0usize); names.len()];
        for s in block {
            if let Some(k) = cell_of(s) {
                here[k].0 += s.excess;
                here[k].1 += 1;
            }
        }
        for (k, (sum, count)) in here.iter().enumerate() {
            sums[k] += sum;
            counts[k] += count;
            spreads[k] += sum * sum;
        }
    }
    let total: f64 = sums.iter().filter(|s| **s > 0.0).sum::<f64>().max(1e-12);
    for (k, name) in names.iter().enumerate() {
        if counts[k] < 10 {
            continue;
        }
        let spread = spreads[k].max(2.0 * counts[k] as f64).sqrt();
        cells.push(Cell {
            axis,
            cell: name.clone(),
            share: sums[k].max(0.0) / total,
            q_value: upper_tail(sums[k] / spread),
        });
    }
}

/// Excess power of the residuals by frequency, cycles per sample.
fn spectrum_cells(cells: &mut Vec<Cell>, innovations: &[Vec<f64>], variance: f64) {
    const SEGMENT: usize = 256;
    const BANDS: usize = 8;
    let mut sums = [0.0; BANDS];
    let mut count = 0.0;
    for segment in innovations.iter().flat_map(|w| w.chunks_exact(SEGMENT)) {
        let power = crate::residuals::spectrum::power(segment, SEGMENT);
        for (k, p) in power.iter().enumerate().skip(1).take(SEGMENT / 2 - 1) {
            sums[k * BANDS / (SEGMENT / 2)] += p / (SEGMENT as f64 * variance) - 1.0;
        }
        count += 1.0;
    }
    if count < 1.0 {
        return;
    }
    let total: f64 = sums.iter().filter(|s| **s > 0.0).sum::<f64>().max(1e-12);
    let ordinates = count * (SEGMENT / 2 / BANDS) as f64;
    for (band, sum) in sums.iter().enumerate() {
        let edge = |k: usize| k as f64 * 0.5 / BANDS as f64;
        cells.push(Cell {
            axis: "frequency",
            cell: format!("{:.4}..{:.4}", edge(band), edge(band + 1)),
            share: sum.max(0.0) / total,
            q_value: upper_tail(sum / ordinates.sqrt()),
        });
    }
}

fn upper_tail(z: f64) -> f64 {
    Normal::standard().sf(z)
}

/// Benjamini–Hochberg: p-values in `q_value` become q-values.
fn control_false_discoveries(cells: &mut [Cell]) {
    let m = cells.len() as f64;
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by(|&i, &j| cells[j].q_value.total_cmp(&cells[i].q_value));
    let mut least = 1.0_f64;
    for (k, &i) in order.iter().enumerate() {
        least = least.min(cells[i].q_value * m / (m - k as f64));
        cells[i].q_value = least;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The oracle: `min_{j ≥ i} p(j)·m/j` of the ordered p-values (Benjamini and Hochberg, 1995).
    #[test]
    fn q_values_are_the_least_rate_at_which_a_cell_is_found() {
        let cell = |p: f64| Cell { axis: "v", cell: String::new(), share: 0.0, q_value: p };
        let mut cells: Vec<Cell> = [0.02, 0.04, 0.041, 0.005, 0.9].map(cell).into();
        control_false_discoveries(&mut cells);
        let expected = [0.05, 0.051_25, 0.051_25, 0.025, 0.9];
        for (cell, q) in cells.iter().zip(expected) {
            assert!((cell.q_value - q).abs() < 1e-12, "{cells:?}");
        }
    }

    #[test]
    fn cells_close_together_are_told_apart() {
        assert_eq!(labels(&[0.0, 0.1, 0.25]), ["0.0000..0.1000", "0.1000..0.2500"]);
        let close = labels(&[0.5, 0.500_001, 0.500_002, 0.500_004]);
        assert!(close.windows(2).all(|w| w[0] != w[1]));
        assert_eq!(labels(&[1.0, 1.0]), ["1.0000..1.0000"]);
    }
}
