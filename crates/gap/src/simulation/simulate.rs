//! Free-run simulation of a fitted model over a record.

use crate::likelihood::design::Design;
use crate::likelihood::engine::Fit;
use crate::model::assembly::{Assembly, BorderColumn, convolve};
use crate::model::stability::stable;
use crate::records::campaign::{Campaign, Track};
use crate::simulation::beginnings::{set_by_first_samples, with_beginnings};

/// The output that the model predicts from the input alone; the samples before the first counted one are the measured ones
/// and set the initial state. Dimensionless units.
pub(crate) fn free_run(campaign: &Campaign, fit: &Fit, number: usize, track: &Track) -> Vec<f64> {
    let begun = started(&fit.assembly, number);
    let (assembly, added) = with_beginnings(campaign, &begun);
    let design = Design::of(campaign, &fit.grid, &assembly, &[(number, track)]);
    let part = &design.tracks[0];
    let mut u = design.input(part, &fit.linear.f);
    if begun != fit.assembly {
        start(&mut u, &design, fit);
    }
    let b = convolve(&fit.linear.b, &design.taps);
    let mut p = fit.linear.padded(fit.grid.len(), &assembly);
    set_by_first_samples(&mut p, &design, part, (added, fit.variance));
    let d = part.columns.coefficients(&p.d);
    let mut x = part.x[..part.from].to_vec();
    for t in part.from..track.v.len() {
        let mut now = 0.0;
        for (i, a) in fit.linear.a.iter().enumerate() {
            now -= a * x[t - i - 1];
        }
        for (j, b) in b.iter().enumerate() {
            now += b * u[t.saturating_sub(j + 1)];
        }
        for (d, psi) in d.iter().zip(part.columns.row(t)) {
            now += d * psi;
        }
        x.push(now.clamp(-BOUND, BOUND));
    }
    let sensed = |x: f64| {
        let y = fit.assembly.curve.read(x);
        match fit.assembly.saturation {
            Some(s) => y.clamp(s.low, s.high),
            None => y,
        }
    };
    let mut y = track.y[..part.from].to_vec();
    y.extend(x[part.from..].iter().map(|x| sensed(*x)));
    y
}

/// An unstable model leaves every range; this bound, in standard deviations of the output, keeps its error finite.
const BOUND: f64 = 1e6;

/// Whether a model has no free run: its `A` is unstable, or its output has come to the bound, or is no number.
pub(crate) fn runs_away<'a>(fit: &Fit, runs: impl IntoIterator<Item = &'a [f64]>) -> bool {
    let leaves = |y: &f64| !y.is_finite() || y.abs() >= BOUND;
    !stable(&fit.linear.a) || runs.into_iter().any(|run| run.iter().any(leaves))
}

/// The assembly with an unknown start of the working point for a track that was not fitted, where fitted tracks have one.
fn started(assembly: &Assembly, number: usize) -> Assembly {
    let mut out = assembly.clone();
    let is_start = |c: &BorderColumn| matches!(c, BorderColumn::Start { .. });
    let own = BorderColumn::Start { track: number };
    if !out.border_columns.contains(&own)
        && let Some(any) = out.border_columns.iter().position(is_start)
    {
        out.border_columns[any] = own;
    }
    out
}

/// Sets the start of the working point by the equation errors before the first counted sample, the only ones a simulation may
/// look at; the present start is that of another track.
fn start(u: &mut [f64], design: &Design, fit: &Fit) {
    let part = &design.tracks[0];
    let is_start = |c: &BorderColumn| matches!(c, BorderColumn::Start { .. });
    let Some(at) = fit.assembly.border_columns.iter().position(is_start) else { return };
    let mut unit = vec![0.0; fit.linear.f.len()];
    unit[fit.grid.len() + at] = 1.0;
    let shape = design.input(part, &unit);
    let other = fit.linear.f[fit.grid.len() + at];
    u.iter_mut().zip(&shape).for_each(|(u, s)| *u -= other * s);
    let b = convolve(&fit.linear.b, &design.taps);
    let (a, x) = (&fit.linear.a, &part.x);
    let through = |u: &[f64], t: usize| -> f64 { b.iter().enumerate().map(|(j, b)| b * u[t - j - 1]).sum() };
    let (mut cross, mut energy) = (0.0, 1e-300);
    for t in a.len().max(b.len())..part.from {
        let left: f64 = x[t] + a.iter().enumerate().map(|(i, a)| a * x[t - i - 1]).sum::<f64>();
        let response = through(&shape, t);
        cross += (left - through(u, t)) * response;
        energy += response * response;
    }
    u.iter_mut().zip(&shape).for_each(|(u, s)| *u += cross / energy * s);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::engine::{Ground, fit};
    use crate::testing::{noise_free, small_campaign, small_model};

    #[test]
    fn what_leaves_every_range_runs_away_and_nothing_else_does() {
        let (campaign, grid) = small_campaign();
        let truth = small_model(&grid);
        let campaign = noise_free(campaign, &grid, &Assembly::default(), &truth);
        let ground = Ground { campaign: &campaign, grid: &grid, known: None };
        let mut fit = fit(ground, &|_| Assembly::default(), &[], &truth, 5).expect("a fit");
        let run = |fit: &Fit| free_run(&campaign, fit, 0, &campaign.tracks[0]);
        assert!(!runs_away(&fit, [&run(&fit)[..]]));
        // A stable model whose run is no number, or beyond the bound.
        assert!(runs_away(&fit, [&[0.0, f64::NAN][..]]) && runs_away(&fit, [&[0.0, -BOUND][..]]));
        // Poles outside the unit circle: a short record need not show it, the coefficients do.
        fit.linear.a = vec![-2.2, 1.21];
        let away = run(&fit);
        assert!(away.iter().all(|y| y.is_finite()) && away.iter().any(|y| y.abs() >= BOUND));
        assert!(runs_away(&fit, [&away[..]]) && runs_away(&fit, [&away[..20]]));
    }
}
