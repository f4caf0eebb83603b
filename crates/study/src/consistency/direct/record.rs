//! Records in the open: the operator, the difference equation and the noise, run sample by sample.

use crate::consistency::cell_design::CellDesign;
use crate::consistency::noise::draw;
use crate::consistency::noise_group::NoiseGroup;
use crate::scenario::{Border, Case, Disturbance};
use switchback_model::linear::filter;
use switchback_noise::{NoiseSamples, StreamId, samples};

/// What is left of a transient when a simulated record begins.
const SETTLED: f64 = 1e-16;

/// The noise of one replicate of a noise group, sample by sample.
#[derive(Debug)]
pub(in crate::consistency) struct OpenNoise {
    pulses: [NoiseSamples; 2],
    /// Means of the step noise, by experiment and number of samples: all that step experiments are used for.
    steps: [Vec<f64>; 2],
}

/// One pulse experiment and the step experiment at its satellite.
#[derive(Debug)]
pub(in crate::consistency) struct OpenRecord {
    /// Samples before `t = 0`, which serve as lags only.
    pub(in crate::consistency) lead: usize,
    /// `v(t)`, `t = −lead…N−1`, `N` the largest of the noise group.
    pub(in crate::consistency) v: Vec<f64>,
    /// `y(t)` of the same `t`.
    pub(in crate::consistency) y: Vec<f64>,
    /// Mean output of the step experiment, one a number of samples of the noise group.
    pub(in crate::consistency) step_means: Vec<f64>,
}

impl OpenNoise {
    pub(in crate::consistency) fn draw(group: &NoiseGroup, seed: u64, replicate: u32) -> Self {
        let plan = &group.noise.pulses;
        let open = |k: usize| {
            let count = plan.checkpoints.last().copied().unwrap_or_default();
            let id = StreamId { seed, experiment: group.noise.stream + k as u32, replicate };
            samples(plan, id, count).expect("a group's noise plan is valid")
        };
        let means = draw(&group.noise, seed, replicate..replicate + 1);
        let steps = |k: usize| (0..plan.checkpoints.len()).map(|c| means[0].step_means(c)[k]).collect();
        Self { pulses: [0, 1].map(open), steps: [0, 1].map(steps) }
    }

    /// Experiment `k` of a setting, `sigma` times the unit noise in it.
    pub(in crate::consistency) fn record(
        &self,
        group: &NoiseGroup,
        (case, border): (&Case, &Border),
        (cell_design, sigma): (&CellDesign, f64),
        k: usize,
    ) -> OpenRecord {
        let (lead, setup, noise) = (group.noise.pulses.lags, &cell_design.setup, &self.pulses[k]);
        let count = noise.w.len() - noise.burn_in;
        // One sample loads the border; then whole periods until both transients and noise have settled.
        let settling = (case.system.settling_samples(SETTLED) + lead).max(noise.burn_in);
        let before = 1 + settling.next_multiple_of(setup.period()) + setup.period();
        let v = setup.input(k, before - 1 + count);
        let u = border.hysteresis.output(&v, border.hysteresis.u_low());
        let mut white = vec![0.0; before - noise.burn_in];
        white.extend(noise.w.iter().map(|w| sigma * w));
        let y = disturbed(case, &u, &white, 0.0);
        let step_mean = |e: &f64| setup.satellite_output(k) + sigma * e;
        OpenRecord {
            lead,
            v: v[before - lead..].to_vec(),
            y: y[before - lead..].to_vec(),
            step_means: self.steps[k].iter().map(step_mean).collect(),
        }
    }
}

/// The output of a case's system for the input `u` of its linear part and the white source `white`, which enters as the case says.
/// Before the first sample the system rests with `u` at `u_before`.
pub(in crate::consistency) fn disturbed(case: &Case, u: &[f64], white: &[f64], u_before: f64) -> Vec<f64> {
    let (a, b) = (case.system.a(), case.system.b());
    let run = |xi: &[f64]| filter(a, b, u, xi, case.system.static_gain() * u_before, u_before);
    match &case.disturbance {
        Disturbance::White => run(white),
        Disturbance::Coloured { ar, ma } => run(&filter(ar, ma, white, white, 0.0, 0.0)),
        Disturbance::Output => run(&[]).iter().zip(white).map(|(y, w)| y + w).collect(),
    }
}
